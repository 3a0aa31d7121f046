/* A pulsed buck converter by hand: exact steps of its three modes, one each half period. */
#include <math.h>
#include <string.h>

enum { Z = 3, DEGREE = 18 };

/* exp(M h) by its series over a part of the step, squared. */
static void exponential(double M[Z][Z], double h, double E[Z][Z])
{
    double term[Z][Z] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, next[Z][Z];
    const int halvings = 6;
    const double part = ldexp(h, -halvings);
    memcpy(E, term, sizeof term);
    for (int k = 1; k <= DEGREE; k++) {
        for (int i = 0; i < Z; i++)
            for (int j = 0; j < Z; j++) {
                next[i][j] = 0;
                for (int l = 0; l < Z; l++)
                    next[i][j] += term[i][l] * M[l][j] * part / k;
            }
        memcpy(term, next, sizeof term);
        for (int i = 0; i < Z; i++)
            for (int j = 0; j < Z; j++)
                E[i][j] += term[i][j];
    }
    for (int k = 0; k < halvings; k++) {
        for (int i = 0; i < Z; i++)
            for (int j = 0; j < Z; j++) {
                next[i][j] = 0;
                for (int l = 0; l < Z; l++)
                    next[i][j] += E[i][l] * E[l][j];
            }
        memcpy(E, next, sizeof next);
    }
}

/* i and v after every `each` half periods, and the instants of both switches. Where the current would
 * fall below zero the count of half periods so far is returned: that mode is not written here. */
int buck_run(const double *p, int halves, int each, double *rows, double *events)
{
    const double E = p[0], L = p[1], C = p[2], R = p[3], half = p[4];
    double M[Z][Z] = {{0, -1 / L, E / L}, {1 / C, -1 / (R * C), 0}, {0, 0, 0}}, step[2][Z][Z];
    double z[Z] = {0, 0, 1}, y[Z];
    exponential(M, half, step[0]);
    M[0][2] = 0;
    exponential(M, half, step[1]);
    for (int k = 0; k < halves; k++) {
        const double(*A)[Z] = (const double(*)[Z])step[k & 1];
        for (int i = 0; i < Z; i++)
            y[i] = A[i][0] * z[0] + A[i][1] * z[1] + A[i][2] * z[2];
        memcpy(z, y, sizeof z);
        if (z[0] < 0)
            return k;
        events[2 * k] = events[2 * k + 1] = (k + 1) * half;
        if ((k + 1) % each == 0)
            memcpy(rows + 2 * ((k + 1) / each), z, 2 * sizeof *z);
    }
    return halves;
}
