/* Impulses with which switches come to hold, at a first look. */
#include "exact_glance.h"

#include <math.h>
#include <string.h>

/* A slip that a mode stops, as a row. */
static void slip_row(const ex_mode *mode, int k, double *row)
{
    for (int j = 0; j < EX_L; j++)
        row[j] = mode->left[j][k];
}

/* The same as what ports receive in the mode. */
static void torn_row(const ex_mode *mode, int k, double *row)
{
    memset(row, 0, EX_L * sizeof *row);
    for (int j = 0; j < EX_L; j++)
        for (int i = 0; i < EX_K; i++)
            row[j] += mode->mix[k][i] * mode->shot[j][EX_AT_SLIP + i];
}

/* Whether none of the slips is more than rounding; 0 where it is not sure. */
static int all_rest(ex_glance *g, const ex_mode *mode)
{
    double row[EX_L];
    int sure = 1;
    for (int k = 0; k < mode->held && sure; k++) {
        double least = 0.0;
        for (int i = 0; i < EX_K; i++)
            least += BG_WIDE * fabs(mode->mix[k][i]) * g->low[i];
        slip_row(mode, k, row);
        sure = ex_ask(g, row, 1.0, -least) && ex_ask(g, row, -1.0, -least);
        torn_row(mode, k, row);
        sure = sure && ex_ask(g, row, 1.0, -least) && ex_ask(g, row, -1.0, -least);
    }
    return sure;
}

/* Whether one of the slips is more than rounding, for sure. */
static int one_jumps(ex_glance *g, const ex_mode *mode)
{
    double row[EX_L], farthest = 1.0;
    int which = -1;
    for (int k = 0; k < mode->held; k++) {
        double near = 0.0;
        for (int i = 0; i < EX_K; i++)
            near += BG_WIDE * fabs(mode->mix[k][i]) * g->near[i];
        slip_row(mode, k, row);
        const double far = fabs(ex_row(row, g->v)) / near;
        if (far > farthest) {
            farthest = far;
            which = k;
        }
    }
    if (which < 0)
        return 0;
    slip_row(mode, which, row);
    const double slip = ex_row(row, g->v);
    return ex_ask(g, row, slip > 0.0 ? 1.0 : -1.0, fabs(slip) / farthest);
}

/* The signs of the shocks; 0 where one is not sure. */
static int shock_signs(ex_glance *g, const ex_mode *mode, const double *slips, int *shocks)
{
    double row[EX_L];
    int sure = 1;
    for (int i = 0; i < EX_K && sure; i++) {
        double terms = 0.0;
        memset(row, 0, sizeof row);
        for (int k = 0; k < mode->held; k++) {
            terms += fabs(mode->shock[k][i]) * slips[k];
            for (int j = 0; j < EX_L; j++)
                row[j] += mode->shock[k][i] * mode->left[j][k];
        }
        const double way = ex_row(row, g->v);
        shocks[i] = terms == 0.0 ? 0 : way > 0.0 ? 1 : -1;
        sure = shocks[i] == 0 || ex_ask(g, row, shocks[i], BG_ROUNDING * terms);
    }
    return sure;
}

int ex_glance_strike(ex_glance *g, const ex_mode *mode, double (*stay)[EX_PORTS], double *most,
                     int *shocks, int *struck)
{
    double slips[EX_PORTS];
    *struck = 0;
    if (mode->held == 0 || all_rest(g, mode))
        return 1;
    if (!one_jumps(g, mode))
        return 0;
    *struck = 1;
    for (int k = 0; k < mode->held; k++) {
        slips[k] = 0.0;
        for (int j = 0; j < EX_L; j++)
            slips[k] += fabs(mode->left[j][k]) * g->to->most[j];
        for (int i = 0; i < EX_N; i++)
            most[i] += fabs(mode->jump[k][i]) * slips[k];
        for (int i = 0; i < EX_K; i++) {
            double moved = 0.0;
            for (int j = 0; j < EX_N; j++)
                moved += mode->stay[j][i] * mode->jump[k][j];
            for (int j = 0; j < EX_L; j++)
                stay[j][i] += moved * mode->left[j][k];
        }
    }
    return shock_signs(g, mode, slips, shocks);
}
