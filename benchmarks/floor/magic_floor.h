/* Fig. 11 with magic formula tires by hand, three times over: what generated code for the same runs
 * is measured against. Nothing is allocated, nothing is global. */
#ifndef MAGIC_FLOOR_H
#define MAGIC_FLOOR_H

enum { MAGIC_ROW = 8 };

/* SI units; demands step at the samples nearest to time_e and time_h. Of tires the peak force D and
 * the shapes C, at most 2, and E. */
typedef struct {
    double i, I_i, I_1, I_2, I_w, k, k_t, r, lag;
    double omega_0, dw0, tau_e, tau_h, time_e, time_h, D, C, E;
} magic_parameters;

/* What a run gives: the largest |tau_k1| at a sample, the first instant of lock and the last of any
 * event (NaN: none), how often it stuck, crossed or slipped again, how many steps were taken (those
 * of Runge-Kutta alone, where runs go side by side) and how many exponentials made. */
typedef struct {
    double peak, lock, last;
    int events, steps, renewals;
} magic_result;

/* Each writes `samples` rows of omega_1, omega_2, tau_k1, tau_k2, omega_t1, omega_t2, tau_f, slip
 * to `rows`, unless that is a null pointer. 0, or -1 where a run had no end, or steps of a third of
 * a sample are too long for its exponentials. */
int magic_dop853(const magic_parameters *p, double h, int samples, double tolerance, double *rows,
                 magic_result *result);
int magic_exponential(const magic_parameters *p, double h, int samples, double *rows,
                      magic_result *result);

/* Runs `count` times with k[n], tau_h[n]; tolerance 0: exponential steps. Rows as above, run after
 * run. How many failed. */
int magic_sweep(const magic_parameters *base, double h, int samples, int count, const double *k,
                const double *tau_h, double tolerance, double *rows, magic_result *results);

/* The same by exponential steps of eight runs at once. */
int magic_lanes(const magic_parameters *base, double h, int samples, int count, const double *k,
                const double *tau_h, double *rows, magic_result *results);

#endif
