#define LAW static __device__ __forceinline__
#define KERNEL extern "C" __global__
#define GLOBAL
#define EACH(a, n) const int a = blockIdx.x * blockDim.x + threadIdx.x; if (a < (n))
#define ALIGNED __align__(16)
#define P_INFINITY __longlong_as_double(0x7ff0000000000000)
#define P_NAN __longlong_as_double(0x7ff8000000000000)
typedef double real;
typedef struct ALIGNED { real x, y; } Pair;
LAW double p_two_to(double k) { return __longlong_as_double(((long long)k + 1023) << 52); }
LAW double p_exponent(double x) { return (double)(((__double_as_longlong(x) >> 52) & 2047) - 1023); }
LAW double p_mantissa(double x) { return __longlong_as_double((__double_as_longlong(x) & 0xfffffffffffff) | 0x3ff0000000000000); }
/* 46 operations */
LAW real p_exp(real x)
{
    const int t2 = x < (-746.0);
    const real t3 = t2 ? (-746.0) : x;
    const int t5 = 710.0 < t3;
    const real t6 = t5 ? 710.0 : t3;
    const int t7 = t6 <= t6;
    const real t9 = t7 ? t6 : 0.0;
    const real t11 = t9 * 1.4426950408889634;
    const real t13 = t11 + 6755399441055744.0;
    const real t14 = t13 - 6755399441055744.0;
    const real t16 = t14 * 0.6931471803691238;
    const real t17 = t9 - t16;
    const real t19 = t14 * 1.9082149292705877e-10;
    const real t20 = t17 - t19;
    const real t21 = t20 * t20;
    const real t23 = t21 * 4.1381367970572385e-8;
    const real t25 = t23 - 1.6533902205465252e-6;
    const real t26 = t21 * t25;
    const real t28 = t26 + 6.613756321437934e-5;
    const real t29 = t21 * t28;
    const real t31 = t29 - 0.0027777777777015593;
    const real t32 = t21 * t31;
    const real t34 = t32 + 0.16666666666666602;
    const real t35 = t21 * t34;
    const real t36 = t20 - t35;
    const real t37 = t20 * t36;
    const real t38 = -t36;
    const real t40 = t38 + 2.0;
    const real t41 = t37 / t40;
    const real t42 = t19 - t41;
    const real t43 = t42 - t17;
    const real t44 = -t43;
    const real t46 = t44 + 1.0;
    const real t48 = t14 * 0.5;
    const real t49 = t48 + 6755399441055744.0;
    const real t50 = t49 - 6755399441055744.0;
    const real t51 = p_two_to(t50);
    const real t52 = t46 * t51;
    const real t53 = t14 - t50;
    const real t54 = p_two_to(t53);
    const real t55 = t52 * t54;
    const int t57 = 709.782712893384 < x;
    const real t59 = t57 ? P_INFINITY : t55;
    const int t61 = x < (-745.1332191019412);
    const real t62 = t61 ? 0.0 : t59;
    const int t63 = x <= x;
    const real t64 = t63 ? t62 : x;
    return t64;
}
/* 63 operations */
LAW real p_expm1(real x)
{
    const int t2 = x < (-40.0);
    const real t3 = t2 ? (-40.0) : x;
    const int t5 = 710.0 < t3;
    const real t6 = t5 ? 710.0 : t3;
    const int t7 = t6 <= t6;
    const real t9 = t7 ? t6 : 0.0;
    const real t11 = t9 * 1.4426950408889634;
    const real t13 = t11 + 6755399441055744.0;
    const real t14 = t13 - 6755399441055744.0;
    const real t16 = t14 * 0.6931471803691238;
    const real t17 = t9 - t16;
    const real t19 = t14 * 1.9082149292705877e-10;
    const real t20 = t17 - t19;
    const real t21 = t20 * t20;
    const real t23 = 1.6059043836821613e-10 * t20;
    const real t25 = t23 + 2.08767569878681e-9;
    const real t26 = t25 * t20;
    const real t28 = t26 + 2.505210838544172e-8;
    const real t29 = t28 * t20;
    const real t31 = t29 + 2.755731922398589e-7;
    const real t32 = t31 * t20;
    const real t34 = t32 + 2.7557319223985893e-6;
    const real t35 = t34 * t20;
    const real t37 = t35 + 2.48015873015873e-5;
    const real t38 = t37 * t20;
    const real t40 = t38 + 0.0001984126984126984;
    const real t41 = t40 * t20;
    const real t43 = t41 + 0.001388888888888889;
    const real t44 = t43 * t20;
    const real t46 = t44 + 0.008333333333333333;
    const real t47 = t46 * t20;
    const real t49 = t47 + 0.041666666666666664;
    const real t50 = t49 * t20;
    const real t52 = t50 + 0.16666666666666666;
    const real t54 = t21 * 0.5;
    const real t55 = t21 * t20;
    const real t56 = t55 * t52;
    const real t57 = t56 - t19;
    const real t58 = t54 + t57;
    const real t59 = t17 + t58;
    const int t61 = t14 < (-1022.0);
    const real t62 = t61 ? (-1022.0) : t14;
    const int t64 = 1023.0 < t62;
    const real t65 = t64 ? 1023.0 : t62;
    const real t66 = p_two_to(t65);
    const real t67 = t59 * t66;
    const real t69 = t66 - 1.0;
    const real t70 = t67 + t69;
    const int t71 = 1023.0 < t14;
    const real t72 = t59 + 1.0;
    const real t73 = t14 * 0.5;
    const real t74 = t73 + 6755399441055744.0;
    const real t75 = t74 - 6755399441055744.0;
    const real t76 = p_two_to(t75);
    const real t77 = t72 * t76;
    const real t78 = t14 - t75;
    const real t79 = p_two_to(t78);
    const real t80 = t77 * t79;
    const real t81 = t71 ? t80 : t70;
    const int t83 = 709.782712893384 < x;
    const real t85 = t83 ? P_INFINITY : t81;
    const int t86 = x <= x;
    const real t87 = t86 ? t85 : x;
    return t87;
}
/* 49 operations */
LAW real p_log(real x)
{
    const int t2 = x < 2.2250738585072014e-308;
    const real t4 = x * 1.8014398509481984e16;
    const real t5 = t2 ? t4 : x;
    const real t7 = p_exponent(t5);
    const real t8 = p_mantissa(t5);
    const int t10 = 1.4142135623730951 < t8;
    const real t12 = t7 + 1.0;
    const real t13 = t10 ? t12 : t7;
    const real t15 = t8 * 0.5;
    const real t16 = t10 ? t15 : t8;
    const real t17 = t16 - 1.0;
    const real t19 = t17 + 2.0;
    const real t20 = t17 / t19;
    const real t21 = t20 * t20;
    const real t22 = t21 * t21;
    const real t24 = t22 * 0.15313837699209373;
    const real t26 = t24 + 0.22222198432149784;
    const real t27 = t22 * t26;
    const real t29 = t27 + 0.3999999999940942;
    const real t30 = t22 * t29;
    const real t32 = t22 * 0.14798198605116586;
    const real t34 = t32 + 0.1818357216161805;
    const real t35 = t22 * t34;
    const real t37 = t35 + 0.2857142874366239;
    const real t38 = t22 * t37;
    const real t40 = t38 + 0.6666666666666735;
    const real t41 = t21 * t40;
    const real t42 = t17 * t17;
    const real t43 = t42 * 0.5;
    const real t44 = t30 + t41;
    const real t45 = t43 + t44;
    const real t46 = t20 * t45;
    const real t48 = t13 * 1.9082149292705877e-10;
    const real t49 = t48 + 0.0;
    const real t50 = t46 + t49;
    const real t52 = t13 * 0.6931471803691238;
    const real t53 = t43 - t50;
    const real t54 = t53 - t17;
    const real t55 = t52 - t54;
    const real t57 = t2 ? 37.42994775023705 : 0.0;
    const real t58 = t55 - t57;
    const int t60 = 1.7976931348623157e308 < x;
    const real t61 = t60 ? x : t58;
    const int t62 = x <= 0.0;
    const real t64 = t62 ? (-P_INFINITY) : t61;
    const int t65 = x < 0.0;
    const real t67 = t65 ? P_NAN : t64;
    const int t68 = x <= x;
    const real t69 = t68 ? t67 : x;
    return t69;
}
/* 53 operations */
LAW real p_log1p(real x)
{
    const real t2 = x + 1.0;
    const real t3 = t2 - 1.0;
    const real t4 = x - t3;
    const real t5 = fabs(x);
    const int t7 = t5 < 1000000000000000.0;
    const real t8 = t4 / t2;
    const real t10 = t7 ? t8 : 0.0;
    const real t11 = p_exponent(t2);
    const real t12 = p_mantissa(t2);
    const int t14 = 1.4142135623730951 < t12;
    const real t15 = t11 + 1.0;
    const real t16 = t14 ? t15 : t11;
    const real t18 = t12 * 0.5;
    const real t19 = t14 ? t18 : t12;
    const real t20 = t19 - 1.0;
    const real t22 = t20 + 2.0;
    const real t23 = t20 / t22;
    const real t24 = t23 * t23;
    const real t25 = t24 * t24;
    const real t27 = t25 * 0.15313837699209373;
    const real t29 = t27 + 0.22222198432149784;
    const real t30 = t25 * t29;
    const real t32 = t30 + 0.3999999999940942;
    const real t33 = t25 * t32;
    const real t35 = t25 * 0.14798198605116586;
    const real t37 = t35 + 0.1818357216161805;
    const real t38 = t25 * t37;
    const real t40 = t38 + 0.2857142874366239;
    const real t41 = t25 * t40;
    const real t43 = t41 + 0.6666666666666735;
    const real t44 = t24 * t43;
    const real t45 = t20 * t20;
    const real t46 = t45 * 0.5;
    const real t47 = t33 + t44;
    const real t48 = t46 + t47;
    const real t49 = t23 * t48;
    const real t51 = t16 * 1.9082149292705877e-10;
    const real t52 = t51 + t10;
    const real t53 = t49 + t52;
    const real t55 = t16 * 0.6931471803691238;
    const real t56 = t46 - t53;
    const real t57 = t56 - t20;
    const real t58 = t55 - t57;
    const int t60 = t5 < 1e-16;
    const int t62 = 1.7976931348623157e308 < t2;
    const real t63 = t62 ? t2 : t58;
    const int t64 = t2 <= 0.0;
    const real t66 = t64 ? (-P_INFINITY) : t63;
    const int t67 = t2 < 0.0;
    const real t69 = t67 ? P_NAN : t66;
    const int t70 = t2 <= t2;
    const real t71 = t70 ? t69 : t2;
    const real t72 = t60 ? x : t71;
    return t72;
}
/* 3 operations */
LAW real p_pow(real x, real y)
{
    const real t2 = p_log(x);
    const real t3 = y * t2;
    const real t4 = p_exp(t3);
    return t4;
}
/* 12 operations */
LAW void gradient_terms(real a_x, real a_y, real a_z, real b_x, real b_y, real b_z, real g_x, real g_y, real g_z, real *d_xx, real *d_xy, real *d_xz, real *d_yx, real *d_yy, real *d_yz, real *d_zx, real *d_zy, real *d_zz)
{
    const real t9 = b_x - a_x;
    const real t10 = t9 * g_x;
    const real t11 = t9 * g_y;
    const real t12 = t9 * g_z;
    const real t13 = b_y - a_y;
    const real t14 = t13 * g_x;
    const real t15 = t13 * g_y;
    const real t16 = t13 * g_z;
    const real t17 = b_z - a_z;
    const real t18 = t17 * g_x;
    const real t19 = t17 * g_y;
    const real t20 = t17 * g_z;
    *d_xx = t10;
    *d_xy = t11;
    *d_xz = t12;
    *d_yx = t14;
    *d_yy = t15;
    *d_yz = t16;
    *d_zx = t18;
    *d_zy = t19;
    *d_zz = t20;
}
/* 161 operations */
LAW void neo_hookean_tension(real a_xx, real a_xy, real a_xz, real a_yx, real a_yy, real a_yz, real a_zx, real a_zy, real a_zz, real volume, real *t_xx, real *t_xy, real *t_xz, real *t_yx, real *t_yy, real *t_yz, real *t_zx, real *t_zy, real *t_zz)
{
    const real t10 = a_xx + a_xx;
    const real t14 = a_yy + a_yy;
    const real t18 = a_zz + a_zz;
    const real t19 = a_xx * a_xx;
    const real t20 = a_yx * a_yx;
    const real t21 = a_zx * a_zx;
    const real t22 = t19 + t20;
    const real t23 = t22 + t21;
    const real t39 = a_xy * a_xy;
    const real t40 = a_yy * a_yy;
    const real t41 = a_zy * a_zy;
    const real t42 = t39 + t40;
    const real t43 = t42 + t41;
    const real t59 = a_xz * a_xz;
    const real t60 = a_yz * a_yz;
    const real t61 = a_zz * a_zz;
    const real t62 = t59 + t60;
    const real t63 = t62 + t61;
    const real t64 = t10 + t23;
    const real t68 = t14 + t43;
    const real t72 = t18 + t63;
    const real t74 = t64 * 0.5;
    const real t78 = t68 * 0.5;
    const real t82 = t72 * 0.5;
    const real t83 = a_xx + a_yy;
    const real t84 = t83 + a_zz;
    const real t85 = a_yy * a_zz;
    const real t86 = a_yz * a_zy;
    const real t87 = t85 - t86;
    const real t94 = a_yz * a_zx;
    const real t95 = a_yx * a_zz;
    const real t96 = t94 - t95;
    const real t97 = a_zz * a_xx;
    const real t98 = a_zx * a_xz;
    const real t99 = t97 - t98;
    const real t103 = a_yx * a_zy;
    const real t104 = a_yy * a_zx;
    const real t105 = t103 - t104;
    const real t109 = a_xx * a_yy;
    const real t110 = a_xy * a_yx;
    const real t111 = t109 - t110;
    const real t112 = t87 + t99;
    const real t113 = t112 + t111;
    const real t114 = t84 + t113;
    const real t115 = a_xx * t87;
    const real t116 = a_xy * t96;
    const real t117 = t115 + t116;
    const real t118 = a_xz * t105;
    const real t119 = t117 + t118;
    const real t120 = t114 + t119;
    const real t123 = a_xx + 1.0;
    const real t124 = a_yx + 0.0;
    const real t125 = a_zx + 0.0;
    const real t126 = a_xy + 0.0;
    const real t127 = a_yy + 1.0;
    const real t128 = a_zy + 0.0;
    const real t129 = a_xz + 0.0;
    const real t130 = a_yz + 0.0;
    const real t131 = a_zz + 1.0;
    const real t132 = p_log1p(t120);
    const real t133 = t120 + 1.0;
    const real t134 = 1.0 / t133;
    const real t135 = t127 * t131;
    const real t136 = t130 * t128;
    const real t137 = t135 - t136;
    const real t138 = t128 * t129;
    const real t139 = t131 * t126;
    const real t140 = t138 - t139;
    const real t141 = t126 * t130;
    const real t142 = t129 * t127;
    const real t143 = t141 - t142;
    const real t144 = t130 * t125;
    const real t145 = t124 * t131;
    const real t146 = t144 - t145;
    const real t147 = t131 * t123;
    const real t148 = t125 * t129;
    const real t149 = t147 - t148;
    const real t150 = t129 * t124;
    const real t151 = t123 * t130;
    const real t152 = t150 - t151;
    const real t153 = t124 * t128;
    const real t154 = t127 * t125;
    const real t155 = t153 - t154;
    const real t156 = t125 * t126;
    const real t157 = t128 * t123;
    const real t158 = t156 - t157;
    const real t159 = t123 * t127;
    const real t160 = t126 * t124;
    const real t161 = t159 - t160;
    const real t162 = t137 * t134;
    const real t163 = t140 * t134;
    const real t164 = t143 * t134;
    const real t165 = t146 * t134;
    const real t166 = t149 * t134;
    const real t167 = t152 * t134;
    const real t168 = t155 * t134;
    const real t169 = t158 * t134;
    const real t170 = t161 * t134;
    const real t171 = t74 + t78;
    const real t172 = t171 + t82;
    const real t174 = t172 * 2.0;
    const real t176 = t174 + 3.0;
    const real t178 = t132 * (-0.6666666666666666);
    const real t179 = p_exp(t178);
    const real t181 = t179 * 500000.0;
    const real t183 = t176 * 0.3333333333333333;
    const real t184 = t162 * t183;
    const real t185 = t163 * t183;
    const real t186 = t164 * t183;
    const real t187 = t165 * t183;
    const real t188 = t166 * t183;
    const real t189 = t167 * t183;
    const real t190 = t168 * t183;
    const real t191 = t169 * t183;
    const real t192 = t170 * t183;
    const real t193 = t123 - t184;
    const real t194 = t124 - t185;
    const real t195 = t125 - t186;
    const real t196 = t126 - t187;
    const real t197 = t127 - t188;
    const real t198 = t128 - t189;
    const real t199 = t129 - t190;
    const real t200 = t130 - t191;
    const real t201 = t131 - t192;
    const real t202 = t193 * t181;
    const real t203 = t194 * t181;
    const real t204 = t195 * t181;
    const real t205 = t196 * t181;
    const real t206 = t197 * t181;
    const real t207 = t198 * t181;
    const real t208 = t199 * t181;
    const real t209 = t200 * t181;
    const real t210 = t201 * t181;
    const real t212 = t120 * 4833333.333333333;
    const real t213 = t137 * t212;
    const real t214 = t140 * t212;
    const real t215 = t143 * t212;
    const real t216 = t146 * t212;
    const real t217 = t149 * t212;
    const real t218 = t152 * t212;
    const real t219 = t155 * t212;
    const real t220 = t158 * t212;
    const real t221 = t161 * t212;
    const real t222 = t202 + t213;
    const real t223 = t203 + t214;
    const real t224 = t204 + t215;
    const real t225 = t205 + t216;
    const real t226 = t206 + t217;
    const real t227 = t207 + t218;
    const real t228 = t208 + t219;
    const real t229 = t209 + t220;
    const real t230 = t210 + t221;
    const real t231 = t222 * volume;
    const real t232 = t225 * volume;
    const real t233 = t228 * volume;
    const real t234 = t223 * volume;
    const real t235 = t226 * volume;
    const real t236 = t229 * volume;
    const real t237 = t224 * volume;
    const real t238 = t227 * volume;
    const real t239 = t230 * volume;
    *t_xx = t231;
    *t_xy = t232;
    *t_xz = t233;
    *t_yx = t234;
    *t_yy = t235;
    *t_yz = t236;
    *t_zx = t237;
    *t_zy = t238;
    *t_zz = t239;
}
/* 15 operations */
LAW void force_terms(real t_xx, real t_xy, real t_xz, real t_yx, real t_yy, real t_yz, real t_zx, real t_zy, real t_zz, real g_x, real g_y, real g_z, real *f_x, real *f_y, real *f_z)
{
    const real t12 = t_xx * g_x;
    const real t13 = t_xy * g_y;
    const real t14 = t12 + t13;
    const real t15 = t_xz * g_z;
    const real t16 = t14 + t15;
    const real t17 = t_yx * g_x;
    const real t18 = t_yy * g_y;
    const real t19 = t17 + t18;
    const real t20 = t_yz * g_z;
    const real t21 = t19 + t20;
    const real t22 = t_zx * g_x;
    const real t23 = t_zy * g_y;
    const real t24 = t22 + t23;
    const real t25 = t_zz * g_z;
    const real t26 = t24 + t25;
    *f_x = t16;
    *f_y = t21;
    *f_z = t26;
}
/* 13 operations */
LAW void kick(real v_x, real v_y, real v_z, real u_x, real u_y, real u_z, real f_x, real f_y, real f_z, real inverse_mass, real *new_v_x, real *new_v_y, real *new_v_z, real *new_u_x, real *new_u_y, real *new_u_z)
{
    const real t11 = inverse_mass * 2e-5;
    const real t12 = f_x * t11;
    const real t13 = v_x + t12;
    const real t14 = f_y * t11;
    const real t15 = v_y + t14;
    const real t16 = f_z * t11;
    const real t17 = v_z + t16;
    const real t18 = t13 * 2e-5;
    const real t19 = u_x + t18;
    const real t20 = t15 * 2e-5;
    const real t21 = u_y + t20;
    const real t22 = t17 * 2e-5;
    const real t23 = u_z + t22;
    *new_v_x = t13;
    *new_v_y = t15;
    *new_v_z = t17;
    *new_u_x = t19;
    *new_u_y = t21;
    *new_u_z = t23;
}
typedef struct ALIGNED { real x, y, z, unused; } Point;
typedef struct ALIGNED { real xx, xy, xz, yx, yy, yz, zx, zy, zz, unused[1]; } Tensor;
KERNEL void solid_tensions(const int n, GLOBAL const int * __restrict__ first, GLOBAL const int * __restrict__ length, GLOBAL const int * __restrict__ neighbor, GLOBAL const real * __restrict__ g_x, GLOBAL const real * __restrict__ g_y, GLOBAL const real * __restrict__ g_z, GLOBAL const Point * __restrict__ displacement, GLOBAL const real * __restrict__ volume, GLOBAL Tensor * __restrict__ tension)
{
    EACH(a, n) {
        const Point me = displacement[a];
        real a_xx = 0;
        real a_xy = 0;
        real a_xz = 0;
        real a_yx = 0;
        real a_yy = 0;
        real a_yz = 0;
        real a_zx = 0;
        real a_zy = 0;
        real a_zz = 0;
        const int row = first[a / 32] * 32 + a % 32;
        for (int k = 0; k < length[a]; ++k) {
            const int e = row + k * 32;
            const Point other = displacement[neighbor[e]];
            real d_xx, d_xy, d_xz, d_yx, d_yy, d_yz, d_zx, d_zy, d_zz;
            gradient_terms(me.x, me.y, me.z, other.x, other.y, other.z, g_x[e], g_y[e], g_z[e], &d_xx, &d_xy, &d_xz, &d_yx, &d_yy, &d_yz, &d_zx, &d_zy, &d_zz);
            a_xx += d_xx;
            a_xy += d_xy;
            a_xz += d_xz;
            a_yx += d_yx;
            a_yy += d_yy;
            a_yz += d_yz;
            a_zx += d_zx;
            a_zy += d_zy;
            a_zz += d_zz;
        }
        Tensor result;
        neo_hookean_tension(a_xx, a_xy, a_xz, a_yx, a_yy, a_yz, a_zx, a_zy, a_zz, volume[a], &result.xx, &result.xy, &result.xz, &result.yx, &result.yy, &result.yz, &result.zx, &result.zy, &result.zz);
        tension[a] = result;
    }
}
KERNEL void solid_step(const int n, GLOBAL const int * __restrict__ first, GLOBAL const int * __restrict__ length, GLOBAL const int * __restrict__ neighbor, GLOBAL const real * __restrict__ g_x, GLOBAL const real * __restrict__ g_y, GLOBAL const real * __restrict__ g_z, GLOBAL const Tensor * __restrict__ tension, GLOBAL const Point * __restrict__ total, GLOBAL const real * __restrict__ inverse_mass, GLOBAL Point * __restrict__ velocity, GLOBAL Point * __restrict__ displacement)
{
    EACH(a, n) {
        const Tensor mine = tension[a];
        const Point g = total[a];
        real f_x, f_y, f_z;
        force_terms(mine.xx, mine.xy, mine.xz, mine.yx, mine.yy, mine.yz, mine.zx, mine.zy, mine.zz, g.x, g.y, g.z, &f_x, &f_y, &f_z);
        const int row = first[a / 32] * 32 + a % 32;
        for (int k = 0; k < length[a]; ++k) {
            const int e = row + k * 32;
            const Tensor other = tension[neighbor[e]];
            real d_x, d_y, d_z;
            force_terms(other.xx, other.xy, other.xz, other.yx, other.yy, other.yz, other.zx, other.zy, other.zz, g_x[e], g_y[e], g_z[e], &d_x, &d_y, &d_z);
            f_x -= d_x;
            f_y -= d_y;
            f_z -= d_z;
        }
        Point v = velocity[a], u = displacement[a];
        kick(v.x, v.y, v.z, u.x, u.y, u.z, f_x, f_y, f_z, inverse_mass[a], &v.x, &v.y, &v.z, &u.x, &u.y, &u.z);
        velocity[a] = v;
        displacement[a] = u;
    }
}
