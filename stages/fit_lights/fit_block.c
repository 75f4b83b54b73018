/* fit_block.c - see fit_block.h. */
#include "stages/fit_lights/fit_block.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/cholesky.h"

/* ---------------------------------------------------------------------------------------------------------- blocks */

void fit_block_release(struct fit_block *b)
{
    free(b->marks);
    free(b->walls);
    free(b->column);
    free(b->wall_column);
    free(b->factors);
    free(b->designs);
    free(b->products);
    free(b->precision);
    free(b->y);
    free(b->z);
    free(b->b);
    free(b->offsets);
    free(b->next);
}

static double *numbers(size_t count) { return calloc(count + 1, sizeof(double)); }

/* The place of a number in a list, to whose end it is added if it is new. */
static int column_of(int *list, int *count, int number)
{
    int k = 0;
    while (k < *count && list[k] != number) k++;
    if (k == *count) list[(*count)++] = number;
    return k;
}

static void list_columns(struct fit_block *b, const struct light_fit *f)
{
    for (int i = 0; i < b->s.count; i++) {
        b->column[i] = column_of(b->marks, &b->mark_count, f->points[b->s.points[i]].mark);
        b->wall_column[i] = column_of(b->walls, &b->wall_count, f->points[b->s.points[i]].wall);
    }
    for (int i = 0; i < b->s.count; i++) b->wall_column[i] += b->mark_count;
    b->columns = b->mark_count + b->wall_count + 1; /* one is the mean */
}

/* The factor, design and product of a kind of texture. */
static void prepare_kind(struct fit_block *b, const struct problem *p, int k)
{
    const int n = b->s.count, m = b->columns;
    const double before = p->f->materials[b->material].deviation;
    const struct texture_kind kind = fit_texture_kind(k, b->s.longest);
    double *l = b->factors + (ptrdiff_t)k * n * n, *w = b->designs + (ptrdiff_t)k * n * m, *row = b->next;
    for (int i = 0; i < n; i++) {
        const int at = b->s.points[i];
        const double sigma = p->f->points[at].sigma;
        for (int j = 0; j < i; j++) l[i * n + j] = fit_texture_correlation(p->f, at, b->s.points[j], kind);
        l[i * n + i] = 1 + (sigma * sigma + 1e-8 + p->excess[at]) / (before * before);
    }
    b->usable[k] = cholesky_factor(l, n);
    if (!b->usable[k]) return;
    b->determinants[k] = 0;
    for (int i = 0; i < n; i++) b->determinants[k] += 2 * log(l[i * n + i]);
    for (int a = 0; a < m; a++) {
        for (int i = 0; i < n; i++) row[i] = a == m - 1 || a == b->column[i] || a == b->wall_column[i];
        cholesky_forward(l, n, row);
        for (int i = 0; i < n; i++) w[i * m + a] = row[i];
    }
    double *product = b->products + (ptrdiff_t)k * m * m;
    memset(product, 0, (size_t)m * (size_t)m * sizeof *product);
    for (int i = 0; i < n; i++)
        for (int a = 0; a < m; a++)
            for (int c = 0; c <= a; c++) product[a * m + c] += w[i * m + a] * w[i * m + c];
}

enum status fit_block_make(struct fit_block *b, const struct problem *p, int material, struct err *err)
{
    const struct light_fit *f = p->f;
    const struct fit_material *m = &f->materials[material];
    *b = (struct fit_block){.p = p, .material = material};
    b->s = fit_texture_sample(f, material);
    const size_t n = (size_t)b->s.count;
    b->marks = calloc(n + 1, sizeof *b->marks);
    b->walls = calloc(n + 1, sizeof *b->walls);
    b->column = calloc(n + 1, sizeof *b->column);
    b->wall_column = calloc(n + 1, sizeof *b->wall_column);
    if (!b->marks || !b->walls || !b->column || !b->wall_column) return err_nomem(err, "marks", n * sizeof *b->marks);
    list_columns(b, f);
    const size_t columns = (size_t)b->columns;
    b->factors = numbers(TEXTURE_KINDS * n * n);
    b->designs = numbers(TEXTURE_KINDS * n * columns);
    b->products = numbers(TEXTURE_KINDS * columns * columns);
    b->precision = numbers(columns * columns);
    b->y = numbers(3 * n);
    b->z = numbers(3 * n);
    b->b = numbers(3 * columns);
    b->offsets = numbers(3 * columns);
    b->next = numbers(3 * n + 2 * columns);
    if (!b->factors || !b->designs || !b->products || !b->precision || !b->y || !b->z || !b->b || !b->offsets ||
        !b->next)
        return err_nomem(err, "materials", TEXTURE_KINDS * n * n * sizeof(double));
    double nearest = INFINITY;
    for (int k = 0; n && k < TEXTURE_KINDS; k++) {
        const struct texture_kind kind = fit_texture_kind(k, b->s.longest);
        const double far = fabs(kind.length - m->length) + fabs(kind.grain - m->grain);
        prepare_kind(b, p, k);
        if (!b->usable[k]) continue;
        b->counts = true;
        if (far < nearest) {
            nearest = far;
            b->kind = k;
        }
    }
    b->variance = m->deviation * m->deviation;
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------ likelihood */

static void set_y(const struct fit_block *b, int colour, double *y)
{
    for (int i = 0; i < b->s.count; i++) {
        const int at = b->s.points[i];
        y[i] = log(b->p->f->points[at].radiance[colour] / fit_irradiance(b->p, at, colour)) - fit_usual_log_k_d();
    }
}

/* z and b of y. */
static void whiten(const struct fit_block *b, const double *y, double *z, double *products)
{
    const int n = b->s.count, m = b->columns;
    const double *w = b->designs + (ptrdiff_t)b->kind * n * m;
    memcpy(z, y, (size_t)n * sizeof *z);
    cholesky_forward(b->factors + (ptrdiff_t)b->kind * n * n, n, z);
    memset(products, 0, (size_t)m * sizeof *products);
    for (int i = 0; i < n; i++)
        for (int a = 0; a < m; a++) products[a] += w[i * m + a] * z[i];
    for (int a = 0; a < m; a++) products[a] /= b->variance;
}

static void set_precision(struct fit_block *b, const double *weights, double tau2)
{
    const int m = b->columns;
    const double *product = b->products + (ptrdiff_t)b->kind * m * m;
    for (int i = 0; i < m * m; i++) b->precision[i] = product[i] / b->variance;
    for (int a = 0; a < b->mark_count; a++) b->precision[a * m + a] += weights[b->marks[a]] / tau2;
    for (int a = b->mark_count; a + 1 < m; a++) b->precision[a * m + a] += 1 / b->p->f->wall_variance;
    b->precision[m * m - 1] += 1 / (ALBEDO_DEVIATION * ALBEDO_DEVIATION);
    cholesky_factor(b->precision, m); /* positive: a product and a positive diagonal */
}

/* log p, without the part that does not depend on S. row: room for the columns. */
static double likelihood(const struct fit_block *b, const double *z, const double *products, double *row)
{
    double sum = 0;
    memcpy(row, products, (size_t)b->columns * sizeof *row);
    cholesky_forward(b->precision, b->columns, row);
    for (int a = 0; a < b->columns; a++) sum += row[a] * row[a];
    for (int i = 0; i < b->s.count; i++) sum -= z[i] * z[i] / b->variance;
    return 0.5 * sum;
}

static double *colour_of(double *values, int colour, int count) { return values + (ptrdiff_t)colour * count; }

void fit_block_renew(struct fit_block *b, const double *weights, double tau2)
{
    set_precision(b, weights, tau2);
    for (int k = 0; k < 3; k++) {
        double *y = colour_of(b->y, k, b->s.count), *z = colour_of(b->z, k, b->s.count);
        double *products = colour_of(b->b, k, b->columns);
        set_y(b, k, y);
        whiten(b, y, z, products);
        b->likely[k] = likelihood(b, z, products, b->next);
    }
}

/* y, z, b stay in `next`. */
double fit_block_try(struct fit_block *b, int colour)
{
    const int n = b->s.count;
    double *y = b->next, *z = y + n, *products = z + n, *row = products + b->columns;
    set_y(b, colour, y);
    whiten(b, y, z, products);
    b->tried = likelihood(b, z, products, row);
    return b->tried - b->likely[colour];
}

void fit_block_keep(struct fit_block *b, int colour)
{
    const size_t n = (size_t)b->s.count;
    memcpy(colour_of(b->y, colour, b->s.count), b->next, n * sizeof(double));
    memcpy(colour_of(b->z, colour, b->s.count), b->next + n, n * sizeof(double));
    memcpy(colour_of(b->b, colour, b->columns), b->next + 2 * n, (size_t)b->columns * sizeof(double));
    b->likely[colour] = b->tried;
}

double fit_block_squares(struct fit_block *b, int colour, int kind)
{
    const int n = b->s.count, m = b->columns;
    const double *e = b->offsets + (ptrdiff_t)colour * m, *y = b->y + (ptrdiff_t)colour * n;
    double *row = b->next, sum = 0;
    for (int i = 0; i < n; i++) row[i] = y[i] - e[m - 1] - e[b->column[i]] - e[b->wall_column[i]];
    cholesky_forward(b->factors + (ptrdiff_t)kind * n * n, n, row);
    for (int i = 0; i < n; i++) sum += row[i] * row[i];
    return sum;
}

double fit_block_offset_square(const struct fit_block *b, int column)
{
    double sum = 0;
    for (int i = 0; i < 3; i++) sum += b->offsets[i * b->columns + column] * b->offsets[i * b->columns + column] / 3;
    return sum;
}
