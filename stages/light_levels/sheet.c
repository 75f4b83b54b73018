/* sheet.c - see sheet.h.
 *
 * Tabs separate columns, and the first line after the comments names them. Uniformity is the least value over the mean.
 * A row of an edit is compared with the row of the unedited room that has the same state, kind, place and unit. */
#include "stages/light_levels/sheet.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/outfile.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"
#include "common/product/product.h"

static void release_row(struct sheet_row *r)
{
    free(r->state);
    free(r->kind);
    free(r->place);
    free(r->unit);
}

void sheet_release(struct light_sheet *s)
{
    for (int i = 0; i < s->count; i++) release_row(&s->rows[i]);
    free(s->rows);
    *s = (struct light_sheet){0};
}

static enum status add_row(struct light_sheet *s, const char *state, const char *kind, const char *place,
                           const char *unit, struct err *err)
{
    if (array_append(&s->rows, (size_t)s->count, sizeof *s->rows, "rows", err)) return err->status;
    struct sheet_row *r = &s->rows[s->count];
    *r = (struct sheet_row){strdup(state), strdup(kind), strdup(place), strdup(unit), 0, 0, 0, 0, false, 0, 0};
    s->count++;
    return r->state && r->kind && r->place && r->unit ? ST_OK : err_nomem(err, "names", strlen(place));
}

enum status sheet_add(struct light_sheet *s, const char *state, const char *kind, const char *place, const char *unit,
                      const struct sheet_values *of, struct err *err)
{
    double sum = 0, weight = 0, least = INFINITY, most = 0;
    for (int i = 0; i < of->count; i++) {
        const double w = of->weights ? of->weights[i] : 1;
        sum += w * of->values[i];
        weight += w;
        least = fmin(least, of->values[i]);
        most = fmax(most, of->values[i]);
    }
    if (!(weight > 0) || add_row(s, state, kind, place, unit, err)) return err->status;
    struct sheet_row *r = &s->rows[s->count - 1];
    r->points = of->count;
    r->mean = sum / weight;
    r->has_interval = of->ends || of->high > 0;
    r->low = of->ends ? of->ends[0] : r->has_interval ? of->low * r->mean : r->mean;
    r->high = of->ends ? of->ends[1] : r->has_interval ? of->high * r->mean : r->mean;
    r->least = least;
    r->most = most;
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------ file */

enum { COLUMNS = 11 };
static const char *const names[COLUMNS] = {"state", "kind",  "place", "points",     "mean", "low",
                                           "high",  "least", "most",  "uniformity", "unit"};

static const struct sheet_row *find_row(const struct light_sheet *s, const struct sheet_row *like)
{
    for (int i = 0; i < s->count; i++) {
        const struct sheet_row *r = &s->rows[i];
        if (!strcmp(r->state, like->state) && !strcmp(r->kind, like->kind) && !strcmp(r->place, like->place) &&
            !strcmp(r->unit, like->unit))
            return r;
    }
    return NULL;
}

static void put_row(FILE *to, const struct sheet_row *r, const struct light_sheet *before)
{
    fprintf(to, "%s\t%s\t%s\t%d\t%.4g", r->state, r->kind, r->place, r->points, r->mean);
    if (r->has_interval)
        fprintf(to, "\t%.4g\t%.4g", r->low, r->high);
    else
        fprintf(to, "\t-\t-");
    fprintf(to, "\t%.4g\t%.4g\t%.3g\t%s", r->least, r->most, r->mean > 0 ? r->least / r->mean : 0, r->unit);
    if (before) {
        const struct sheet_row *was = find_row(before, r);
        if (was)
            fprintf(to, "\t%.4g\t%.4g", was->mean, r->mean - was->mean);
        else
            fprintf(to, "\t-\t-");
    }
    fprintf(to, "\n");
}

enum status sheet_write(const struct light_sheet *s, const struct light_sheet *before, const char *path,
                        const struct provenance *prov, struct err *err)
{
    struct outfile f = {0};
    if (product_begin(&f, PRODUCT_LIGHT_SHEET, path, prov, err)) return err->status;
    const locale_t was = uselocale(scan_c_locale());
    if (*s->note) fprintf(f.fp, "# %s\n", s->note);
    for (int i = 0; i < COLUMNS; i++) fprintf(f.fp, "%s%s", i ? "\t" : "", names[i]);
    fprintf(f.fp, before ? "\tbefore\tdifference\n" : "\n");
    for (int i = 0; i < s->count; i++) put_row(f.fp, &s->rows[i], before);
    uselocale(was);
    outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

/* An end of the interval; without one it is the mean. */
static enum status read_end(double *end, double mean, struct textfile *t, const char *what, struct err *err)
{
    char *word;
    *end = mean;
    if (textfile_word(t, what, &word, err) || !strcmp(word, "-")) return err->status;
    return textfile_number_of(t, word, what, 0, INFINITY, end, err);
}

static enum status read_row(struct light_sheet *s, struct textfile *t, struct err *err)
{
    char *word[3];
    int64_t points;
    double uniformity;
    for (int i = 0; i < 3; i++)
        if (textfile_word(t, names[i], &word[i], err)) return err->status;
    if (add_row(s, word[0], word[1], word[2], "", err)) return err->status;
    struct sheet_row *r = &s->rows[s->count - 1];
    if (textfile_int(t, "a number of points", 1, 1 << 30, &points, err) ||
        textfile_number(t, "a mean", 0, INFINITY, &r->mean, err) ||
        read_end(&r->low, r->mean, t, "the low end of the interval", err) ||
        read_end(&r->high, r->mean, t, "the high end of the interval", err) ||
        textfile_number(t, "the least", 0, INFINITY, &r->least, err) ||
        textfile_number(t, "the most", 0, INFINITY, &r->most, err) ||
        textfile_number(t, "a uniformity", 0, INFINITY, &uniformity, err) || textfile_word(t, "a unit", &word[0], err))
        return err->status;
    r->points = (int)points;
    free(r->unit);
    r->unit = strdup(word[0]);
    return r->unit ? ST_OK : err_nomem(err, "a unit", strlen(word[0]));
}

enum status sheet_read(struct light_sheet *s, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    *s = (struct light_sheet){0};
    if (product_open(&t, NULL, PRODUCT_LIGHT_SHEET, path, prov, err)) return err->status;
    textfile_expect_line(&t, names[0], err);
    while (!err->status && textfile_next(&t)) read_row(s, &t, err);
    textfile_release(&t);
    if (err->status) sheet_release(s);
    return err->status;
}
