/* Exponentials of small matrices, and their integrals over the step. */
#include "exact_internal.h"

#include <string.h>

/* Sums stay in registers: gcc vectorises the loop over rows, and unrolls the one inside. */
void ex_multiply(double (*left)[EX_Z], double (*right)[EX_Z], double (*restrict product)[EX_Z])
{
    for (int j = 0; j < EX_Z; j++)
#pragma GCC unroll 1
        for (int i = 0; i < EX_Z; i++) {
            double sum = 0.0;
#pragma GCC unroll 32
            for (int l = 0; l < EX_Z; l++)
                sum += left[l][i] * right[j][l];
            product[j][i] = sum;
        }
}

/* total += c[0] I + c[1] B + c[2] B^2 + c[3] B^3 */
static void add_terms(const double *c, double (*one)[EX_Z], double (*two)[EX_Z],
                      double (*three)[EX_Z], double (*total)[EX_Z])
{
    for (int j = 0; j < EX_Z; j++) {
        for (int i = 0; i < EX_Z; i++)
            total[j][i] += c[1] * one[j][i] + c[2] * two[j][i] + c[3] * three[j][i];
        total[j][j] += c[0];
    }
}

/* The series of (exp(B) - 1)/B to B^16 (Paterson and Stockmeyer), with B in work[0]. */
static void exponential_series(ex_context *c, double (*total)[EX_Z])
{
    double(*one)[EX_Z] = c->work[0], (*two)[EX_Z] = c->work[1], (*three)[EX_Z] = c->work[2];
    double(*four)[EX_Z] = c->work[3], inverse[17], factorial = 1.0;
    for (int k = 0; k < 17; k++) {
        factorial *= k + 1;
        inverse[k] = 1.0 / factorial;
    }
    ex_multiply(one, one, two);
    ex_multiply(two, one, three);
    ex_multiply(two, two, four);
    for (int j = 0; j < EX_Z; j++)
        for (int i = 0; i < EX_Z; i++)
            total[j][i] = inverse[16] * four[j][i];
    add_terms(inverse + 12, one, two, three, total);
    for (int first = 8; first >= 0; first -= 4) {
        ex_multiply(four, total, c->work[4]);
        add_terms(inverse + first, one, two, three, c->work[4]);
        memcpy(total, c->work[4], sizeof c->work[4]);
    }
}

void ex_exponential(ex_context *c, double (*M)[EX_Z], double norm, double h, double (*E)[EX_Z],
                    double (*gather)[EX_Z])
{
    double part = h;
    int doublings = 0;
    for (; norm * part > BG_RADIUS && doublings < 60; part /= 2)
        doublings++;
    for (int j = 0; j < EX_Z; j++)
        for (int i = 0; i < EX_Z; i++)
            c->work[0][j][i] = part * M[j][i];
    exponential_series(c, gather);
    ex_multiply(c->work[0], gather, E);
    for (int j = 0; j < EX_Z; j++) {
        E[j][j] += 1.0;
        for (int i = 0; i < EX_Z; i++)
            gather[j][i] *= part;
    }
    for (; doublings > 0; doublings--) {
        ex_multiply(E, gather, c->work[4]);
        for (int j = 0; j < EX_Z; j++)
            for (int i = 0; i < EX_Z; i++)
                gather[j][i] += c->work[4][j][i];
        ex_multiply(E, E, c->work[4]);
        memcpy(E, c->work[4], sizeof c->work[4]);
    }
}
