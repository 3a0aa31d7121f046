/* What delays read in model exchange, between the points that an importer's integrator comes to. */
#include <math.h>
#include <string.h>

#include "fmu_common.h"

enum { FMU_POINTS = BG_PAST_VALUES };

void fmu_begin_late(fmu_instance *f)
{
    bg_memory_begin(&f->model.memory, f->at.time);
    f->at.read.time = f->at.time;
}

fmu_error fmu_go_on_late(fmu_instance *f, int turned)
{
    fmu_read *const read = &f->at.read;
    const fmu_error failed = fmu_refresh(f);
    read->time = f->at.time;
    read->turned |= turned;
    memcpy(read->s, f->at.s, sizeof read->s);
    memcpy(read->rate, f->located.view.shot.rate, sizeof read->rate);
    memcpy(read->given, f->at.given, sizeof read->given);
    return failed;
}

/* Weights by which values at the places give the integral from the first place to each: of the
 * polynomials that are 1 at one place. */
static void integrals(double weights[FMU_POINTS][FMU_POINTS])
{
    const double *const places = bg_past_places();
    for (int k = 0; k < FMU_POINTS; k++) {
        double powers[FMU_POINTS + 1] = {1.0};
        for (int j = 0; j < FMU_POINTS; j++)
            for (int p = FMU_POINTS - 1; p >= 0 && j != k; p--)
                powers[p] = ((p > 0 ? powers[p - 1] : 0.0) - places[j] * powers[p])
                    / (places[k] - places[j]);
        for (int i = 0; i < FMU_POINTS; i++) {
            double at = 1.0, first = 1.0;
            weights[i][k] = 0.0;
            for (int p = 0; p < FMU_POINTS; p++) {
                at *= places[i];
                first *= places[0];
                weights[i][k] += powers[p] * (at - first) / (p + 1);
            }
        }
    }
}

/* Between two points, as their states and rates tell: where the search begins. */
static void begin_between(const fmu_instance *f, const double *rate, double h,
                          double s[FMU_POINTS][BG_SIZE])
{
    const fmu_read *const a = &f->at.read;
    for (int k = 0; k < FMU_POINTS; k++)
        bg_between(0.5 * (bg_past_places()[k] + 1.0), h, a->s, f->at.s, a->rate, rate, s[k]);
}

/* States as the integrals of their rates, from the first point, and less by and by what they miss
 * of the last; how far they went, of the largest. */
static double renew_between(const fmu_instance *b, double h,
                            double weights[FMU_POINTS][FMU_POINTS],
                            double rates[FMU_POINTS][BG_SIZE], double s[FMU_POINTS][BG_SIZE])
{
    double most = 0.0;
    for (int i = 0; i < BG_SIZE; i++) {
        double found[FMU_POINTS], size = BG_TINY;
        for (int k = 0; k < FMU_POINTS; k++) {
            found[k] = s[0][i];
            for (int j = 0; j < FMU_POINTS; j++)
                found[k] += 0.5 * h * weights[k][j] * rates[j][i];
            size = fmax(size, fabs(found[k]));
        }
        const double missed = found[FMU_POINTS - 1] - b->at.s[i];
        for (int k = 1; k < FMU_POINTS; k++) {
            found[k] -= 0.5 * (bg_past_places()[k] + 1.0) * missed;
            most = fmax(most, fabs(found[k] - s[k][i]) / size);
            s[k][i] = found[k];
        }
    }
    return most;
}

/* Rates at all points, and what is read there; what the importer gives is on a line. */
static int look_between(fmu_instance *f, double s[FMU_POINTS][BG_SIZE],
                        double rates[FMU_POINTS][BG_SIZE], double values[BG_LAGS][BG_PAST_VALUES])
{
    const double half = 0.5 * (f->at.time - f->at.read.time);
    double read[BG_LAGS];
    int status = BG_OK;
    for (int k = 0; k < FMU_POINTS && status == BG_OK; k++) {
        const double inside = f->at.read.time + half * (bg_past_places()[k] + 1.0);
        const double t = k + 1 < FMU_POINTS ? inside : f->at.time;
        status = bg_view_look(&f->located.view, t, s[k], f->at.mode);
        memcpy(rates[k], f->located.view.shot.rate, sizeof rates[k]);
        bg_read_late(&f->model, read);
        for (int i = 0; i < BG_DELAYS; i++)
            values[i][k] = read[i];
    }
    return status;
}

/* Points are renewed as long as they draw nearer; as they first were where they never do, as where
 * rates are stiff. */
static int read_between(fmu_instance *f, double h)
{
    double weights[FMU_POINTS][FMU_POINTS], last = INFINITY, went = INFINITY;
    double s[FMU_POINTS][BG_SIZE], rates[FMU_POINTS][BG_SIZE], values[BG_LAGS][BG_PAST_VALUES];
    integrals(weights);
    double rate[BG_SIZE];
    memcpy(rate, f->located.view.shot.rate, sizeof rate);
    begin_between(f, rate, h, s);
    int status = look_between(f, s, rates, values);
    for (int turn = 0; turn < BG_RENEWED && status == BG_OK && went > BG_DELAYED; turn++) {
        last = went;
        went = renew_between(f, h, weights, rates, s);
        if (went >= last)
            begin_between(f, rate, h, s);
        status = look_between(f, s, rates, values);
        if (went >= last)
            break;
    }
    if (status == BG_OK)
        status = bg_memory_take(&f->model.memory, f->at.time, FMU_POINTS, bg_past_places(), values,
                                f->at.read.turned);
    f->at.read.turned = 0;
    return status;
}

fmu_error fmu_read_late(fmu_instance *f)
{
    const double h = f->at.time - f->at.read.time;
    double slopes[BG_ROOM(BG_EXTERNAL)];
    const fmu_error failed = h > 0.0 ? fmu_refresh(f) : NULL;
    if (failed || !(h > 0.0))
        return failed;
    memcpy(slopes, f->at.slopes, sizeof slopes);
    for (int i = 0; i < BG_EXTERNAL; i++)
        f->at.slopes[i] = (f->at.given[i] - f->at.read.given[i]) / h;
    const int status = read_between(f, h);
    memcpy(f->at.slopes, slopes, sizeof slopes);
    f->stale = 1;
    return fmu_message(f, status);
}
