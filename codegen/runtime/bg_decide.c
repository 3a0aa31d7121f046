/* The mode just after an instant, from the affine maps of the modes. */
#include "bg_internal.h"

#include <math.h>
#include <string.h>

/* Everything a little later in a mode, by one midpoint step. */
static int later(bg_context *c, const bg_mode *mode, const double *now, double *shot)
{
    const int last = c->segment + 1 == c->inputs->segments;
    const double following = last ? INFINITY : c->inputs->breaks[c->segment];
    const double ahead = bg_look_ahead(c->peaks.time, c->t, following);
    double s[BG_N];
    bg_shot half;
    for (int i = 0; i < BG_N; i++)
        s[i] = c->s[i] + 0.5 * ahead * now[BG_AT_RATE + i];
    const int status = bg_look(c, c->t + 0.5 * ahead, s, mode, half);
    if (status)
        return status;
    for (int i = 0; i < BG_N; i++)
        s[i] = c->s[i] + ahead * half[BG_AT_RATE + i];
    return bg_look(c, c->t + ahead, s, mode, shot);
}

/* The ports in a mode, at the instant or a moment later. */
static int look(void *self, const signed char *mode, int moved, bg_port *ports, bg_ruling *ruling)
{
    bg_context *const c = self;
    const bg_mode *found;
    bg_shot shot;
    bg_scales size = {0};
    int status = bg_find(c, bg_number(mode), &found);
    if (status == BG_UNSUPPORTED && found->none)
        return BG_NO_MODE;
    if (status == BG_UNSUPPORTED && found->ruled) {
        ruling->unknown = status;
        status = BG_OK;
    }
    if (status == BG_OK)
        status = bg_look(c, c->t, c->s, found, shot);
    if (status == BG_OK && moved)
        status = later(c, found, shot, shot);
    else if (status == BG_OK)
        bg_scale(c, shot, c->t, &size);
    if (status)
        return status;
    for (int i = 0; i < BG_K; i++)
        ports[i] = (bg_port){
            shot[BG_AT_SLIP + i], shot[BG_AT_EFFORT + i], shot[BG_AT_CAP + i],
            shot[BG_AT_PUSH + i], size.slip[i], size.effort[i], size.acceleration[i],
        };
    ruling->count = found->ruled;
    for (int k = 0; k < found->ruled; k++)
        memcpy(ruling->rows[k], found->ruling[k], sizeof found->ruling[k]);
    return BG_OK;
}

int bg_decide(bg_context *c, double time)
{
    const bg_chooser chooser = {BG_K, c->touched, c->model->coupled, c, look};
    const bg_mode *found;
    signed char slipping[BG_PORTS];
    bg_shot now;
    if (BG_K == 0)
        return BG_OK;
    for (int i = 0; i < BG_K; i++)
        slipping[i] = c->mode[i] ? c->mode[i] : 1;
    int status = bg_find(c, bg_number(slipping), &found);
    if (status == BG_OK)
        status = bg_look(c, c->t, c->s, found, now);
    if (status)
        return status;
    bg_see(c, found, now);
    c->peaks.time = time;
    status = bg_choose(&chooser, c->mode);
    return status == BG_NO_MODE ? BG_UNDECIDED : status;
}
