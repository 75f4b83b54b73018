/* light_record.c - see light_record.h. */
#include "common/gather/light_record.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

#include "common/product/product.h"

static const char *const words[LIGHT_SOURCES] = {"none",        "texture", "synthesised", "sky",
                                                 "sky-guessed", "lamp",    "material",    "object"};

enum status light_record_write(const struct light_record *r, const char *path, const struct provenance *prov,
                               struct err *err)
{
    struct outfile f = {0};
    if (product_begin(&f, PRODUCT_LIGHT_RECORD, path, prov, err)) return err->status;
    fprintf(f.fp, "points %d dark %d\nerror %.4g %.4g %.4g\nshares", r->points, r->dark, r->error[0], r->error[1],
            r->error[2]);
    for (int s = 0; s < LIGHT_SOURCES; s++) fprintf(f.fp, " %s %.6f", words[s], r->from[s]);
    fputc('\n', f.fp);
    if (r->level[1] > 0) fprintf(f.fp, "level %.6g %.6g\n", r->level[0], r->level[1]);
    for (int i = 0; i < r->example_count; i++) {
        const struct light_example *e = &r->examples[i];
        const struct vec3 p = e->point.at, n = e->point.normal;
        fprintf(f.fp, "hemicube %d %.6g %.6g %.6g %.6g %.6g %.6g %.6g %.6g %.6g %.4g\n", i + 1, p.x, p.y, p.z, n.x, n.y,
                n.z, e->value.r, e->value.g, e->value.b, e->error);
    }
    outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- reading */

static enum status read_numbers(struct textfile *t, double *values, int count, double least, double most,
                                struct err *err)
{
    for (int i = 0; i < count; i++) {
        char found[32];
        if (textfile_double(t, "a number", &values[i], err)) return err->status;
        snprintf(found, sizeof found, "%.9g", values[i]);
        if (!(values[i] >= least && values[i] <= most))
            return textfile_error(t, err, found, "a number from %g to %g", least, most);
    }
    return ST_OK;
}

static enum status read_count(struct textfile *t, const char *what, int least, int most, int *count, struct err *err)
{
    int64_t value = 0;
    if (textfile_int(t, what, least, most, &value, err)) return err->status;
    *count = (int)value;
    return ST_OK;
}

static enum status read_shares(struct light_record *r, struct textfile *t, struct err *err)
{
    for (int s = 0; s < LIGHT_SOURCES; s++)
        if (textfile_expect(t, words[s], err) || read_numbers(t, &r->from[s], 1, 0, 1.001, err)) return err->status;
    return ST_OK;
}

static enum status read_example(struct light_record *r, struct textfile *t, struct err *err)
{
    double place[6], light[4];
    int number;
    if (r->example_count == LIGHT_EXAMPLES_MAX)
        return textfile_error(t, err, "another hemicube", "at most %d", LIGHT_EXAMPLES_MAX);
    if (read_count(t, "the number of a hemicube", r->example_count + 1, r->example_count + 1, &number, err) ||
        read_numbers(t, place, 6, -1e9, 1e9, err) || read_numbers(t, light, 4, 0, 1e12, err))
        return err->status;
    struct light_example *e = &r->examples[r->example_count++];
    e->point = (struct gather_point){{place[0], place[1], place[2]}, {place[3], place[4], place[5]}};
    e->value = rgb_make(light[0], light[1], light[2]);
    e->error = light[3];
    return ST_OK;
}

static enum status read_statement(struct light_record *r, struct textfile *t, struct err *err)
{
    char *word;
    if (textfile_word(t, "a statement", &word, err)) return err->status;
    if (!strcmp(word, "points"))
        return read_count(t, "a number of points", 0, INT_MAX, &r->points, err) || textfile_expect(t, "dark", err)
                   ? err->status
                   : read_count(t, "a number of points", 0, r->points, &r->dark, err);
    if (!strcmp(word, "error")) return read_numbers(t, r->error, 3, 0, 1e12, err);
    if (!strcmp(word, "shares")) return read_shares(r, t, err);
    if (!strcmp(word, "level")) return read_numbers(t, r->level, 2, 0, 1e12, err);
    if (!strcmp(word, "hemicube")) return read_example(r, t, err);
    return textfile_error(t, err, word, "points, error, shares, level or hemicube");
}

enum status light_record_read(struct light_record *r, const char *path, struct err *err)
{
    struct textfile t = {0};
    *r = (struct light_record){0};
    product_open(&t, NULL, PRODUCT_LIGHT_RECORD, path, NULL, err);
    while (!err->status && textfile_next(&t))
        if (!read_statement(r, &t, err)) textfile_end(&t, err);
    textfile_release(&t);
    return err->status;
}
