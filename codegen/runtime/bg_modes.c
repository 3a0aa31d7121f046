/* Everything at one instant in a friction mode, and what counts as zero there. */
#include "bg_internal.h"

#include <float.h>
#include <math.h>

int bg_number(const signed char *mode)
{
    int number = 0;
    for (int i = BG_K - 1; i >= 0; i--)
        number = 3 * number + (mode[i] == 0 ? 0 : mode[i] > 0 ? 1 : 2);
    return number;
}

int bg_find(bg_context *c, int number, const bg_mode **found)
{
    c->where = number;
    *found = c->model->modes[number];
    if (*found == 0)
        return BG_MISSING;
    return (*found)->supported ? BG_OK : BG_UNSUPPORTED;
}

/* Whether a port sticks in a mode though only inputs rule its slip. */
int bg_rests(const bg_mode *mode, int port)
{
    int any = 0;
    for (int k = 0; k < mode->ruled; k++)
        any |= mode->ruling[k][port] != 0.0;
    return any;
}

/* What affine maps act on; inputs are evaluated once for an instant. */
void bg_vector(bg_context *c, double t, const double *s, double *v)
{
    if (!c->known || c->known_time != t || c->known_segment != c->segment) {
        double g[BG_G];
        bg_slots(c->inputs, c->segment, t, g);
        bg_given(c->inputs, c->segment, g, c->given, c->given + BG_W);
        c->known = 1;
        c->known_time = t;
        c->known_segment = c->segment;
    }
    for (int j = 0; j < BG_N; j++)
        v[j] = s[j];
    for (int j = 0; j < 2 * BG_W; j++)
        v[BG_N + j] = c->given[j];
    v[BG_L - 1] = 1.0;
}

/* Whether a level that is not positive is rounding of its terms, and so zero. */
static int is_rounding(const bg_context *c, double t, const double *v, const bg_mode *mode,
                       int port, double level)
{
    double w[BG_W], sum = 0.0;
    bg_input_sizes(c->inputs, c->segment, t, w);
    for (int j = 0; j < BG_L; j++) {
        const int given = j >= BG_N && j < BG_N + BG_W;
        double size = given ? w[j - BG_N] : fabs(v[j]);
        if (j < BG_N && j < BG_X) /* a state that comes down to zero rounds by what it was */
            size = bg_greater(size, c->peaks.x[j]);
        sum += fabs(mode->shot[j][BG_AT_CAP + port]) * size;
    }
    return level >= -BG_ROUNDING * sum;
}

int bg_look(bg_context *c, double t, const double *s, const bg_mode *mode, double *shot)
{
    double v[BG_L];
    bg_vector(c, t, s, v);
#pragma GCC unroll 1
    for (int i = 0; i < BG_SHOT; i++) {
        double sum = 0.0;
#pragma GCC unroll 32
        for (int j = 0; j < BG_L; j++)
            sum += mode->shot[j][i] * v[j];
        shot[i] = sum;
    }
    for (int i = 0; i < BG_K; i++)
        if (!(shot[BG_AT_CAP + i] >= 0.0)) {
            if (is_rounding(c, t, v, mode, i, shot[BG_AT_CAP + i])) {
                shot[BG_AT_CAP + i] = 0.0;
                continue;
            }
            c->task->time = t;
            return shot[BG_AT_CAP + i] < 0.0 ? BG_NEGATIVE : BG_UNUSABLE;
        }
    return BG_OK;
}

/* Takes an instant into the peaks: states, and the terms that make up inputs. */
void bg_see(bg_context *c, const bg_mode *mode, const double *shot)
{
    double v[BG_L], terms[BG_U];
    bg_vector(c, c->t, c->s, v);
    for (int i = 0; i < BG_U; i++)
        terms[i] = 0.0;
    for (int j = 0; j < BG_L; j++) {
        const double size = j >= BG_N + BG_W && j < BG_L - 1 ? 0.0 : fabs(v[j]);
        for (int i = 0; i < BG_U; i++)
            terms[i] += fabs(mode->shot[j][BG_AT_U + i]) * size;
    }
    for (int i = 0; i < BG_X; i++)
        c->peaks.x[i] = bg_greater(c->peaks.x[i], fabs(shot[BG_AT_X + i]));
    for (int i = 0; i < BG_U; i++)
        c->peaks.u[i] = bg_greater(c->peaks.u[i], terms[i]);
}

/* The rounding to be expected, from the magnitude of the terms that cancel, and of the time's. */
void bg_scale(const bg_context *c, const double *shot, double t, bg_scales *size)
{
    const double time = c->peaks.time;
    const double spacing = nextafter(fabs(t), INFINITY) - fabs(t);
    double x[BG_X], u[BG_U], rate[BG_X], slip[BG_PORTS] = {0}, moved[BG_PORTS] = {0};
    for (int i = 0; i < BG_X; i++) {
        x[i] = bg_greater(fabs(shot[BG_AT_X + i]), c->peaks.x[i]);
        rate[i] = 0.0;
    }
    for (int i = 0; i < BG_U; i++)
        u[i] = bg_greater(fabs(shot[BG_AT_U + i]), c->peaks.u[i]);
    for (int j = 0; j < BG_X; j++) {
        for (int i = 0; i < BG_K; i++)
            slip[i] += c->model->F[j][i] * x[j];
        for (int i = 0; i < BG_X; i++)
            rate[i] += c->model->P[j][i] * x[j];
    }
    for (int j = 0; j < BG_U; j++) {
        for (int i = 0; i < BG_K; i++) {
            slip[i] += c->model->D[j][i] * u[j];
            moved[i] += c->model->FQ[j][i] * u[j];
        }
        for (int i = 0; i < BG_X; i++)
            rate[i] += c->model->Q[j][i] * u[j];
    }
    /* At rest states are rounding themselves: of what moves them within a time constant. */
    for (int j = 0; j < BG_X; j++)
        for (int i = 0; i < BG_K; i++)
            moved[i] += c->model->FP[j][i] * bg_greater(x[j], time * rate[j]);
    for (int i = 0; i < BG_K; i++) {
        const double inertia = c->model->inertia[i];
        const double driven = inertia > 0.0 ? moved[i] / inertia : 0.0;
        const double effort = fabs(shot[BG_AT_EFFORT + i]) + shot[BG_AT_CAP + i];
        const double late = 16.0 * spacing * fabs(shot[BG_AT_PUSH + i]);
        size->slip[i] = BG_ROUNDING * (slip[i] + moved[i] * time) + late + DBL_MIN;
        size->effort[i] = BG_ROUNDING * (effort + driven) + DBL_MIN;
        size->acceleration[i] = BG_ROUNDING * 10.0 * moved[i] + DBL_MIN;
    }
}
