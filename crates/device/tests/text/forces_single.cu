/* 63 operations */
LAW void forces_pair_0(work way_0, work way_1, work slot_a, work slot_b, work my_side_0, work my_side_1, work my_side_2, work my_side_3, work my_side_4, work my_side_5, work my_side_6, work my_side_7, work its_side_0, work its_side_1, work its_side_2, work its_side_3, work its_side_4, work its_side_5, work its_side_6, work its_side_7, work s_pressure_x, work s_pressure_y, work s_viscosity_x, work s_viscosity_y, work s_artificial_viscosity_x, work s_artificial_viscosity_y, work s_walls_x, work s_walls_y, work s_carried_x, work s_carried_y, work s_volume_x, work s_volume_y, work s_crowding_x, work s_crowding_y, work *d_pressure_x, work *d_pressure_y, work *d_viscosity_x, work *d_viscosity_y, work *d_artificial_viscosity_x, work *d_artificial_viscosity_y, work *d_walls_x, work *d_walls_y, work *d_carried_x, work *d_carried_y, work *d_volume_x, work *d_volume_y, work *d_crowding_x, work *d_crowding_y)
{
    const work t35 = way_0 * way_0;
    const work t36 = way_1 * way_1;
    const work t37 = t35 + t36;
    const work t38 = sqrtf(t37);
    const work t40 = t38 * 10.0f;
    const work t42 = t40 * 0.5f;
    const work t43 = 0.0f * t42;
    const work t45 = t43 + 4.0f;
    const work t46 = t45 * t42;
    const work t48 = t46 + 1.0f;
    const work t49 = -t42;
    const work t50 = t49 + 1.0f;
    const work t51 = t50 * t50;
    const work t52 = t51 * t51;
    const work t53 = t52 * t48;
    const int t55 = t40 < 2.0f;
    const work t56 = t55 ? t53 : 0.0f;
    const work t58 = t56 * 55.70423f;
    const work t60 = t43 + (-5.0f);
    const work t61 = t50 * t51;
    const work t62 = t61 * t60;
    const work t63 = t55 ? t62 : 0.0f;
    const work t65 = t63 * 5570.423f;
    const work t66 = its_side_5 * its_side_4;
    const work t67 = t66 * t65;
    const work t68 = my_side_0 - its_side_0;
    const work t69 = my_side_1 - its_side_1;
    const work t70 = my_side_4 + its_side_4;
    const work t75 = 1.0f / t70;
    const work t76 = t67 * t75;
    const work t78 = t76 * 0.04f;
    const work t79 = my_side_6 + its_side_6;
    const work t80 = t67 * t79;
    const work t81 = way_0 * t80;
    const work t82 = s_pressure_x - t81;
    const work t83 = t68 * t78;
    const work t84 = s_viscosity_x + t83;
    const work t85 = way_1 * t80;
    const work t86 = s_pressure_y - t85;
    const work t87 = t69 * t78;
    const work t88 = s_viscosity_y + t87;
    const work t89 = its_side_5 * t65;
    const work t90 = my_side_2 * way_0;
    const work t91 = my_side_3 * way_1;
    const work t92 = t90 + t91;
    const work t93 = t92 * t89;
    const work t94 = t68 * t93;
    const work t95 = s_carried_x - t94;
    const work t96 = t69 * t93;
    const work t97 = s_carried_y - t96;
    const work t99 = t58 * 0.02f;
    const work t100 = t99 * t99;
    const work t101 = t100 * t100;
    const work t103 = t101 * 0.2f;
    const work t104 = t103 + 1.0f;
    const work t105 = way_0 * t89;
    const work t106 = s_volume_x + t105;
    const work t107 = t105 * t104;
    const work t108 = s_crowding_x + t107;
    const work t109 = way_1 * t89;
    const work t110 = s_volume_y + t109;
    const work t111 = t109 * t104;
    const work t112 = s_crowding_y + t111;
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
KERNEL void EIGHT_BLOCKS forces(const int n, const real scale, GLOBAL const unsigned *__restrict__ numbers, GLOBAL const unsigned *__restrict__ passive, GLOBAL const unsigned *__restrict__ entries, GLOBAL const unsigned *__restrict__ first, GLOBAL const unsigned *__restrict__ active, const int spot_rows, GLOBAL const work *__restrict__ spot, const int side_rows, GLOBAL const work *__restrict__ side, GLOBAL const real *__restrict__ near, GLOBAL real *__restrict__ force)
{
    const int thread = blockIdx.x * blockDim.x + threadIdx.x;
    const int lane = thread % 8;
    const int a = thread / 8 < n ? thread / 8 : 0;
    const int is_on = thread / 8 < n && passive[numbers[a]] >= 0 && near[a] > 0.5;
    {
    const WorkPair here_0_piece = ((GLOBAL const WorkPair *)spot)[a];
    const work here_0 = here_0_piece.x, here_1 = here_0_piece.y;
    const WorkQuad my_side_0_piece = ((GLOBAL const WorkQuad *)side)[a];
    const work my_side_0 = my_side_0_piece.x, my_side_1 = my_side_0_piece.y, my_side_2 = my_side_0_piece.z, my_side_3 = my_side_0_piece.w;
    const WorkQuad my_side_4_piece = ((GLOBAL const WorkQuad *)side)[a + 1 * side_rows];
    const work my_side_4 = my_side_4_piece.x, my_side_5 = my_side_4_piece.y, my_side_6 = my_side_4_piece.z, my_side_7 = my_side_4_piece.w;
    work s_pressure_x = 0;
    work s_pressure_y = 0;
    work s_viscosity_x = 0;
    work s_viscosity_y = 0;
    work s_artificial_viscosity_x = 0;
    work s_artificial_viscosity_y = 0;
    work s_walls_x = 0;
    work s_walls_y = 0;
    work s_carried_x = 0;
    work s_carried_y = 0;
    work s_volume_x = 0;
    work s_volume_y = 0;
    work s_crowding_x = 0;
    work s_crowding_y = 0;
    {
    const unsigned from = first[a], end = is_on ? active[a] : 0;
    for (unsigned k = lane, next = k < end ? entries[from + k] : 0; k < end; k += 8) {
        const unsigned b = next;
        next = k + 8 < end ? entries[from + k + 8] : 0;
        const WorkPair there_0_piece = ((GLOBAL const WorkPair *)spot)[b];
        const work there_0 = there_0_piece.x, there_1 = there_0_piece.y;
        const work way_0 = p_way(here_0, there_0) * 2.3283064e-10f;
        const work way_1 = p_way(here_1, there_1) * 2.142042e-10f;
        const WorkQuad its_side_0_piece = ((GLOBAL const WorkQuad *)side)[b];
        const work its_side_0 = its_side_0_piece.x, its_side_1 = its_side_0_piece.y, its_side_2 = its_side_0_piece.z, its_side_3 = its_side_0_piece.w;
        const WorkQuad its_side_4_piece = ((GLOBAL const WorkQuad *)side)[b + 1 * side_rows];
        const work its_side_4 = its_side_4_piece.x, its_side_5 = its_side_4_piece.y, its_side_6 = its_side_4_piece.z, its_side_7 = its_side_4_piece.w;
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
