/* 34 operations */
LAW void quintic_spline_kernel(real r, real *w, real *slope)
{
    const real t2 = r * r;
    const real t3 = -r;
    const real t5 = t3 + 3.0;
    const real t6 = t2 * t5;
    const real t8 = t6 * 10.0;
    const real t10 = t8 - 60.0;
    const real t11 = t2 * t10;
    const real t13 = t11 + 66.0;
    const int t15 = 0.0 < t5;
    const real t16 = t15 ? t5 : 0.0;
    const real t17 = t16 * t16;
    const real t18 = t17 * t17;
    const real t19 = t16 * t18;
    const real t21 = t3 + 2.0;
    const int t22 = 0.0 < t21;
    const real t23 = t22 ? t21 : 0.0;
    const real t24 = t23 * t23;
    const real t25 = t24 * t24;
    const real t26 = t23 * t25;
    const real t28 = t26 * 6.0;
    const real t29 = t19 - t28;
    const int t30 = r < 1.0;
    const real t31 = t30 ? t13 : t29;
    const real t33 = t31 * 0.0026525823848649226;
    const real t35 = r * (-50.0);
    const real t37 = t35 + 120.0;
    const real t38 = t2 * t37;
    const real t39 = t38 - 120.0;
    const real t40 = t25 * 6.0;
    const real t41 = t18 - t40;
    const real t43 = t41 * (-5.0);
    const real t44 = t43 / r;
    const real t45 = t30 ? t39 : t44;
    const real t46 = t45 * 0.0026525823848649226;
    *w = t33;
    *slope = t46;
}
