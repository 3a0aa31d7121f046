/* Between the generated model and the engine, whose headers use the same names: this one uses
 * neither. Matrices are by rows. */
#ifndef BATCH_MODEL_H
#define BATCH_MODEL_H

/* The matrices of one set of parameters, and the places of the friction ports. `driven`: whether
 * inputs drive storages. */
typedef struct {
    int driven;
    const double *P, *Q, *R, *F, *D;
    const int *friction_inputs, *friction_readings, *beside;
} batch_numbers;

/* Slips that sticking takes from the states: slip_x x + slip_u u, and what to add per unit. Of the
 * slips of `count` ports that stick, `ruled` combinations, by rows, that only inputs rule. */
typedef struct {
    int kept, ruled, count;
    const int *ports;
    const double *slip_x, *slip_u, *take_away, *ruling;
} batch_hold;

/* What there is of a mode: all, no more than the slips of a similar one, nothing that holds its
 * ports, or a refusal. */
enum batch_found { BATCH_MODE_WHOLE, BATCH_MODE_SLIPS, BATCH_MODE_NONE, BATCH_MODE_REFUSED };

/* Bytes of an instance. */
unsigned long batch_model_size(void);

/* Binds parameters; nonzero if they cannot be used, or if that is doubtful. */
int batch_model_begin(void *model, const double *parameters, batch_numbers *found);

/* The affine map of a mode, -1, 0 or 1 for each port, and what it holds. */
enum batch_found batch_model_mode(void *model, const int *mode, double *map, batch_hold *held);

/* The integrated vector of states at t, the external inputs given; nonzero if there is none. */
int batch_model_start(void *model, double t, const double *states, const double *w, double *s);

#endif
