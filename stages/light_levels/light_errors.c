/* light_errors.c - see light_errors.h.
 *
 * Intervals of 95 % become standard errors of logarithms, one to each side. A lamp's three colours are off together, so
 * the ends of its luminance are those of its colours. A lamp that is a lower bound may be brighter: up to BOUND times,
 * as saturated lamps of made rooms are. A sky is off by its misfit to what is seen. */
#include "stages/light_levels/light_errors.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/textfile.h"
#include "common/light/colour.h"
#include "common/product/product.h"

static const double BOUND = 4, LEAST = 0.1; /* no interval reaches below this part of a value */

void light_errors_release(struct light_errors *e)
{
    free(e->of);
    *e = (struct light_errors){0};
}

static struct group_error between(double value, double low, double high)
{
    if (!(value > 0)) return (struct group_error){0, 0};
    return (struct group_error){log(value / fmin(value, fmax(low, LEAST * value))) / LIGHT_NORMAL_95,
                                log(fmax(value, high) / value) / LIGHT_NORMAL_95};
}

/* ----------------------------------------------------------------------------------------------------------- lamps */

static enum status read_numbers(struct textfile *t, double *values, int count, const char *what, struct err *err)
{
    for (int i = 0; i < count; i++)
        if (textfile_number(t, what, 0, INFINITY, &values[i], err)) return err->status;
    return ST_OK;
}

static enum status read_lamp_name(int *lamp, struct textfile *t, const struct light_groups *g, struct err *err)
{
    const struct light_list *lights = &g->field->lights;
    char *name;
    if (textfile_word(t, "the name of a lamp", &name, err)) return err->status;
    for (*lamp = 0; *lamp < lights->lamp_count; ++*lamp)
        if (!strcmp(lights->lamps[*lamp].name, name)) return ST_OK;
    return textfile_error(t, err, name, "a lamp of lights.txt; fit the lights again");
}

/* Half widths of an interval; of a lower bound it has no upper end. */
static enum status read_lamp(struct light_errors *e, struct textfile *t, const struct light_groups *g, struct err *err)
{
    double v[6];
    char *source;
    int lamp = 0;
    if (read_lamp_name(&lamp, t, g, err) ||
        textfile_word(t, "given, fitted, measured, bound, unknown or unseen", &source, err) ||
        read_numbers(t, v, 6, "a colour", err))
        return err->status;
    const double value = luminance_of_doubles(v), half = luminance_of_doubles(v + 3);
    e->of[lamp] = between(value, value - half, (strcmp(source, "bound") != 0 ? 1 : BOUND) * (value + half));
    return ST_OK;
}

/* Follows the lamp's own line. */
static enum status read_range(struct light_errors *e, struct textfile *t, const struct light_groups *g, struct err *err)
{
    double v[6], ends[2][3];
    int lamp = 0;
    if (read_lamp_name(&lamp, t, g, err) || read_numbers(t, v, 6, "an end of an interval", err)) return err->status;
    for (int c = 0; c < 3; c++) {
        ends[0][c] = v[2 * c];
        ends[1][c] = v[2 * c + 1];
    }
    const struct rgb rgb = g->field->lights.lamps[lamp].radiance;
    const double value = luminance_of_doubles((const double[]){rgb.r, rgb.g, rgb.b});
    e->of[lamp] = between(value, luminance_of_doubles(ends[0]), luminance_of_doubles(ends[1]));
    return ST_OK;
}

/* ----------------------------------------------------------------------------------------------------- sky and sun */

static void set_windows(struct light_errors *e, const struct light_groups *g, int first, struct group_error error)
{
    for (int v = 0; v < g->windows_count; v++) e->of[first + v] = error;
}

static enum status skip_to(struct textfile *t, const char *wanted, struct err *err)
{
    char *word = NULL;
    do
        if (textfile_word(t, wanted, &word, err)) return err->status;
    while (strcmp(word, wanted) != 0);
    return ST_OK;
}

/* sky unknown, or TYPE brightest L misfit M */
static enum status read_sky_line(struct light_errors *e, struct textfile *t, const struct light_groups *g,
                                 struct err *err)
{
    double misfit;
    char *type;
    if (textfile_word(t, "a type of sky", &type, err) || !strcmp(type, "unknown")) return err->status;
    if (skip_to(t, "misfit", err) || textfile_number(t, "a misfit", 0, INFINITY, &misfit, err)) return err->status;
    set_windows(e, g, g->sky, (struct group_error){misfit, misfit});
    return ST_OK;
}

/* Only the light of a sun that was found by its patches has an interval. */
static enum status read_sun_line(struct light_errors *e, struct textfile *t, const struct light_groups *g,
                                 struct err *err)
{
    double rgb[3], error;
    char *how;
    if (textfile_word(t, "how the sun was found", &how, err) || strcmp(how, "patches") != 0) return err->status;
    if (skip_to(t, "irradiance", err) || read_numbers(t, rgb, 3, "an irradiance", err) ||
        textfile_expect(t, "error", err) || textfile_number(t, "an error", 0, INFINITY, &error, err))
        return err->status;
    set_windows(e, g, g->sun, between(1, 1 - error, 1 + error));
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------ files */

struct statement {
    const char *word;
    enum status (*read)(struct light_errors *e, struct textfile *t, const struct light_groups *g, struct err *err);
};

/* Reads the lines of a product that begin with one of two words; others say nothing of errors. */
static enum status read_statements(struct light_errors *e, enum product_id id, const char *path,
                                   const struct statement statements[2], const struct light_groups *g,
                                   struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    product_open(&t, NULL, id, path, prov, err);
    while (!err->status && textfile_next(&t)) {
        char *word;
        if (textfile_word(&t, "a statement", &word, err)) break;
        for (int i = 0; !err->status && i < 2; i++)
            if (!strcmp(word, statements[i].word)) statements[i].read(e, &t, g, err);
    }
    textfile_release(&t);
    return err->status;
}

enum status light_errors_read(struct light_errors *e, const char *fit, const char *sky, const struct light_groups *g,
                              struct provenance *prov, struct err *err)
{
    static const struct statement of_fit[2] = {{"lamp", read_lamp}, {"range", read_range}};
    static const struct statement of_sky[2] = {{"sky", read_sky_line}, {"sun", read_sun_line}};
    const struct light_list *lights = &g->field->lights;
    *e = (struct light_errors){calloc((size_t)g->patch + 1, sizeof *e->of), g->patch};
    if (!e->of) return err_nomem(err, "groups of light", (size_t)g->patch * sizeof *e->of);
    for (int i = 0; i < lights->lamp_count; i++)
        if (lights->lamps[i].bound) e->of[i] = between(1, 1, BOUND);
    if (fit && read_statements(e, PRODUCT_LIGHT_FIT, fit, of_fit, g, prov, err)) return err->status;
    return sky ? read_statements(e, PRODUCT_SKY, sky, of_sky, g, prov, err) : ST_OK;
}
