/* residual_table.c - reprojection errors by photo and by distance from the picture's centre. A photo with large errors
 * moved or was matched wrongly; errors that grow with the distance show a lens that does not fit (lens_fit.c). */
#include "stages/sfm_import/residual_table.h"

#include <stdlib.h>

#include "common/base/outfile.h"
#include "common/base/sort.h"
#include "common/product/product.h"

/* Statistics of the residuals of each key in [0, rows). */
static enum status fill_rows(struct residual_row *row, int rows, const struct lens_residual *residuals, const int *key,
                             size_t count, struct err *err)
{
    size_t *first = calloc((size_t)rows + 2, sizeof *first);
    double *error = malloc((count + 1) * sizeof *error), *radial = malloc((count + 1) * sizeof *radial);
    if (!first || !error || !radial) err_nomem(err, "residuals", count * sizeof *error);
    for (size_t i = 0; !err->status && i < count; i++) first[key[i] + 2]++;
    for (int k = 0; !err->status && k < rows; k++) first[k + 2] += first[k + 1];
    for (size_t i = 0; !err->status && i < count; i++) {
        const size_t at = first[key[i] + 1]++;
        error[at] = residuals[i].error;
        radial[at] = residuals[i].radial;
    }
    for (int k = 0; !err->status && k < rows; k++) {
        const size_t n = first[k + 1] - first[k];
        double *e = error + first[k], *r = radial + first[k];
        row[k] = (struct residual_row){.observations = (int)n};
        if (!n) continue;
        sort_doubles(e, n);
        sort_doubles(r, n);
        row[k].median = (e[(n - 1) / 2] + e[n / 2]) / 2;
        row[k].p90 = e[(n - 1) * 9 / 10];
        row[k].radial = (r[(n - 1) / 2] + r[n / 2]) / 2;
    }
    free(first);
    free(error);
    free(radial);
    return err->status;
}

enum status residual_table_make(struct residual_table *t, const struct lens_residual *residuals, const int *photo,
                                size_t count, int photo_count, struct err *err)
{
    int *ring = malloc((count + 1) * sizeof *ring);
    *t = (struct residual_table){.photo_count = photo_count};
    t->photos = calloc((size_t)photo_count + 1, sizeof *t->photos);
    if (!ring || !t->photos) err_nomem(err, "residuals", count * sizeof *ring);
    for (size_t i = 0; !err->status && i < count; i++)
        ring[i] = residuals[i].radius < 1 ? (int)(residuals[i].radius * RESIDUAL_RINGS) : RESIDUAL_RINGS - 1;
    if (!err->status && !fill_rows(t->photos, photo_count, residuals, photo, count, err))
        fill_rows(t->rings, RESIDUAL_RINGS, residuals, ring, count, err);
    free(ring);
    if (err->status) residual_table_release(t);
    return err->status;
}

void residual_table_release(struct residual_table *t)
{
    if (!t) return;
    free(t->photos);
    *t = (struct residual_table){0};
}

static void print_row(FILE *to, const struct residual_row *row)
{
    fprintf(to, " %d %.9g %.9g %.9g\n", row->observations, row->median, row->p90, row->radial);
}

enum status residual_table_write(const struct residual_table *t, const struct photo_list *photos, const char *path,
                                 const struct provenance *prov, struct err *err)
{
    struct outfile f = {0};
    if (!product_begin(&f, PRODUCT_RESIDUALS, path, prov, err)) {
        fputs("# photo ID observations median_px p90_px radial_px\n", f.fp);
        for (int i = 0; i < t->photo_count; i++) {
            if (!t->photos[i].observations) continue;
            fprintf(f.fp, "photo %s", photos->photos[i].id);
            print_row(f.fp, &t->photos[i]);
        }
        fputs("# radius FROM TO (0: centre, 1: corner) observations median_px p90_px radial_px\n", f.fp);
        for (int i = 0; i < RESIDUAL_RINGS; i++) {
            if (!t->rings[i].observations) continue;
            fprintf(f.fp, "radius %.1f %.1f", (double)i / RESIDUAL_RINGS, (i + 1.0) / RESIDUAL_RINGS);
            print_row(f.fp, &t->rings[i]);
        }
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
}
