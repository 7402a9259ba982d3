/* sin, cos, exp, 1/sqrt and 1/x on vectors, about one unit in the last place.
 *
 * The coefficients come from minimax.py. pi/2 in three parts of 53 bits: x - k P1 is exact (the
 * product is not rounded), and the third part matters for doubles next to a multiple of pi/2.
 */
#ifndef ELEMENTARY_H
#define ELEMENTARY_H

#include "simd.h"

#define ROUND_MAGIC 6755399441055744.0 /* 1.5 * 2^52: adding it leaves the integer in the low bits */

/* sin x and cos x: x = k pi/2 + r, polynomials of z = r^2, then the quadrant k mod 4. */
INLINE void v_sincos(vd x, vd *sin_x, vd *cos_x) {
    vd shifted = v_fma(x, v_set(0x1.45f306dc9c883p-1), v_set(ROUND_MAGIC));
    vi k_bits = v_bits(shifted);
    vd k = shifted - v_set(ROUND_MAGIC);
    vd r = v_fnma(k, v_set(0x1.1a62633145c07p-54), v_fnma(k, v_set(0x1.921fb54442d18p+0), x));
    r = v_fnma(k, v_set(-0x1.f1976b7ed8fbcp-110), r);
    vd z = r * r;
    vd s = v_fma(z, v_set(0x1.5e0b05bff20f2p-33), v_set(-0x1.ae600aca92c64p-26));
    vd c = v_fma(z, v_set(-0x1.907d8f29fe831p-37), v_set(0x1.1eeb68cd22f56p-29));
    s = v_fma(z, s, v_set(0x1.71de379654304p-19));
    c = v_fma(z, c, v_set(-0x1.27e4fa17bf139p-22));
    s = v_fma(z, s, v_set(-0x1.a01a019e83816p-13));
    c = v_fma(z, c, v_set(0x1.a01a019f4e9b4p-16));
    s = v_fma(z, s, v_set(0x1.1111111110bb2p-7));
    c = v_fma(z, c, v_set(-0x1.6c16c16c16967p-10));
    s = v_fma(z, s, v_set(-0x1.5555555555555p-3));
    c = v_fma(z, c, v_set(0x1.5555555555555p-5));
    s = v_fma(r * z, s, r);
    c = v_fma(z, v_fma(z, c, v_set(-0.5)), v_set(1.0));
    vm swap = v_odd(k_bits);
    vi turned = v_shl(k_bits, 62);
    *sin_x = v_flip(v_select(swap, c, s), turned);
    *cos_x = v_flip(v_select_minus(swap, s, c), turned);
}

/* exp x for x <= 709: x = k ln 2 + r, polynomial of degree 11 by Estrin's scheme. */
INLINE vd v_exp(vd x) {
    vd k = v_rint(x * v_set(0x1.71547652b82fep+0));
    vd r = v_fnma(k, v_set(0x1.abc9e3b39803fp-56), v_fnma(k, v_set(0x1.62e42fefa39efp-1), x));
    vd r2 = r * r, r4 = r2 * r2;
    vd e0 = v_fma(r, v_set(0x1.5555555555556p-3), v_set(0x1.0000000000001p-1));
    vd e1 = v_fma(r, v_set(0x1.11111111109b3p-7), v_set(0x1.5555555553d63p-5));
    vd e2 = v_fma(r, v_set(0x1.a01a01a7c41d5p-13), v_set(0x1.6c16c1788bd90p-10));
    vd e3 = v_fma(r, v_set(0x1.71de0dae63bb3p-19), v_set(0x1.a019b90d2ae7ap-16));
    vd e4 = v_fma(r, v_set(0x1.af38a9b0ec855p-26), v_set(0x1.289185613a3d6p-22));
    vd low = v_fma(r2, e1, e0), high = v_fma(r2, e3, e2);
    vd tail = v_fma(r4, v_fma(r4, e4, high), low);
    return v_scale2(v_fma(r2, tail, r) + v_set(1.0), k);
}

/* 1/sqrt(x): 14 bits from the table, then one step of order four, where the CPU has that table. */
INLINE vd v_rsqrt(vd x) {
#if W == 8 && !defined(EXACT_RSQRT)
    vd y = _mm512_rsqrt14_pd(x);
    vd e = v_fnma(x * y, y, v_set(1.0));
    vd p = v_fma(v_fma(v_set(0.3125), e, v_set(0.375)), e, v_set(0.5));
    return v_fma(y * e, p, y);
#else
    return v_set(1.0) / v_sqrt(x);
#endif
}

/* 1/x, likewise. */
INLINE vd v_reciprocal(vd x) {
#if W == 8 && !defined(EXACT_RSQRT)
    vd y = _mm512_rcp14_pd(x);
    vd e = v_fnma(x, y, v_set(1.0));
    return v_fma(y, v_fma(e, v_fma(e, e, e), e), y);
#else
    return v_set(1.0) / x;
#endif
}

#endif
