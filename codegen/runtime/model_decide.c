/* The mode just after an instant of an event-located run, and sticking ports brought to rest. */
#include <math.h>

#include "model_located_internal.h"
#include "model_ruling.h"

enum { K = BG_FRICTION };

/* Everything a little later in a mode, by one midpoint step from the instant in c->shot. */
static int later(bg_located *c, const signed char *mode)
{
    const int last = c->segment + 1 == c->signals->segments;
    const double following = last ? INFINITY : c->signals->breaks[c->segment];
    const double ahead = bg_look_ahead(c->moment, c->t, following);
    double s[BG_SIZE];
    for (int i = 0; i < BG_SIZE; i++)
        s[i] = c->s[i] + 0.5 * ahead * c->shot.rate[i];
    const int status = bg_located_look(c, c->t + 0.5 * ahead, s, mode);
    if (status != BG_OK)
        return status;
    for (int i = 0; i < BG_SIZE; i++)
        s[i] = c->s[i] + ahead * c->shot.rate[i];
    return bg_located_look(c, c->t + ahead, s, mode);
}

/* Statuses that say nothing about the mode: a refusal of the model. */
static int refuses(int status)
{
    return status == BG_NEEDS_SLOPE || status == BG_STRUCTURE;
}

static int look(void *self, const signed char *mode, int moved, bg_port *ports, bg_ruling *ruling)
{
    bg_located *const c = self;
    bg_rounding size = {{0}, {0}, {0}};
    int status = bg_located_look(c, c->t, c->s, mode);
    if (status == BG_OK && moved)
        status = later(c, mode);
    else if (status == BG_OK)
        bg_located_rounding(c, c->t, &size);
    if (status != BG_OK && c->failed != BG_OK)
        c->failed = status;
    if (status != BG_OK)
        return refuses(status) ? status : BG_NO_MODE;
    c->failed = BG_OK;
    for (int i = 0; i < K; i++)
        ports[i] = (bg_port){
            c->shot.y[bg_friction_readings[i]], c->shot.u[bg_friction_inputs[i]], c->shot.caps[i],
            bg_slip_rate(c->model, &c->shot, i), size.slip[i], size.effort[i], size.push[i],
        };
    bg_rule(c->model, mode, ruling);
    return BG_OK;
}

/* What is told where there is no mode: why none could be evaluated, if that is so. */
static int told(const bg_located *c, int status)
{
    if (status != BG_NO_MODE)
        return status;
    return c->failed != BG_OK ? c->failed : BG_UNDECIDED;
}

int bg_located_usable(bg_located *c, int slipping, signed char *mode)
{
    const bg_chooser chooser = {K, c->touched, bg_beside, c, look};
    bg_port ports[BG_ROOM(K)];
    c->failed = BG_NO_SOLUTION;
    return told(c, bg_evaluated(&chooser, slipping, mode, ports));
}

int bg_located_decide(bg_located *c)
{
    const bg_chooser chooser = {K, c->touched, bg_beside, c, look};
    int mode[BG_ROOM(K)] = {0}, sticking = 0;
    c->failed = BG_NO_SOLUTION;
    int status = bg_choose(&chooser, c->mode);
    if (status)
        return told(c, status);
    for (int i = 0; i < K; i++) {
        mode[i] = c->mode[i];
        sticking |= mode[i] == 0;
    }
    status = sticking ? bg_located_look(c, c->t, c->s, c->mode) : BG_OK;
    return status == BG_OK && sticking ? bg_remove_slips(c->model, mode, &c->shot, c->s) : status;
}
