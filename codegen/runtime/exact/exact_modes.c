/* Everything at one instant in a friction mode, and what counts as zero there. */
#include "exact_internal.h"

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

static ex_key key_of(const int *mode)
{
    ex_key key = {{0}};
    for (int i = 0; i < EX_K; i++) {
        const unsigned long long digit = mode[i] == 0 ? 0 : mode[i] > 0 ? 1 : 2;
        key.digits[i / EX_DIGITS] |= digit << i % EX_DIGITS * 2;
    }
    return key;
}

int ex_is_same(const ex_key *one, const ex_key *other)
{
    unsigned long long differ = 0;
    for (int k = 0; k < EX_WORDS; k++)
        differ |= one->digits[k] ^ other->digits[k];
    return differ == 0;
}

/* The place of a mode among those that are known; -1: it is none of them. */
static int known_place(const ex_context *c, const ex_key *key)
{
    const ex_model *const m = c->model;
    for (int k = 0; k < m->count; k++)
        if (ex_is_same(m->keys + k, key))
            return k;
    return -1;
}

int ex_seek(ex_context *c, const int *mode, const ex_mode **found)
{
    const ex_model *const m = c->model;
    const ex_key key = key_of(mode);
    int at = known_place(c, &key);
    c->where = key;
    c->place = -1;
    *found = NULL;
    if ((at < 0 || !m->modes[at]) && m->supply && m->supply(m->self, mode) == BG_OK)
        at = known_place(c, &key);
    if (at < 0 || !m->modes[at])
        return BG_MISSING;
    if (m->used) {
        c->met += m->used[at] <= c->began;
        m->used[at] = ++c->looks;
        if (m->most && c->met > m->most)
            return BG_CROWDED;
    }
    c->place = at;
    for (int i = 0; i < EX_K; i++)
        c->signs[i] = mode[i];
    *found = m->modes[at];
    return (*found)->supported ? BG_OK : BG_NOT_AFFINE;
}

/* Whether a port sticks in a mode though only inputs rule its slip. */
int ex_rests(const ex_mode *mode, int port)
{
    int any = 0;
    for (int k = 0; k < mode->ruled; k++)
        any |= mode->ruling[k][port] != 0.0;
    return any;
}

void ex_evaluate(ex_context *c, double t)
{
    ex_slots(c->inputs, c->run.span.segment, t, c->slots);
    ex_given(c->inputs, c->run.span.segment, c->slots, c->given, c->given + EX_W);
    c->known = 1;
    c->known_time = t;
    c->known_segment = c->run.span.segment;
}

/* What affine maps act on. */
void ex_vector(ex_context *c, double t, const double *s, double *v)
{
    ex_know(c, t);
    for (int j = 0; j < EX_N; j++)
        v[j] = s[j];
    for (int j = 0; j < 2 * EX_W; j++)
        v[EX_N + j] = c->given[j];
    v[EX_L - 1] = 1.0;
}

/* Whether a level that is not positive is rounding of its terms, and so zero. */
static int is_rounding(const ex_context *c, double t, const double *v, const ex_mode *mode,
                       int port, double level)
{
    double w[EX_W], sum = 0.0;
    ex_input_sizes(c->inputs, c->run.span.segment, t, w);
    for (int j = 0; j < EX_L; j++) {
        const int given = j >= EX_N && j < EX_N + EX_W;
        double size = given ? w[j - EX_N] : fabs(v[j]);
        if (j < EX_N && j < EX_X) /* a state that comes down to zero rounds by what it was */
            size = bg_greater(size, c->peaks.x[j]);
        sum += fabs(mode->shot[j][EX_AT_CAP + port]) * size;
    }
    return level >= -BG_ROUNDING * sum;
}

int ex_look(ex_context *c, double t, const double *s, const ex_mode *mode, double *shot)
{
    double *const v = c->seen;
    c->shown = NULL;
    c->rounded = 0;
    ex_vector(c, t, s, v);
#pragma GCC unroll 1
    for (int i = 0; i < EX_SHOT; i++) {
        double sum = 0.0;
#pragma GCC unroll 32
        for (int j = 0; j < EX_L; j++)
            sum += mode->shot[j][i] * v[j];
        shot[i] = sum;
    }
    for (int i = 0; i < EX_K; i++)
        if (!(shot[EX_AT_CAP + i] >= 0.0)) {
            if (is_rounding(c, t, v, mode, i, shot[EX_AT_CAP + i])) {
                shot[EX_AT_CAP + i] = 0.0;
                continue;
            }
            c->task->time = t;
            return shot[EX_AT_CAP + i] < 0.0 ? BG_NEGATIVE : BG_NOT_FINITE;
        }
    return BG_OK;
}

/* Whether that is the look that has been made last. */
static int is_shown(const ex_context *c, double t, const double *s, const ex_mode *mode)
{
    int differ = c->shown != mode || c->shown_time != t
        || c->shown_segment != c->run.span.segment || !ex_is_same(&c->shown_key, &c->where);
    for (int i = 0; i < EX_N; i++)
        differ |= s[i] != c->seen[i];
    return !differ;
}

int ex_show(ex_context *c, double t, const double *s, const ex_mode *mode)
{
    if (is_shown(c, t, s, mode))
        return BG_OK;
    const int status = ex_look(c, t, s, mode, c->shot);
    c->shown = status == BG_OK ? mode : NULL;
    c->shown_key = c->where;
    c->shown_time = t;
    c->shown_segment = c->run.span.segment;
    return status;
}

/* The ports of an instant, without what counts as zero. */
void ex_ports(const double *shot, bg_port *ports)
{
    for (int i = 0; i < EX_K; i++)
        ports[i] = (bg_port){
            .slip = shot[EX_AT_SLIP + i], .effort = shot[EX_AT_EFFORT + i],
            .cap = shot[EX_AT_CAP + i], .push = shot[EX_AT_PUSH + i],
        };
}

/* The ports of the instant t, with that. */
void ex_round(const ex_context *c, const double *shot, double t, bg_port *ports)
{
    const ex_model *const m = c->model;
    const bg_magnitudes sizes = {(double *)m->F, (double *)m->D, (double *)m->FP, (double *)m->FQ,
                                 (double *)m->P, (double *)m->Q, (double *)m->inertia};
    double x[EX_X], u[EX_U], rate[EX_X];
    for (int i = 0; i < EX_X; i++)
        x[i] = bg_greater(fabs(shot[EX_AT_X + i]), c->peaks.x[i]);
    for (int i = 0; i < EX_U; i++)
        u[i] = bg_greater(fabs(shot[EX_AT_U + i]), c->peaks.u[i]);
    ex_ports(shot, ports);
    bg_round_ports(EX_X, EX_U, EX_K, &sizes, t, c->run.at.time, x, u, rate, ports);
}

void ex_round_shown(ex_context *c, double t, bg_port *ports)
{
    if (!c->rounded || c->rounded_time != c->run.at.time || c->shown_time != t) {
        ex_round(c, c->shot, t, c->ports);
        c->rounded = c->shown && c->shown_time == t;
        c->rounded_time = c->run.at.time;
    }
    memcpy(ports, c->ports, EX_K * sizeof *ports);
}
