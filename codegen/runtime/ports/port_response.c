/* What a unit of what each port gives over a time does to states, to readings at once, and so to
 * slips. Laws that friction moves answer, by their slopes. */
#include <math.h>
#include <string.h>

#include "model_internal.h"

enum { MOVED_LAWS = BG_COUPLED, LAW_ROOM = BG_ROOM(BG_COUPLED) };

/* How coupled laws change per unit of one input. */
static void slope_along(bg_model *m, const double *before, int column, double *slopes)
{
    bg_values *const now = &m->now;
    const double step = BG_LOOP_DIFFERENCE * (bg_largest(M, now->u) + BG_LOOP_FLOOR);
    double u = now->u[column], y[BG_ROOM(ROWS)];
    memcpy(y, now->y, sizeof y);
    now->u[column] += step;
    for (int i = 0; i < ROWS; i++)
        now->y[i] += step * m->numbers.D[i * M + column];
    bg_coupled.values(now, m->work.law);
    for (int l = 0; l < MOVED_LAWS; l++)
        slopes[l] = (m->work.law[l] - before[l]) / step;
    now->u[column] = u;
    memcpy(now->y, y, sizeof y);
}

/* What coupled laws give per unit of what each port gives, ports by columns; 0 where their slopes
 * have no common answer. */
static int answers(bg_model *m, double *given)
{
    double before[LAW_ROOM], along[LAW_ROOM], system[LAW_ROOM * LAW_ROOM];
    int pivots[LAW_ROOM];
    bg_coupled.values(&m->now, m->work.law);
    memcpy(before, m->work.law, sizeof(double) * MOVED_LAWS);
    for (int k = 0; k < K; k++) {
        slope_along(m, before, bg_friction_inputs[k], along);
        for (int l = 0; l < MOVED_LAWS; l++)
            given[l * K + k] = along[l];
    }
    for (int c = 0; c < MOVED_LAWS; c++) {
        slope_along(m, before, bg_coupled.inputs[c], along);
        for (int l = 0; l < MOVED_LAWS; l++)
            system[l * MOVED_LAWS + c] = (l == c ? 1.0 : 0.0) - along[l];
    }
    if (!bg_finite(MOVED_LAWS * MOVED_LAWS, system) || !bg_finite(MOVED_LAWS * K, given)
        || !bg_factor(MOVED_LAWS, system, pivots))
        return 0;
    bg_solve(MOVED_LAWS, system, pivots, K, given);
    return bg_finite(MOVED_LAWS * K, given);
}

/* columns += those of laws times what these give. */
static void add_answers(int rows, const double *matrix, const double *given, double *columns)
{
    for (int k = 0; k < K; k++)
        for (int l = 0; l < MOVED_LAWS; l++)
            for (int i = 0; i < rows; i++)
                columns[k * rows + i] += given[l * K + k] * matrix[i * M + bg_coupled.inputs[l]];
}

/* What states gain over a time, with the rates of the storages and resistances after a `lag`,
 * the whole time at the most: then it is a step of Euler's implicit method, and what is passive
 * yields so over any time; straight on without any. */
static void gain_over(bg_model *m, double time, double lag, double *gains)
{
    double *const system = m->work.implicit, *const right = m->work.gained;
    int *const pivots = m->work.implicit_pivots;
    for (int i = 0; i < N * N; i++)
        system[i] = (i % (N + 1) == 0 ? 1.0 : 0.0) - lag * m->numbers.P[i];
    for (int i = 0; i < N; i++)
        for (int k = 0; k < K; k++)
            right[i * K + k] = time * gains[k * N + i];
    if (lag > 0.0 && bg_finite(N * N, system) && bg_factor(N, system, pivots))
        bg_solve(N, system, pivots, K, right);
    for (int i = 0; i < N; i++)
        for (int k = 0; k < K; k++)
            gains[k * N + i] = right[i * K + k];
}

void bg_respond(bg_model *m, double time, double lag, bg_response *of)
{
    double given[LAW_ROOM * PORTS] = {0};
    for (int k = 0; k < K; k++) {
        for (int i = 0; i < N; i++)
            of->gains[k * N + i] = m->numbers.Q[i * M + bg_friction_inputs[k]];
        for (int i = 0; i < ROWS; i++)
            of->readings[k * ROWS + i] = m->numbers.D[i * M + bg_friction_inputs[k]];
    }
    if (MOVED_LAWS > 0 && answers(m, given)) {
        add_answers(N, m->numbers.Q, given, of->gains);
        add_answers(ROWS, m->numbers.D, given, of->readings);
    }
    gain_over(m, time, lag, of->gains);
    of->time = time;
}

int bg_yields(const bg_model *m, const bg_response *of, double *yields, int *reversed)
{
    double largest = 0.0;
    int passive = 1;
    for (int i = 0; i < K; i++) {
        const int row = bg_friction_readings[i];
        for (int k = 0; k < K; k++) {
            double sum = of->readings[k * ROWS + row];
            for (int l = 0; l < N; l++)
                sum += m->numbers.F[row * N + l] * of->gains[k * N + l];
            yields[i * K + k] = -sum;
        }
        largest = fmax(largest, fabs(yields[i * K + i]));
    }
    /* What several ports hold together they share; what nothing moves none can hold. */
    for (int i = 0; i < K; i++) {
        const double own = yields[i * K + i];
        const int rubs = bg_switches[i].kind == BG_RUBS;
        passive &= own >= -BG_SHARED * largest;
        reversed[i] = rubs && own < -BG_SHARED * largest;
        if (!reversed[i])
            yields[i * K + i] += BG_SHARED * (own > BG_SHARED * largest ? own
                                              : largest > 0 ? largest : 1.0);
    }
    return passive;
}

void bg_push(const bg_response *of, const double *given, double *s)
{
    for (int k = 0; k < K; k++) {
        for (int i = 0; i < N; i++)
            s[i] += given[k] * of->gains[k * N + i];
        for (int i = 0; i < OWN; i++)
            s[N + i] += given[k] * of->time * of->readings[k * ROWS + bg_law_rates[i]];
    }
}
