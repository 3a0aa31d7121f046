/* Whether a step is beyond the stability of Runge's and Kutta's method: two products of the rates'
 * slopes with a vector that is kept from step to step, by differences inside the step's mode. What
 * the rates do twice is fitted by what they do once, so pairs of complex rates are seen as well as
 * real ones (B. P. Sommeijer, L. F. Shampine, J. G. Verwer, RKC, J. Comput. Appl. Math. 88, 1998,
 * keep such a vector in the same way, for norms alone). */
#include <math.h>
#include <string.h>

#include "model_internal.h"

enum {
    LINEAR_ROUNDS = 8, /* by storages and resistances alone, before the first verdict */
    AVERAGED = 8,     /* rounds in the mean growth */
    REFINED = 16      /* before a refusal tells the longest step */
};

/* l^2 = a l + b for the fastest rates l, or l = a; the part left unexplained; its error bound. */
typedef struct {
    double a, b, left, doubt, growth;
} fit;

static double normalised(const bg_model *m, double *a)
{
    const double squared = bg_energy(m, a, a), size = squared > 0 ? sqrt(squared) : 0.0;
    for (int i = 0; i < ALL && size > 0; i++)
        a[i] /= size;
    return size;
}

/* Fits J J from, which becomes `next`, both of length 1, by J from and from. */
static int look_along(bg_model *m, double t, const double *s, const double *w, double amount,
                const double *from, double *next, fit *found)
{
    double *const once = m->work.image;
    double apart[BG_SIZE] = {0}, first, second, c, along, back, sine, root;
    int status = bg_slope(m, t, s, w, amount, from, once);
    memset(found, 0, sizeof *found);
    memcpy(next, from, sizeof(double) * BG_SIZE);
    first = status == BG_OK ? normalised(m, once) : 0.0;
    if (status == BG_OK)
        status = bg_slope(m, t, s, w, amount, once, next);
    second = status == BG_OK ? normalised(m, next) : 0.0;
    if (!(first > 0) || !(second > 0))
        return status;
    c = bg_energy(m, once, from);
    along = bg_energy(m, next, once);
    back = bg_energy(m, next, from);
    sine = 1 - c * c;
    found->growth = sqrt(first * second);
    found->a = sine > BG_SINE * BG_SINE ? (along - c * back) / sine : along;
    found->b = sine > BG_SINE * BG_SINE ? (back - c * along) / sine : 0.0;
    for (int i = 0; i < ALL; i++)
        apart[i] = next[i] - found->a * once[i] - found->b * from[i];
    found->left = normalised(m, apart);
    found->a *= second;
    found->b *= second * first;
    /* Roots move by the error over their distance; double ones by its square root. */
    root = fabs(found->a * found->a / 4 + found->b);
    c = found->a * found->a / 4 + fabs(found->b);
    found->doubt = fmin(root > 0 ? found->left * c / (2 * root) : 1.0, 2 * sqrt(found->left));
    return status;
}

/* The longest stable step by a fit or, where that leaves too much, by the mean growth alone. */
static double longest(const bg_fastest *f, const fit *found, double h)
{
    double step, grown;
    if (found->left <= BG_UNEXPLAINED) {
        /* No root is larger than this: mostly nothing needs to be looked for. */
        if (h * (fabs(found->a) / 2 + sqrt(fabs(found->a * found->a / 4 + found->b))) < BG_NEAREST)
            return h;
        step = bg_stable_step(found->a, found->b);
        return h > step * (1 + found->doubt) ? step : h;
    }
    if (f->rounds < AVERAGED || !(h * found->growth > 1.05 * BG_FARTHEST))
        return h;
    grown = fmin(exp(f->growth), found->growth);
    return h * grown > 1.05 * BG_FARTHEST ? BG_NEAREST / grown : h;
}

/* The kept vector goes on, and a little of every direction with it, so that none is ever lost. */
static void keep_direction(bg_model *m, const fit *found, const double *next)
{
    bg_fastest *const f = &m->fastest;
    double stir[BG_SIZE] = {0};
    for (int i = 0; i < ALL; i++)
        stir[i] = bg_stir(&f->noise);
    normalised(m, stir);
    for (int i = 0; i < ALL; i++)
        f->direction[i] = next[i] + BG_STIRRED * stir[i];
    normalised(m, f->direction);
    if (found->growth > 0) {
        f->rounds += f->rounds < AVERAGED;
        f->growth += (log(found->growth) - f->growth) / f->rounds;
    }
}

/* A port that slips against its mode, in the moment of a change, shows slopes of neither. */
static int on_one_side(const bg_model *m)
{
    for (int i = 0; i < K; i++)
        if (bg_switches[i].kind == BG_RUBS && !bg_hangs(bg_switches + i)
            && m->mode[i] * m->shot.y[bg_friction_readings[i]] < 0)
            return 0;
    return 1;
}

/* Rounds that give no verdict; 0 where the rates have no values beside s. */
static int look_on(bg_model *m, double t, const double *s, const double *w, int rounds, fit *found)
{
    for (int k = 0; k < rounds; k++) {
        double *const along = m->fastest.direction;
        if (look_along(m, t, s, w, BG_DIFFERENCE, along, m->work.next, found) != BG_OK)
            return 0;
        keep_direction(m, found, m->work.next);
    }
    return 1;
}

/* The kept vector as the storages and resistances alone would turn it: that asks for no rates. */
static void follow_storages(bg_model *m)
{
    const double *const P = m->numbers.P, *const weight = m->work.weight;
    double *const along = m->fastest.direction, turned[BG_SIZE];
    for (int round = 0; round < LINEAR_ROUNDS; round++) {
        memcpy(turned, along, sizeof turned);
        for (int i = 0; i < N; i++) {
            turned[i] = 0.0;
            for (int j = 0; j < N; j++)
                turned[i] += weight[i] * P[i * N + j] * along[j] / weight[j];
        }
        if (!(normalised(m, turned) > 0))
            return;
        memcpy(along, turned, sizeof turned);
    }
}

/* A direction that no structure of the model is blind to. */
static void begin_fit(bg_model *m, fit *found)
{
    memset(found, 0, sizeof *found);
    memset(m->work.next, 0, sizeof m->work.next);
    keep_direction(m, found, m->work.next);
    follow_storages(m);
    memcpy(m->work.next, m->fastest.direction, sizeof m->work.next);
    keep_direction(m, found, m->work.next);
}

/* Looks a second time, to the other side and farther: a jump has other slopes there. The longest
 * step that is stable or, if it was a jump, h. */
static double confirmed(bg_model *m, double t, double h, const double *s, const double *w,
                        const fit *found)
{
    const double other = -BG_FARTHER * BG_DIFFERENCE;
    bg_fastest *const f = &m->fastest;
    fit again;
    double step = longest(f, found, h), finer;
    if (look_along(m, t, s, w, other, f->direction, m->work.next, &again) != BG_OK
        || again.growth < 0.5 * found->growth || !(longest(f, &again, h) < h))
        return h;
    if (look_on(m, t, s, w, REFINED, &again)) {
        finer = longest(f, &again, h);
        step = fmin(step, finer);
    }
    return step;
}

int bg_check_step(bg_model *m, double t, double h, const double *s, const double *w)
{
    bg_fastest *const f = &m->fastest;
    const int sided = on_one_side(m);
    fit found;
    double step = h;
    int seen;
    if (ALL == 0)
        return BG_OK;
    bg_weigh(m, h);
    bg_reach(m, h, s);
    if (f->noise == 0)
        begin_fit(m, &found);
    seen = look_along(m, t, s, w, BG_DIFFERENCE, f->direction, m->work.next, &found) == BG_OK;
    if (seen && sided && longest(f, &found, h) < h)
        step = confirmed(m, t, h, s, w, &found);
    else if (seen)
        keep_direction(m, &found, m->work.next);
    m->where = -1;
    if (!(step < h))
        return BG_OK;
    f->step = step;
    return BG_UNSTABLE;
}

/* What the stages of a step did at the same instant is a product that costs nothing: where they
 * move fast is where to look next. */
void bg_note_stages(bg_model *m)
{
    const bg_work *const work = &m->work;
    double seed[BG_SIZE] = {0}, moved[BG_SIZE] = {0}, before, after, part;
    for (int i = 0; i < ALL; i++) {
        moved[i] = (work->stage[1][i] - work->stage[0][i]) * work->weight[i];
        seed[i] = (work->stage[2][i] - work->stage[1][i]) * work->weight[i];
    }
    before = normalised(m, moved);
    after = normalised(m, seed);
    if (!(after > 0) || !(before > 0) || !isfinite(after) || !isfinite(before))
        return;
    part = 2 * after > BG_NEAREST * before ? 0.0 : 1 / BG_SEEDED;
    for (int i = 0; i < ALL; i++)
        m->fastest.direction[i] = part * m->fastest.direction[i] + seed[i];
    normalised(m, m->fastest.direction);
}
