/* Calls a unit of FMI 2 or 3 as an importer does, by model exchange and by co-simulation, for a checker
 * of memory: compiled together with the unit's own sources. Prints every number. */
#include <stdio.h>
#include <stdlib.h>

#include "fmu_common.h"

#ifdef FMI_3
#include "fmi3Functions.h"
typedef fmi3Instance unit;
typedef fmi3ValueReference reference;
#define F(name) fmi3##name
#define GET_REAL(c, vr, n, out) fmi3GetFloat64(c, vr, n, out, n)
#define SET_REAL(c, vr, n, from) fmi3SetFloat64(c, vr, n, from, n)
#define GET_INTEGER(c, vr, n, out) fmi3GetInt32(c, vr, n, out, n)
#define DERIVE(c, u, n, v, m, seed, out) fmi3GetDirectionalDerivative(c, u, n, v, m, seed, m, out, n)
#define RATES fmi3GetContinuousStateDerivatives
#define SAVED fmi3FMUState
#define SAVE fmi3GetFMUState
#define RESTORE fmi3SetFMUState
#define FORGET fmi3FreeFMUState
#else
#include "fmi2Functions.h"
typedef fmi2Component unit;
typedef fmi2ValueReference reference;
#define F(name) fmi2##name
#define GET_REAL fmi2GetReal
#define SET_REAL fmi2SetReal
#define GET_INTEGER fmi2GetInteger
#define DERIVE fmi2GetDirectionalDerivative
#define RATES fmi2GetDerivatives
#define SAVED fmi2FMUstate
#define SAVE fmi2GetFMUstate
#define RESTORE fmi2SetFMUstate
#define FORGET fmi2FreeFMUstate
#endif

static int failures;

static void good(const char *what, int status)
{
    if (status != 0) {
        printf("%s: status %d\n", what, status);
        failures++;
    }
}

static void show(const char *what, int count, const double *values)
{
    printf("%s", what);
    for (int i = 0; i < count; i++)
        printf(" %.17g", values[i]);
    printf("\n");
}

/* Every variable of the unit, and how each follows every other that may be derived. */
static void show_all(unit c)
{
    for (reference at = 0; at < FMU_VARIABLES; at++) {
        double *const value = malloc(sizeof *value);
        int *const mode = malloc(sizeof *mode);
        if (fmu_variables[at].kind == FMU_MODE) {
            good("mode", GET_INTEGER(c, &at, 1, mode));
            printf("%u: %d\n", at, *mode);
        } else {
            good("value", GET_REAL(c, &at, 1, value));
            printf("%u: %.17g\n", at, *value);
        }
        free(value), free(mode);
    }
}

static void slopes(unit c, int knowns, int unknowns)
{
    const double seed = 1.0;
    for (reference v = 0; v < FMU_VARIABLES; v++)
        for (reference u = 0; u < FMU_VARIABLES && fmu_variables[v].kind == knowns; u++) {
            double *const slope = malloc(sizeof *slope);
            if (fmu_variables[u].kind == unknowns && DERIVE(c, &u, 1, &v, 1, &seed, slope) == 0)
                printf("%u by %u: %.17g\n", u, v, *slope);
            free(slope);
        }
}

#ifdef FMI_3
static unit begin(int exchange, const char *token)
{
    unit c = exchange ? fmi3InstantiateModelExchange("c", token, NULL, 0, 0, NULL, NULL)
                      : fmi3InstantiateCoSimulation("c", token, NULL, 0, 0, 0, 0, NULL, 0, NULL,
                                                    NULL, NULL);
    good("initialize", fmi3EnterInitializationMode(c, 0, 0.0, 0.0, 0, 0.0));
    return c;
}

static int update(unit c, double *next)
{
    fmi3Boolean again, end, nominals, states, timed;
    good("update", fmi3UpdateDiscreteStates(c, &again, &end, &nominals, &states, &timed, next));
    if (!timed)
        *next = 1e300;
    return again;
}

static void stride(unit c, double t, double h)
{
    fmi3Boolean event, end, early;
    double last;
    good("step", fmi3DoStep(c, t, h, 1, &event, &end, &early, &last));
}

static void complete(unit c)
{
    fmi3Boolean event, end;
    good("complete", fmi3CompletedIntegratorStep(c, 1, &event, &end));
}
#else
static void *room(size_t count, size_t size)
{
    return malloc(count * size);
}

static unit begin(int exchange, const char *token)
{
    static const fmi2CallbackFunctions calls = {NULL, room, free, NULL, NULL};
    unit c = fmi2Instantiate("c", exchange ? fmi2ModelExchange : fmi2CoSimulation, token, NULL,
                             &calls, 0, 0);
    good("set up", fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0));
    good("initialize", fmi2EnterInitializationMode(c));
    return c;
}

static int update(unit c, double *next)
{
    fmi2EventInfo *const info = malloc(sizeof *info);
    good("update", fmi2NewDiscreteStates(c, info));
    const int again = info->newDiscreteStatesNeeded;
    *next = info->nextEventTimeDefined ? info->nextEventTime : 1e300;
    free(info);
    return again;
}

static void stride(unit c, double t, double h)
{
    good("step", fmi2DoStep(c, t, h, 1));
}

static void complete(unit c)
{
    fmi2Boolean event, end;
    good("complete", fmi2CompletedIntegratorStep(c, 1, &event, &end));
}
#endif

/* Explicit steps between the unit's time events; an event wherever an indicator changes its sign. */
static void exchange(unit c, double end, int count)
{
    double *const x = malloc(sizeof(double) * (FMU_STATES + 1));
    double *const rate = malloc(sizeof(double) * (FMU_STATES + 1));
    double *const now = malloc(sizeof(double) * (FMU_INDICATORS + 1));
    double *const then = malloc(sizeof(double) * (FMU_INDICATORS + 1)), next = 1e300, t = 0.0;
    good("exit", F(ExitInitializationMode)(c));
    while (update(c, &next))
        continue;
    good("continue", F(EnterContinuousTimeMode)(c));
    good("indicators", F(GetEventIndicators)(c, then, FMU_INDICATORS));
    for (int k = 0; k < count; k++) {
        const double to = t + end / count < next ? t + end / count : next, h = to - t;
        int event = to >= next;
        good("states", F(GetContinuousStates)(c, x, FMU_STATES));
        good("rates", RATES(c, rate, FMU_STATES));
        for (int i = 0; i < FMU_STATES; i++)
            x[i] += h * rate[i];
        good("time", F(SetTime)(c, t = to));
        good("set", F(SetContinuousStates)(c, x, FMU_STATES));
        good("indicators", F(GetEventIndicators)(c, now, FMU_INDICATORS));
        complete(c);
        for (int i = 0; i < FMU_INDICATORS; i++)
            event |= (now[i] > 0) != (then[i] > 0);
        for (int i = 0; i < FMU_INDICATORS; i++)
            then[i] = now[i];
        show("x", FMU_STATES, x);
        show("indicators", FMU_INDICATORS, now);
        if (!event)
            continue;
        good("event", F(EnterEventMode)(c));
        while (update(c, &next))
            continue;
        good("continue", F(EnterContinuousTimeMode)(c));
        good("indicators", F(GetEventIndicators)(c, then, FMU_INDICATORS));
    }
    slopes(c, FMU_VECTOR, FMU_RATE), slopes(c, FMU_INPUT, FMU_RATE), slopes(c, FMU_VECTOR, FMU_READING);
    free(x), free(rate), free(now), free(then);
}

static void simulate(unit c, double end, int count)
{
    SAVED saved = NULL;
    good("exit", F(ExitInitializationMode)(c));
    for (int k = 0; k < count; k++) {
        stride(c, end * k / count, end / count);
        if (k == count / 2)
            good("save", SAVE(c, &saved));
    }
    show_all(c);
    good("restore", RESTORE(c, saved));
    good("forget", FORGET(c, &saved));
}

int main(int count, char **words)
{
    const double end = count > 1 ? strtod(words[1], NULL) : 1.0;
    for (int kind = 0; kind < 2; kind++) {
        unit c = begin(kind, FMU_TOKEN);
        for (reference at = 0; at < FMU_VARIABLES; at++) {
            const double value = 0.25;
            if (fmu_variables[at].kind == FMU_INPUT)
                (void)SET_REAL(c, &at, 1, &value);
        }
        show_all(c);
        if (kind)
            exchange(c, end, 60);
        else
            simulate(c, end, 12);
        show_all(c);
        good("terminate", F(Terminate)(c));
        F(FreeInstance)(c);
    }
    return failures != 0;
}
