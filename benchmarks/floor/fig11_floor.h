/* Fig. 11 by hand, stepped exactly: the floor for generated code. Nothing is allocated, nothing
 * is global; a context is only read by runs and may be shared between threads. */
#ifndef FIG11_FLOOR_H
#define FIG11_FLOOR_H

enum { FIG11_MAX_THREADS = 64, FIG11_ROW = 8, FIG11_STRIDE = 4 };

/* SI units; demands step at the samples nearest to time_e and time_h. */
typedef struct {
    double i, I_i, I_1, I_2, I_w, k, k_t, r, lag;
    double omega_0, dw0, tau_e, tau_h, time_e, time_h;
} fig11_parameters;

/* mode after it: 0 stuck, -1 or 1 the sign of the slip; kind: 0 stick, 1 cross, 2 slip. */
typedef struct {
    double time;
    int mode, kind;
} fig11_event;

/* What the parameters come to in the equations. */
typedef struct {
    double inverse_11, inverse_12, inverse_22, stuck_mass, stuck_inverse, asymmetry;
    double a, I_1, I_2, I_w, wheel_inverse, k, half_i;
    double start_1, start_2, slope_1, slope_2, lag, rate;
} fig11_system;

/* One mode: 1, 2, .. steps ahead; its guard's slope (a third of a step) and fourth derivative. */
typedef struct {
    double step[FIG11_STRIDE][FIG11_ROW][FIG11_ROW], slope[FIG11_ROW];
    double fourth, fourth_h, fourth_e;
} fig11_mode;

typedef struct {
    fig11_system system;
    fig11_mode slip, stuck;
    double h, norm, decay, torque_e, torque_h, demand_e, demand_h;
    long index_e, index_h;
} fig11_context;

/* Builds both modes' exponentials for the sample step h. */
void fig11_prepare(const fig11_parameters *p, double h, fig11_context *c);

/* Writes `samples` rows of omega_1, omega_2, tau_k1, tau_k2, omega_t1, omega_t2, tau_f, slip.
 * Returns the number of events, of which the first `capacity` are kept; -1 if they had no end. */
int fig11_run(const fig11_context *c, int samples, double *out, fig11_event *events, int capacity);

/* The same from the parameters: exponentials built anew. */
int fig11_run_anew(const fig11_parameters *p, double h, int samples, double *out,
                   fig11_event *events, int capacity);

/* A sampled PI that sets the demand on the clutch's torque, every so many samples; it asks for a
 * difference of the wheels' speeds. */
typedef struct {
    double gain, reset, wanted, start;
    int every;
} fig11_controller;

/* The same in a closed loop, the clutch's torque at `start` first. */
int fig11_run_closed(const fig11_parameters *p, const fig11_controller *pi, double h, int samples,
                     double *out, fig11_event *events, int capacity);

/* Runs `count` times with k[n], tau_h[n]; peak |halfshaft torque| over the samples and the first
 * instant of lock (NaN: none). Returns how many failed. */
int fig11_sweep(const fig11_parameters *base, double h, int samples, int count, const double *k,
                const double *tau_h, double *peak, double *lock);
int fig11_sweep_threads(const fig11_parameters *base, double h, int samples, int count,
                        const double *k, const double *tau_h, double *peak, double *lock,
                        int threads);

/* x: the six states; u: tau_e, tau_f. */
void fig11_rhs(const fig11_system *s, double t, const double *x, const double *u, double *dx);

/* `calls` Euler steps through fig11_rhs; returns a state so that none can be left out. */
double fig11_drive_rhs(const fig11_parameters *p, long calls, double dt);

#endif
