/* 63 operations */
LAW void forces_pair_0(real way_0, real way_1, real slot_a, real slot_b, real my_side_0, real my_side_1, real my_side_2, real my_side_3, real my_side_4, real my_side_5, real my_side_6, real my_side_7, real its_side_0, real its_side_1, real its_side_2, real its_side_3, real its_side_4, real its_side_5, real its_side_6, real its_side_7, real s_pressure_x, real s_pressure_y, real s_viscosity_x, real s_viscosity_y, real s_artificial_viscosity_x, real s_artificial_viscosity_y, real s_walls_x, real s_walls_y, real s_carried_x, real s_carried_y, real s_volume_x, real s_volume_y, real s_crowding_x, real s_crowding_y, real *d_pressure_x, real *d_pressure_y, real *d_viscosity_x, real *d_viscosity_y, real *d_artificial_viscosity_x, real *d_artificial_viscosity_y, real *d_walls_x, real *d_walls_y, real *d_carried_x, real *d_carried_y, real *d_volume_x, real *d_volume_y, real *d_crowding_x, real *d_crowding_y)
{
    const real t35 = way_0 * way_0;
    const real t36 = way_1 * way_1;
    const real t37 = t35 + t36;
    const real t38 = sqrt(t37);
    const real t40 = t38 * 10.0;
    const real t42 = t40 * 0.5;
    const real t43 = 0.0 * t42;
    const real t45 = t43 + 4.0;
    const real t46 = t45 * t42;
    const real t48 = t46 + 1.0;
    const real t49 = -t42;
    const real t50 = t49 + 1.0;
    const real t51 = t50 * t50;
    const real t52 = t51 * t51;
    const real t53 = t52 * t48;
    const int t55 = t40 < 2.0;
    const real t56 = t55 ? t53 : 0.0;
    const real t58 = t56 * 55.70423008216338;
    const real t60 = t43 + (-5.0);
    const real t61 = t50 * t51;
    const real t62 = t61 * t60;
    const real t63 = t55 ? t62 : 0.0;
    const real t65 = t63 * 5570.423008216338;
    const real t66 = its_side_5 * its_side_4;
    const real t67 = t66 * t65;
    const real t68 = my_side_0 - its_side_0;
    const real t69 = my_side_1 - its_side_1;
    const real t70 = my_side_4 + its_side_4;
    const real t75 = 1.0 / t70;
    const real t76 = t67 * t75;
    const real t78 = t76 * 0.04;
    const real t79 = my_side_6 + its_side_6;
    const real t80 = t67 * t79;
    const real t81 = way_0 * t80;
    const real t82 = s_pressure_x - t81;
    const real t83 = t68 * t78;
    const real t84 = s_viscosity_x + t83;
    const real t85 = way_1 * t80;
    const real t86 = s_pressure_y - t85;
    const real t87 = t69 * t78;
    const real t88 = s_viscosity_y + t87;
    const real t89 = its_side_5 * t65;
    const real t90 = my_side_2 * way_0;
    const real t91 = my_side_3 * way_1;
    const real t92 = t90 + t91;
    const real t93 = t92 * t89;
    const real t94 = t68 * t93;
    const real t95 = s_carried_x - t94;
    const real t96 = t69 * t93;
    const real t97 = s_carried_y - t96;
    const real t99 = t58 * 0.02;
    const real t100 = t99 * t99;
    const real t101 = t100 * t100;
    const real t103 = t101 * 0.2;
    const real t104 = t103 + 1.0;
    const real t105 = way_0 * t89;
    const real t106 = s_volume_x + t105;
    const real t107 = t105 * t104;
    const real t108 = s_crowding_x + t107;
    const real t109 = way_1 * t89;
    const real t110 = s_volume_y + t109;
    const real t111 = t109 * t104;
    const real t112 = s_crowding_y + t111;
    *d_pressure_x = t82;
    *d_pressure_y = t86;
    *d_viscosity_x = t84;
    *d_viscosity_y = t88;
    *d_artificial_viscosity_x = s_artificial_viscosity_x;
    *d_artificial_viscosity_y = s_artificial_viscosity_y;
    *d_walls_x = s_walls_x;
    *d_walls_y = s_walls_y;
    *d_carried_x = t95;
    *d_carried_y = t97;
    *d_volume_x = t106;
    *d_volume_y = t110;
    *d_crowding_x = t108;
    *d_crowding_y = t112;
}
/* 4 operations */
LAW void forces_close(real s_pressure_x, real s_pressure_y, real s_viscosity_x, real s_viscosity_y, real s_artificial_viscosity_x, real s_artificial_viscosity_y, real s_walls_x, real s_walls_y, real s_carried_x, real s_carried_y, real s_volume_x, real s_volume_y, real s_crowding_x, real s_crowding_y, real scale, real *new_force_0, real *new_force_1)
{
    const real t16 = s_pressure_x + s_viscosity_x;
    const real t17 = t16 * scale;
    const real t18 = s_pressure_y + s_viscosity_y;
    const real t19 = t18 * scale;
    *new_force_0 = t17;
    *new_force_1 = t19;
}
/* 8 operations */
LAW void forces_separation(real here_0, real here_1, real there_0, real there_1, real *way_0, real *way_1)
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
KERNEL void forces(const int n, const real scale, GLOBAL const unsigned *__restrict__ numbers, GLOBAL const unsigned *__restrict__ passive, GLOBAL const unsigned *__restrict__ entries, GLOBAL const unsigned *__restrict__ first, GLOBAL const unsigned *__restrict__ active, GLOBAL const real *__restrict__ place, GLOBAL const real *__restrict__ side, GLOBAL const real *__restrict__ near, GLOBAL real *__restrict__ force)
{
    const int thread = blockIdx.x * blockDim.x + threadIdx.x;
    const int lane = thread % 8;
    const int a = thread / 8 < n ? thread / 8 : 0;
    const int is_on = thread / 8 < n && passive[numbers[a]] >= 0 && near[a] > 0.5;
    {
    const Pair here_0_piece = ((GLOBAL const Pair *)place)[a];
    const real here_0 = here_0_piece.x, here_1 = here_0_piece.y;
    const Pair my_side_0_piece = ((GLOBAL const Pair *)side)[(size_t)a * 4 + 0];
    const real my_side_0 = my_side_0_piece.x, my_side_1 = my_side_0_piece.y;
    const Pair my_side_2_piece = ((GLOBAL const Pair *)side)[(size_t)a * 4 + 1];
    const real my_side_2 = my_side_2_piece.x, my_side_3 = my_side_2_piece.y;
    const Pair my_side_4_piece = ((GLOBAL const Pair *)side)[(size_t)a * 4 + 2];
    const real my_side_4 = my_side_4_piece.x, my_side_5 = my_side_4_piece.y;
    const Pair my_side_6_piece = ((GLOBAL const Pair *)side)[(size_t)a * 4 + 3];
    const real my_side_6 = my_side_6_piece.x, my_side_7 = my_side_6_piece.y;
    real s_pressure_x = 0;
    real s_pressure_y = 0;
    real s_viscosity_x = 0;
    real s_viscosity_y = 0;
    real s_artificial_viscosity_x = 0;
    real s_artificial_viscosity_y = 0;
    real s_walls_x = 0;
    real s_walls_y = 0;
    real s_carried_x = 0;
    real s_carried_y = 0;
    real s_volume_x = 0;
    real s_volume_y = 0;
    real s_crowding_x = 0;
    real s_crowding_y = 0;
    {
    const unsigned from = first[a], end = is_on ? active[a] : 0;
    for (unsigned k = lane, next = k < end ? entries[from + k] : 0; k < end; k += 8) {
        const unsigned b = next;
        next = k + 8 < end ? entries[from + k + 8] : 0;
        const Pair there_0_piece = ((GLOBAL const Pair *)place)[b];
        const real there_0 = there_0_piece.x, there_1 = there_0_piece.y;
        real way_0 = here_0 - there_0, way_1 = here_1 - there_1;
        if (fabs(way_0) > 1.0) forces_separation(here_0, here_1, there_0, there_1, &way_0, &way_1);
        const Pair its_side_0_piece = ((GLOBAL const Pair *)side)[(size_t)b * 4 + 0];
        const real its_side_0 = its_side_0_piece.x, its_side_1 = its_side_0_piece.y;
        const Pair its_side_2_piece = ((GLOBAL const Pair *)side)[(size_t)b * 4 + 1];
        const real its_side_2 = its_side_2_piece.x, its_side_3 = its_side_2_piece.y;
        const Pair its_side_4_piece = ((GLOBAL const Pair *)side)[(size_t)b * 4 + 2];
        const real its_side_4 = its_side_4_piece.x, its_side_5 = its_side_4_piece.y;
        const Pair its_side_6_piece = ((GLOBAL const Pair *)side)[(size_t)b * 4 + 3];
        const real its_side_6 = its_side_6_piece.x, its_side_7 = its_side_6_piece.y;
        forces_pair_0(way_0, way_1, (real)a, (real)b, my_side_0, my_side_1, my_side_2, my_side_3, my_side_4, my_side_5, my_side_6, my_side_7, its_side_0, its_side_1, its_side_2, its_side_3, its_side_4, its_side_5, its_side_6, its_side_7, s_pressure_x, s_pressure_y, s_viscosity_x, s_viscosity_y, s_artificial_viscosity_x, s_artificial_viscosity_y, s_walls_x, s_walls_y, s_carried_x, s_carried_y, s_volume_x, s_volume_y, s_crowding_x, s_crowding_y, &s_pressure_x, &s_pressure_y, &s_viscosity_x, &s_viscosity_y, &s_artificial_viscosity_x, &s_artificial_viscosity_y, &s_walls_x, &s_walls_y, &s_carried_x, &s_carried_y, &s_volume_x, &s_volume_y, &s_crowding_x, &s_crowding_y);
    }
    }
    s_pressure_x += __shfl_down_sync(WHOLE_WARP, s_pressure_x, 4, 8);
    s_pressure_x += __shfl_down_sync(WHOLE_WARP, s_pressure_x, 2, 8);
    s_pressure_x += __shfl_down_sync(WHOLE_WARP, s_pressure_x, 1, 8);
    s_pressure_y += __shfl_down_sync(WHOLE_WARP, s_pressure_y, 4, 8);
    s_pressure_y += __shfl_down_sync(WHOLE_WARP, s_pressure_y, 2, 8);
    s_pressure_y += __shfl_down_sync(WHOLE_WARP, s_pressure_y, 1, 8);
    s_viscosity_x += __shfl_down_sync(WHOLE_WARP, s_viscosity_x, 4, 8);
    s_viscosity_x += __shfl_down_sync(WHOLE_WARP, s_viscosity_x, 2, 8);
    s_viscosity_x += __shfl_down_sync(WHOLE_WARP, s_viscosity_x, 1, 8);
    s_viscosity_y += __shfl_down_sync(WHOLE_WARP, s_viscosity_y, 4, 8);
    s_viscosity_y += __shfl_down_sync(WHOLE_WARP, s_viscosity_y, 2, 8);
    s_viscosity_y += __shfl_down_sync(WHOLE_WARP, s_viscosity_y, 1, 8);
    s_carried_x += __shfl_down_sync(WHOLE_WARP, s_carried_x, 4, 8);
    s_carried_x += __shfl_down_sync(WHOLE_WARP, s_carried_x, 2, 8);
    s_carried_x += __shfl_down_sync(WHOLE_WARP, s_carried_x, 1, 8);
    s_carried_y += __shfl_down_sync(WHOLE_WARP, s_carried_y, 4, 8);
    s_carried_y += __shfl_down_sync(WHOLE_WARP, s_carried_y, 2, 8);
    s_carried_y += __shfl_down_sync(WHOLE_WARP, s_carried_y, 1, 8);
    s_volume_x += __shfl_down_sync(WHOLE_WARP, s_volume_x, 4, 8);
    s_volume_x += __shfl_down_sync(WHOLE_WARP, s_volume_x, 2, 8);
    s_volume_x += __shfl_down_sync(WHOLE_WARP, s_volume_x, 1, 8);
    s_volume_y += __shfl_down_sync(WHOLE_WARP, s_volume_y, 4, 8);
    s_volume_y += __shfl_down_sync(WHOLE_WARP, s_volume_y, 2, 8);
    s_volume_y += __shfl_down_sync(WHOLE_WARP, s_volume_y, 1, 8);
    s_crowding_x += __shfl_down_sync(WHOLE_WARP, s_crowding_x, 4, 8);
    s_crowding_x += __shfl_down_sync(WHOLE_WARP, s_crowding_x, 2, 8);
    s_crowding_x += __shfl_down_sync(WHOLE_WARP, s_crowding_x, 1, 8);
    s_crowding_y += __shfl_down_sync(WHOLE_WARP, s_crowding_y, 4, 8);
    s_crowding_y += __shfl_down_sync(WHOLE_WARP, s_crowding_y, 2, 8);
    s_crowding_y += __shfl_down_sync(WHOLE_WARP, s_crowding_y, 1, 8);
    if (!is_on || lane > 0) return;
    real new_force_0, new_force_1;
    forces_close(s_pressure_x, s_pressure_y, s_viscosity_x, s_viscosity_y, s_artificial_viscosity_x, s_artificial_viscosity_y, s_walls_x, s_walls_y, s_carried_x, s_carried_y, s_volume_x, s_volume_y, s_crowding_x, s_crowding_y, scale, &new_force_0, &new_force_1);
    force[(size_t)a * 2 + 0] = new_force_0;
    force[(size_t)a * 2 + 1] = new_force_1;
    }
}
