/* One vector of W doubles (W = 8: AVX-512, 4: AVX2 + FMA, 1: plain doubles) and what C lacks on it.
 *
 * Sums and products are written with + - *, which GCC and Clang accept on vectors and contract to
 * fused multiply-adds (-ffp-contract=fast). Everything else is a function here.
 */
#ifndef SIMD_H
#define SIMD_H

#include <immintrin.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#ifndef W
#define W 8
#endif

#define INLINE static inline __attribute__((always_inline))

#if W == 8
typedef __m512d vd;
typedef __m512i vi;
typedef __mmask8 vm;
INLINE vd v_set(double x) { return _mm512_set1_pd(x); }
INLINE vd v_load(const double *p) { return _mm512_loadu_pd(p); }
INLINE void v_store(double *p, vd x) { _mm512_storeu_pd(p, x); }
INLINE vd v_fma(vd a, vd b, vd c) { return _mm512_fmadd_pd(a, b, c); }
INLINE vd v_fnma(vd a, vd b, vd c) { return _mm512_fnmadd_pd(a, b, c); }
INLINE vd v_max(vd a, vd b) { return _mm512_max_pd(a, b); }
INLINE vd v_abs(vd a) { return _mm512_abs_pd(a); }
INLINE vd v_sqrt(vd a) { return _mm512_sqrt_pd(a); }
INLINE vd v_select(vm m, vd a, vd b) { return _mm512_mask_mov_pd(b, m, a); } /* m ? a : b */
INLINE vd v_select_minus(vm m, vd a, vd b) { /* m ? -a : b */
    return _mm512_mask_xor_pd(b, m, a, _mm512_set1_pd(-0.0));
}
INLINE vm v_less(vd a, vd b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
/* max(|a|, |b|) in one instruction */
INLINE vd v_maxabs(vd a, vd b) { return _mm512_range_pd(a, b, 0x0b); }
INLINE vi v_bits(vd a) { return _mm512_castpd_si512(a); }
INLINE vd v_double(vi a) { return _mm512_castsi512_pd(a); }
INLINE vi v_seti(int64_t x) { return _mm512_set1_epi64(x); }
#define v_shl(a, n) _mm512_slli_epi64(a, n)
INLINE vm v_odd(vi a) { return _mm512_test_epi64_mask(a, v_seti(1)); }
/* a ^ (b & sign bit) and (a & ~sign bit) | (b & sign bit) */
INLINE vd v_flip(vd a, vi b) {
    return v_double(_mm512_ternarylogic_epi64(v_bits(a), b, v_seti(INT64_MIN), 0x78));
}
INLINE vd v_copysign(vd a, vd b) {
    return v_double(_mm512_ternarylogic_epi64(v_bits(a), v_bits(b), v_seti(INT64_MIN), 0xd8));
}
INLINE vd v_rint(vd a) { return _mm512_roundscale_pd(a, 8); }
INLINE vd v_scale2(vd a, vd k) { return _mm512_scalef_pd(a, k); } /* a 2^k */

#elif W == 4
typedef __m256d vd;
typedef __m256i vi;
typedef __m256d vm;
INLINE vd v_set(double x) { return _mm256_set1_pd(x); }
INLINE vd v_load(const double *p) { return _mm256_loadu_pd(p); }
INLINE void v_store(double *p, vd x) { _mm256_storeu_pd(p, x); }
INLINE vd v_fma(vd a, vd b, vd c) { return _mm256_fmadd_pd(a, b, c); }
INLINE vd v_fnma(vd a, vd b, vd c) { return _mm256_fnmadd_pd(a, b, c); }
INLINE vd v_max(vd a, vd b) { return _mm256_max_pd(a, b); }
INLINE vi v_bits(vd a) { return _mm256_castpd_si256(a); }
INLINE vd v_double(vi a) { return _mm256_castsi256_pd(a); }
INLINE vi v_seti(int64_t x) { return _mm256_set1_epi64x(x); }
INLINE vd v_abs(vd a) { return _mm256_andnot_pd(v_set(-0.0), a); }
INLINE vd v_sqrt(vd a) { return _mm256_sqrt_pd(a); }
INLINE vd v_select(vm m, vd a, vd b) { return _mm256_blendv_pd(b, a, m); }
INLINE vd v_select_minus(vm m, vd a, vd b) { /* m ? -a : b */
    return v_select(m, _mm256_xor_pd(a, v_set(-0.0)), b);
}
INLINE vm v_less(vd a, vd b) { return _mm256_cmp_pd(a, b, _CMP_LT_OQ); }
INLINE vd v_maxabs(vd a, vd b) { return v_max(v_abs(a), v_abs(b)); }
#define v_shl(a, n) _mm256_slli_epi64(a, n)
INLINE vm v_odd(vi a) { return v_double(v_shl(a, 63)); } /* blendv reads the sign bit */
INLINE vd v_flip(vd a, vi b) { return _mm256_xor_pd(a, _mm256_and_pd(v_double(b), v_set(-0.0))); }
INLINE vd v_copysign(vd a, vd b) {
    return _mm256_or_pd(v_abs(a), _mm256_and_pd(b, v_set(-0.0)));
}
INLINE vd v_rint(vd a) { return _mm256_round_pd(a, 8); }
INLINE vd v_scale2(vd a, vd k) {
    vd shifted = v_max(k, v_set(-1022.0)) + v_set(6755399441055744.0 + 1023.0);
    return a * v_double(v_shl(v_bits(shifted), 52));
}

#elif W == 1
typedef double vd;
typedef int64_t vi;
typedef int vm;
INLINE vd v_set(double x) { return x; }
INLINE vd v_load(const double *p) { return *p; }
INLINE void v_store(double *p, vd x) { *p = x; }
INLINE vd v_fma(vd a, vd b, vd c) { return __builtin_fma(a, b, c); }
INLINE vd v_fnma(vd a, vd b, vd c) { return __builtin_fma(-a, b, c); }
INLINE vd v_max(vd a, vd b) { return a > b ? a : b; }
INLINE vd v_abs(vd a) { return __builtin_fabs(a); }
INLINE vd v_sqrt(vd a) { return __builtin_sqrt(a); }
INLINE vd v_select(vm m, vd a, vd b) { return m ? a : b; }
INLINE vd v_select_minus(vm m, vd a, vd b) { return m ? -a : b; }
INLINE vm v_less(vd a, vd b) { return a < b; }
INLINE vd v_maxabs(vd a, vd b) { return v_max(v_abs(a), v_abs(b)); }
INLINE vi v_bits(vd a) { vi b; memcpy(&b, &a, 8); return b; }
INLINE vd v_double(vi a) { vd b; memcpy(&b, &a, 8); return b; }
INLINE vi v_seti(int64_t x) { return x; }
INLINE vi v_shl(vi a, int n) { return (vi)((uint64_t)a << n); }
INLINE vm v_odd(vi a) { return (int)(a & 1); }
INLINE vd v_flip(vd a, vi b) { return v_double(v_bits(a) ^ (b & INT64_MIN)); }
INLINE vd v_copysign(vd a, vd b) { return __builtin_copysign(a, b); }
INLINE vd v_rint(vd a) { return __builtin_nearbyint(a); }
INLINE vd v_scale2(vd a, vd k) {
    vd shifted = v_max(k, -1022.0) + (6755399441055744.0 + 1023.0);
    return a * v_double(v_shl(v_bits(shifted), 52));
}
#else
#error "W must be 8, 4 or 1"
#endif

#endif
