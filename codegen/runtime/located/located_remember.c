/* What delays read in a step with a tolerance: polynomials through what its interpolant tells. */
#include <string.h>

#include "located_internal.h"

static int read_at(bg_located *c, double t, double *values)
{
    double s[BG_SIZE];
    int status = bg_solver_dense(c, t, s);
    if (status == BG_OK)
        status = bg_view_look(&c->view, t, s, c->run.mode);
    bg_read_late(c->model, values);
    return status;
}

/* How far the polynomials through these values are off at a place between, of the largest read. */
static double missed(const bg_located *c, double (*values)[BG_PAST_VALUES], double place,
                     const double *read)
{
    const double *const places = bg_past_places();
    double most = 0.0;
    for (int i = 0; i < BG_DELAYS; i++) {
        double sum = 0.0, size = BG_TINY;
        for (int k = 0; k < BG_PAST_VALUES; k++) {
            double of = values[i][k];
            for (int j = 0; j < BG_PAST_VALUES; j++)
                of *= j == k ? 1.0 : (place - places[j]) / (places[k] - places[j]);
            sum += of;
            size = fmax(size, fabs(values[i][k]));
        }
        most = fmax(most, fabs(sum - read[i]) / fmax(size, c->model->memory.is.size[i]));
    }
    return most;
}

/* A part from where it is known, halved until its polynomials tell what was read. */
static int read_part(bg_located *c, double until)
{
    const double *const places = bg_past_places();
    bg_memory *const memory = &c->model->memory;
    const double begin = memory->is.until, most = fmax(BG_DELAYED, BG_REMEMBERED * c->asked->rtol);
    double values[BG_LAGS][BG_PAST_VALUES], read[BG_LAGS], off = INFINITY;
    int status = BG_OK;
    for (int halves = 0; halves <= BG_PART_HALVES && status == BG_OK && off > most; halves++) {
        const double half = 0.5 * (until - begin);
        for (int k = 0; k < BG_PAST_VALUES && status == BG_OK; k++) {
            const double t = k + 1 < BG_PAST_VALUES ? begin + half * (1.0 + places[k]) : until;
            status = read_at(c, t, read);
            for (int i = 0; i < BG_DELAYS; i++)
                values[i][k] = read[i];
        }
        const double place = 0.5 * (places[3] + places[4]) + 0.1;
        if (status == BG_OK)
            status = read_at(c, begin + half * (1.0 + place), read);
        off = status == BG_OK ? missed(c, values, place, read) : 0.0;
        if (off > most && halves < BG_PART_HALVES)
            until = begin + half;
    }
    if (status == BG_OK)
        status = bg_memory_take(memory, until, BG_PAST_VALUES, places, values, c->turned);
    c->turned = 0;
    return status;
}

int bg_located_remember(bg_located *c, double until)
{
    int status = BG_OK;
    for (int k = 0; k < BG_MEMORY && status == BG_OK && c->model->memory.is.until < until; k++)
        status = read_part(c, until);
    return status;
}
