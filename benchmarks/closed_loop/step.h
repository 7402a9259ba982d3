/* The time step: rates held, RK4 on attitude and body rate, TILE vectors at a time. */
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

INLINE void command_rates(State x[TILE], int law, vd rate[TILE][4]) {
    vd hdot[TILE][3], raw[TILE][4], den[TILE];
    EACH wanted_momentum_rate(&x[j], hdot[j]);
    if (law == LAW_SVD) {
        EACH den[j] = v_set(1.0);
        law_svd(x, hdot, raw);
    } else {
        EACH den[j] = law_sr(&x[j], hdot[j], law == LAW_GRADIENT, raw[j]);
    }
    EACH limit_rates(raw[j], den[j], rate[j]);
}

/* What the law can do as soon as the gimbal angles of its next turn are known. */
INLINE void look_ahead(State *x, int law) {
    array_momentum(x->s, x->c, x->h);
    if (law != LAW_SVD) prepare_sr(x, law == LAW_GRADIENT);
}

INLINE void step(State x[TILE], int law) {
    vd rate[TILE][4], d[TILE][4], s[TILE][4], c[TILE][4], h[TILE][3], u[TILE][3];
    vd y[TILE][7], z[TILE][7], sum[TILE][7];
    command_rates(x, law, rate);
    EACH gimbals(x[j].d, rate[j], DT / 2, d[j], s[j], c[j]);
    EACH first_stage(&x[j], rate[j], y[j], sum[j], z[j]);
    EACH array_momentum(s[j], c[j], h[j]);
    EACH array_torque(s[j], c[j], rate[j], u[j]);
    EACH middle_stage(y[j], h[j], u[j], DT / 2, sum[j], z[j]);
    EACH gimbals(x[j].d, rate[j], DT, x[j].d, x[j].s, x[j].c);
    EACH middle_stage(y[j], h[j], u[j], DT, sum[j], z[j]);
    EACH look_ahead(&x[j], law);
    EACH last_stage(&x[j], rate[j], z[j], sum[j]);
}

#endif
