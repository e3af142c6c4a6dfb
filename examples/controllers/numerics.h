/* What the controllers and their simulations share: small dense numerics, no heap, no state of
 * their own.
 *
 * Matrices are dense and row-major. No dimension may exceed NUMERICS_MOST. What can fail returns a
 * status, 0 if all is well.
 */
#ifndef NUMERICS_H
#define NUMERICS_H

#define NUMERICS_MOST 16

/* x' = f(t, x); `plant` is whatever f needs to know beside. */
typedef int (*numerics_rates)(const void *plant, double t, const double x[], double xdot[]);

/* One step h of the classical Runge-Kutta method of fourth order; x (n) is advanced in place. */
int numerics_rk4(numerics_rates f, const void *plant, int n, double t, double h, double x[]);

/* B := A^-1 B by Gaussian elimination with row pivoting; A is n x n, B n x m. 1: A is singular. */
int numerics_solve(int n, int m, const double A[], double B[]);

/* C := A B; A is n x k, B k x m. C may be neither. */
void numerics_product(int n, int k, int m, const double A[], const double B[], double C[]);

/* x' = A x + B u with u held over h becomes x+ = Ad x + Bd u; A is n x n, B n x m. */
void numerics_discretize(int n, int m, const double A[], const double B[], double h, double Ad[],
                         double Bd[]);

/* Gain K (m x n) of u = -K x that minimises sum x^T Q x + u^T R u for x+ = A x + B u, with diagonal
 * Q (n) and R (m): the Riccati recursion, until P no longer changes. 1: it does not settle. */
int numerics_lqr(int n, int m, const double A[], const double B[], const double Q[],
                 const double R[], double K[]);

/* Random numbers: the same sequence on every machine. `seed` is the generator's state. */
double numerics_uniform(unsigned long long *seed); /* in (0, 1) */
double numerics_normal(unsigned long long *seed);  /* mean 0, variance 1 */

/* What a sensor with this resolution shows of x. */
double numerics_quantized(double x, double resolution);

/* x, but not beyond the limits -most and most. */
double numerics_clipped(double x, double most);

#endif
