/* What keeps the switches of a generated model, what counts as none of that, and their impulses. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "port_sight.h"

enum { GUARDS = BG_ROOM(BG_GUARDS) };

void bg_view_keep(const bg_view *v, const int *mode, bg_port *ports)
{
    double guards[GUARDS] = {0};
    bg_guards(&v->model->now, guards);
    for (int i = 0; i < K; i++)
        if (bg_switches[i].kind != BG_RUBS)
            ports[i].stay =
                bg_stay(bg_switches + i, mode[i], ports[i].slip, ports[i].effort, guards);
    for (int i = 0; i < K; i++)
        if (bg_switches[i].kind == BG_STOPS) {
            ports[i].gap = guards[bg_switches[i].guard];
            ports[i].back = guards[bg_switches[i].guard + 1];
        } else if (bg_hangs(bg_switches + i))
            ports[i].gap = guards[bg_switches[i].guard];
}

/* Of efforts that hold: the rounding of the equations that they follow from. */
static void round_held(const bg_view *v, const int *mode, const double *x, const double *u,
                       bg_port *ports)
{
    bg_hold *held = NULL;
    double terms[PORTS];
    int any = 0;
    for (int i = 0; i < K; i++)
        any |= mode[i] == 0;
    if (!any || bg_hold_of(v->model, mode, &held) != BG_OK)
        return;
    bg_effort_terms(held, x, u, v->shot.du, terms);
    for (int c = 0; c < held->count; c++) {
        bg_port *const port = ports + held->ports[c];
        port->near_effort = fmax(port->near_effort, BG_ROUNDING * terms[c]);
    }
}

/* Below these gaps count as closed, from what displacements have been, too. */
static void round_gaps(const bg_view *v, double spacing, bg_port *ports)
{
    for (int i = 0; i < K; i++) {
        const bg_switch *const s = bg_switches + i;
        if (s->kind != BG_STOPS)
            continue;
        const double place = v->shot.z[s->place - N], seen = v->model->seen[s->place];
        ports[i].near_gap =
            bg_gap_rounding(s, ports[i].gap, place, v->shot.rate[s->place], seen, spacing);
    }
}

void bg_view_stay(bg_view *v, const int *mode, double time, const double *x, const double *u,
                  bg_port *ports)
{
    double terms[GUARDS] = {0}, slopes[GUARDS] = {0};
    const double spacing = nextafter(fabs(v->t), INFINITY) - fabs(v->t);
    bg_view_keep(v, mode, ports);
    round_held(v, mode, x, u, ports);
    if (BG_GUARDS)
        bg_guard_terms(v->model, &v->shot, time, terms, slopes);
    for (int i = 0; i < K; i++) {
        const bg_switch *const s = bg_switches + i;
        const int at = bg_condition(s, mode[i]);
        if (s->kind == BG_TOLD)
            ports[i].near_stay =
                BG_ROUNDING * terms[at] + BG_LATE * spacing * slopes[at] + DBL_MIN;
        else
            ports[i].near_stay = mode[i] ? ports[i].near_slip : ports[i].near_effort;
        if (bg_hangs(s))
            bg_count_leaps(ports + i, terms[s->guard], v->inertia[i], spacing);
    }
    round_gaps(v, spacing, ports);
}

/* The slips that a mode would stop, or, unless `speeds` is NULL, what they are beyond these; and
 * whether that is more than rounding. All is let go. */
static int have_to_jump(const bg_hold *held, const bg_snapshot *shot, const bg_port *ports,
                        const double *speeds, double *slips)
{
    double near[PORTS];
    for (int c = 0; c < held->count; c++)
        near[c] = BG_WIDE * ports[held->ports[c]].near_slip;
    bg_held_slips(held, shot, slips);
    if (speeds)
        bg_less_speeds(held, speeds, slips);
    return bg_have_slips(held, slips, near);
}

int bg_view_strike(void *view, const bg_instant *at, const int *mode, const double *speeds,
                   double *s, bg_blow *blow)
{
    bg_view *const v = view;
    double impulses[PORTS * PORTS], slips[PORTS], ways[PORTS] = {0};
    bg_port ports[PORTS];
    bg_hold *held = NULL;
    int loose[BG_MOST_PORTS];
    bg_instant now = *at;
    const bg_sight sight = bg_view_sight(v);
    blow->struck = 0;
    memset(blow->given, 0, sizeof blow->given);
    /* Where rows turn as states jump, each strike leaves what is bent of its way. */
    for (int strikes = BG_VARYING ? BG_IMPACTS : 1; strikes > 0; strikes--) {
        for (int i = 0; i < K; i++)
            loose[i] = 1;
        int status = bg_evaluated(&sight, &now, 1, loose);
        if (status == BG_OK) {
            bg_view_ports(v, loose, at->time, ports);
            status = bg_impulses(v->model, mode, &held, impulses);
        }
        if (status)
            return status;
        if (!held || held->kept == 0)
            break;
        const int asked = speeds && !blow->struck;
        if (!have_to_jump(held, &v->shot, ports, speeds, slips) && !asked)
            break;
        blow->struck = 1;
        status = bg_stop(v->model, &v->shot, mode, held, impulses, speeds, s, blow->given, ways);
        if (status)
            return status;
        now.s = s;
    }
    if (speeds && blow->struck)
        bg_round_struck(v->model, &v->shot, blow->given, BG_ROUNDING, blow->near);
    for (int i = 0; i < K; i++)
        blow->shocks[i] = ways[i] == 0.0 ? 0 : ways[i] > 0.0 ? 1 : -1;
    return BG_OK;
}
