/* 65 operations */
LAW void forces_pair_0(work way_0, work way_1, work slot_a, work slot_b, work my_side_0, work my_side_1, work my_side_2, work my_side_3, work my_side_4, work my_side_5, work my_side_6, work my_side_7, work its_side_0, work its_side_1, work its_side_2, work its_side_3, work its_side_4, work its_side_5, work its_side_6, work its_side_7, work s_pressure_x, work s_pressure_y, work s_viscosity_x, work s_viscosity_y, work s_artificial_viscosity_x, work s_artificial_viscosity_y, work s_walls_x, work s_walls_y, work s_carried_x, work s_carried_y, work s_volume_x, work s_volume_y, work s_crowding_x, work s_crowding_y, work s_filling, work *d_pressure_x, work *d_pressure_y, work *d_viscosity_x, work *d_viscosity_y, work *d_artificial_viscosity_x, work *d_artificial_viscosity_y, work *d_walls_x, work *d_walls_y, work *d_carried_x, work *d_carried_y, work *d_volume_x, work *d_volume_y, work *d_crowding_x, work *d_crowding_y, work *d_filling)
{
    const work t36 = way_0 * way_0;
    const work t37 = way_1 * way_1;
    const work t38 = t36 + t37;
    const work t39 = sqrtf(t38);
    const work t41 = t39 * 10.0f;
    const work t43 = t41 * 0.5f;
    const work t44 = 0.0f * t43;
    const work t46 = t44 + 4.0f;
    const work t47 = t46 * t43;
    const work t49 = t47 + 1.0f;
    const work t50 = -t43;
    const work t51 = t50 + 1.0f;
    const work t52 = t51 * t51;
    const work t53 = t52 * t52;
    const work t54 = t53 * t49;
    const int t56 = t41 < 2.0f;
    const work t57 = t56 ? t54 : 0.0f;
    const work t59 = t57 * 55.70423f;
    const work t61 = t44 + (-5.0f);
    const work t62 = t51 * t52;
    const work t63 = t62 * t61;
    const work t64 = t56 ? t63 : 0.0f;
    const work t66 = t64 * 5570.423f;
    const work t67 = its_side_5 * its_side_4;
    const work t68 = t67 * t66;
    const work t69 = my_side_6 + its_side_6;
    const work t70 = t68 * t69;
    const work t71 = way_0 * t70;
    const work t72 = way_1 * t70;
    const work t73 = s_pressure_x - t71;
    const work t74 = s_pressure_y - t72;
    const work t75 = my_side_0 - its_side_0;
    const work t76 = my_side_1 - its_side_1;
    const work t77 = my_side_4 + its_side_4;
    const work t82 = 1.0f / t77;
    const work t83 = t68 * t82;
    const work t85 = t83 * 0.04f;
    const work t86 = t75 * t85;
    const work t87 = s_viscosity_x + t86;
    const work t88 = t76 * t85;
    const work t89 = s_viscosity_y + t88;
    const work t90 = its_side_5 * t66;
    const work t91 = my_side_2 * way_0;
    const work t92 = my_side_3 * way_1;
    const work t93 = t91 + t92;
    const work t94 = t93 * t90;
    const work t95 = t75 * t94;
    const work t96 = s_carried_x - t95;
    const work t97 = t76 * t94;
    const work t98 = s_carried_y - t97;
    const work t99 = t67 * t59;
    const work t100 = s_filling + t99;
    const work t102 = t59 * 0.02f;
    const work t103 = t102 * t102;
    const work t104 = t103 * t103;
    const work t106 = t104 * 0.2f;
    const work t107 = t106 + 1.0f;
    const work t108 = way_0 * t90;
    const work t109 = s_volume_x + t108;
    const work t110 = t108 * t107;
    const work t111 = s_crowding_x + t110;
    const work t112 = way_1 * t90;
    const work t113 = s_volume_y + t112;
    const work t114 = t112 * t107;
    const work t115 = s_crowding_y + t114;
    *d_pressure_x = t73;
    *d_pressure_y = t74;
    *d_viscosity_x = t87;
    *d_viscosity_y = t89;
    *d_artificial_viscosity_x = s_artificial_viscosity_x;
    *d_artificial_viscosity_y = s_artificial_viscosity_y;
    *d_walls_x = s_walls_x;
    *d_walls_y = s_walls_y;
    *d_carried_x = t96;
    *d_carried_y = t98;
    *d_volume_x = t109;
    *d_volume_y = t113;
    *d_crowding_x = t111;
    *d_crowding_y = t115;
    *d_filling = t100;
}
/* 4 operations */
LAW void forces_close(real s_pressure_x, real s_pressure_y, real s_viscosity_x, real s_viscosity_y, real s_artificial_viscosity_x, real s_artificial_viscosity_y, real s_walls_x, real s_walls_y, real s_carried_x, real s_carried_y, real s_volume_x, real s_volume_y, real s_crowding_x, real s_crowding_y, real s_filling, real scale, real *new_force_0, real *new_force_1)
{
    const real t17 = s_pressure_x + s_viscosity_x;
    const real t18 = t17 * scale;
    const real t19 = s_pressure_y + s_viscosity_y;
    const real t20 = t19 * scale;
    *new_force_0 = t18;
    *new_force_1 = t20;
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
    work s_filling = 0;
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
        forces_pair_0(way_0, way_1, (real)a, (real)b, my_side_0, my_side_1, my_side_2, my_side_3, my_side_4, my_side_5, my_side_6, my_side_7, its_side_0, its_side_1, its_side_2, its_side_3, its_side_4, its_side_5, its_side_6, its_side_7, s_pressure_x, s_pressure_y, s_viscosity_x, s_viscosity_y, s_artificial_viscosity_x, s_artificial_viscosity_y, s_walls_x, s_walls_y, s_carried_x, s_carried_y, s_volume_x, s_volume_y, s_crowding_x, s_crowding_y, s_filling, &s_pressure_x, &s_pressure_y, &s_viscosity_x, &s_viscosity_y, &s_artificial_viscosity_x, &s_artificial_viscosity_y, &s_walls_x, &s_walls_y, &s_carried_x, &s_carried_y, &s_volume_x, &s_volume_y, &s_crowding_x, &s_crowding_y, &s_filling);
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
    s_filling += __shfl_down_sync(WHOLE_WARP, s_filling, 4, 8);
    s_filling += __shfl_down_sync(WHOLE_WARP, s_filling, 2, 8);
    s_filling += __shfl_down_sync(WHOLE_WARP, s_filling, 1, 8);
    if (!is_on || lane > 0) return;
    real new_force_0, new_force_1;
    forces_close(s_pressure_x, s_pressure_y, s_viscosity_x, s_viscosity_y, s_artificial_viscosity_x, s_artificial_viscosity_y, s_walls_x, s_walls_y, s_carried_x, s_carried_y, s_volume_x, s_volume_y, s_crowding_x, s_crowding_y, s_filling, scale, &new_force_0, &new_force_1);
    force[(size_t)a * 2 + 0] = new_force_0;
    force[(size_t)a * 2 + 1] = new_force_1;
    }
}
