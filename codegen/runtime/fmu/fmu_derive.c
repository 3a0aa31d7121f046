/* Directional derivatives: exact where a mode is one affine map, else by central differences. */
#include <math.h>
#include <string.h>

#include "fmu_common.h"

/* Whether a mode is one affine map of s, w and w'; redundant ports that share a load are not. */
static int is_affine(fmu_instance *f)
{
    bg_hold *held = NULL;
    int sticking = 0;
    for (int i = 0; i < K; i++)
        sticking |= f->at.mode[i] == 0;
    if (!BG_AFFINE || (sticking && bg_hold_of(&f->model, f->at.mode, &held) != BG_OK))
        return 0;
    return !held || !bg_shares(held);
}

/* Moves variables along the seed, where they are part of s, w or w'; 0: one is not. */
static int push_along(const unsigned *knowns, size_t columns, const double *seed, double way, double *s,
                double *w, double *dw)
{
    for (size_t j = 0; j < columns; j++) {
        const fmu_variable *v = &fmu_variables[knowns[j]];
        const int plain = v->kind == FMU_STATE && (!FMU_MOVED || v->index >= BG_STATES);
        if (v->kind == FMU_VECTOR || plain)
            s[v->index] += way * seed[j];
        else if (v->kind == FMU_INPUT)
            w[v->index] += way * seed[j];
        else if (v->kind == FMU_SLOPE)
            dw[v->index] += way * seed[j];
        else
            return 0;
    }
    return 1;
}

/* The values far out along the seed less those at the origin, exactly: the model is affine. */
static fmu_error far_difference(fmu_instance *f, const unsigned *unknowns, size_t rows,
                                const unsigned *knowns, size_t columns, const double *seed,
                                double *result)
{
    for (int out = 0; out < 2; out++) {
        double dw[BG_ROOM(W)] = {0};
        int status;
        memset(f->point, 0, sizeof f->point);
        memset(f->w, 0, sizeof f->w);
        push_along(knowns, columns, seed, out * BG_FAR, f->point, f->w, dw);
        status = bg_evaluate(&f->model, 0.0, f->point, f->w, dw, f->at.mode, 0, &f->located.view.shot);
        if (status != BG_OK)
            return bg_model_message(status);
        if (FMU_SWITCHES)
            fmu_switch_values(&f->model.now, f->switches);
        memcpy(f->at.s, f->point, sizeof f->at.s);
        f->stale = 0;
        for (size_t i = 0; i < rows; i++) {
            double value = 0.0;
            fmu_get(f, unknowns[i], &value);
            result[i] = out ? (value - result[i]) / BG_FAR : value;
        }
    }
    return NULL;
}

/* Sets variables along the seed whatever the phase. */
static fmu_error set_along(fmu_instance *f, const unsigned *knowns, size_t columns,
                           const double *seed, double way, const fmu_memory *from)
{
    fmu_restore(f, from);
    if (push_along(knowns, columns, seed, way, f->at.phase > FMU_INITIALIZING ? f->at.s : f->at.start,
             f->at.given, f->at.slopes))
        return NULL;
    fmu_restore(f, from);
    for (size_t j = 0; j < columns; j++) {
        const fmu_variable *v = &fmu_variables[knowns[j]];
        double value = 0.0;
        fmu_error failed = fmu_get(f, knowns[j], &value);
        if (!failed && v->kind == FMU_PARAMETER && (f->changed = 1))
            f->at.parameters[v->index] += way * seed[j];
        else if (!failed && v->kind == FMU_VECTOR && f->at.phase > FMU_INITIALIZING)
            f->at.s[v->index] += way * seed[j];
        else if (!failed)
            failed = fmu_set(f, knowns[j], value + way * seed[j]);
        if (failed)
            return failed;
    }
    return NULL;
}

/* A length along the seed at which differences are neither rounding nor curved. */
static fmu_error difference_step(fmu_instance *f, const unsigned *knowns, size_t columns,
                                 const double *seed, double *step)
{
    fmu_error failed = fmu_refresh(f);
    *step = 0.0;
    for (size_t j = 0; j < columns && !failed; j++) {
        double value = 0.0;
        failed = fmu_get(f, knowns[j], &value);
        if (seed[j] != 0) {
            const int free = value != 0 && fmu_variables[knowns[j]].kind == FMU_PARAMETER;
            const double size = free ? fabs(value) : fmax(fabs(value), 1.0);
            const double most = BG_UNIT_DIFFERENCE * size / fabs(seed[j]);
            *step = *step > 0 ? fmin(*step, most) : most;
        }
    }
    return failed;
}

fmu_error fmu_derive(fmu_instance *f, const unsigned *unknowns, size_t rows, const unsigned *knowns,
                     size_t columns, const double *seed, double *result)
{
    fmu_error failed = NULL;
    double step = 0.0;
    for (size_t i = 0; i < rows; i++)
        result[i] = 0.0;
    for (size_t j = 0; j < columns; j++)
        if (knowns[j] >= FMU_VARIABLES)
            return "unknown value reference";
    for (size_t j = 0; j < columns; j++)
        if (fmu_is_table(fmu_variables[knowns[j]].kind))
            return "there are no derivatives by the values of tables";
    failed = difference_step(f, knowns, columns, seed, &step);
    if (failed || step == 0)
        return failed;
    const fmu_memory kept = f->at;
    f->frozen = 1;
    if (is_affine(f) && push_along(knowns, columns, seed, 0.0, f->point, f->w, f->dw)) {
        failed = far_difference(f, unknowns, rows, knowns, columns, seed, result);
    } else {
        for (int way = 1; way >= -1 && !failed; way -= 2) {
            failed = set_along(f, knowns, columns, seed, way * step, &kept);
            for (size_t i = 0; i < rows && !failed; i++) {
                double value = 0.0;
                failed = fmu_get(f, unknowns[i], &value);
                result[i] += way * value / (2 * step);
            }
        }
    }
    f->frozen = 0;
    fmu_restore(f, &kept);
    return failed;
}
