/* Exponentials of small matrices, and their integrals over the step. */
#include "bg_internal.h"

#include <string.h>

#define BG_RADIUS 0.75 /* of the Taylor polynomial of degree 16: 0.75^17/17! = 2e-17 */

/* Sums stay in registers: gcc vectorises the loop over rows, and unrolls the one inside. */
void bg_multiply(double (*left)[BG_Z], double (*right)[BG_Z], double (*restrict product)[BG_Z])
{
    for (int j = 0; j < BG_Z; j++)
#pragma GCC unroll 1
        for (int i = 0; i < BG_Z; i++) {
            double sum = 0.0;
#pragma GCC unroll 32
            for (int l = 0; l < BG_Z; l++)
                sum += left[l][i] * right[j][l];
            product[j][i] = sum;
        }
}

/* total += c[0] I + c[1] B + c[2] B^2 + c[3] B^3 */
static void add_terms(const double *c, double (*one)[BG_Z], double (*two)[BG_Z],
                      double (*three)[BG_Z], double (*total)[BG_Z])
{
    for (int j = 0; j < BG_Z; j++) {
        for (int i = 0; i < BG_Z; i++)
            total[j][i] += c[1] * one[j][i] + c[2] * two[j][i] + c[3] * three[j][i];
        total[j][j] += c[0];
    }
}

/* The series of (exp(B) - 1)/B to B^16 (Paterson and Stockmeyer), with B in work[0]. */
static void series(bg_context *c, double (*total)[BG_Z])
{
    double(*one)[BG_Z] = c->work[0], (*two)[BG_Z] = c->work[1], (*three)[BG_Z] = c->work[2];
    double(*four)[BG_Z] = c->work[3], inverse[17], factorial = 1.0;
    for (int k = 0; k < 17; k++) {
        factorial *= k + 1;
        inverse[k] = 1.0 / factorial;
    }
    bg_multiply(one, one, two);
    bg_multiply(two, one, three);
    bg_multiply(two, two, four);
    for (int j = 0; j < BG_Z; j++)
        for (int i = 0; i < BG_Z; i++)
            total[j][i] = inverse[16] * four[j][i];
    add_terms(inverse + 12, one, two, three, total);
    for (int first = 8; first >= 0; first -= 4) {
        bg_multiply(four, total, c->work[4]);
        add_terms(inverse + first, one, two, three, c->work[4]);
        memcpy(total, c->work[4], sizeof c->work[4]);
    }
}

void bg_exponential(bg_context *c, double (*M)[BG_Z], double norm, double h, double (*E)[BG_Z],
                    double (*gather)[BG_Z])
{
    double part = h;
    int doublings = 0;
    for (; norm * part > BG_RADIUS && doublings < 60; part /= 2)
        doublings++;
    for (int j = 0; j < BG_Z; j++)
        for (int i = 0; i < BG_Z; i++)
            c->work[0][j][i] = part * M[j][i];
    series(c, gather);
    bg_multiply(c->work[0], gather, E);
    for (int j = 0; j < BG_Z; j++) {
        E[j][j] += 1.0;
        for (int i = 0; i < BG_Z; i++)
            gather[j][i] *= part;
    }
    for (; doublings > 0; doublings--) {
        bg_multiply(E, gather, c->work[4]);
        for (int j = 0; j < BG_Z; j++)
            for (int i = 0; i < BG_Z; i++)
                gather[j][i] += c->work[4][j][i];
        bg_multiply(E, E, c->work[4]);
        memcpy(E, c->work[4], sizeof c->work[4]);
    }
}
