#include "numerics.h"

#include <math.h>

enum { MOST = NUMERICS_MOST };

int numerics_rk4(numerics_rates f, const void *plant, int n, double t, double h, double x[]) {
    static const double node[4] = {0.0, 0.5, 0.5, 1.0};
    static const double weight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    double k[MOST] = {0.0};
    double at[MOST];
    double sum[MOST] = {0.0};

    for (int stage = 0; stage < 4; ++stage) {
        for (int i = 0; i < n; ++i) {
            at[i] = x[i] + node[stage] * h * k[i];
        }
        const int status = f(plant, t + node[stage] * h, at, k);
        if (status != 0) {
            return status;
        }
        for (int i = 0; i < n; ++i) {
            sum[i] += weight[stage] * k[i];
        }
    }
    for (int i = 0; i < n; ++i) {
        x[i] += h * sum[i];
    }
    return 0;
}

static void exchange(int m, double a[], double b[]) {
    for (int j = 0; j < m; ++j) {
        const double kept = a[j];
        a[j] = b[j];
        b[j] = kept;
    }
}

int numerics_solve(int n, int m, const double A[], double B[]) {
    double L[MOST * MOST];

    for (int i = 0; i < n * n; ++i) {
        L[i] = A[i];
    }
    for (int k = 0; k < n; ++k) {
        int pivot = k;
        for (int i = k + 1; i < n; ++i) {
            if (fabs(L[i * n + k]) > fabs(L[pivot * n + k])) {
                pivot = i;
            }
        }
        if (!(fabs(L[pivot * n + k]) > 0.0)) {
            return 1;
        }
        exchange(n, &L[k * n], &L[pivot * n]);
        exchange(m, &B[k * m], &B[pivot * m]);
        for (int i = k + 1; i < n; ++i) {
            const double factor = L[i * n + k] / L[k * n + k];
            for (int j = k; j < n; ++j) {
                L[i * n + j] -= factor * L[k * n + j];
            }
            for (int j = 0; j < m; ++j) {
                B[i * m + j] -= factor * B[k * m + j];
            }
        }
    }
    for (int k = n - 1; k >= 0; --k) {
        for (int j = 0; j < m; ++j) {
            for (int i = k + 1; i < n; ++i) {
                B[k * m + j] -= L[k * n + i] * B[i * m + j];
            }
            B[k * m + j] /= L[k * n + k];
        }
    }
    return 0;
}

void numerics_product(int n, int k, int m, const double A[], const double B[], double C[]) {
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < m; ++j) {
            C[i * m + j] = 0.0;
            for (int l = 0; l < k; ++l) {
                C[i * m + j] += A[i * k + l] * B[l * m + j];
            }
        }
    }
}

/* exp([A B; 0 0] h) = [Ad Bd; 0 1]: the series at h / 2^s, then s times x(2h) from x(h). */
void numerics_discretize(int n, int m, const double A[], const double B[], double h, double Ad[],
                         double Bd[]) {
    double term[MOST * MOST];
    double next[MOST * MOST];
    double integral[MOST * MOST]; /* of exp(A s) over s from 0 to h */
    double largest = 0.0;
    int halvings = 0;

    for (int i = 0; i < n * n; ++i) {
        largest = fmax(largest, fabs(A[i]) * h * n);
    }
    for (; largest > 0.5; largest /= 2) {
        h /= 2;
        ++halvings;
    }
    for (int i = 0; i < n * n; ++i) {
        term[i] = i % (n + 1) == 0 ? h : 0.0;
        integral[i] = term[i];
    }
    for (int order = 2; order < 18; ++order) {
        numerics_product(n, n, n, A, term, next);
        for (int i = 0; i < n * n; ++i) {
            term[i] = next[i] * h / order;
            integral[i] += term[i];
        }
    }
    numerics_product(n, n, n, A, integral, Ad);
    for (int i = 0; i < n; ++i) {
        Ad[i * n + i] += 1.0;
    }
    for (int k = 0; k < halvings; ++k) {
        numerics_product(n, n, n, Ad, integral, next);
        for (int i = 0; i < n * n; ++i) {
            integral[i] += next[i];
        }
        numerics_product(n, n, n, Ad, Ad, next);
        for (int i = 0; i < n * n; ++i) {
            Ad[i] = next[i];
        }
    }
    numerics_product(n, n, m, integral, B, Bd);
}

int numerics_lqr(int n, int m, const double A[], const double B[], const double Q[],
                 const double R[], double K[]) {
    double P[MOST * MOST] = {0.0};
    double PA[MOST * MOST];
    double PB[MOST * MOST];
    double S[MOST * MOST];

    for (int i = 0; i < n; ++i) {
        P[i * n + i] = Q[i];
    }
    for (int round = 0; round < 100000; ++round) {
        double change = 0.0;
        double largest = 0.0;

        numerics_product(n, n, n, P, A, PA);
        numerics_product(n, n, m, P, B, PB);
        for (int i = 0; i < m; ++i) { /* K = (R + B^T P B)^-1 B^T P A */
            for (int j = 0; j < m; ++j) {
                S[i * m + j] = i == j ? R[i] : 0.0;
                for (int k = 0; k < n; ++k) {
                    S[i * m + j] += B[k * m + i] * PB[k * m + j];
                }
            }
            for (int j = 0; j < n; ++j) {
                K[i * n + j] = 0.0;
                for (int k = 0; k < n; ++k) {
                    K[i * n + j] += B[k * m + i] * PA[k * n + j];
                }
            }
        }
        if (numerics_solve(m, n, S, K) != 0) {
            return 1;
        }
        for (int i = 0; i < n; ++i) { /* PA := P (A - B K); P := Q + A^T PA */
            for (int j = 0; j < n; ++j) {
                for (int k = 0; k < m; ++k) {
                    PA[i * n + j] -= PB[i * m + k] * K[k * n + j];
                }
            }
        }
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) {
                double next = i == j ? Q[i] : 0.0;
                for (int k = 0; k < n; ++k) {
                    next += A[k * n + i] * PA[k * n + j];
                }
                change = fmax(change, fabs(next - P[i * n + j]));
                largest = fmax(largest, fabs(next));
                P[i * n + j] = next;
            }
        }
        if (!(largest < HUGE_VAL)) {
            return 1; /* what u does not reach grows without end */
        }
        if (change <= 1e-12 * largest) {
            return 0;
        }
    }
    return 1;
}

/* splitmix64: a counter, mixed. */
double numerics_uniform(unsigned long long *seed) {
    unsigned long long z = (*seed += 0x9e3779b97f4a7c15ULL) & 0xffffffffffffffffULL;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL & 0xffffffffffffffffULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL & 0xffffffffffffffffULL;
    z ^= z >> 31;
    return ((double)(z >> 11) + 0.5) / 9007199254740992.0;
}

double numerics_normal(unsigned long long *seed) { /* Box and Muller */
    const double radius = sqrt(-2.0 * log(numerics_uniform(seed)));
    return radius * cos(6.283185307179586 * numerics_uniform(seed));
}

double numerics_quantized(double x, double resolution) {
    return resolution * floor(x / resolution + 0.5);
}

double numerics_clipped(double x, double most) { return fmax(-most, fmin(x, most)); }
