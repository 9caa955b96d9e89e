/* 10 operations */
LAW void in_order_pair_0(real pair_0, real pair_1, real slot_a, real slot_b, real my_displacement_0, real my_displacement_1, real its_displacement_0, real its_displacement_1, real s_0_xx, real s_0_xy, real s_0_yx, real s_0_yy, real *d_0_xx, real *d_0_xy, real *d_0_yx, real *d_0_yy)
{
    const real t14 = its_displacement_0 - my_displacement_0;
    const real t15 = its_displacement_1 - my_displacement_1;
    const real t16 = t14 * pair_0;
    const real t17 = s_0_xx + t16;
    const real t18 = t15 * pair_0;
    const real t19 = s_0_yx + t18;
    const real t20 = t14 * pair_1;
    const real t21 = s_0_xy + t20;
    const real t22 = t15 * pair_1;
    const real t23 = s_0_yy + t22;
    *d_0_xx = t17;
    *d_0_xy = t21;
    *d_0_yx = t19;
    *d_0_yy = t23;
}
/* 0 operations */
LAW void in_order_close(real s_0_xx, real s_0_xy, real s_0_yx, real s_0_yy, real *new_gradient_0, real *new_gradient_1, real *new_gradient_2, real *new_gradient_3)
{
    *new_gradient_0 = s_0_xx;
    *new_gradient_1 = s_0_xy;
    *new_gradient_2 = s_0_yx;
    *new_gradient_3 = s_0_yy;
}
KERNEL void in_order(const int n, GLOBAL const unsigned *__restrict__ row, GLOBAL const unsigned *__restrict__ row_count, GLOBAL const unsigned *__restrict__ neighbors, GLOBAL const real *__restrict__ numbers, GLOBAL const real *__restrict__ displacement, GLOBAL real *__restrict__ gradient)
{
    const int thread = blockIdx.x * blockDim.x + threadIdx.x;
    const int lane = thread % 8;
    const int a = thread / 8 < n ? thread / 8 : 0;
    const int is_on = thread / 8 < n;
    {
    const Pair my_displacement_0_piece = ((GLOBAL const Pair *)displacement)[a];
    const real my_displacement_0 = my_displacement_0_piece.x, my_displacement_1 = my_displacement_0_piece.y;
    real s_0_xx = 0;
    real s_0_xy = 0;
    real s_0_yx = 0;
    real s_0_yy = 0;
    {
    const unsigned from = row[a], end = is_on ? row_count[a] : 0;
    for (unsigned row = 0; __any_sync(WHOLE_WARP, row < end); row += 8) {
        const unsigned k = row + lane;
        const unsigned b = k < end ? neighbors[from * 8 + k] : a;
        const unsigned block = from + k / 8;
        const real pair_0 = k < end ? numbers[(size_t)block * 16 + 0 + k % 8] : 0;
        const real pair_1 = k < end ? numbers[(size_t)block * 16 + 8 + k % 8] : 0;
        const Pair its_displacement_0_piece = ((GLOBAL const Pair *)displacement)[b];
        const real its_displacement_0 = its_displacement_0_piece.x, its_displacement_1 = its_displacement_0_piece.y;
        real ts_0_xx, ts_0_xy, ts_0_yx, ts_0_yy;
        in_order_pair_0(pair_0, pair_1, (real)a, (real)b, my_displacement_0, my_displacement_1, its_displacement_0, its_displacement_1, 0, 0, 0, 0, &ts_0_xx, &ts_0_xy, &ts_0_yx, &ts_0_yy);
        for (int j = 0; j < 8; ++j) {
            { const real t = __shfl_sync(WHOLE_WARP, ts_0_xx, j, 8); if (row + j < end) s_0_xx += t; }
            { const real t = __shfl_sync(WHOLE_WARP, ts_0_xy, j, 8); if (row + j < end) s_0_xy += t; }
            { const real t = __shfl_sync(WHOLE_WARP, ts_0_yx, j, 8); if (row + j < end) s_0_yx += t; }
            { const real t = __shfl_sync(WHOLE_WARP, ts_0_yy, j, 8); if (row + j < end) s_0_yy += t; }
        }
    }
    }
    if (!is_on || lane > 0) return;
    real new_gradient_0, new_gradient_1, new_gradient_2, new_gradient_3;
    in_order_close(s_0_xx, s_0_xy, s_0_yx, s_0_yy, &new_gradient_0, &new_gradient_1, &new_gradient_2, &new_gradient_3);
    gradient[(size_t)a * 4 + 0] = new_gradient_0;
    gradient[(size_t)a * 4 + 1] = new_gradient_1;
    gradient[(size_t)a * 4 + 2] = new_gradient_2;
    gradient[(size_t)a * 4 + 3] = new_gradient_3;
    }
}
