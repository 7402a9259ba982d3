/* The yardstick: the closed loop in hand-written SIMD C, one run a lane, TILE vectors at a time.
 *
 *   gcc -O3 -march=native -DW=8 -DTILE=2 -shared -fPIC reference.c      (W = 8, 4 or 1)
 * The scalar build is the same source with W = 1 and auto-vectorisation off. Strict IEEE: no
 * -ffast-math; products and sums contract to fused multiply-adds.
 */
#include "reference.h"

#include "step.h"

INLINE void load(State *x, const double *q, const double *w, const double *d, long n) {
    UPTO(4, i) x->q[i] = v_load(q + i * n);
    UPTO(3, i) x->w[i] = v_load(w + i * n);
    UPTO(4, i) x->d[i] = v_load(d + i * n);
    UPTO(4, i) v_sincos(x->d[i], &x->s[i], &x->c[i]);
}

INLINE void store(const State *x, double *q, double *w, double *d, long n) {
    UPTO(4, i) v_store(q + i * n, x->q[i]);
    UPTO(3, i) v_store(w + i * n, x->w[i]);
    UPTO(4, i) v_store(d + i * n, x->d[i]);
}

INLINE void run(double *q, double *w, double *d, long n, long steps, int law) {
    for (long at = 0; at < n; at += TILE * W) {
        State x[TILE];
        EACH load(&x[j], q + at + j * W, w + at + j * W, d + at + j * W, n);
        EACH look_ahead(&x[j], law);
        for (long k = 0; k < steps; k++) step(x, law);
        EACH store(&x[j], q + at + j * W, w + at + j * W, d + at + j * W, n);
    }
}

void reference_sr(double *q, double *omega, double *delta, long n, long steps) {
    run(q, omega, delta, n, steps, LAW_SR);
}

void reference_gradient(double *q, double *omega, double *delta, long n, long steps) {
    run(q, omega, delta, n, steps, LAW_GRADIENT);
}

void reference_svd(double *q, double *omega, double *delta, long n, long steps) {
    run(q, omega, delta, n, steps, LAW_SVD);
}

long reference_lanes(void) { return TILE * W; }

void reference_sincos(const double *x, double *sin_x, double *cos_x, long n) {
    for (long i = 0; i < n; i += W) {
        vd s, c;
        v_sincos(v_load(x + i), &s, &c);
        v_store(sin_x + i, s);
        v_store(cos_x + i, c);
    }
}

void reference_exp(const double *x, double *exp_x, long n) {
    for (long i = 0; i < n; i += W) v_store(exp_x + i, v_exp(v_load(x + i)));
}
