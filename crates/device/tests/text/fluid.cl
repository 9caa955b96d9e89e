#pragma OPENCL FP_CONTRACT OFF
#define LAW static inline
#define KERNEL __kernel
#define GLOBAL __global
#define EACH(a, n) const int a = get_global_id(0); if (a < (n))
#define ALIGNED __attribute__((aligned(16)))
#define P_INFINITY INFINITY
#define P_NAN NAN
typedef float real;
typedef float work;
typedef struct ALIGNED { real x, y; } Pair;
typedef struct { work x, y; } WorkPair;
/* 78 operations */
LAW void fluid_exchange(work a_x, work a_y, work a_z, work a_u, work a_v, work a_w, work a_density, work a_pressure, work b_x, work b_y, work b_z, work b_u, work b_v, work b_w, work b_density, work b_pressure, work *force_x, work *force_y, work *force_z, work *rate, work *open_x, work *open_y, work *open_z)
{
    const work t16 = a_x - b_x;
    const work t17 = a_y - b_y;
    const work t18 = a_z - b_z;
    const work t19 = a_u - b_u;
    const work t20 = a_v - b_v;
    const work t21 = a_w - b_w;
    const work t22 = t16 * t16;
    const work t23 = t17 * t17;
    const work t24 = t22 + t23;
    const work t25 = t18 * t18;
    const work t26 = t24 + t25;
    const work t27 = sqrt(t26);
    const work t29 = t27 * 11.111111f;
    const work t30 = t29 * t29;
    const work t32 = t29 * (-50.0f);
    const work t34 = t32 + 120.0f;
    const work t35 = t30 * t34;
    const work t36 = t35 - 120.0f;
    const work t37 = -t29;
    const work t39 = t37 + 3.0f;
    const int t41 = 0.0f < t39;
    const work t42 = t41 ? t39 : 0.0f;
    const work t44 = t42 * t42;
    const work t45 = t44 * t44;
    const work t47 = t37 + 2.0f;
    const int t48 = 0.0f < t47;
    const work t49 = t48 ? t47 : 0.0f;
    const work t50 = t49 * t49;
    const work t51 = t50 * t50;
    const work t53 = t51 * 6.0f;
    const work t54 = t45 - t53;
    const work t56 = t54 * (-5.0f);
    const work t57 = t56 / t29;
    const int t58 = t29 < 1.0f;
    const work t59 = t58 ? t36 : t57;
    const work t61 = t59 * 449.21716f;
    const work t62 = t19 * t16;
    const work t63 = t20 * t17;
    const work t64 = t62 + t63;
    const work t65 = t21 * t18;
    const work t66 = t64 + t65;
    const work t67 = a_density + b_density;
    const work t69 = t26 + 8.1e-5f;
    const work t70 = t69 * t67;
    const work t71 = 1.0f / t70;
    const work t72 = t26 * t61;
    const work t73 = t72 * t71;
    const work t75 = t73 * 0.04f;
    const int t77 = t66 < 0.0f;
    const work t78 = t66 * t71;
    const work t81 = t78 * (-0.072f);
    const work t82 = t77 ? t81 : 0.0f;
    const work t84 = t73 * 0.45f;
    const work t85 = 1.0f / b_density;
    const work t86 = a_density * a_density;
    const work t87 = a_pressure / t86;
    const work t88 = b_pressure * t85;
    const work t89 = t88 * t85;
    const work t90 = t87 + t89;
    const work t91 = t90 + t82;
    const work t92 = t61 * t91;
    const work t93 = t61 * t85;
    const work t94 = t19 * t75;
    const work t95 = t16 * t92;
    const work t96 = t94 - t95;
    const work t97 = t20 * t75;
    const work t98 = t17 * t92;
    const work t99 = t97 - t98;
    const work t100 = t21 * t75;
    const work t101 = t18 * t92;
    const work t102 = t100 - t101;
    const work t103 = t61 * t66;
    const work t104 = a_density - b_density;
    const work t105 = t84 * t104;
    const work t106 = t103 + t105;
    const work t107 = t16 * t93;
    const work t108 = t17 * t93;
    const work t109 = t18 * t93;
    *force_x = t96;
    *force_y = t99;
    *force_z = t102;
    *rate = t106;
    *open_x = t107;
    *open_y = t108;
    *open_z = t109;
}
/* 16 operations */
LAW void fluid_advance(work x, work y, work z, work u, work v, work w, work density, work pressure, work force_x, work force_y, work force_z, work rate, work open_x, work open_y, work open_z, work *new_x, work *new_y, work *new_z, work *new_u, work *new_v, work *new_w, work *new_density, work *new_pressure)
{
    const work t16 = force_x * 0.000225f;
    const work t17 = u + t16;
    const work t18 = force_y * 0.000225f;
    const work t19 = v + t18;
    const work t20 = force_z * 0.000225f;
    const work t21 = w + t20;
    const work t22 = t17 * 0.000225f;
    const work t23 = x + t22;
    const work t24 = t19 * 0.000225f;
    const work t25 = y + t24;
    const work t26 = t21 * 0.000225f;
    const work t27 = z + t26;
    const work t28 = rate * 0.000225f;
    const work t29 = density + t28;
    const work t31 = t29 - 1000.0f;
    const work t33 = t31 * 400.0f;
    *new_x = t23;
    *new_y = t25;
    *new_z = t27;
    *new_u = t17;
    *new_v = t19;
    *new_w = t21;
    *new_density = t29;
    *new_pressure = t33;
}
typedef struct ALIGNED { real x, y, z, u, v, w, density, pressure; } Side;
typedef struct { real force_x, force_y, force_z, rate, open_x, open_y, open_z; } Sums;
KERNEL void fluid_sums(const int n, GLOBAL const int *first, GLOBAL const int *neighbor, GLOBAL const Side *side, GLOBAL Sums *sums)
{
    EACH(a, n) {
        Sums lanes[8] = {{0, 0, 0, 0, 0, 0, 0}, {0, 0, 0, 0, 0, 0, 0}, {0, 0, 0, 0, 0, 0, 0}, {0, 0, 0, 0, 0, 0, 0}, {0, 0, 0, 0, 0, 0, 0}, {0, 0, 0, 0, 0, 0, 0}, {0, 0, 0, 0, 0, 0, 0}, {0, 0, 0, 0, 0, 0, 0}};
        const Side me = side[a];
        for (int k = 0; k < first[a + 1] - first[a]; ++k) {
            const Side other = side[neighbor[first[a] + k]];
            real d_force_x, d_force_y, d_force_z, d_rate, d_open_x, d_open_y, d_open_z;
            fluid_exchange(me.x, me.y, me.z, me.u, me.v, me.w, me.density, me.pressure, other.x, other.y, other.z, other.u, other.v, other.w, other.density, other.pressure, &d_force_x, &d_force_y, &d_force_z, &d_rate, &d_open_x, &d_open_y, &d_open_z);
            lanes[k % 8].force_x += d_force_x;
            lanes[k % 8].force_y += d_force_y;
            lanes[k % 8].force_z += d_force_z;
            lanes[k % 8].rate += d_rate;
            lanes[k % 8].open_x += d_open_x;
            lanes[k % 8].open_y += d_open_y;
            lanes[k % 8].open_z += d_open_z;
        }
        for (int step = 4; step > 0; step /= 2) {
            for (int lane = 0; lane < step; ++lane) {
                lanes[lane].force_x += lanes[lane + step].force_x;
                lanes[lane].force_y += lanes[lane + step].force_y;
                lanes[lane].force_z += lanes[lane + step].force_z;
                lanes[lane].rate += lanes[lane + step].rate;
                lanes[lane].open_x += lanes[lane + step].open_x;
                lanes[lane].open_y += lanes[lane + step].open_y;
                lanes[lane].open_z += lanes[lane + step].open_z;
            }
        }
        sums[a] = lanes[0];
    }
}
KERNEL void fluid_step(const int n, GLOBAL const Sums *sums, GLOBAL Side *side)
{
    EACH(a, n) {
        const Side me = side[a];
        const Sums sum = sums[a];
        Side next;
        fluid_advance(me.x, me.y, me.z, me.u, me.v, me.w, me.density, me.pressure, sum.force_x, sum.force_y, sum.force_z, sum.rate, sum.open_x, sum.open_y, sum.open_z, &next.x, &next.y, &next.z, &next.u, &next.v, &next.w, &next.density, &next.pressure);
        side[a] = next;
    }
}
