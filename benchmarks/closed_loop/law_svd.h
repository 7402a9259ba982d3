/* Singular direction avoidance on a full singular value decomposition A = U S V^T (3 x 4).
 *
 *   rates = V diag(1/s1, 1/s2, s3 / (s3^2 + alpha)) U^T hdot,  alpha = 0.01 exp(-10 s3^2)
 * Householder QR of A^T = Q R, one-sided Jacobi on L = R^T (L Z = U S, four fixed sweeps), sorted,
 * V = Q Z. One rotation waits for the one before it, so TILE vectors advance together, line by
 * line: EACH is the loop over them.
 */
#ifndef LAW_SVD_H
#define LAW_SVD_H

#include "model.h"

#define SWEEPS 4
#define TINY 1e-280
#define SMALL 1e-140

/* A^T = Q R with reflectors I - tau[k] v[k] v[k]^T; L = R^T and Z by columns, n2 = |column of L|^2 */
typedef struct {
    vd v[3][4], tau[3];
    vd l[3][3], z[3][3], n2[3];
} Svd;

/* v_rsqrt and v_reciprocal, line by line over the tile. */
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

INLINE vd dot3(const vd a[3], const vd b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* The sum over i = k..3 of a_i b_i. */
INLINE vd dot_from(const int k, const vd a[4], const vd b[4]) {
    vd p = a[3] * b[3];
    UPTO(3, i) if (i >= k) p += a[i] * b[i];
    return p;
}

/* Column k of the factorisation: H x = -sign(x_k) |x| e_k, applied to the columns after it.
 * v = x + sign(x_k) |x| e_k, so v.y = x.y + sign(x_k) |x| y_k need not wait for the norm. */
INLINE void factor_column(Svd f[TILE], vd m[TILE][3][4], const int k) {
    vd n2[TILE], norm[TILE], p[3][TILE];
    EACH n2[j] = v_max(dot_from(k, m[j][k], m[j][k]), v_set(TINY));
    rsqrt_tile(n2, norm);
    UPTO(3, i) if (i > k) EACH p[i][j] = dot_from(k, m[j][k], m[j][i]);
    EACH norm[j] *= n2[j];
    EACH f[j].tau[k] = v_reciprocal(n2[j] + v_abs(m[j][k][k]) * norm[j]);
    EACH norm[j] = v_copysign(norm[j], m[j][k][k]);
    UPTO(3, i) if (i > k) EACH p[i][j] += norm[j] * m[j][i][k];
    EACH f[j].l[k][k] = -norm[j];
    EACH m[j][k][k] += norm[j];
    UPTO(3, i) if (i > k) {
        EACH p[i][j] *= f[j].tau[k];
        UPTO(4, n) if (n >= k) EACH m[j][i][n] -= p[i][j] * m[j][k][n];
        EACH f[j].l[k][i] = m[j][i][k];
    }
    UPTO(4, i) if (i >= k) EACH f[j].v[k][i] = m[j][k][i];
}

INLINE void factor(const State x[TILE], Svd f[TILE]) {
    vd m[TILE][3][4];
    EACH {
        const vd *s = x[j].s, *c = x[j].c;
        vd rows[3][4] = {{-COS_B * c[0], s[1], COS_B * c[2], -s[3]},
                         {-s[0], -COS_B * c[1], s[2], COS_B * c[3]},
                         {SIN_B * c[0], SIN_B * c[1], SIN_B * c[2], SIN_B * c[3]}};
        UPTO(3, k) UPTO(4, i) m[j][k][i] = rows[k][i];
    }
    factor_column(f, m, 0);
    factor_column(f, m, 1);
    factor_column(f, m, 2);
    EACH f[j].l[1][0] = f[j].l[2][0] = f[j].l[2][1] = v_set(0.0);
    EACH UPTO(3, k) UPTO(3, i) f[j].z[k][i] = v_set(i == k);
    EACH UPTO(3, k) f[j].n2[k] = dot3(f[j].l[k], f[j].l[k]);
}

INLINE void rotate(vd *a, vd *b, vd c, vd s) {
    vd t = c * *a - s * *b;
    *b = s * *a + c * *b;
    *a = t;
}

/* The inner Jacobi rotation that makes columns p and r orthogonal.
 * With d = |r|^2 - |p|^2, g = p.r:  1/h = (d^2/4 + g^2)^-1/2,  c^2 = 1/2 + |d| / (4 h),
 * s = sign(d) g / (2 h c); |d| is kept off zero so that d = g = 0 gives c = 1. */
INLINE void orthogonalise(Svd f[TILE], int p, int r) {
    vd g[TILE], d[TILE], quarter[TILE], h2[TILE], rh[TILE], c2[TILE], rc[TILE], s[TILE], c[TILE];
    EACH g[j] = f[j].l[p][2] * f[j].l[r][2];
    EACH d[j] = f[j].n2[r] - f[j].n2[p];
    EACH g[j] += f[j].l[p][1] * f[j].l[r][1];
    EACH s[j] = v_copysign(v_set(0.5), d[j]);
    EACH d[j] = v_maxabs(d[j], v_set(SMALL));
    EACH g[j] += f[j].l[p][0] * f[j].l[r][0];
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

INLINE void swap_if(vm swap, vd *a, vd *b) {
    vd t = v_select(swap, *b, *a);
    *b = v_select(swap, *a, *b);
    *a = t;
}

INLINE void order(Svd *f, int p, int r) {
    vm swap = v_less(f->n2[p], f->n2[r]);
    swap_if(swap, &f->n2[p], &f->n2[r]);
    UPTO(3, i) swap_if(swap, &f->l[p][i], &f->l[r][i]);
    UPTO(3, i) swap_if(swap, &f->z[p][i], &f->z[r][i]);
}

/* v = H_0 H_1 H_2 (z, 0), a column of V */
INLINE void right_vector(const Svd *f, const vd z[3], vd v[4]) {
    vd p = f->tau[2] * (f->v[2][2] * z[2]);
    v[0] = z[0];
    v[1] = z[1];
    v[2] = z[2] - p * f->v[2][2];
    v[3] = -(p * f->v[2][3]);
    p = f->tau[1] * dot_from(1, f->v[1], v);
    UPTO(4, i) if (i > 0) v[i] -= p * f->v[1][i];
    p = f->tau[0] * dot_from(0, f->v[0], v);
    UPTO(4, i) v[i] -= p * f->v[0][i];
}

/* Normalise: U in f->l, singular values, their inverses. */
INLINE void left_vectors(Svd *f, vd sigma[3], vd inverse[3]) {
    UPTO(3, k) {
        vd n2 = v_max(dot3(f->l[k], f->l[k]), v_set(TINY));
        inverse[k] = v_rsqrt(n2);
        sigma[k] = n2 * inverse[k];
        UPTO(3, i) f->l[k][i] *= inverse[k];
    }
}

/* The law's formula on one vector's finished decomposition. */
INLINE void apply_svd(const State *x, Svd *f, vd rate[4]) {
    vd hdot[3], sigma[3], gain[3], v[3][4];
    order(f, 0, 1);
    order(f, 0, 2);
    order(f, 1, 2);
    left_vectors(f, sigma, gain);
    UPTO(3, k) right_vector(f, f->z[k], v[k]);
    vd s2 = sigma[2] * sigma[2];
    gain[2] = sigma[2] * v_reciprocal(s2 + 0.01 * v_exp(-10.0 * s2));
    wanted_momentum_rate(x, hdot);
    UPTO(3, k) gain[k] *= dot3(f->l[k], hdot);
    UPTO(4, i) rate[i] = v[0][i] * gain[0] + v[1][i] * gain[1] + v[2][i] * gain[2];
}

INLINE void law_svd(const State x[TILE], vd rate[TILE][4]) {
    Svd f[TILE];
    factor(x, f);
    _Pragma("GCC unroll 1") for (int sweep = 0; sweep < SWEEPS; sweep++) {
        orthogonalise(f, 0, 1);
        orthogonalise(f, 0, 2);
        orthogonalise(f, 1, 2);
    }
    EACH apply_svd(&x[j], &f[j], rate[j]);
}

#endif
