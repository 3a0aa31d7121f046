/* Eight runs at once, a lane each, at samples of their own: exponential steps, the look for events
 * and for changed slopes are worked out for all of them together, the rest for a run by itself. */
#include <string.h>

#include "magic_exponential.h"

enum { LANES = 8, SHAFT = 6, WINDOW = HISTORY + SUB };

typedef double lane[LANES] __attribute__((aligned(64)));
typedef long lane_mask[LANES] __attribute__((aligned(64)));

/* `E`, `weight`: rows of the first six states; torques of clutch and engine hang on themselves.
 * `wheel`, `rest`: with the newest first, as it is when a sample is done; from SUB on as it was
 * before. `guard`, `rate`: as magic_guard's, at that sample and at the next; `x`: its instant. */
typedef struct {
    magic_vector E[SHAFT][N], weight[SHAFT][HISTORY][2], constant[N], decay;
    magic_vector z[N], before[N], wheel[WINDOW][2], rest[WINDOW][2], slope[2];
    lane guard, rate, new_guard, new_rate, mode, demand[2], x, stop, peak, busy;
    lane k;
    lane_mask unsure, changed;
} lanes_state;

/* What is done for a run by itself. */
typedef struct {
    magic_run run;
    magic_weights weights;
    int number;
} lanes_run;

/* What runs are to be done. */
typedef struct {
    const magic_parameters *base;
    const double *k, *tau_h;
    double h, *rows;
    magic_result *results;
    int samples, count, next, failed;
} lanes_job;

static void torques(const magic_system *s, lanes_state *a, int n)
{
    double *const rest = (double *)a->rest[n];
    const double *const wheel = (const double *)a->wheel[n];
    const double *const slope = (const double *)a->slope;
    double scale[2 * LANES];
    for (int l = 0; l < LANES; l++) {
        scale[l] = s->scale[0];
        scale[LANES + l] = s->scale[1];
    }
    for (int l = 0; l < 2 * LANES; l++) {
        const double torque = magic_torque(s, scale[l] * wheel[l]);
        rest[l] = slope[l] * wheel[l] - s->wheel_inverse * torque;
    }
}

/* A sub-step of all lanes; n: where in the windows it comes. */
static inline __attribute__((always_inline)) void sub_step(const magic_system *s, lanes_state *a,
                                                           int n)
{
    magic_vector z[SHAFT];
#pragma GCC unroll 6
    for (int i = SHAFT - 1; i >= 0; i--) {
        magic_vector one = a->constant[i], two = a->E[i][0] * a->z[0];
#pragma GCC unroll 8
        for (int j = 1; j < N; j++)
            two += a->E[i][j] * a->z[j];
#pragma GCC unroll 8
        for (int j = HISTORY - 1; j >= 0; j--) {
            one += a->weight[i][j][0] * a->rest[n + 1 + j][0];
            two += a->weight[i][j][1] * a->rest[n + 1 + j][1];
        }
        z[i] = one + two;
    }
    memcpy(a->z, z, sizeof z);
    a->z[TH] = a->constant[TH] + a->decay * a->z[TH];
    a->z[TE] = a->constant[TE] + a->decay * a->z[TE];
    a->wheel[n][0] = z[T1];
    a->wheel[n][1] = z[T2];
    torques(s, a, n);
}

/* As magic_guard, of all lanes. */
static void guards(const magic_system *s, const lanes_state *a, double *guard, double *rate)
{
    const double one = s->inverse_11 - s->inverse_12, other = s->inverse_22 - s->inverse_12;
    const magic_vector *const z = a->z;
    for (int l = 0; l < LANES; l++) {
        const double mode = a->mode[l], drive = s->half_i * z[TE][l];
        const double friction = 0.5 * mode * z[TH][l], sum = z[K1][l] + z[K2][l];
        const double q1 = drive - friction - z[K1][l], q2 = drive + friction - z[K2][l];
        const double slip = 0.5 * (z[W1][l] - z[W2][l] + s->apart);
        const double hold = z[K2][l] - z[K1][l] - s->asymmetry * (2 * drive - sum);
        const double sign = hold < 0 ? -1.0 : 1.0;
        const double d1 = a->k[l] * (z[W1][l] - z[T1][l]), d2 = a->k[l] * (z[W2][l] - z[T2][l]);
        const double faster = 2 * s->half_i * s->rate * (a->demand[1][l] - z[TE][l]);
        const double held = d2 - d1 - s->asymmetry * (faster - d1 - d2);
        const double stuck = s->rate * (a->demand[0][l] - z[TH][l]) - sign * held;
        guard[l] = mode != 0.0 ? mode * slip : z[TH][l] - sign * hold;
        rate[l] = mode != 0.0 ? 0.5 * mode * (one * q1 - other * q2) : stuck;
    }
}

/* Which lanes may have come to an event, and which to another slope. */
static void look(const magic_system *s, double h, lanes_state *a)
{
    const double *const wheel = (const double *)a->wheel[0];
    const double *const slope = (const double *)a->slope;
    double change[2 * LANES], scale[2 * LANES];
    guards(s, a, a->new_guard, a->new_rate);
    for (int l = 0; l < LANES; l++) {
        scale[l] = s->scale[0];
        scale[LANES + l] = s->scale[1];
    }
    for (int l = 0; l < 2 * LANES; l++) {
        const double now = s->wheel_inverse * scale[l] * magic_slope(s, scale[l] * wheel[l]);
        change[l] = fabs(now - slope[l]) * h;
    }
    for (int l = 0; l < LANES; l++) {
        const double r0 = SUB * h * a->rate[l], r1 = SUB * h * a->new_rate[l];
        const double g0 = a->guard[l], g1 = a->new_guard[l];
        const double ends = g0 < g1 ? g0 : g1, low = g0 + r0 / 3, high = g1 - r1 / 3;
        const double inner = low < high ? low : high, least = ends < inner ? ends : inner;
        const double most = change[l] > change[LANES + l] ? change[l] : change[LANES + l];
        a->unsure[l] = !(least > 0.02 * (fabs(r0) + fabs(r1)));
        a->changed[l] = most > MAGIC_CHANGE;
    }
}

/* Takes what was found for all lanes that are sure; whether any lane needs a look of its own. */
static long accept(lanes_state *a)
{
    long any = 0;
    for (int l = 0; l < LANES; l++) {
        const double now = fabs(a->z[K1][l]), peak = a->peak[l];
        const double x = a->unsure[l] ? a->x[l] : a->x[l] + SUB;
        a->peak[l] = !a->unsure[l] && now > peak ? now : peak;
        a->x[l] = x;
        a->guard[l] = a->new_guard[l];
        a->rate[l] = a->new_rate[l];
        any |= (a->unsure[l] | a->changed[l] | (x >= a->stop[l])) & (a->busy[l] != 0.0);
    }
    return any;
}

static void unload(const lanes_state *a, int l, lanes_run *one)
{
    const magic_vector *const z = a->unsure[l] ? a->before : a->z;
    const int from = a->unsure[l] ? SUB : 0;
    for (int i = 0; i < N; i++)
        one->run.z[i] = z[i][l];
    for (int n = 0; n < HISTORY; n++)
        for (int j = 0; j < 2; j++)
            one->run.wheel[n][j] = a->wheel[from + n][j][l];
    one->run.x = a->x[l];
    one->run.result->peak = a->peak[l];
}

/* A run's weights to its lane. */
static void load_weights(lanes_state *a, int l, const lanes_run *one)
{
    const magic_weights *const w = &one->weights;
    for (int i = 0; i < SHAFT; i++) {
        for (int j = 0; j < N; j++)
            a->E[i][j][l] = w->E[j][i];
        for (int n = 0; n < HISTORY; n++)
            for (int j = 0; j < 2; j++)
                a->weight[i][n][j][l] = w->weight[n][j][i];
    }
    for (int i = 0; i < N; i++)
        a->constant[i][l] = w->constant[i];
    a->decay[l] = w->E[TH][TH];
    a->slope[0][l] = w->slope[0];
    a->slope[1][l] = w->slope[1];
}

/* Where a run is to its lane, as if a sample had just been done. */
static void load(lanes_state *a, int l, const lanes_run *one)
{
    const magic_run *const run = &one->run;
    const double *const z = magic_read(&run->z);
    for (int i = 0; i < N; i++)
        a->z[i][l] = z[i];
    for (int n = 0; n < HISTORY; n++)
        for (int j = 0; j < 2; j++) {
            const double wheel = run->wheel[n][j];
            const double torque = magic_torque(&run->s, run->s.scale[j] * wheel);
            a->wheel[n][j][l] = wheel;
            a->rest[n][j][l] = a->slope[j][l] * wheel - run->s.wheel_inverse * torque;
        }
    a->mode[l] = run->mode;
    a->demand[0][l] = run->demand[0];
    a->demand[1][l] = run->demand[1];
    a->k[l] = run->s.k;
    a->x[l] = run->x;
    a->stop[l] = magic_stop(run);
    a->peak[l] = run->result->peak;
    magic_guard(&run->s, run->mode, run->demand, z, &a->guard[l], &a->rate[l]);
}

/* Slopes alone are other ones: what is left of the torques changes by as much. */
static void renew(lanes_state *a, int l, lanes_run *one, int *failed)
{
    const double before[2] = {a->slope[0][l], a->slope[1][l]};
    for (int j = 0; j < 2; j++)
        one->run.wheel[0][j] = a->wheel[0][j][l];
    *failed = magic_weigh(&one->run, &one->weights);
    load_weights(a, l, one);
    for (int n = 0; n < HISTORY; n++)
        for (int j = 0; j < 2; j++)
            a->rest[n][j][l] += (a->slope[j][l] - before[j]) * a->wheel[n][j][l];
}

static int begin(lanes_job *job, lanes_run *one)
{
    magic_parameters p = *job->base;
    one->number = job->next++;
    p.k = job->k[one->number];
    p.tau_h = job->tau_h[one->number];
    double *const rows =
        job->rows ? job->rows + (long)one->number * job->samples * MAGIC_ROW : job->rows;
    magic_begin(&one->run, &p, job->h, job->samples, rows, job->results + one->number);
    return magic_settle(&one->run, 0) || magic_weigh(&one->run, &one->weights);
}

/* Takes a lane's run on to where it goes by steps again, or begins the next one. */
static void turn(lanes_job *job, lanes_state *a, int l, lanes_run *one)
{
    magic_run *const run = &one->run;
    int failed = 0, fresh = a->busy[l] == 0.0;
    if (!fresh && !a->unsure[l] && a->x[l] < a->stop[l]) {
        renew(a, l, one, &failed);
        job->failed += failed;
        return;
    }
    if (!fresh) {
        unload(a, l, one);
        if (!a->unsure[l] && magic_breaks(run))
            run->known = 0;
        failed = magic_settle(run, a->unsure[l] ? run->x + SUB : run->x);
        if (!failed && (magic_stale(run, &one->weights) || a->changed[l]))
            failed = magic_weigh(run, &one->weights);
    }
    while ((fresh || failed || run->x >= run->end) && job->next < job->count) {
        job->failed += failed;
        failed = begin(job, one);
        fresh = 0;
    }
    job->failed += failed;
    a->busy[l] = !fresh && !failed && run->x < run->end;
    if (a->busy[l] != 0.0) {
        load_weights(a, l, one);
        load(a, l, one);
    }
}

/* Rows of lanes that are sure, where they are asked for. */
static void record(const lanes_state *a, lanes_run *runs)
{
    for (int l = 0; l < LANES; l++)
        if (a->busy[l] != 0.0 && !a->unsure[l]) {
            magic_vector z;
            for (int i = 0; i < N; i++)
                z[i] = a->z[i][l];
            magic_sample(&runs[l].run, a->x[l], &z);
        }
}

int magic_lanes(const magic_parameters *base, double h, int samples, int count, const double *k,
                const double *tau_h, double *rows, magic_result *results)
{
    lanes_job job = {base, k, tau_h, h, rows, results, samples, count, 0, 0};
    lanes_state a;
    lanes_run runs[LANES];
    magic_system s;
    int busy = 0;
    magic_reduce(base, &s);
    memset(&a, 0, sizeof a);
    for (int l = 0; l < LANES; l++) {
        turn(&job, &a, l, runs + l);
        busy += a.busy[l] != 0.0;
    }
    while (busy) {
        memmove(a.wheel + SUB, a.wheel, HISTORY * sizeof *a.wheel);
        memmove(a.rest + SUB, a.rest, HISTORY * sizeof *a.rest);
        memcpy(a.before, a.z, sizeof a.z);
        sub_step(&s, &a, 2);
        sub_step(&s, &a, 1);
        sub_step(&s, &a, 0);
        look(&s, h / SUB, &a);
        const long any = accept(&a);
        if (rows)
            record(&a, runs);
        if (!any)
            continue;
        busy = 0;
        for (int l = 0; l < LANES; l++) {
            if (a.busy[l] != 0.0 && (a.unsure[l] || a.changed[l] || a.x[l] >= a.stop[l]))
                turn(&job, &a, l, runs + l);
            busy += a.busy[l] != 0.0;
        }
    }
    return job.failed;
}
