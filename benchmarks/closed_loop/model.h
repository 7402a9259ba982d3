/* Four-CMG pyramid on a rigid body: kinematics, quaternion feedback, one RK4 step.
 *
 * With s_i, c_i the sine and cosine of gimbal angle i, b = cos beta, a = sin beta and h0 = 1:
 *   h = ( b (s3 - s1) + c4 - c2,  c1 - c3 + b (s4 - s2),  a (s1 + s2 + s3 + s4) )
 *   A = [ -b c1   s2    b c3  -s4  ;  -s1  -b c2   s3   b c4  ;  a c1  a c2  a c3  a c4 ]
 */
#ifndef MODEL_H
#define MODEL_H

#include "elementary.h"

#define COS_B 0x1.27a4eeef98f58p-1 /* cos 54.73 deg */
#define SIN_B 0x1.a2046dedfc954p-1 /* sin 54.73 deg */
#define DT 0.01
#define KP 4.0
#define KW 12.0
#define RATE_MAX 1.5
#define JX 24.0
#define JY 20.0
#define JZ 16.0

#ifndef TILE
#define TILE 1 /* vectors that advance together, to hide latency */
#endif
#define EACH _Pragma("GCC unroll 8") for (int j = 0; j < TILE; j++)
#define ROLLED _Pragma("GCC unroll 1") for (int j = 0; j < TILE; j++)
#define UPTO(n, i) _Pragma("GCC unroll 8") for (int i = 0; i < n; i++)

/* A symmetric 3 x 3 matrix. */
typedef struct {
    vd xx, yy, zz, xy, xz, yz;
} Sym3;

/* What the singularity-robust laws know from the gimbal angles alone: adj(M), det(M), and for the
 * null motion k det(M) grad and k A grad. Ready before the body's last stage, to run beside it. */
typedef struct {
    Sym3 adjugate;
    vd det, null[4], drift[3];
} Plan;

typedef struct {
    vd q[4], w[3], d[4]; /* the state: attitude, body rate, gimbal angles */
    vd s[4], c[4], h[3]; /* sine, cosine and momentum at d: the end of one step serves the next */
    Plan plan;
} State;

INLINE void array_momentum(const vd s[4], const vd c[4], vd h[3]) {
    h[0] = COS_B * (s[2] - s[0]) + (c[3] - c[1]);
    h[1] = COS_B * (s[3] - s[1]) + (c[0] - c[2]);
    h[2] = SIN_B * ((s[0] + s[1]) + (s[2] + s[3]));
}

/* A rates */
INLINE void array_torque(const vd s[4], const vd c[4], const vd rate[4], vd u[3]) {
    vd e0 = c[0] * rate[0], e1 = c[1] * rate[1], e2 = c[2] * rate[2], e3 = c[3] * rate[3];
    u[0] = COS_B * (e2 - e0) + (s[1] * rate[1] - s[3] * rate[3]);
    u[1] = COS_B * (e3 - e1) + (s[2] * rate[2] - s[0] * rate[0]);
    u[2] = SIN_B * ((e0 + e1) + (e2 + e3));
}

/* A^T y */
INLINE void array_transpose(const vd s[4], const vd c[4], const vd y[3], vd rate[4]) {
    vd z = SIN_B * y[2];
    rate[0] = c[0] * (z - COS_B * y[0]) - s[0] * y[1];
    rate[1] = c[1] * (z - COS_B * y[1]) + s[1] * y[0];
    rate[2] = c[2] * (z + COS_B * y[0]) + s[2] * y[1];
    rate[3] = c[3] * (z + COS_B * y[1]) - s[3] * y[0];
}

/* hdot = kp sign(q0) q_vec + kw omega - omega x h */
INLINE void wanted_momentum_rate(const State *x, vd hdot[3]) {
    const vd *q = x->q, *w = x->w, *h = x->h;
    vd kp = v_copysign(v_set(KP), q[0]);
    hdot[0] = kp * q[1] + KW * w[0] - w[1] * h[2] + w[2] * h[1];
    hdot[1] = kp * q[2] + KW * w[1] - w[2] * h[0] + w[0] * h[2];
    hdot[2] = kp * q[3] + KW * w[2] - w[0] * h[1] + w[1] * h[0];
}

/* k = (2 q_dot, J omega_dot): q_dot = q * [0, omega] / 2,
 * J omega_dot = (J omega + h) x omega - A rates. advance() holds the 1/2 and the 1/J. */
INLINE void derivative(const vd q[4], const vd w[3], const vd h[3], const vd u[3], vd k[7]) {
    vd lx = JX * w[0] + h[0], ly = JY * w[1] + h[1], lz = JZ * w[2] + h[2];
    k[0] = -(q[1] * w[0]) - q[2] * w[1] - q[3] * w[2];
    k[1] = q[0] * w[0] + q[2] * w[2] - q[3] * w[1];
    k[2] = q[0] * w[1] + q[3] * w[0] - q[1] * w[2];
    k[3] = q[0] * w[2] + q[1] * w[1] - q[2] * w[0];
    k[4] = ly * w[2] - (lz * w[1] + u[0]);
    k[5] = lz * w[0] - (lx * w[2] + u[1]);
    k[6] = lx * w[1] - (ly * w[0] + u[2]);
}

/* out = x + step (k_q / 2, J^-1 k_w) */
INLINE void advance(const vd x[7], const vd k[7], double step, vd out[7]) {
    for (int i = 0; i < 4; i++) out[i] = x[i] + (0.5 * step) * k[i];
    out[4] = x[4] + (step / JX) * k[4];
    out[5] = x[5] + (step / JY) * k[5];
    out[6] = x[6] + (step / JZ) * k[6];
}

/* The end of a step: x = sum with q / |q|. */
INLINE void normalise(const vd sum[7], State *x) {
    vd n = v_rsqrt((sum[0] * sum[0] + sum[1] * sum[1]) + (sum[2] * sum[2] + sum[3] * sum[3]));
    for (int i = 0; i < 4; i++) x->q[i] = sum[i] * n;
    for (int i = 0; i < 3; i++) x->w[i] = sum[4 + i];
}

/* Scale rates = raw / den to the rate limit, with one division: 1 / max(den, max|raw| / limit). */
INLINE void limit_rates(const vd raw[4], vd den, vd rate[4]) {
    vd peak = v_maxabs(v_maxabs(raw[0], raw[1]), v_maxabs(raw[2], raw[3]));
    vd scale = v_reciprocal(v_max(den, peak * (1.0 / RATE_MAX)));
    for (int i = 0; i < 4; i++) rate[i] = raw[i] * scale;
}

#endif
