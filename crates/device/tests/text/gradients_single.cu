/* 10 operations */
LAW void gradients_pair_0(work pair_0, work pair_1, work slot_a, work slot_b, work my_displacement_0, work my_displacement_1, work its_displacement_0, work its_displacement_1, work s_0_xx, work s_0_xy, work s_0_yx, work s_0_yy, work *d_0_xx, work *d_0_xy, work *d_0_yx, work *d_0_yy)
{
    const work t14 = its_displacement_0 - my_displacement_0;
    const work t15 = its_displacement_1 - my_displacement_1;
    const work t16 = t14 * pair_0;
    const work t17 = s_0_xx + t16;
    const work t18 = t15 * pair_0;
    const work t19 = s_0_yx + t18;
    const work t20 = t14 * pair_1;
    const work t21 = s_0_xy + t20;
    const work t22 = t15 * pair_1;
    const work t23 = s_0_yy + t22;
    *d_0_xx = t17;
    *d_0_xy = t21;
    *d_0_yx = t19;
    *d_0_yy = t23;
}
/* 0 operations */
LAW void gradients_close(real s_0_xx, real s_0_xy, real s_0_yx, real s_0_yy, real *new_gradient_0, real *new_gradient_1, real *new_gradient_2, real *new_gradient_3)
{
    *new_gradient_0 = s_0_xx;
    *new_gradient_1 = s_0_xy;
    *new_gradient_2 = s_0_yx;
    *new_gradient_3 = s_0_yy;
}
KERNEL void gradients(const int n, GLOBAL const unsigned *__restrict__ row, GLOBAL const unsigned *__restrict__ row_count, GLOBAL const unsigned *__restrict__ neighbors, GLOBAL const work *__restrict__ numbers, GLOBAL const real *__restrict__ displacement, GLOBAL real *__restrict__ gradient)
{
    const int thread = blockIdx.x * blockDim.x + threadIdx.x;
    const int lane = thread % 8;
    const int a = thread / 8 < n ? thread / 8 : 0;
    const int is_on = thread / 8 < n;
    {
    const Pair my_displacement_0_piece = ((GLOBAL const Pair *)displacement)[a];
    const real my_displacement_0 = my_displacement_0_piece.x, my_displacement_1 = my_displacement_0_piece.y;
    work s_0_xx = 0;
    work s_0_xy = 0;
    work s_0_yx = 0;
    work s_0_yy = 0;
    {
    const unsigned from = row[a], end = is_on ? row_count[a] : 0;
    for (unsigned k = lane, next = k < end ? neighbors[from * 8 + k] : 0; k < end; k += 8) {
        const unsigned b = next;
        next = k + 8 < end ? neighbors[from * 8 + k + 8] : 0;
        const unsigned block = from + k / 8;
        const work pair_0 = numbers[(size_t)block * 16 + 0 + k % 8];
        const work pair_1 = numbers[(size_t)block * 16 + 8 + k % 8];
        const Pair its_displacement_0_piece = ((GLOBAL const Pair *)displacement)[b];
        const real its_displacement_0 = its_displacement_0_piece.x, its_displacement_1 = its_displacement_0_piece.y;
        gradients_pair_0(pair_0, pair_1, (real)a, (real)b, 0, 0, (work)(its_displacement_0 - my_displacement_0), (work)(its_displacement_1 - my_displacement_1), s_0_xx, s_0_xy, s_0_yx, s_0_yy, &s_0_xx, &s_0_xy, &s_0_yx, &s_0_yy);
    }
    }
    s_0_xx += __shfl_down_sync(WHOLE_WARP, s_0_xx, 4, 8);
    s_0_xx += __shfl_down_sync(WHOLE_WARP, s_0_xx, 2, 8);
    s_0_xx += __shfl_down_sync(WHOLE_WARP, s_0_xx, 1, 8);
    s_0_xy += __shfl_down_sync(WHOLE_WARP, s_0_xy, 4, 8);
    s_0_xy += __shfl_down_sync(WHOLE_WARP, s_0_xy, 2, 8);
    s_0_xy += __shfl_down_sync(WHOLE_WARP, s_0_xy, 1, 8);
    s_0_yx += __shfl_down_sync(WHOLE_WARP, s_0_yx, 4, 8);
    s_0_yx += __shfl_down_sync(WHOLE_WARP, s_0_yx, 2, 8);
    s_0_yx += __shfl_down_sync(WHOLE_WARP, s_0_yx, 1, 8);
    s_0_yy += __shfl_down_sync(WHOLE_WARP, s_0_yy, 4, 8);
    s_0_yy += __shfl_down_sync(WHOLE_WARP, s_0_yy, 2, 8);
    s_0_yy += __shfl_down_sync(WHOLE_WARP, s_0_yy, 1, 8);
    if (!is_on || lane > 0) return;
    real new_gradient_0, new_gradient_1, new_gradient_2, new_gradient_3;
    gradients_close(s_0_xx, s_0_xy, s_0_yx, s_0_yy, &new_gradient_0, &new_gradient_1, &new_gradient_2, &new_gradient_3);
    gradient[(size_t)a * 4 + 0] = new_gradient_0;
    gradient[(size_t)a * 4 + 1] = new_gradient_1;
    gradient[(size_t)a * 4 + 2] = new_gradient_2;
    gradient[(size_t)a * 4 + 3] = new_gradient_3;
    }
}
