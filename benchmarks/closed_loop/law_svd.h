/* Singular direction avoidance on a full singular value decomposition A = U S V^T (3 x 4).
 *
 *   rates = V diag(1/s1, 1/s2, s3 / (s3^2 + alpha)) U^T hdot,  alpha = 0.01 exp(-10 s3^2)
 * Householder QR of A^T = Q R, one-sided Jacobi on L = R^T (L Z = U S, four fixed sweeps), sorted,
 * V = Q Z. TILE vectors advance together, since one rotation waits for the one before it.
 */
#ifndef LAW_SVD_H
#define LAW_SVD_H

#include "model.h"

#define SWEEPS 4
#define TINY 1e-290
#define SMALL 1e-140

/* Householder reflector H = I - tau v v^T with H x = -sign(x0) |x| e0; v overwrites x. */
INLINE vd reflector(int n, vd *v, vd *tau) {
    vd n2 = v[0] * v[0];
    for (int i = 1; i < n; i++) n2 += v[i] * v[i];
    n2 = v_max(n2, v_set(TINY));
    vd norm = n2 * v_rsqrt(n2);
    *tau = v_reciprocal(n2 + v_abs(v[0]) * norm);
    vd signed_norm = v_copysign(norm, v[0]);
    v[0] += signed_norm;
    return -signed_norm;
}

INLINE void reflect(int n, const vd *v, vd tau, vd *x) {
    vd p = v[0] * x[0];
    for (int i = 1; i < n; i++) p += v[i] * x[i];
    p *= tau;
    for (int i = 0; i < n; i++) x[i] -= p * v[i];
}

/* A^T = Q R: reflectors in v[k][k..3], tau[k]; l[k] is column k of L = R^T. */
typedef struct {
    vd v[3][4], tau[3];
    vd l[3][3], z[3][3], n2[3]; /* columns of L and Z, squared norms of L's columns */
} Svd;

INLINE void factor(const State *x, Svd *f) {
    const vd *s = x->s, *c = x->c;
    vd m[3][4] = {{-COS_B * c[0], s[1], COS_B * c[2], -s[3]},
                  {-s[0], -COS_B * c[1], s[2], COS_B * c[3]},
                  {SIN_B * c[0], SIN_B * c[1], SIN_B * c[2], SIN_B * c[3]}};
    for (int k = 0; k < 3; k++) {
        f->l[k][k] = reflector(4 - k, &m[k][k], &f->tau[k]);
        for (int i = k; i < 4; i++) f->v[k][i] = m[k][i];
        for (int i = k + 1; i < 3; i++) {
            reflect(4 - k, &f->v[k][k], f->tau[k], &m[i][k]);
            f->l[k][i] = m[i][k];
        }
    }
}

INLINE vd dot3(const vd a[3], const vd b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* v_rsqrt, line by line over the tile. */
INLINE void rsqrt_tile(const vd x[TILE], vd y[TILE]) {
#if W == 8 && !defined(EXACT_RSQRT)
    vd e[TILE], p[TILE];
    EACH y[j] = _mm512_rsqrt14_pd(x[j]);
    EACH e[j] = x[j] * y[j];
    EACH e[j] = v_fnma(e[j], y[j], v_set(1.0));
    EACH p[j] = v_fma(e[j], v_set(0.3125), v_set(0.375));
    EACH p[j] = v_fma(e[j], p[j], v_set(0.5));
    EACH e[j] *= y[j];
    EACH y[j] = v_fma(e[j], p[j], y[j]);
#else
    EACH y[j] = v_rsqrt(x[j]);
#endif
}

INLINE void rotate(vd *a, vd *b, vd c, vd s) {
    vd t = c * *a - s * *b;
    *b = s * *a + c * *b;
    *a = t;
}

/* The inner Jacobi rotation that makes columns p and r orthogonal, line by line over the tile.
 * With d = |r|^2 - |p|^2, g = p.r:  1/h = (d^2/4 + g^2)^-1/2,  c^2 = 1/2 + |d| / (4 h),
 * s = sign(d) g / (2 h c); |d| is kept off zero so that d = g = 0 gives c = 1. */
INLINE void orthogonalise(Svd f[TILE], int p, int r) {
    vd g[TILE], d[TILE], quarter[TILE], h2[TILE], rh[TILE], c2[TILE], rc[TILE], s[TILE], c[TILE];
    EACH g[j] = f[j].l[p][0] * f[j].l[r][0];
    EACH g[j] += f[j].l[p][1] * f[j].l[r][1];
    EACH g[j] += f[j].l[p][2] * f[j].l[r][2];
    EACH d[j] = f[j].n2[r] - f[j].n2[p];
    EACH s[j] = v_copysign(v_set(0.5), d[j]);
    EACH d[j] = v_maxabs(d[j], v_set(SMALL));
    EACH quarter[j] = 0.25 * d[j];
    EACH h2[j] = quarter[j] * d[j];
    EACH h2[j] += g[j] * g[j];
    rsqrt_tile(h2, rh);
    EACH s[j] *= g[j];
    EACH c2[j] = quarter[j] * rh[j] + 0.5;
    EACH s[j] *= rh[j];
    rsqrt_tile(c2, rc);
    EACH c[j] = c2[j] * rc[j];
    EACH s[j] *= rc[j];
    UPTO(3, i) EACH rotate(&f[j].l[p][i], &f[j].l[r][i], c[j], s[j]);
    EACH g[j] *= s[j] * rc[j];
    UPTO(3, i) EACH rotate(&f[j].z[p][i], &f[j].z[r][i], c[j], s[j]);
    EACH f[j].n2[p] -= g[j];
    EACH f[j].n2[r] += g[j];
}

INLINE void order(Svd *f, int p, int r) {
    vm swap = v_less(f->n2[p], f->n2[r]);
    vd big = v_select(swap, f->n2[r], f->n2[p]), small = v_select(swap, f->n2[p], f->n2[r]);
    f->n2[p] = big;
    f->n2[r] = small;
    UPTO(3, i) {
        vd lp = f->l[p][i], lr = f->l[r][i], zp = f->z[p][i], zr = f->z[r][i];
        f->l[p][i] = v_select(swap, lr, lp);
        f->l[r][i] = v_select(swap, lp, lr);
        f->z[p][i] = v_select(swap, zr, zp);
        f->z[r][i] = v_select(swap, zp, zr);
    }
}

/* U (columns f->l), singular values and V's three columns that belong to them. */
INLINE void finish(Svd *f, vd sigma[3], vd inverse[3], vd v[3][4]) {
    for (int k = 0; k < 3; k++) {
        vd n2 = v_max(f->n2[k], v_set(TINY));
        inverse[k] = v_rsqrt(n2);
        sigma[k] = n2 * inverse[k];
        UPTO(3, i) f->l[k][i] *= inverse[k];
        UPTO(3, i) v[k][i] = f->z[k][i];
        v[k][3] = v_set(0.0);
        for (int i = 2; i >= 0; i--) reflect(4 - i, &f->v[i][i], f->tau[i], &v[k][i]);
    }
}

INLINE void apply_law(Svd *f, const vd hdot[3], vd rate[4]) {
    vd sigma[3], gain[3], v[3][4];
    finish(f, sigma, gain, v);
    vd s2 = sigma[2] * sigma[2];
    gain[2] = sigma[2] * v_reciprocal(s2 + 0.01 * v_exp(-10.0 * s2));
    for (int k = 0; k < 3; k++) gain[k] *= dot3(f->l[k], hdot);
    for (int i = 0; i < 4; i++) rate[i] = v[0][i] * gain[0] + v[1][i] * gain[1] + v[2][i] * gain[2];
}

INLINE void law_svd(const State x[TILE], const vd hdot[TILE][3], vd rate[TILE][4]) {
    Svd f[TILE];
    EACH factor(&x[j], &f[j]);
    EACH UPTO(3, k) UPTO(3, i) f[j].z[k][i] = v_set(i == k);
    EACH UPTO(3, k) UPTO(k, i) f[j].l[k][i] = v_set(0.0);
    EACH UPTO(3, k) f[j].n2[k] = dot3(f[j].l[k], f[j].l[k]);
#ifdef ROLL
_Pragma("GCC unroll 1")
#else
_Pragma("GCC unroll 8")
#endif
 for (int sweep = 0; sweep < SWEEPS; sweep++) {
        orthogonalise(f, 0, 1);
        orthogonalise(f, 0, 2);
        orthogonalise(f, 1, 2);
    }
    EACH UPTO(3, k) f[j].n2[k] = dot3(f[j].l[k], f[j].l[k]);
    EACH order(&f[j], 0, 1);
    EACH order(&f[j], 0, 2);
    EACH order(&f[j], 1, 2);
    EACH apply_law(&f[j], hdot[j], rate[j]);
}

#endif
