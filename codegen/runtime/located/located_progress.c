/* Whether an integrator still advances, told by its work: steps far shorter than anything in the
 * model asks for, in front of rates that jump. runs/progress.py decides the same way with the same
 * numbers and says what they are. */
#include <math.h>
#include <string.h>

#include "located_internal.h"

/* Along the rates `base` of the present instant: where they are asked for, and what they are. */
typedef struct {
    bg_located *c;
    double reach, base[BG_SIZE], scale[BG_SIZE];
} line;

/* Rates at a part of the reach, and beyond that at a part of it along others; 0 where there are
 * none. */
static int rates_at(const line *l, double part, double beyond, const double *other, double *rate)
{
    double s[BG_SIZE];
    for (int i = 0; i < BG_SIZE; i++)
        s[i] = l->c->s[i] + l->reach * (part * l->base[i] + (other ? beyond * other[i] : 0.0));
    return bg_located_rate(l->c, l->c->run.at.t + (part + beyond) * l->reach, s, rate) == BG_OK;
}

/* How far apart rates are, in tolerances over the reach. */
static double changed(const line *l, const double *one, const double *other)
{
    double most = 0.0;
    for (int i = 0; i < BG_SIZE; i++)
        most = fmax(most, fabs(one[i] - other[i]) * l->scale[i]);
    return most;
}

/* Whether the rates jump just ahead, along their own direction; `slides`: and push back beyond. */
static int jumps(bg_located *c, double mean, int slides)
{
    line l = {c, BG_REACH * mean, {0}, {0}};
    double low[BG_SIZE], middle[BG_SIZE], high[BG_SIZE], begin = 0.0, end = 1.0;
    for (int i = 0; i < BG_SIZE; i++)
        l.scale[i] = l.reach / (c->asked->atol + c->asked->rtol * fabs(c->s[i]));
    if (bg_located_rate(c, c->run.at.t, c->s, l.base) != BG_OK
        || !rates_at(&l, 1.0, 0.0, NULL, high))
        return 0;
    memcpy(low, l.base, sizeof low);
    const double first = changed(&l, low, high);
    for (int k = 0; k < BG_HALVES; k++) {
        const double half = 0.5 * (begin + end);
        if (!rates_at(&l, half, 0.0, NULL, middle))
            return 0;
        if (changed(&l, low, middle) > changed(&l, middle, high)) {
            end = half;
            memcpy(high, middle, sizeof high);
        } else {
            begin = half;
            memcpy(low, middle, sizeof low);
        }
    }
    if (!(changed(&l, low, high) > fmax(BG_WHOLE * first, BG_FELT)))
        return 0;
    return !slides || (rates_at(&l, end, BG_BACK, high, middle)
                       && changed(&l, middle, low) < changed(&l, middle, high));
}

void bg_progress_begin(bg_located *c)
{
    c->progress = (bg_progress){c->run.at.t, 0, 0};
}

int bg_progress_check(bg_located *c)
{
    bg_progress *const p = &c->progress;
    double fastest = 0.0;
    if (++p->steps % BG_LOT)
        return BG_OK;
    const double mean = (c->run.at.t - p->begin) / BG_LOT;
    double part = mean / bg_longest_step(c->run.at.t - c->run.began);
    p->begin = c->run.at.t;
    if (part < BG_SHORT) {
        const int status = bg_located_calm(c, &fastest);
        if (status != BG_OK)
            return status;
        part = fmax(part, mean * fastest);
    }
    if (part < BG_SHORT && p->idle && jumps(c, mean, part >= BG_SHORTER))
        return BG_STEPS;
    p->idle = part < BG_SHORT;
    return BG_OK;
}
