/* lux_scale.c - reads and writes lux/scale.txt; see lux_scale.h. */
#include "common/daylight/lux_scale.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/daylight/sky_luminance.h"
#include "common/product/product.h"

enum { NAME_SIZE = 256 };
static const double LEAST = 1e-30, MOST = 1e30;
static const char *const sources[] = {"unknown", "exposure", "measurements"};
static const char *const kinds[] = {"illuminance", "luminance"};

/* The index of a word among `count`. */
static enum status read_choice(int *choice, const char *const *words, int count, const char *wanted, struct textfile *t,
                               struct err *err)
{
    char *word;
    if (textfile_word(t, wanted, &word, err)) return err->status;
    for (*choice = 0; *choice < count; ++*choice)
        if (!strcmp(word, words[*choice])) return ST_OK;
    return textfile_error(t, err, word, "%s", wanted);
}

static enum status read_scale(double *scale, struct textfile *t, struct err *err)
{
    return textfile_number(t, "a scale in cd/m2", 0, MOST, scale, err);
}

static enum status read_ends(struct lux_interval *i, struct textfile *t, struct err *err)
{
    return textfile_number(t, "the lower end of the interval, above 0 and up to the scale", i->scale > 0 ? LEAST : 0,
                           i->scale, &i->low, err) ||
                   textfile_number(t, "the upper end of the interval, from the scale on", i->scale,
                                   i->scale > 0 ? MOST : 0, &i->high, err) ||
                   textfile_end(t, err)
               ? err->status
               : ST_OK;
}

static enum status read_head(struct lux_scale *s, struct textfile *t, struct err *err)
{
    int from = 0;
    int64_t photos;
    if (textfile_expect_line(t, "scale", err) || read_scale(&s->is.scale, t, err) || textfile_end(t, err) ||
        textfile_expect_line(t, "interval", err) || read_ends(&s->is, t, err) || textfile_expect_line(t, "from", err) ||
        read_choice(&from, sources, 3, "unknown, exposure or measurements", t, err))
        return err->status;
    s->from = (enum lux_source)from;
    if ((s->from == LUX_UNKNOWN) != (s->is.scale == 0))
        return textfile_error(t, err, sources[from], "unknown for a scale of 0, and for no other");
    if (textfile_end(t, err) || textfile_expect_line(t, "exposure", err) ||
        textfile_int(t, "the number of photos", 0, INT_MAX, &photos, err) || read_scale(&s->by_exposure.scale, t, err))
        return err->status;
    s->photos = (int)photos;
    if ((s->photos == 0) != (s->by_exposure.scale == 0))
        return textfile_error(t, err, NULL, "a scale of 0 without photos, and above 0 with some");
    return read_ends(&s->by_exposure, t, err);
}

static enum status read_measurement(struct lux_measurement *m, struct textfile *t, struct err *err)
{
    static const char *const uses[] = {"used", "off"};
    char name[NAME_SIZE];
    int kind = 0, use = 0;
    if (textfile_word_into(t, "the name of a measurement", name, sizeof name, err) ||
        read_choice(&kind, kinds, 2, "illuminance or luminance", t, err))
        return err->status;
    if (textfile_number(t, "what was measured, in lx or cd/m2", LEAST, MOST, &m->value, err) ||
        textfile_number(t, "the same in the scene's unit", LEAST, MOST, &m->light, err) ||
        textfile_number(t, "the deviation expected", 0, MOST, &m->expected, err) ||
        textfile_double(t, "the deviation found", &m->deviation, err) ||
        read_choice(&use, uses, 2, "used or off", t, err) || textfile_end(t, err))
        return err->status;
    m->kind = (enum lux_kind)kind;
    m->off = use == 1;
    m->name = strdup(name);
    return m->name ? ST_OK : err_nomem(err, "a name", strlen(name) + 1);
}

enum status lux_scale_read(struct lux_scale *s, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    *s = (struct lux_scale){0};
    if (product_open(&t, NULL, PRODUCT_LUX_SCALE, path, prov, err)) return err->status;
    read_head(s, &t, err);
    while (!err->status && textfile_next(&t)) {
        if (textfile_expect(&t, "measurement", err) ||
            array_append(&s->measurements, (size_t)s->count, sizeof *s->measurements, "measurements", err))
            break;
        s->measurements[s->count] = (struct lux_measurement){0};
        if (!read_measurement(&s->measurements[s->count], &t, err)) s->count++;
    }
    if (!err->status && s->from == LUX_MEASUREMENTS && !s->count)
        textfile_error(&t, err, NULL, "a line \"measurement ...\"");
    textfile_release(&t);
    if (err->status) lux_scale_release(s);
    return err->status;
}

enum status lux_scale_write(const struct lux_scale *s, const char *path, const struct provenance *prov, struct err *err)
{
    struct outfile f = {0};
    if (product_begin(&f, PRODUCT_LUX_SCALE, path, prov, err)) return err->status;
    if (s->is.scale > 0)
        fprintf(f.fp, "# in Radiance's unit, by %g lm/W: %.6g W/m2/sr\n", WHITE_EFFICACY, s->is.scale / WHITE_EFFICACY);
    fprintf(f.fp, "scale %.17g\ninterval %.17g %.17g\nfrom %s\n", s->is.scale, s->is.low, s->is.high, sources[s->from]);
    fprintf(f.fp, "exposure %d %.17g %.17g %.17g\n", s->photos, s->by_exposure.scale, s->by_exposure.low,
            s->by_exposure.high);
    for (int i = 0; !err->status && i < s->count; i++) {
        const struct lux_measurement *m = &s->measurements[i];
        char name[2 * NAME_SIZE + 3];
        if (textfile_quote(m->name, name, sizeof name, err)) break;
        fprintf(f.fp, "measurement %s %s %.17g %.17g %.9g %.9g %s\n", name, kinds[m->kind], m->value, m->light,
                m->expected, m->deviation, m->off ? "off" : "used");
    }
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

void lux_scale_release(struct lux_scale *s)
{
    for (int i = 0; i < s->count; i++) free(s->measurements[i].name);
    free(s->measurements);
    *s = (struct lux_scale){0};
}
