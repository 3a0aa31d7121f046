/* Values of tables: one by one, or all of a table at once; axes are only told. What is between the
 * points is worked out once it is asked for. Saved states have the values, too. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "fmu_common.h"

static size_t points_of(int table)
{
    return (size_t)(bg_tables[table].counts[0] * bg_tables[table].counts[1]);
}

size_t fmu_size(unsigned reference)
{
    const fmu_variable *const v = &fmu_variables[reference];
    if (v->kind == FMU_TABLE)
        return points_of(v->index);
    return v->kind == FMU_AXIS ? (size_t)bg_tables[v->index / 2].counts[v->index % 2] : 1;
}

size_t fmu_sizes(const unsigned *references, size_t count)
{
    size_t all = 0;
    for (size_t i = 0; i < count; i++)
        all += references[i] < FMU_VARIABLES ? fmu_size(references[i]) : 1;
    return all;
}

/* The table that one of all tables' values is of, and which it is there. */
static int table_of(int index, int *at)
{
    int table = 0;
    for (*at = index; *at >= (int)points_of(table); table++)
        *at -= (int)points_of(table);
    return table;
}

void fmu_get_table(const fmu_instance *f, unsigned reference, double *values)
{
    const fmu_variable *const v = &fmu_variables[reference];
    const size_t bytes = fmu_size(reference) * sizeof *values;
    int at = 0, table = v->index;
    if (v->kind == FMU_AXIS) {
        memcpy(values, bg_tables[v->index / 2].points[v->index % 2], bytes);
        return;
    }
    if (v->kind == FMU_TABLE_VALUE)
        table = table_of(v->index, &at);
    memcpy(values, f->own.tables[table].values + at, bytes);
}

/* What is no number, by its row and column. */
static fmu_error no_number(fmu_instance *f, int table, int at, double value)
{
    const int columns = bg_tables[table].counts[1];
    if (bg_tables[table].points[1])
        snprintf(f->text, sizeof f->text, "table %.120s, row %d, column %d: %g is not finite",
                 bg_lookup_names[table], at / columns + 1, at % columns + 1, value);
    else
        snprintf(f->text, sizeof f->text, "table %.120s, row %d: %g is not finite",
                 bg_lookup_names[table], at + 1, value);
    return f->text;
}

fmu_error fmu_set_table(fmu_instance *f, unsigned reference, const double *values)
{
    const fmu_variable *const v = &fmu_variables[reference];
    const size_t count = fmu_size(reference);
    int at = 0, table = v->index;
    if (v->kind == FMU_AXIS)
        return "the axes of a table cannot be set";
    if (fmu_tunable(f))
        return fmu_tunable(f);
    if (v->kind == FMU_TABLE_VALUE)
        table = table_of(v->index, &at);
    if (bg_tables[table].method == BG_TABLE_FIXED)
        return "a table that is turned round keeps its values";
    for (size_t i = 0; i < count; i++)
        if (!isfinite(values[i]))
            return no_number(f, table, at + (int)i, values[i]);
    if (memcmp(f->own.tables[table].values + at, values, count * sizeof *values) == 0)
        return NULL;
    memcpy(bg_tables_values(&f->own, table) + at, values, count * sizeof *values);
    f->retabled[table] = f->changed = f->stale = 1;
    return NULL;
}

fmu_error fmu_fit_tables(fmu_instance *f)
{
    for (int i = 0; i < BG_TABLES; i++)
        if (f->retabled[i]) {
            if (bg_tables_fit(&f->own, i) != BG_OK) {
                snprintf(f->text, sizeof f->text,
                         "table %.120s: what is between its values is not finite",
                         bg_lookup_names[i]);
                return f->text;
            }
            f->retabled[i] = 0;
        }
    return NULL;
}

fmu_error fmu_save(const fmu_instance *f, fmu_saved *to)
{
    double *values = to ? to->tables : NULL;
    if (!to)
        return "no memory for the state";
    to->at = f->at;
    to->memory = f->model.memory;
    values[0] = 0.0;
    for (int i = 0; i < BG_TABLES; values += points_of(i), i++)
        memcpy(values, f->own.tables[i].values, points_of(i) * sizeof *values);
    return NULL;
}

void fmu_load(fmu_instance *f, const fmu_saved *from)
{
    const double *values = from->tables;
    fmu_restore(f, &from->at);
    f->model.memory = from->memory;
    for (int i = 0; i < BG_TABLES; values += points_of(i), i++) {
        const size_t bytes = points_of(i) * sizeof *values;
        if (memcmp(f->own.tables[i].values, values, bytes) != 0) {
            memcpy(bg_tables_values(&f->own, i), values, bytes);
            f->retabled[i] = 1;
        }
    }
}
