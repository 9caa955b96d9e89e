/* 65 operations */
LAW void forces_pair_0(real way_0, real way_1, real slot_a, real slot_b, real my_side_0, real my_side_1, real my_side_2, real my_side_3, real my_side_4, real my_side_5, real my_side_6, real my_side_7, real its_side_0, real its_side_1, real its_side_2, real its_side_3, real its_side_4, real its_side_5, real its_side_6, real its_side_7, real s_pressure_x, real s_pressure_y, real s_viscosity_x, real s_viscosity_y, real s_artificial_viscosity_x, real s_artificial_viscosity_y, real s_walls_x, real s_walls_y, real s_carried_x, real s_carried_y, real s_volume_x, real s_volume_y, real s_crowding_x, real s_crowding_y, real s_filling, real *d_pressure_x, real *d_pressure_y, real *d_viscosity_x, real *d_viscosity_y, real *d_artificial_viscosity_x, real *d_artificial_viscosity_y, real *d_walls_x, real *d_walls_y, real *d_carried_x, real *d_carried_y, real *d_volume_x, real *d_volume_y, real *d_crowding_x, real *d_crowding_y, real *d_filling)
{
    const real t36 = way_0 * way_0;
    const real t37 = way_1 * way_1;
    const real t38 = t36 + t37;
    const real t39 = sqrt(t38);
    const real t41 = t39 * 10.0;
    const real t43 = t41 * 0.5;
    const real t44 = 0.0 * t43;
    const real t46 = t44 + 4.0;
    const real t47 = t46 * t43;
    const real t49 = t47 + 1.0;
    const real t50 = -t43;
    const real t51 = t50 + 1.0;
    const real t52 = t51 * t51;
    const real t53 = t52 * t52;
    const real t54 = t53 * t49;
    const int t56 = t41 < 2.0;
    const real t57 = t56 ? t54 : 0.0;
    const real t59 = t57 * 55.70423008216338;
    const real t61 = t44 + (-5.0);
    const real t62 = t51 * t52;
    const real t63 = t62 * t61;
    const real t64 = t56 ? t63 : 0.0;
    const real t66 = t64 * 5570.423008216338;
    const real t67 = its_side_5 * its_side_4;
    const real t68 = t67 * t66;
    const real t69 = my_side_6 + its_side_6;
    const real t70 = t68 * t69;
    const real t71 = way_0 * t70;
    const real t72 = way_1 * t70;
    const real t73 = s_pressure_x - t71;
    const real t74 = s_pressure_y - t72;
    const real t75 = my_side_0 - its_side_0;
    const real t76 = my_side_1 - its_side_1;
    const real t77 = my_side_4 + its_side_4;
    const real t82 = 1.0 / t77;
    const real t83 = t68 * t82;
    const real t85 = t83 * 0.04;
    const real t86 = t75 * t85;
    const real t87 = s_viscosity_x + t86;
    const real t88 = t76 * t85;
    const real t89 = s_viscosity_y + t88;
    const real t90 = its_side_5 * t66;
    const real t91 = my_side_2 * way_0;
    const real t92 = my_side_3 * way_1;
    const real t93 = t91 + t92;
    const real t94 = t93 * t90;
    const real t95 = t75 * t94;
    const real t96 = s_carried_x - t95;
    const real t97 = t76 * t94;
    const real t98 = s_carried_y - t97;
    const real t99 = t67 * t59;
    const real t100 = s_filling + t99;
    const real t102 = t59 * 0.02;
    const real t103 = t102 * t102;
    const real t104 = t103 * t103;
    const real t106 = t104 * 0.2;
    const real t107 = t106 + 1.0;
    const real t108 = way_0 * t90;
    const real t109 = s_volume_x + t108;
    const real t110 = t108 * t107;
    const real t111 = s_crowding_x + t110;
    const real t112 = way_1 * t90;
    const real t113 = s_volume_y + t112;
    const real t114 = t112 * t107;
    const real t115 = s_crowding_y + t114;
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
    real s_filling = 0;
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
