/* The mode just after an instant of an event-located run, and sticking ports brought to rest. */
#include <math.h>

#include "bg_choose.h"
#include "model_located_internal.h"

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

static int look(void *self, const signed char *mode, int moved, bg_port *ports)
{
    bg_located *const c = self;
    bg_rounding size = {{0}, {0}, {0}};
    int status = bg_located_look(c, c->t, c->s, mode);
    if (status == BG_OK && moved)
        status = later(c, mode);
    else if (status == BG_OK)
        bg_located_rounding(c, c->t, &size);
    for (int i = 0; i < K && status == BG_OK; i++)
        ports[i] = (bg_port){
            c->shot.y[bg_friction_readings[i]], c->shot.u[bg_friction_inputs[i]], c->shot.caps[i],
            bg_slip_rate(c->model, &c->shot, i), size.slip[i], size.effort[i], size.push[i],
        };
    return status;
}

int bg_located_decide(bg_located *c)
{
    const bg_chooser chooser = {K, c->touched, bg_beside, c, look};
    int mode[BG_ROOM(K)] = {0}, sticking = 0;
    int status = bg_choose(&chooser, c->mode);
    if (status)
        return status == BG_NO_MODE ? BG_UNDECIDED : status;
    for (int i = 0; i < K; i++) {
        mode[i] = c->mode[i];
        sticking |= mode[i] == 0;
    }
    status = sticking ? bg_located_look(c, c->t, c->s, c->mode) : BG_OK;
    return status == BG_OK && sticking ? bg_remove_slips(c->model, mode, &c->shot, c->s) : status;
}
