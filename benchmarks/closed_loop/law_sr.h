/* Singularity-robust inverse, with or without null motion along the gradient of det(A A^T).
 *
 *   rates = A^T M^-1 hdot,  M = A A^T + lambda I,  lambda = 0.01 exp(-10 det(A A^T))
 *   null motion: k (grad - A^T M^-1 A grad),  grad_i = -2 h_i^T adj(A A^T) a_i
 * With adj(M) = det(M) M^-1 everything is multiplied by det(M), which limit_rates divides by.
 */
#ifndef LAW_SR_H
#define LAW_SR_H

#include "model.h"

#define GRADIENT_GAIN 0.5

/* A A^T from c^2, s c (s^2 = 1 - c^2). */
INLINE Sym3 gram(const vd square[4], const vd product[4]) {
    Sym3 m;
    vd c13 = square[0] + square[2], c24 = square[1] + square[3];
    m.xx = (COS_B * COS_B) * c13 + (2.0 - c24);
    m.yy = (COS_B * COS_B) * c24 + (2.0 - c13);
    m.zz = (SIN_B * SIN_B) * (c13 + c24);
    m.xy = COS_B * ((product[0] + product[2]) - (product[1] + product[3]));
    m.xz = SIN_B * (COS_B * (square[2] - square[0]) + (product[1] - product[3]));
    m.yz = SIN_B * (COS_B * (square[3] - square[1]) + (product[2] - product[0]));
    return m;
}

INLINE Sym3 adjugate(Sym3 m) {
    Sym3 g;
    g.xx = m.yy * m.zz - m.yz * m.yz;
    g.yy = m.xx * m.zz - m.xz * m.xz;
    g.zz = m.xx * m.yy - m.xy * m.xy;
    g.xy = m.xz * m.yz - m.xy * m.zz;
    g.xz = m.xy * m.yz - m.xz * m.yy;
    g.yz = m.xy * m.xz - m.yz * m.xx;
    return g;
}

INLINE vd determinant(Sym3 m, Sym3 g) { return m.xx * g.xx + m.xy * g.xy + m.xz * g.xz; }

INLINE void multiply(Sym3 g, const vd v[3], vd out[3]) {
    out[0] = g.xx * v[0] + g.xy * v[1] + g.xz * v[2];
    out[1] = g.xy * v[0] + g.yy * v[1] + g.yz * v[2];
    out[2] = g.xz * v[0] + g.yz * v[1] + g.zz * v[2];
}

/* m += lambda I and its adjugate (off the diagonal: g_xy - lambda m_xy); returns det(m). */
INLINE vd add_diagonal(Sym3 *m, Sym3 *g, vd lambda) {
    m->xx += lambda;
    m->yy += lambda;
    m->zz += lambda;
    g->xx = m->yy * m->zz - m->yz * m->yz;
    g->yy = m->xx * m->zz - m->xz * m->xz;
    g->zz = m->xx * m->yy - m->xy * m->xy;
    g->xy -= lambda * m->xy;
    g->xz -= lambda * m->xz;
    g->yz -= lambda * m->yz;
    return determinant(*m, *g);
}

/* grad_i = -2 h_i^T G a_i with h_i = c s_i + s t_i and a_i = c t_i - s s_i, G = adj(A A^T):
 * -2 [ (2 c^2 - 1) s_i^T G t_i + s c (t_i^T G t_i - s_i^T G s_i) ] */
INLINE void gradient(Sym3 g, const vd square[4], const vd product[4], vd grad[4]) {
    vd zz = (SIN_B * SIN_B) * g.zz;
    vd even_x = (COS_B * COS_B) * g.xx + zz - g.yy, odd_x = (2 * SIN_B * COS_B) * g.xz;
    vd even_y = (COS_B * COS_B) * g.yy + zz - g.xx, odd_y = (2 * SIN_B * COS_B) * g.yz;
    vd cross = (2 * COS_B) * g.xy, lift_y = (2 * SIN_B) * g.yz, lift_x = (2 * SIN_B) * g.xz;
    vd two[4];
    for (int i = 0; i < 4; i++) two[i] = 2.0 * square[i] - 1.0;
    grad[0] = two[0] * (cross - lift_y) - 2.0 * product[0] * (even_x - odd_x);
    grad[1] = two[1] * (lift_x - cross) - 2.0 * product[1] * (even_y - odd_y);
    grad[2] = two[2] * (cross + lift_y) - 2.0 * product[2] * (even_x + odd_x);
    grad[3] = two[3] * (-cross - lift_x) - 2.0 * product[3] * (even_y + odd_y);
}

/* Everything that needs gimbal angles only. */
INLINE void prepare_sr(State *x, int with_gradient) {
    vd square[4], product[4], grad[4];
    Plan *p = &x->plan;
    for (int i = 0; i < 4; i++) {
        square[i] = x->c[i] * x->c[i];
        product[i] = x->s[i] * x->c[i];
    }
    Sym3 m = gram(square, product);
    p->adjugate = adjugate(m);
    vd lambda = 0.01 * v_exp(-10.0 * determinant(m, p->adjugate));
    if (with_gradient) {
        gradient(p->adjugate, square, product, grad);
        for (int i = 0; i < 4; i++) grad[i] *= GRADIENT_GAIN;
        array_torque(x->s, x->c, grad, p->drift);
    }
    p->det = add_diagonal(&m, &p->adjugate, lambda);
    if (with_gradient)
        for (int i = 0; i < 4; i++) p->null[i] = p->det * grad[i];
}

/* rates det(M) in raw, det(M) returned */
INLINE vd law_sr(const State *x, const vd hdot[3], int with_gradient, vd raw[4]) {
    const Plan *p = &x->plan;
    vd y[3], target[3];
    for (int i = 0; i < 3; i++) {
        target[i] = hdot[i];
        if (with_gradient) target[i] -= p->drift[i];
    }
    multiply(p->adjugate, target, y);
    array_transpose(x->s, x->c, y, raw);
    if (with_gradient)
        for (int i = 0; i < 4; i++) raw[i] += p->null[i];
    return p->det;
}

#endif
