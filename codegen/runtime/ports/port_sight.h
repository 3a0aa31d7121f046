/* A generated model as a choice of mode sees it. */
#ifndef BG_PORT_SIGHT_H
#define BG_PORT_SIGHT_H

#include "model_internal.h"
#include "port_choose.h"
#include "port_rounding.h"

/* The largest magnitudes seen, of the terms that make inputs up. */
typedef struct {
    double x[BG_ROOM(BG_STATES)], u[BG_ROOM(BG_INPUTS)];
} bg_peaks;

/* What is looked at. `given` tells the external inputs at t, and whether friction levels are to be
 * checked there; `t` and `shot` are of the latest look; `measured`: whether the magnitudes
 * of the present numbers are known. */
typedef struct {
    bg_model *model;
    bg_peaks *peaks;
    const void *self;
    int (*given)(const void *self, double t, double *w, double *dw);
    double t, point[BG_SIZE], struck[BG_SIZE];
    bg_snapshot shot;
    int measured;
    double F[BG_TABLE(BG_STATES, BG_FRICTION)], D[BG_TABLE(BG_INPUTS, BG_FRICTION)];
    double FP[BG_TABLE(BG_STATES, BG_FRICTION)], FQ[BG_TABLE(BG_INPUTS, BG_FRICTION)];
    double P[BG_TABLE(BG_STATES, BG_STATES)], Q[BG_TABLE(BG_INPUTS, BG_STATES)];
    double inertia[BG_ROOM(BG_FRICTION)];
} bg_view;

/* The view as what can be looked at. */
bg_sight bg_view_sight(bg_view *v);

/* Everything at t and s in a mode, in v->shot; its ports with what counts as zero, where `time` is
 * the shortest time constant. */
int bg_view_look(void *view, double t, const double *s, const int *mode);
void bg_view_ports(bg_view *v, const int *mode, double time, bg_port *ports);

/* port_keep.c: what keeps switches of the latest look; below what that is none, where the largest
 * magnitudes of states and inputs are x and u; and their impulses, as a choice wants them. */
void bg_view_keep(const bg_view *v, const int *mode, bg_port *ports);
void bg_view_stay(bg_view *v, const int *mode, double time, const double *x, const double *u,
                  bg_port *ports);
int bg_view_strike(void *view, const bg_instant *at, const int *mode, const double *speeds,
                   double *s, bg_blow *blow);

/* Takes the latest look, at s, into the peaks, friction slipping so; it stays the latest. */
void bg_view_see(bg_view *v, const double *s, const int *slipping);

/* Magnitudes of a model's matrices, for `bg_round_ports`. */
void bg_measure(const bg_numbers *a, const bg_magnitudes *to);

#endif
