/* Tables with values of the caller's: the polynomials between their points, worked out anew. As
 * bondgraph/tables/pieces.py, which leaves that to scipy. */
#include <math.h>
#include <string.h>

#include "model_internal.h"

/* Numbers that do not lie side by side. */
typedef struct {
    const double *from;
    int step;
} strided;

static double at(strided of, int i)
{
    return of.from[i * of.step];
}

/* The slope of the line from a point to the next. */
static double chord(const double *x, strided z, int i)
{
    return (at(z, i + 1) - at(z, i)) / (x[i + 1] - x[i]);
}

/* The cubic with these values and slopes at the ends of a length, highest power first. */
static void hermite(double length, double z0, double z1, double slope0, double slope1, double *out)
{
    const double mean = (z1 - z0) / length, bend = (slope0 + slope1 - 2 * mean) / length;
    out[0] = bend / length;
    out[1] = (mean - slope0) / length - bend;
    out[2] = slope0;
    out[3] = z0;
}

/* At an end, from the two lengths and chords next to it (Moler 2004, 3.6). */
static double pchip_end(double h0, double h1, double m0, double m1)
{
    const double slope = ((2 * h0 + h1) * m0 - h0 * m1) / (h0 + h1);
    if (bg_sign(slope) != bg_sign(m0))
        return 0.0;
    return bg_sign(m0) != bg_sign(m1) && fabs(slope) > 3 * fabs(m0) ? 3 * m0 : slope;
}

static void pchip_slopes(int count, const double *x, strided z, double *slopes)
{
    const int last = count - 1;
    if (count == 2) {
        slopes[0] = slopes[1] = chord(x, z, 0);
        return;
    }
    for (int i = 1; i < last; i++) {
        const double before = x[i] - x[i - 1], after = x[i + 1] - x[i];
        const double m0 = chord(x, z, i - 1), m1 = chord(x, z, i);
        const double w0 = 2 * after + before, w1 = after + 2 * before;
        const int level = bg_sign(m0) != bg_sign(m1) || m0 == 0.0;
        slopes[i] = level ? 0.0 : (w0 + w1) / (w0 / m0 + w1 / m1);
    }
    slopes[0] = pchip_end(x[1] - x[0], x[2] - x[1], chord(x, z, 0), chord(x, z, 1));
    slopes[last] = pchip_end(x[last] - x[last - 1], x[last - 1] - x[last - 2],
                             chord(x, z, last - 1), chord(x, z, last - 2));
}

/* Of each point the two chords before it and the two after it count, of which two beyond either end
 * go on as the last two do. */
static void akima_slopes(int count, const double *x, strided z, double *slopes, double *chords)
{
    double *const m = chords + 2;
    double most = 0.0;
    for (int i = 0; i + 1 < count; i++)
        m[i] = chord(x, z, i);
    m[-1] = 2 * m[0] - m[1];
    m[-2] = 2 * m[-1] - m[0];
    m[count - 1] = 2 * m[count - 2] - m[count - 3];
    m[count] = 2 * m[count - 1] - m[count - 2];
    for (int i = 0; i < count; i++)
        most = fmax(most, fabs(m[i + 1] - m[i]) + fabs(m[i - 1] - m[i - 2]));
    for (int i = 0; i < count; i++) {
        const double after = fabs(m[i + 1] - m[i]), before = fabs(m[i - 1] - m[i - 2]);
        const int none = !(after + before > BG_AKIMA_LEVEL * most);
        slopes[i] = none ? 0.5 * (m[i + 1] + m[i - 2])
                         : m[i - 1] + before / (after + before) * (m[i] - m[i - 1]);
    }
}

/* Those of the cubic spline without knots beside its ends; `upper`: room for so many. */
static void spline_slopes(int count, const double *x, strided z, double *slopes, int step,
                          double *upper)
{
    const int last = count - 1;
    double a = x[1] - x[0], b = x[2] - x[1], both = a + b, pivot = b;
    upper[0] = both / pivot;
    slopes[0] = ((a + 2 * both) * b * chord(x, z, 0) + a * a * chord(x, z, 1)) / both / pivot;
    for (int i = 1; i < last; i++) {
        a = x[i] - x[i - 1];
        b = x[i + 1] - x[i];
        pivot = 2 * (a + b) - b * upper[i - 1];
        upper[i] = a / pivot;
        slopes[i * step] = (3 * (b * chord(x, z, i - 1) + a * chord(x, z, i))
                            - b * slopes[(i - 1) * step]) / pivot;
    }
    a = x[last - 1] - x[last - 2];
    b = x[last] - x[last - 1];
    both = a + b;
    pivot = a - both * upper[last - 1];
    slopes[last * step] = b * b * chord(x, z, last - 2) / both;
    slopes[last * step] += (2 * both + b) * a * chord(x, z, last - 1) / both;
    slopes[last * step] -= both * slopes[(last - 1) * step];
    slopes[last * step] /= pivot;
    for (int i = last - 1; i >= 0; i--)
        slopes[i * step] -= upper[i] * slopes[(i + 1) * step];
}

static void fit_line(const bg_table *of, double *factors, double *work)
{
    const strided z = {of->values, 1};
    double *const slopes = work;
    const double *const x = of->points[0];
    const int count = of->counts[0];
    if (of->method == BG_TABLE_PCHIP)
        pchip_slopes(count, x, z, slopes);
    else if (of->method == BG_TABLE_AKIMA)
        akima_slopes(count, x, z, slopes, work + count);
    for (int i = 0; i + 1 < count; i++) {
        if (of->degree == 1) {
            factors[2 * i] = chord(x, z, i);
            factors[2 * i + 1] = at(z, i);
        } else {
            hermite(x[i + 1] - x[i], at(z, i), at(z, i + 1), slopes[i], slopes[i + 1],
                    factors + 4 * i);
        }
    }
}

static void fit_bilinear(const bg_table *of, double *factors)
{
    const double *const x = of->points[0], *const y = of->points[1];
    const int rows = of->counts[0], columns = of->counts[1];
    for (int i = 0; i + 1 < rows; i++)
        for (int j = 0; j + 1 < columns; j++, factors += 4) {
            const double *const z = of->values + i * columns + j;
            const double h = x[i + 1] - x[i], low = (z[columns] - z[0]) / h;
            factors[0] = ((z[columns + 1] - z[1]) / h - low) / (y[j + 1] - y[j]);
            factors[1] = low;
            factors[2] = (z[1] - z[0]) / (y[j + 1] - y[j]);
            factors[3] = z[0];
        }
}

/* The point where a cell between knots begins, which those beside the ends are not; of that beyond
 * the last where that ends. */
static int point_of(const bg_table *of, int axis, int cell)
{
    return cell == 0 ? 0 : cell == of->cells[axis] ? of->counts[axis] - 1 : cell + 1;
}

/* A cell's polynomial by values and slopes at its corners. */
static void fit_patch(const bg_table *of, int i, int j, const double *const *slopes, double *out)
{
    const int ends[2] = {point_of(of, 0, i), point_of(of, 0, i + 1)};
    const int left = point_of(of, 1, j), right = point_of(of, 1, j + 1);
    const double h = of->points[0][ends[1]] - of->points[0][ends[0]];
    const double w = of->points[1][right] - of->points[1][left];
    double rows[4][4], column[4];
    for (int end = 0; end < 2; end++) {
        const int a = ends[end] * of->counts[1] + left, b = a + right - left;
        hermite(w, of->values[a], of->values[b], slopes[1][a], slopes[1][b], rows[end]);
        hermite(w, slopes[0][a], slopes[0][b], slopes[2][a], slopes[2][b], rows[2 + end]);
    }
    for (int q = 0; q < 4; q++) {
        hermite(h, rows[0][q], rows[1][q], rows[2][q], rows[3][q], column);
        for (int p = 0; p < 4; p++)
            out[4 * p + q] = column[p];
    }
}

static void fit_bicubic(const bg_table *of, double *factors, double *work)
{
    const int rows = of->counts[0], columns = of->counts[1], all = rows * columns;
    double *const along_x = work, *const along_y = work + all, *const both = work + 2 * all;
    const double *const slopes[3] = {along_x, along_y, both};
    double *const room = work + 3 * all;
    for (int j = 0; j < columns; j++)
        spline_slopes(rows, of->points[0], (strided){of->values + j, columns}, along_x + j, columns,
                      room);
    for (int i = 0; i < rows; i++) {
        const int k = i * columns;
        spline_slopes(columns, of->points[1], (strided){of->values + k, 1}, along_y + k, 1, room);
        spline_slopes(columns, of->points[1], (strided){along_x + k, 1}, both + k, 1, room);
    }
    for (int i = 0; i < of->cells[0]; i++)
        for (int j = 0; j < of->cells[1]; j++, factors += 16)
            fit_patch(of, i, j, slopes, factors);
}

/* A bound on the slope over one axis between the ends. */
static double steepest(const bg_table *of)
{
    double found = 0.0;
    for (int i = 0; i < of->cells[0]; i++) {
        const double width = of->breaks[0][i + 1] - of->breaks[0][i];
        const double *const factors = of->factors + i * (of->degree + 1);
        double sum = 0.0;
        for (int power = of->degree; power > 0; power--)
            sum = sum * width + power * fabs(factors[of->degree - power]);
        found = fmax(found, sum);
    }
    return found;
}

static int cells_of(const bg_table *of)
{
    return of->counts[0] * of->counts[1];
}

static int factors_of(const bg_table *of)
{
    const int size = of->degree + 1, cells = of->cells[0] * of->cells[1];
    return cells * size * (of->points[1] ? size : 1);
}

void bg_tables_init(bg_own_tables *own)
{
    for (int i = 0; i < BG_TABLES; i++)
        own->tables[i] = bg_tables[i];
}

double *bg_tables_values(bg_own_tables *own, int table)
{
    int values = 0;
    for (int i = 0; i < table; i++)
        values += cells_of(bg_tables + i);
    bg_table *const of = own->tables + table;
    double *const mine = own->values + values;
    if (of->values != mine)
        memcpy(mine, of->values, sizeof(double) * (size_t)cells_of(of));
    of->values = mine;
    return mine;
}

int bg_tables_fit(bg_own_tables *own, int table)
{
    bg_table *const of = own->tables + table;
    double *factors = own->factors;
    for (int i = 0; i < table; i++)
        factors += factors_of(bg_tables + i);
    (void)bg_tables_values(own, table);
    of->factors = factors;
    if (!of->points[1])
        fit_line(of, factors, own->work);
    else if (of->degree == 1)
        fit_bilinear(of, factors);
    else
        fit_bicubic(of, factors, own->work);
    of->steepest = of->points[1] ? 0.0 : steepest(of);
    return bg_finite(factors_of(of), factors) ? BG_OK : BG_TABLE_VALUE;
}

int bg_tables_set(bg_own_tables *own, int table, const double *values)
{
    const int known = table >= 0 && table < BG_TABLES;
    const int fixed = !known || bg_tables[table].method == BG_TABLE_FIXED;
    const int count = fixed ? 0 : cells_of(bg_tables + table);
    if (count == 0 || !bg_finite(count, values))
        return BG_TABLE_VALUE;
    memcpy(bg_tables_values(own, table), values, sizeof(double) * (size_t)count);
    return bg_tables_fit(own, table);
}
