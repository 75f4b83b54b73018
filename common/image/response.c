/* response.c - reads and evaluates response curves. */
#include "common/image/response.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/textfile.h"
#include "common/product/product.h"

float response_light(const struct response *r, int colour, float sample)
{
    if (!r->table && !r->space) return linear_from_srgb(sample);
    const int levels = r->table ? RESPONSE_LEVELS : r->space->levels;
    const float *light = r->table ? r->light[colour] : r->space->light + colour * levels;
    const float at = (sample > 0 ? sample < 1 ? sample : 1 : 0) * (float)(levels - 1);
    const int below = at < (float)(levels - 2) ? (int)at : levels - 2;
    return light[below] + (at - (float)below) * (light[below + 1] - light[below]);
}

float *response_tables(const struct response *r, int bits, struct err *err)
{
    const size_t levels = bits == 16 ? 65536 : 256;
    float *tables = malloc(3 * levels * sizeof *tables);
    if (!tables) err_nomem(err, "tone curves", 3 * levels * sizeof *tables);
    for (int c = 0; tables && c < 3; c++) {
        float *to = tables + (size_t)c * levels;
        if (c && !r->table && !r->space)
            memcpy(to, tables, levels * sizeof *to);
        else
            for (size_t i = 0; i < levels; i++) to[i] = response_light(r, c, (float)i / (float)(levels - 1));
    }
    return tables;
}

static enum status read_levels(struct response *r, struct textfile *t, struct err *err)
{
    static const char *const colours[] = {"red", "green", "blue"};
    for (int i = 0; !err->status && i < RESPONSE_LEVELS; i++) {
        if (!textfile_next(t)) return textfile_error(t, err, NULL, "%d lines \"R G B\", not %d", RESPONSE_LEVELS, i);
        for (int c = 0; !err->status && c < 3; c++) {
            double light = 0;
            char found[32];
            if (textfile_double(t, colours[c], &light, err)) break;
            snprintf(found, sizeof found, "%.9g", light);
            if (light < 0 || light > 1e6)
                textfile_error(t, err, found, "light from 0 to 1e6");
            else if (i && (float)light < r->light[c][i - 1])
                textfile_error(t, err, found, "a curve that does not fall (%s)", colours[c]);
            r->light[c][i] = (float)light;
        }
        if (!err->status) textfile_end(t, err);
    }
    for (int c = 0; !err->status && c < 3; c++)
        if (!(r->light[c][RESPONSE_LEVELS - 1] > r->light[c][0]))
            textfile_error(t, err, "a constant curve", "a curve that rises (%s)", colours[c]);
    return err->status;
}

enum status response_read(struct response *r, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    char *curve = NULL;
    int64_t number = 0;
    *r = (struct response){0};
    if (!product_open(&t, NULL, PRODUCT_RESPONSE, path, prov, err) && !textfile_expect_line(&t, "curve", err))
        textfile_word(&t, "srgb or table", &curve, err);
    if (!err->status && strcmp(curve, "srgb") && strcmp(curve, "table"))
        textfile_error(&t, err, curve, "srgb or table");
    if (!err->status && !strcmp(curve, "table")) {
        r->table = true;
        textfile_int(&t, "number of levels", RESPONSE_LEVELS, RESPONSE_LEVELS, &number, err);
    }
    if (!err->status) textfile_end(&t, err);
    if (!err->status && r->table) read_levels(r, &t, err);
    if (!err->status) textfile_end_of_file(&t, err);
    textfile_release(&t);
    if (err->status) *r = (struct response){0};
    return err->status;
}
