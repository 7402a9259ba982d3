/* The time step: quaternion feedback, the law, rates held, RK4 on attitude and body rate. */
#ifndef STEP_H
#define STEP_H

#include "law_sr.h"
#include "law_svd.h"

enum { LAW_SR, LAW_GRADIENT, LAW_SVD };

/* Gimbal angles after `time` at held rates, with what the body needs there. */
INLINE void gimbals(const vd d[4], const vd rate[4], double time, vd out[4], vd s[4], vd c[4]) {
    for (int i = 0; i < 4; i++) {
        out[i] = d[i] + time * rate[i];
        v_sincos(out[i], &s[i], &c[i]);
    }
}

/* Stage 1, at the start of the step: sum = y + dt/6 k1, z = y + dt/2 k1. */
INLINE void first_stage(const State *x, const vd rate[4], vd y[7], vd sum[7], vd z[7]) {
    vd u[3], k[7];
    for (int i = 0; i < 4; i++) y[i] = x->q[i];
    for (int i = 0; i < 3; i++) y[4 + i] = x->w[i];
    array_torque(x->s, x->c, rate, u);
    derivative(y, y + 4, x->h, u, k);
    advance(y, k, DT / 6, sum);
    advance(y, k, DT / 2, z);
}

/* Stages 2 and 3: the held rates give them one set of gimbal angles. */
INLINE void middle_stage(const vd y[7], const vd h[3], const vd u[3], double step, vd sum[7],
                         vd z[7]) {
    vd k[7];
    derivative(z, z + 4, h, u, k);
    advance(sum, k, DT / 3, sum);
    advance(y, k, step, z);
}

/* Stage 4, at the gimbal angles of the next step's start. */
INLINE void last_stage(State *x, const vd rate[4], const vd z[7], vd sum[7]) {
    vd u[3], k[7];
    array_torque(x->s, x->c, rate, u);
    derivative(z, z + 4, x->h, u, k);
    advance(sum, k, DT / 6, sum);
    normalise(sum, x);
}

/* What the law can do as soon as the gimbal angles of its next turn are known. */
INLINE void look_ahead(State *x, int law) {
    array_momentum(x->s, x->c, x->h);
    if (law != LAW_SVD) prepare_sr(x, law == LAW_GRADIENT);
}

/* Hold the rates for one step. */
INLINE void hold_rates(State *x, const vd rate[4], int law) {
    vd d[4], s[4], c[4], h[3], u[3], y[7], z[7], sum[7];
    gimbals(x->d, rate, DT / 2, d, s, c);
    first_stage(x, rate, y, sum, z);
    array_momentum(s, c, h);
    array_torque(s, c, rate, u);
    middle_stage(y, h, u, DT / 2, sum, z);
    gimbals(x->d, rate, DT, x->d, x->s, x->c);
    middle_stage(y, h, u, DT, sum, z);
    look_ahead(x, law);
    last_stage(x, rate, z, sum);
}

INLINE void step_sr(State *x, int law) {
    vd hdot[3], raw[4], rate[4];
    wanted_momentum_rate(x, hdot);
    vd det = law_sr(x, hdot, law == LAW_GRADIENT, raw);
    limit_rates(raw, det, rate);
    hold_rates(x, rate, law);
}

INLINE void step_svd(State x[TILE]) {
    vd raw[TILE][4];
    law_svd(x, raw);
    ROLLED {
        vd rate[4];
        limit_rates(raw[j], v_set(1.0), rate);
        hold_rates(&x[j], rate, LAW_SVD);
    }
}

INLINE void step(State x[TILE], int law) {
    if (law == LAW_SVD)
        step_svd(x);
    else
        EACH step_sr(&x[j], law);
}

#endif
