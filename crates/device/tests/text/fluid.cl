#pragma OPENCL FP_CONTRACT OFF
#define LAW static inline
#define KERNEL __kernel
#define GLOBAL __global
#define EACH(a, n) const int a = get_global_id(0); if (a < (n))
#define ALIGNED __attribute__((aligned(16)))
#define P_INFINITY INFINITY
#define P_NAN NAN
typedef float real;
typedef struct ALIGNED { real x, y; } Pair;
/* 78 operations */
LAW void fluid_exchange(real a_x, real a_y, real a_z, real a_u, real a_v, real a_w, real a_density, real a_pressure, real b_x, real b_y, real b_z, real b_u, real b_v, real b_w, real b_density, real b_pressure, real *force_x, real *force_y, real *force_z, real *rate, real *open_x, real *open_y, real *open_z)
{
    const real t16 = a_x - b_x;
    const real t17 = a_y - b_y;
    const real t18 = a_z - b_z;
    const real t19 = a_u - b_u;
    const real t20 = a_v - b_v;
    const real t21 = a_w - b_w;
    const real t22 = t16 * t16;
    const real t23 = t17 * t17;
    const real t24 = t22 + t23;
    const real t25 = t18 * t18;
    const real t26 = t24 + t25;
    const real t27 = sqrt(t26);
    const real t29 = t27 * 11.111111f;
    const real t30 = t29 * t29;
    const real t32 = t29 * (-50.0f);
    const real t34 = t32 + 120.0f;
    const real t35 = t30 * t34;
    const real t36 = t35 - 120.0f;
    const real t37 = -t29;
    const real t39 = t37 + 3.0f;
    const int t41 = 0.0f < t39;
    const real t42 = t41 ? t39 : 0.0f;
    const real t44 = t42 * t42;
    const real t45 = t44 * t44;
    const real t47 = t37 + 2.0f;
    const int t48 = 0.0f < t47;
    const real t49 = t48 ? t47 : 0.0f;
    const real t50 = t49 * t49;
    const real t51 = t50 * t50;
    const real t53 = t51 * 6.0f;
    const real t54 = t45 - t53;
    const real t56 = t54 * (-5.0f);
    const real t57 = t56 / t29;
    const int t58 = t29 < 1.0f;
    const real t59 = t58 ? t36 : t57;
    const real t61 = t59 * 449.21716f;
    const real t62 = t19 * t16;
    const real t63 = t20 * t17;
    const real t64 = t62 + t63;
    const real t65 = t21 * t18;
    const real t66 = t64 + t65;
    const real t67 = a_density + b_density;
    const real t69 = t26 + 8.1e-5f;
    const real t70 = t69 * t67;
    const real t71 = 1.0f / t70;
    const real t72 = t26 * t61;
    const real t73 = t72 * t71;
    const real t75 = t73 * 0.04f;
    const int t77 = t66 < 0.0f;
    const real t78 = t66 * t71;
    const real t81 = t78 * (-0.072f);
    const real t82 = t77 ? t81 : 0.0f;
    const real t84 = t73 * 0.45f;
    const real t85 = 1.0f / b_density;
    const real t86 = a_density * a_density;
    const real t87 = a_pressure / t86;
    const real t88 = b_pressure * t85;
    const real t89 = t88 * t85;
    const real t90 = t87 + t89;
    const real t91 = t90 + t82;
    const real t92 = t61 * t91;
    const real t93 = t61 * t85;
    const real t94 = t19 * t75;
    const real t95 = t16 * t92;
    const real t96 = t94 - t95;
    const real t97 = t20 * t75;
    const real t98 = t17 * t92;
    const real t99 = t97 - t98;
    const real t100 = t21 * t75;
    const real t101 = t18 * t92;
    const real t102 = t100 - t101;
    const real t103 = t61 * t66;
    const real t104 = a_density - b_density;
    const real t105 = t84 * t104;
    const real t106 = t103 + t105;
    const real t107 = t16 * t93;
    const real t108 = t17 * t93;
    const real t109 = t18 * t93;
    *force_x = t96;
    *force_y = t99;
    *force_z = t102;
    *rate = t106;
    *open_x = t107;
    *open_y = t108;
    *open_z = t109;
}
/* 16 operations */
LAW void fluid_advance(real x, real y, real z, real u, real v, real w, real density, real pressure, real force_x, real force_y, real force_z, real rate, real open_x, real open_y, real open_z, real *new_x, real *new_y, real *new_z, real *new_u, real *new_v, real *new_w, real *new_density, real *new_pressure)
{
    const real t16 = force_x * 0.000225f;
    const real t17 = u + t16;
    const real t18 = force_y * 0.000225f;
    const real t19 = v + t18;
    const real t20 = force_z * 0.000225f;
    const real t21 = w + t20;
    const real t22 = t17 * 0.000225f;
    const real t23 = x + t22;
    const real t24 = t19 * 0.000225f;
    const real t25 = y + t24;
    const real t26 = t21 * 0.000225f;
    const real t27 = z + t26;
    const real t28 = rate * 0.000225f;
    const real t29 = density + t28;
    const real t31 = t29 - 1000.0f;
    const real t33 = t31 * 400.0f;
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
