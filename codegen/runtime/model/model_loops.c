/* Laws that determine one another at one instant: a bounded search for their common solution. A law
 * that dissipates has it between what its port receives if nothing is given and receiving nothing:
 * that bounds a single law, and is where Newton's iteration starts for several. */
#include <math.h>
#include <string.h>

#include "model_internal.h"

enum { ITERATIONS = 60, LOOPS = BG_ROOM(BG_LOOP) };

/* One search: the instant as it was before, the part that ports receive of what comes to them from
 * outside the laws, and the status of what could not be evaluated at all. */
typedef struct {
    bg_model *m;
    const bg_loop *loop;
    double part;
    int status;
} search;

/* What is left of the laws if the inputs have these values. */
static void left_over(search *s, const double *values, double *left)
{
    bg_model *const m = s->m;
    int status;
    memcpy(m->now.u, m->work.u, sizeof m->now.u);
    memcpy(m->now.y, m->work.y, sizeof m->now.y);
    for (int i = 0; i < s->loop->count; i++)
        m->now.y[s->loop->rows[i]] = s->part * m->work.y[s->loop->rows[i]];
    bg_give(m, s->loop->count, s->loop->columns, values);
    status = bg_residual(m, s->loop, left);
    if (status != BG_OK)
        s->status = status;
    for (int i = 0; i < s->loop->count; i++)
        if (!isfinite(left[i]))
            left[i] = left[i] < 0 ? -BG_HUGE : BG_HUGE;
}

static int solves(search *s, const double *values)
{
    double left[LOOPS];
    left_over(s, values, left);
    return bg_largest(s->loop->count, left)
        <= BG_RESIDUAL * (BG_RESIDUAL_FLOOR + bg_largest(s->loop->count, values));
}

static double one(void *self, double value)
{
    double left[LOOPS];
    left_over(self, &value, left);
    return left[0];
}

/* From the narrowest step to the size of anything. */
enum { MOST_WIDER = 40 };

/* What is left where one value is more, by a step that the rounding of what is left does not
 * swallow; the step. */
static double move_on(search *s, double *values, const double *now, int j, double size,
                      double *moved)
{
    const double kept = values[j];
    double step = BG_LOOP_DIFFERENCE * (fabs(kept) + BG_LOOP_FLOOR);
    for (int widened = 0; widened < MOST_WIDER; widened++, step *= BG_LOOP_WIDER) {
        double most = 0.0;
        values[j] = kept + step;
        left_over(s, values, moved);
        values[j] = kept;
        for (int i = 0; i < s->loop->count; i++)
            most = fmax(most, fabs(moved[i] - now[i]));
        if (step >= size || most > BG_LOOP_LOST * size)
            break;
    }
    return step;
}

/* Slopes by differences; the change to make, or 0 if there is none. */
static int newton_change(search *s, double *values, const double *now, double *change)
{
    double moved[LOOPS];
    double *const slopes = s->m->work.slopes;
    const int n = s->loop->count;
    const double size = bg_largest(n, now);
    for (int j = 0; j < n; j++) {
        const double step = move_on(s, values, now, j, size, moved);
        for (int i = 0; i < n; i++)
            slopes[i * n + j] = (moved[i] - now[i]) / step;
        change[j] = -now[j];
    }
    if (!bg_finite(n * n, slopes) || !bg_factor(n, slopes, s->m->work.pivots))
        return 0;
    bg_solve(n, slopes, s->m->work.pivots, 1, change);
    return bg_finite(n, change);
}

/* Newton's iteration; a step that does not help is halved. */
static void newton(search *s, double *values)
{
    double now[LOOPS], change[LOOPS], tried[LOOPS], left[LOOPS];
    const int n = s->loop->count;
    left_over(s, values, now);
    for (int k = 0; k < ITERATIONS; k++) {
        const double size = bg_largest(n, now);
        int halvings = 0;
        if (size == 0 || !newton_change(s, values, now, change))
            return;
        for (; halvings < ITERATIONS; halvings++) {
            for (int i = 0; i < n; i++)
                tried[i] = values[i] + change[i];
            left_over(s, tried, left);
            if (bg_largest(n, left) < size)
                break;
            int moves = 0;
            for (int i = 0; i < n; i++) {
                change[i] /= 2;
                moves |= values[i] + change[i] != values[i];
            }
            /* Rounding is reached: other steps give what is known. */
            if (!moves)
                return;
        }
        if (halvings == ITERATIONS)
            return;
        memcpy(values, tried, sizeof tried);
        memcpy(now, left, sizeof left);
    }
}

/* From ports that receive nothing from outside to those that receive all, one part after another:
 * laws that rise have one solution for each part, which moves with it without a leap. Along the
 * line through the last two it is near enough to the next, where parts are small enough. */
static int by_parts(search *s, double *values)
{
    double tried[LOOPS] = {0}, way[LOOPS] = {0}, done = 0.0, more = 1.0;
    const int n = s->loop->count;
    memset(values, 0, sizeof tried);
    s->part = 0.0;
    for (int k = 0; k < BG_PORTIONS && more >= BG_LEAST_PORTION; k++) {
        const double on = s->part - done;
        for (int i = 0; i < n; i++)
            tried[i] = values[i] + on * way[i];
        newton(s, tried);
        if (!solves(s, tried)) {
            more /= 4;
        } else {
            for (int i = 0; i < n && on > 0; i++)
                way[i] = (tried[i] - values[i]) / on;
            memcpy(values, tried, sizeof tried);
            if (s->part == 1.0)
                return 1;
            more *= on > 0 ? 2 : 1;
            done = s->part;
        }
        s->part = fmin(done + more, 1.0);
    }
    s->part = 1.0;
    return 0;
}

/* The inputs for which the ports receive nothing; zero where there are none. */
static void nothing_received(const bg_model *m, const bg_loop *loop, double *values)
{
    double system[LOOPS * LOOPS];
    int pivots[LOOPS];
    const int n = loop->count;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++)
            system[i * n + j] = m->numbers.D[loop->rows[i] * BG_INPUTS + loop->columns[j]];
        values[i] = -m->now.y[loop->rows[i]];
    }
    if (bg_factor(n, system, pivots))
        bg_solve(n, system, pivots, 1, values);
    else
        memset(values, 0, sizeof(double) * LOOPS);
}

int bg_solve_loop(bg_model *m, const bg_loop *loop)
{
    search s = {m, loop, 1.0, BG_OK};
    double start[LOOPS] = {0}, values[LOOPS] = {0};
    nothing_received(m, loop, start);
    memcpy(m->work.u, m->now.u, sizeof m->work.u);
    memcpy(m->work.y, m->now.y, sizeof m->work.y);
    /* The root of a single law between nothing given and nothing received. */
    if (loop->count == 1 && start[0] != 0 && bg_root(one, &s, 0.0, start[0], values)
        && solves(&s, values))
        return s.status;
    memcpy(values, start, sizeof start);
    newton(&s, values);
    if (solves(&s, values))
        return s.status;
    memset(values, 0, sizeof values);
    newton(&s, values);
    /* A single law that rises is bracketed, or has no solution. */
    if (solves(&s, values) || (s.loop->count > 1 && by_parts(&s, values)))
        return s.status;
    return s.status != BG_OK ? s.status : BG_NO_SOLUTION;
}
