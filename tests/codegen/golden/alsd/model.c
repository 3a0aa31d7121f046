/* alsd
 *
 *     A x' = J x + B u + E u'
 *        y = F x + D u + G u'
 *
 * Written by bondgraph-toolkit 0.1.0; change the graph rather than this file. C99, no memory is
 * allocated and nothing is global: an instance is one `bg_model`, which the caller provides.
 *
 *     #include "model_runtime.h"
 *     static bg_model model;                          size known when compiled
 *     double s[BG_SIZE], w[3 * BG_ROOM(BG_EXTERNAL)]; states; inputs at t, t + h/2, t + h
 *     bg_model_init(&model, NULL);                    NULL: the parameters written here
 *     bg_model_vector(&model, 0, states, w, s);
 *     for (...) bg_model_step(&model, t, h, s, w);    a real-time step; friction sticks and slips
 * or, with events located and steps that keep a tolerance, `bg_model_run` of model_located.h.
 *
 * Every call gives a status, 0 for success; `bg_model_message` says what it means. Build all files
 * of the folder, for example `cc -std=c99 -O2 *.c -lm`; with main.c that gives a program:
 *     ./a.out END SAMPLE [located] [name=value ...]   prints states and outputs as CSV
 *
 * A program with two models takes each from a folder of its own, written with `prefix`, which every
 * external symbol then carries. Where a model is used, a file of its own includes its header; sizes
 * and types are those of that file, and `bg_model_init` and the others its model's functions.
 *
 * One evaluation takes 30 operations beside those of the matrices.
 * states: omega_1, omega_2, tau_k1, tau_k2, omega_t1, omega_t2
 * inputs: tau_e, tau_h
 * outputs: omega_f, omega_e, omega_c, tau_hs1, tau_hs2
 * parameters: I_1, I_2, I_i, I_w, b, i, k, k_t, omega_t1_0, omega_t2_0, r
 */
#include <math.h>

#include "model_internal.h"

const char *const bg_model_name = "alsd";
const char *const bg_state_names[] = {
    "omega_1", "omega_2", "tau_k1", "tau_k2", "omega_t1", "omega_t2"
};
const char *const bg_state_units[] = {"", "", "", "", "", ""};
const char *const bg_input_names[] = {"tau_e", "tau_h"};
const char *const bg_input_units[] = {"", ""};
const char *const bg_output_names[] = {"omega_f", "omega_e", "omega_c", "tau_hs1", "tau_hs2"};
const char *const bg_output_units[] = {"", "", "", "", ""};
const char *const bg_parameter_names[] = {
    "I_1", "I_2", "I_i", "I_w", "b", "i", "k", "k_t", "omega_t1_0", "omega_t2_0", "r"
};
const char *const bg_friction_names[] = {"clutch"};
const char *const bg_task_names[] = {""};
const bg_table bg_tables[] = {{0}};
const char *const bg_lookup_names[] = {""};


const double bg_defaults[] = {
    0.008, 0.008, 0.1604, 0.8, 0.0, 2.8, 8600.0, 200000.0, 80.0, 80.0, 0.3
};
const int bg_law_rates[] = {0};
const int bg_friction_inputs[] = {1};
const int bg_friction_readings[] = {1};
const int bg_received_readings[] = {1};
const int bg_moving[] = {-1};
const int bg_first_modes[] = {1};
const int bg_beside[] = {0};
const int bg_momenta_rows[] = {0};
const int bg_outside_inputs[] = {0};
const int bg_differentiable[] = {1, 1, 0, 0};
const int bg_output_readings[] = {1, 4, 5, 6, 7};
const bg_switch bg_switches[] = {{BG_RUBS, 0, 0, 0, 0, 0, 0, 0, 0, 0}};
const bg_reset bg_resets[] = {{0, 0, 0, 0}};
const bg_clock bg_clocks[] = {{0.0, 0.0, 0.0}};

static const int rows_A[] = {0, 0, 1, 1, 2, 3, 4, 5};
static const int columns_A[] = {0, 1, 0, 1, 2, 3, 4, 5};
static const int rows_J[] = {0, 0, 0, 1, 1, 1, 2, 2, 3, 3, 4, 4, 4, 5, 5, 5};
static const int columns_J[] = {0, 2, 4, 1, 3, 5, 0, 4, 1, 5, 0, 2, 4, 1, 3, 5};
static const int rows_B[] = {0, 0, 1, 1, 4, 5};
static const int columns_B[] = {0, 1, 0, 1, 2, 3};
static const int rows_E[] = {0};
static const int columns_E[] = {0};
static const int rows_F[] = {0, 0, 1, 1, 2, 3, 4, 4, 5, 5, 6, 6, 6, 7, 7, 7};
static const int columns_F[] = {0, 1, 0, 1, 4, 5, 0, 1, 0, 1, 0, 2, 4, 1, 3, 5};
static const int rows_D[] = {0};
static const int columns_D[] = {0};
static const int rows_H[] = {0};
static const int columns_H[] = {0};
static const int rows_K[] = {0};
static const int columns_K[] = {0};
const bg_pattern bg_layout[BG_MATRICES] = {
    {8, rows_A, columns_A}, {16, rows_J, columns_J}, {6, rows_B, columns_B}, {0, rows_E, columns_E},
        {16, rows_F, columns_F}, {0, rows_D, columns_D}, {0, rows_H, columns_H}, {0, rows_K,
        columns_K}
};

const int bg_slip_begins[] = {0, 2};
const int bg_slip_places[] = {0, 1};
const unsigned long long bg_slip_residues[] = {1152920373028383961u, 1152920373028383960u};
const int bg_moved_begins[] = {0, 0};
const int bg_moved[] = {0};
const unsigned long long bg_prime = 2305840746056767921u;
const unsigned long long bg_prime_inverse = 2899849368476528815u;
const char *const bg_held_names[] = {
    "p_I_1", "p_I_2", "q_halfshaft_1_spring", "q_halfshaft_2_spring", "p_I_w1", "p_I_w2"
};
const int bg_held_begins[] = {0, 1, 2, 3, 4, 5, 6};
const int bg_held_states[] = {0, 1, 2, 3, 4, 5};
const int bg_held_by_law[] = {0, 0, 0, 0, 0, 0};

/* Nonzero entries of A, J, B, E, F, D, H, K: 22 operations. */
void bg_coefficients(const bg_values *v, double *out)
{
    const double I_1 = v->p[0];
    const double I_2 = v->p[1];
    const double I_i = v->p[2];
    const double I_w = v->p[3];
    const double b = v->p[4];
    const double i = v->p[5];
    const double k = v->p[6];
    const double c0 = (1.0/4.0)*I_i*(i*i);
    const double c1 = 1.0/k;
    const double c2 = -b;
    const double c3 = (1.0/2.0)*i;
    out[0] = I_1 + c0;
    out[1] = c0;
    out[2] = c0;
    out[3] = I_2 + c0;
    out[4] = c1;
    out[5] = c1;
    out[6] = I_w;
    out[7] = I_w;
    out[8] = c2;
    out[9] = -1.0;
    out[10] = b;
    out[11] = c2;
    out[12] = -1.0;
    out[13] = b;
    out[14] = 1.0;
    out[15] = -1.0;
    out[16] = 1.0;
    out[17] = -1.0;
    out[18] = b;
    out[19] = 1.0;
    out[20] = c2;
    out[21] = b;
    out[22] = 1.0;
    out[23] = c2;
    out[24] = c3;
    out[25] = -1.0/2.0;
    out[26] = c3;
    out[27] = 1.0/2.0;
    out[28] = -1.0;
    out[29] = -1.0;
    out[30] = c3;
    out[31] = c3;
    out[32] = 1.0/2.0;
    out[33] = -1.0/2.0;
    out[34] = 1.0;
    out[35] = 1.0;
    out[36] = c3;
    out[37] = c3;
    out[38] = 1.0/2.0;
    out[39] = 1.0/2.0;
    out[40] = b;
    out[41] = 1.0;
    out[42] = c2;
    out[43] = b;
    out[44] = 1.0;
    out[45] = c2;
}

/* Rates of what known laws give: 0 operations. */
void bg_known_rates(const bg_values *v, double *out)
{
    (void)v;
    (void)out;
}

/* Level, breakaway level, curve and curve at rest of each friction port: 0 operations. */
void bg_friction_values(const bg_values *v, double *out)
{
    const double tau_h = v->w[1];
    out[0] = tau_h;
    out[1] = tau_h;
    out[2] = 1.0;
    out[3] = 1.0;
}

/* Conditions of switches, to turn on and to turn off in turn: 0 operations. */
void bg_guards(const bg_values *v, double *out)
{
    (void)v;
    (void)out;
}

/* What storages hold that impulses exchange: 0 operations. */
void bg_momenta(const bg_values *v, double *out)
{
    (void)v;
    (void)out;
}

/* How states follow from what storages hold at a start: 2 operations. */
void bg_held_values(const bg_values *v, double *out)
{
    const double I_1 = v->p[0];
    const double I_2 = v->p[1];
    const double I_w = v->p[3];
    const double k = v->p[6];
    out[0] = I_1;
    out[1] = I_2;
    out[2] = 1.0/k;
    out[3] = 1.0/k;
    out[4] = I_w;
    out[5] = I_w;
}

/* Of each delay what it reads, how late it is, what it gives before: 0 operations. */
void bg_delaying(const bg_values *v, double *out)
{
    (void)v;
    (void)out;
}

/* What corners hang on, and for each whether it counts: 0 operations. */
void bg_corners(const bg_values *v, double *out)
{
    (void)v;
    (void)out;
}

/* What known laws give: 0 operations. */
static void known_values(const bg_values *v, double *out)
{
    (void)v;
    (void)out;
}

/* What tire_1 gives: 4 operations. */
static void group_0_values(const bg_values *v, double *out)
{
    const double k_t = v->p[7];
    const double omega_t1 = v->x[4];
    const double omega_t1_0 = v->p[8];
    const double r = v->p[10];
    out[0] = k_t*r*(omega_t1 - omega_t1_0)/omega_t1_0;
}

/* What tire_2 gives: 4 operations. */
static void group_1_values(const bg_values *v, double *out)
{
    const double k_t = v->p[7];
    const double omega_t2 = v->x[5];
    const double omega_t2_0 = v->p[9];
    const double r = v->p[10];
    out[0] = k_t*r*(omega_t2 - omega_t2_0)/omega_t2_0;
}

/* Laws solved with friction: 0 operations. */
static void coupled_values(const bg_values *v, double *out)
{
    (void)v;
    (void)out;
}

const bg_refusing bg_refusings[] = {{0, 0, 0, 0}};

/* Arguments of tables that refuse what is outside: 0 operations. */
void bg_refused(const bg_values *v, double *out)
{
    (void)v;
    (void)out;
}
static const int group_0_inputs[] = {2};
static const int group_0_readings[] = {2};
static const int group_1_inputs[] = {3};
static const int group_1_readings[] = {3};
static const int known_inputs[] = {0};
static const int known_readings[] = {0};
static const int coupled_inputs[] = {0};
static const int coupled_readings[] = {0};
const bg_group bg_known = {0, 0, known_inputs, known_readings, known_values};
const bg_group bg_coupled = {0, 1, coupled_inputs, coupled_readings, coupled_values};
const bg_group bg_groups[] = {
    {1, 0, group_0_inputs, group_0_readings, group_0_values}, {1, 0, group_1_inputs,
        group_1_readings, group_1_values}
};

/* What parameters determine: 7 operations. */
static void bg_hoisted(const bg_values *v, double *out)
{
    const double b = v->p[4];
    const double i = v->p[5];
    const double k_t = v->p[7];
    const double omega_t1_0 = v->p[8];
    const double omega_t2_0 = v->p[9];
    const double r = v->p[10];
    out[0] = -omega_t1_0;
    out[1] = k_t*r/omega_t1_0;
    out[2] = -omega_t2_0;
    out[3] = k_t*r/omega_t2_0;
    out[4] = b;
    out[5] = (1.0/2.0)*i;
}

static const int inverse_rows[] = {0, 0, 1, 2, 3, 4, 5};
static const int inverse_columns[] = {0, 1, 1, 2, 3, 4, 5};

void bg_prepare_rhs(bg_model *m)
{
    bg_hoisted(&m->now, m->constants);
    bg_inverse_entries(m, 7, inverse_rows, inverse_columns, m->constants + 6);
}

/* Rates of slipping friction: 39 operations. */
int bg_model_rhs(bg_model *m, double time, const double *s, const double *w,
                 const double *signs, double *rate)
{
    (void)time;
    const double a_0_0 = m->constants[6];
    const double a_0_1 = m->constants[7];
    const double a_1_1 = m->constants[8];
    const double a_2_2 = m->constants[9];
    const double a_3_3 = m->constants[10];
    const double a_4_4 = m->constants[11];
    const double a_5_5 = m->constants[12];
    const double k0 = m->constants[0];
    const double k1 = m->constants[1];
    const double k2 = m->constants[2];
    const double k3 = m->constants[3];
    const double k4 = m->constants[4];
    const double k5 = m->constants[5];
    const double omega_1 = s[0];
    const double omega_2 = s[1];
    const double omega_t1 = s[4];
    const double omega_t2 = s[5];
    const double sign_0 = signs[0];
    const double tau_e = w[0];
    const double tau_h = w[1];
    const double tau_k1 = s[2];
    const double tau_k2 = s[3];
    const double tau_t1 = k1*(k0 + omega_t1);
    const double tau_t2 = k3*(k2 + omega_t2);
    const double tau_f = sign_0*tau_h;
    const double q0 = k4*(-omega_1 + omega_t1) + k5*tau_e - 1.0/2.0*tau_f - tau_k1;
    const double q1 = k4*(-omega_2 + omega_t2) + k5*tau_e + (1.0/2.0)*tau_f - tau_k2;
    rate[0] = a_0_0*q0 + a_0_1*q1;
    rate[1] = a_0_1*q0 + a_1_1*q1;
    rate[2] = a_2_2*(omega_1 - omega_t1);
    rate[3] = a_3_3*(omega_2 - omega_t2);
    rate[4] = a_4_4*(k4*(omega_1 - omega_t1) + tau_k1 - tau_t1);
    rate[5] = a_5_5*(k4*(omega_2 - omega_t2) + tau_k2 - tau_t2);
    return BG_OK;
}
