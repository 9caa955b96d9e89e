/* 21 operations */
LAW void density_pair_0(real way_0, real way_1, real slot_a, real slot_b, real my_side_0, real my_side_1, real my_side_2, real my_side_3, real my_side_4, real my_side_5, real my_side_6, real my_side_7, real its_side_0, real its_side_1, real its_side_2, real its_side_3, real its_side_4, real its_side_5, real its_side_6, real its_side_7, real s, real *d)
{
    const real t22 = way_0 * way_0;
    const real t23 = way_1 * way_1;
    const real t24 = t22 + t23;
    const real t25 = sqrt(t24);
    const real t27 = t25 * 10.0;
    const real t29 = t27 * 0.5;
    const real t30 = 0.0 * t29;
    const real t32 = t30 + 4.0;
    const real t33 = t32 * t29;
    const real t35 = t33 + 1.0;
    const real t36 = -t29;
    const real t37 = t36 + 1.0;
    const real t38 = t37 * t37;
    const real t39 = t38 * t38;
    const real t40 = t39 * t35;
    const int t42 = t27 < 2.0;
    const real t43 = t42 ? t40 : 0.0;
    const real t45 = t43 * 55.70423008216338;
    const real t53 = its_side_5 * its_side_4;
    const real t54 = t53 * t45;
    const real t55 = s + t54;
    *d = t55;
}
/* 0 operations */
LAW void density_close(real s, real *new_summed_0)
{
    *new_summed_0 = s;
}
/* 8 operations */
LAW void density_separation(real here_0, real here_1, real there_0, real there_1, real *way_0, real *way_1)
{
    const real t4 = here_0 - there_0;
    const int t6 = 1.0 < t4;
    const real t8 = t4 - 2.0;
    const real t9 = t6 ? t8 : t4;
    const int t11 = t4 < (-1.0);
    const real t12 = t4 + 2.0;
    const real t13 = t11 ? t12 : t9;
    const real t14 = here_1 - there_1;
    *way_0 = t13;
    *way_1 = t14;
}
KERNEL void density(const int n, GLOBAL const unsigned *__restrict__ numbers, GLOBAL const unsigned *__restrict__ passive, GLOBAL const unsigned *__restrict__ entries, GLOBAL const unsigned *__restrict__ first, GLOBAL const unsigned *__restrict__ active, GLOBAL const unsigned *__restrict__ passive_first, GLOBAL const unsigned *__restrict__ passive_count, GLOBAL const real *__restrict__ place, GLOBAL const real *__restrict__ side, GLOBAL real *__restrict__ summed)
{
    const int thread = blockIdx.x * blockDim.x + threadIdx.x;
    const int lane = thread % 8;
    const int a = thread / 8 < n ? thread / 8 : 0;
    const int is_on = thread / 8 < n && passive[numbers[a]] == 0;
    {
    const Pair here_0_piece = ((GLOBAL const Pair *)place)[a];
    const real here_0 = here_0_piece.x, here_1 = here_0_piece.y;
    real s = 0;
    {
    const unsigned from = first[a], end = is_on ? active[a] : 0;
    for (unsigned row = 0; __any_sync(WHOLE_WARP, row < end); row += 8) {
        const unsigned k = row + lane;
        const unsigned b = k < end ? entries[from + k] : a;
        const Pair there_0_piece = ((GLOBAL const Pair *)place)[b];
        const real there_0 = there_0_piece.x, there_1 = there_0_piece.y;
        real way_0 = here_0 - there_0, way_1 = here_1 - there_1;
        if (fabs(way_0) > 1.0) density_separation(here_0, here_1, there_0, there_1, &way_0, &way_1);
        const Pair its_side_0_piece = ((GLOBAL const Pair *)side)[(size_t)b * 4 + 0];
        const real its_side_0 = its_side_0_piece.x, its_side_1 = its_side_0_piece.y;
        const Pair its_side_2_piece = ((GLOBAL const Pair *)side)[(size_t)b * 4 + 1];
        const real its_side_2 = its_side_2_piece.x, its_side_3 = its_side_2_piece.y;
        const Pair its_side_4_piece = ((GLOBAL const Pair *)side)[(size_t)b * 4 + 2];
        const real its_side_4 = its_side_4_piece.x, its_side_5 = its_side_4_piece.y;
        const Pair its_side_6_piece = ((GLOBAL const Pair *)side)[(size_t)b * 4 + 3];
        const real its_side_6 = its_side_6_piece.x, its_side_7 = its_side_6_piece.y;
        real ts;
        density_pair_0(way_0, way_1, (real)a, (real)b, 0, 0, 0, 0, 0, 0, 0, 0, its_side_0, its_side_1, its_side_2, its_side_3, its_side_4, its_side_5, its_side_6, its_side_7, 0, &ts);
        for (int j = 0; j < 8; ++j) {
            { const real t = __shfl_sync(WHOLE_WARP, ts, j, 8); if (row + j < end) s += t; }
        }
    }
    }
    {
    const unsigned from = passive_first[a], end = is_on ? passive_count[a] : 0;
    for (unsigned row = 0; __any_sync(WHOLE_WARP, row < end); row += 8) {
        const unsigned k = row + lane;
        const unsigned b = k < end ? entries[from + k] : a;
        const Pair there_0_piece = ((GLOBAL const Pair *)place)[b];
        const real there_0 = there_0_piece.x, there_1 = there_0_piece.y;
        real way_0 = here_0 - there_0, way_1 = here_1 - there_1;
        if (fabs(way_0) > 1.0) density_separation(here_0, here_1, there_0, there_1, &way_0, &way_1);
        const Pair its_side_0_piece = ((GLOBAL const Pair *)side)[(size_t)b * 4 + 0];
        const real its_side_0 = its_side_0_piece.x, its_side_1 = its_side_0_piece.y;
        const Pair its_side_2_piece = ((GLOBAL const Pair *)side)[(size_t)b * 4 + 1];
        const real its_side_2 = its_side_2_piece.x, its_side_3 = its_side_2_piece.y;
        const Pair its_side_4_piece = ((GLOBAL const Pair *)side)[(size_t)b * 4 + 2];
        const real its_side_4 = its_side_4_piece.x, its_side_5 = its_side_4_piece.y;
        const Pair its_side_6_piece = ((GLOBAL const Pair *)side)[(size_t)b * 4 + 3];
        const real its_side_6 = its_side_6_piece.x, its_side_7 = its_side_6_piece.y;
        real ts;
        density_pair_0(way_0, way_1, (real)a, (real)b, 0, 0, 0, 0, 0, 0, 0, 0, its_side_0, its_side_1, its_side_2, its_side_3, its_side_4, its_side_5, its_side_6, its_side_7, 0, &ts);
        for (int j = 0; j < 8; ++j) {
            { const real t = __shfl_sync(WHOLE_WARP, ts, j, 8); if (row + j < end) s += t; }
        }
    }
    }
    if (!is_on || lane > 0) return;
    real new_summed_0;
    density_close(s, &new_summed_0);
    summed[a] = new_summed_0;
    }
}
