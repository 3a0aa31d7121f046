/* What keeps the switches of a mode, and what they do as they come to hold. */
#include "batch_internal.h"

#include <string.h>

/* Conditions of switches in a column of the map, less their constants but in the last. */
static void guards_in(const double *map, bg_model *m, int column, const double *constant,
                      double *guards)
{
    bg_values *const now = &m->now;
    for (int i = 0; i < N; i++)
        now->x[i] = map[i * BG_MAP_COLUMNS + column];
    for (int i = 0; i < OWN; i++)
        now->z[i] = map[(BG_AT_z + i) * BG_MAP_COLUMNS + column];
    for (int i = 0; i < M; i++)
        now->u[i] = map[(BG_AT_u + i) * BG_MAP_COLUMNS + column];
    for (int i = 0; i < ROWS; i++)
        now->y[i] = map[(BG_AT_y + i) * BG_MAP_COLUMNS + column];
    for (int i = 0; i < BG_EXTERNAL; i++)
        now->w[i] = column == BG_SIZE + i;
    now->t = 0.0;
    bg_guards(now, guards);
    for (int g = 0; g < BG_GUARDS && column < BG_MAP_COLUMNS - 1; g++)
        guards[g] -= constant[g];
}

static void forget_instant(bg_model *m)
{
    double p[BG_ROOM(BG_PARAMETERS)];
    memcpy(p, m->now.p, sizeof p);
    memset(&m->now, 0, sizeof m->now);
    memcpy(m->now.p, p, sizeof p);
}

/* What resets set s to; what inputs that drive dependent storages add to states stays. */
static void fill_resets(const double *map, int column, const double *guards, double *become)
{
    for (int r = 0; r < BG_RESETS; r++) {
        const int place = bg_resets[r].place;
        become[r] = guards[bg_resets[r].value];
        if (place < N)
            become[r] += (column == place) - map[place * BG_MAP_COLUMNS + column];
    }
}

void batch_fill_stops(ex_model *record, bg_model *m)
{
    double guards[BG_ROOM(BG_GUARDS)] = {0};
    if (!BG_STOPPING)
        return;
    forget_instant(m);
    bg_guards(&m->now, guards);
    record->stopping = 1;
    for (int k = 0; k < EX_K; k++)
        if (bg_switches[k].kind == BG_STOPS) {
            record->room[k] = guards[bg_switches[k].guard];
            record->back[k] = guards[bg_switches[k].guard + 1];
        }
}

void batch_fill_switches(ex_mode *made, const double *map, bg_model *m, const int *mode)
{
    double constant[BG_ROOM(BG_GUARDS)] = {0}, guards[BG_ROOM(BG_GUARDS)] = {0};
    double impulses[PORTS * PORTS], received[BG_ROOM(ROWS)];
    bg_hold *held = NULL;
    int forwards = 1;
    forget_instant(m);
    bg_guards(&m->now, constant);
    for (int j = 0; j < EX_L; j++) {
        const int column = batch_column_of(j);
        if (column < 0)
            continue;
        guards_in(map, m, column, constant, guards);
        fill_resets(map, column, guards, made->become[j]);
        for (int k = 0; k < EX_K; k++)
            if (bg_switches[k].kind != BG_RUBS)
                made->stay[j][k] = bg_stay(bg_switches + k, mode[k], made->shot[j][EX_AT_SLIP + k],
                                           made->shot[j][EX_AT_EFFORT + k], guards);
            else if (bg_hangs(bg_switches + k))
                made->stay[j][k] = guards[bg_switches[k].guard];
    }
    for (int k = 0; k < EX_K; k++)
        forwards &= bg_switches[k].kind != BG_RUBS || mode[k] == 1;
    forget_instant(m);
    if (!forwards || bg_impulses(m, mode, &held, impulses) != BG_OK || !held)
        return;
    for (int k = 0; k < held->kept; k++) {
        bg_pass_on(m, impulses + k * K, made->jump[k], received);
        bg_shocks(m, mode, impulses + k * K, received, made->shock[k]);
        memcpy(made->blow[k], impulses + k * K, sizeof(double) * K);
    }
}
