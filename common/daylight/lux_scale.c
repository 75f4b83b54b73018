/* lux_scale.c - reads and writes lux/scale.txt; see lux_scale.h. */
#include "common/daylight/lux_scale.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/product/product.h"

enum { NAME_SIZE = 256 };
static const double LEAST = 1e-30, MOST = 1e30;
static const char *const kinds[] = {"illuminance", "luminance"};

static enum status read_interval(struct lux_interval *i, struct textfile *t, struct err *err)
{
    if (textfile_number(t, "a scale in cd/m2", LEAST, MOST, &i->scale, err) ||
        textfile_number(t, "the lower end of its interval", LEAST, i->scale, &i->low, err))
        return err->status;
    return textfile_number(t, "the upper end of its interval", i->scale, MOST, &i->high, err);
}

static enum status read_head(struct lux_scale *s, struct textfile *t, struct err *err)
{
    char *from;
    int64_t photos;
    if (textfile_expect_line(t, "scale", err) ||
        textfile_number(t, "a scale in cd/m2", LEAST, MOST, &s->is.scale, err) || textfile_end(t, err) ||
        textfile_expect_line(t, "interval", err) ||
        textfile_number(t, "the lower end of the interval", LEAST, s->is.scale, &s->is.low, err) ||
        textfile_number(t, "the upper end of the interval", s->is.scale, MOST, &s->is.high, err) ||
        textfile_end(t, err) || textfile_expect_line(t, "from", err) ||
        textfile_word(t, "\"exposure\" or \"measurements\"", &from, err))
        return err->status;
    s->measured = !strcmp(from, "measurements");
    if (!s->measured && strcmp(from, "exposure"))
        return textfile_error(t, err, from, "\"exposure\" or \"measurements\"");
    if (textfile_end(t, err) || textfile_expect_line(t, "exposure", err) ||
        textfile_int(t, "the number of photos", 0, INT_MAX, &photos, err))
        return err->status;
    s->photos = (int)photos;
    if (s->photos) {
        if (read_interval(&s->by_exposure, t, err)) return err->status;
    } else {
        for (int i = 0; i < 3; i++)
            if (textfile_expect(t, "0", err)) return err->status;
    }
    return textfile_end(t, err);
}

static enum status read_measurement(struct lux_measurement *m, struct textfile *t, struct err *err)
{
    char name[NAME_SIZE], *kind, *use;
    if (textfile_word_into(t, "the name of a measurement", name, sizeof name, err) ||
        textfile_word(t, "illuminance or luminance", &kind, err))
        return err->status;
    if (strcmp(kind, kinds[LUX_ILLUMINANCE]) && strcmp(kind, kinds[LUX_LUMINANCE]))
        return textfile_error(t, err, kind, "illuminance or luminance");
    m->kind = strcmp(kind, kinds[LUX_LUMINANCE]) ? LUX_ILLUMINANCE : LUX_LUMINANCE;
    if (textfile_number(t, "what was measured, in lx or cd/m2", LEAST, MOST, &m->value, err) ||
        textfile_number(t, "the same in the scene's unit", LEAST, MOST, &m->light, err) ||
        textfile_number(t, "the deviation expected", 0, MOST, &m->expected, err) ||
        textfile_double(t, "the deviation found", &m->deviation, err) || textfile_word(t, "used or off", &use, err))
        return err->status;
    m->off = !strcmp(use, "off");
    if (!m->off && strcmp(use, "used")) return textfile_error(t, err, use, "used or off");
    if (textfile_end(t, err)) return err->status;
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
    if (!err->status && s->measured && !s->count) textfile_error(&t, err, NULL, "a line \"measurement ...\"");
    textfile_release(&t);
    if (err->status) lux_scale_release(s);
    return err->status;
}

enum status lux_scale_write(const struct lux_scale *s, const char *path, const struct provenance *prov, struct err *err)
{
    struct outfile f = {0};
    if (product_begin(&f, PRODUCT_LUX_SCALE, path, prov, err)) return err->status;
    fprintf(f.fp, "scale %.17g\ninterval %.17g %.17g\nfrom %s\n", s->is.scale, s->is.low, s->is.high,
            s->measured ? "measurements" : "exposure");
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
