/* Entry points of the hand-written closed-loop reference (see reference.c). */
#ifndef REFERENCE_H
#define REFERENCE_H

/* Advance n runs by `steps` steps in place. q is 4 x n, omega 3 x n, delta 4 x n, row by row;
 * n must be a multiple of reference_lanes(). */
void reference_sr(double *q, double *omega, double *delta, long n, long steps);
void reference_gradient(double *q, double *omega, double *delta, long n, long steps);
void reference_svd(double *q, double *omega, double *delta, long n, long steps);
long reference_lanes(void);

/* The elementary functions by themselves, for their accuracy tests; n as above. */
void reference_sincos(const double *x, double *sin_x, double *cos_x, long n);
void reference_exp(const double *x, double *exp_x, long n);

#endif
