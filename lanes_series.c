/* External inputs as power series, which all lanes work out in one way whatever they are. */
#include <string.h>

#include "lanes.h"
#include "model_terms.h"

/* A polynomial about another place, by Horner's rule in tau + x. */
static void shift_term(const bg_term *term, const double (*coefficients)[2], double tau,
                       double (*shifted)[2])
{
    for (int k = term->count - 1; k >= 0; k--) {
        const double *const c = coefficients[term->first + k];
        for (int j = term->count - 1 - k; j >= 0; j--) {
            const double *const before = j > 0 ? shifted[j - 1] : c;
            for (int part = 0; part < 2; part++)
                shifted[j][part] = shifted[j][part] * tau + before[part];
        }
    }
}

/* Adds a term's series about t: its polynomial there times the exponential's series. */
static void add_series(const bg_term *term, const double (*coefficients)[2], double t,
                       double *series)
{
    const double tau = t - term->start, size = exp(term->rate[0] * tau);
    double shifted[LANE_SERIES][2] = {{0}};
    double power[2] = {size * cos(term->rate[1] * tau), size * sin(term->rate[1] * tau)};
    shift_term(term, coefficients, tau, shifted);
    for (int k = 0; k < LANE_SERIES && (power[0] != 0.0 || power[1] != 0.0); k++) {
        for (int j = 0; j < term->count && k + j < LANE_SERIES; j++)
            series[k + j] += power[0] * shifted[j][0] - power[1] * shifted[j][1];
        const double real = power[0] / (k + 1.0), imaginary = power[1] / (k + 1.0);
        power[0] = real * term->rate[0] - imaginary * term->rate[1];
        power[1] = real * term->rate[1] + imaginary * term->rate[0];
    }
}

/* Where rate times reach is a half, an exponential's terms from the 14th on are rounding. */
enum { EXPONENTIAL = 13 };

int bg_lanes_series(const bg_signals *signals, const bg_span *span, double t,
                      double (*series)[LANE_SERIES])
{
    int most = 1;
    for (int i = 0; i < BG_EXTERNAL; i++)
        for (int k = 0; k < LANE_SERIES; k++)
            series[i][k] = 0.0;
    bg_term_walk walk = bg_walk_terms(signals, span);
    for (const bg_term *term = bg_next_term(&walk); term; term = bg_next_term(&walk)) {
        const int grows = term->rate[0] != 0.0 || term->rate[1] != 0.0;
        const int count = term->count + (grows ? EXPONENTIAL : 0);
        if (count > LANE_SERIES)
            return 0;
        most = count > most ? count : most;
        add_series(term, signals->coefficients, t, series[term->input]);
    }
    return most;
}

int bg_lanes_follow(bg_lanes_group *group, int lane, double end)
{
    bg_lane_run *const one = group->run[lane];
    bg_located *const c = one->room->run;
    const double t = c->solver.t, origin = group->origin[lane];
    double series[BG_ROOM(BG_EXTERNAL)][LANE_SERIES];
    if (fmax(fabs(t - origin), fabs(end - origin)) <= one->reach)
        return 1;
    const double fastest = bg_signals_fastest(c->signals, &c->run.span);
    one->reach = fastest > 0.0 ? LANE_REACH / fastest : INFINITY;
    group->origin[lane] = fastest > 0.0 ? t + one->reach : t;
    const int terms = bg_lanes_series(c->signals, &c->run.span, group->origin[lane], series);
    group->terms = terms > group->terms ? terms : group->terms;
    for (int i = 0; i < BG_EXTERNAL; i++)
        for (int k = 0; k < LANE_SERIES; k++)
            group->series[i][k][lane] = series[i][k];
    return terms > 0;
}

void bg_lanes_inputs(bg_lanes_group *group)
{
    bg_lane x;
    for (int l = 0; l < BG_LANES; l++)
        x[l] = group->at.t[l] - group->origin[l];
    for (int i = 0; i < BG_EXTERNAL; i++) {
        bg_lane p = {0}, d = {0};
        for (int k = group->terms - 1; k >= 0; k--)
            for (int l = 0; l < BG_LANES; l++) {
                d[l] = BG_LANE_RATED ? d[l] * x[l] + p[l] : 0.0;
                p[l] = p[l] * x[l] + group->series[i][k][l];
            }
        memcpy(group->at.w[i], p, sizeof p);
        memcpy(group->at.dw[i], d, sizeof d);
    }
}
