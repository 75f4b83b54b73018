/* lux_marks.c - reads lux.txt as people write it; see lux_marks.h. */
#include "stages/calibrate_light/lux_marks.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"

enum { NAME_SIZE = 256 };

static enum status copy_word(struct textfile *t, const char *what, char **to, struct err *err)
{
    char word[NAME_SIZE];
    if (textfile_word_into(t, what, word, sizeof word, err)) return err->status;
    if (strchr(word, '\r')) return textfile_error(t, err, word, "%s without a line break", what);
    *to = strdup(word);
    return *to ? ST_OK : err_nomem(err, what, strlen(word) + 1);
}

static enum status read_pixel(struct lux_mark *m, const char *x, struct textfile *t, struct err *err)
{
    double *to = m->pixel + 2 * m->pixels++;
    return textfile_number_of(t, x, "a pixel's x", 0, 1e6, &to[0], err) ||
                   textfile_number(t, "a pixel's y", 0, 1e6, &to[1], err)
               ? err->status
               : ST_OK;
}

/* "in VIEW X Y [X Y]" or "on FACE", and what the meter is good for. */
static enum status read_place(struct lux_mark *m, struct textfile *t, struct err *err)
{
    char *word;
    const bool is_luminance = m->kind == LUX_LUMINANCE;
    const char *wanted = is_luminance ? "\"in\" and a photo" : "\"in\" and a photo, or \"on\" and a face";
    if (textfile_word(t, wanted, &word, err)) return err->status;
    if (!strcmp(word, "on") && !is_luminance) {
        if (copy_word(t, "the name of a face of the model", &m->face, err)) return err->status;
    } else if (!strcmp(word, "in")) {
        if (copy_word(t, "a photo's id or a view's name", &m->view, err) ||
            textfile_word(t, "a pixel's x", &word, err) || read_pixel(m, word, t, err))
            return err->status;
    } else {
        return textfile_error(t, err, word, "%s", wanted);
    }
    while (textfile_more(t)) {
        if (textfile_word(t, "\"within\"", &word, err)) return err->status;
        if (!strcmp(word, "within") && m->within < 0) {
            if (textfile_number(t, "the meter's error in per cent", 0, 100, &m->within, err)) return err->status;
            m->within /= 100;
        } else if (is_luminance && m->pixels == 1 && m->within < 0) {
            if (read_pixel(m, word, t, err)) return err->status;
        } else {
            return textfile_error(t, err, word, "\"within\" and a percentage, or the end of the line");
        }
    }
    return ST_OK;
}

static enum status read_mark(struct lux_marks *marks, struct textfile *t, struct err *err)
{
    char *word;
    if (array_append(&marks->items, (size_t)marks->count, sizeof *marks->items, "measurements", err))
        return err->status;
    struct lux_mark *m = &marks->items[marks->count];
    *m = (struct lux_mark){.line = t->line, .within = -1};
    marks->count++;
    if (textfile_word(t, "illuminance or luminance", &word, err)) return err->status;
    m->kind = strcmp(word, "luminance") ? LUX_ILLUMINANCE : LUX_LUMINANCE;
    if (m->kind == LUX_ILLUMINANCE && strcmp(word, "illuminance"))
        return textfile_error(t, err, word, "illuminance (lx) or luminance (cd/m2)");
    if (copy_word(t, "a name for the measurement", &m->name, err)) return err->status;
    for (int i = 0; i < marks->count - 1; i++)
        if (!strcmp(marks->items[i].name, m->name))
            return textfile_error(t, err, m->name, "a name of its own (it is also in line %d)", marks->items[i].line);
    if (textfile_number(t, m->kind == LUX_LUMINANCE ? "a luminance in cd/m2" : "an illuminance in lx", 1e-6, 1e9,
                        &m->value, err))
        return err->status;
    return read_place(m, t, err);
}

enum status lux_marks_read(struct lux_marks *marks, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    *marks = (struct lux_marks){0};
    provenance_open(prov, "lux.txt", &t, path, err);
    if (!err->status && !(marks->path = strdup(path))) err_nomem(err, "a path", strlen(path) + 1);
    if (!err->status && !textfile_expect_line(&t, "remodel-lux", err) && !textfile_expect(&t, "1", err))
        textfile_end(&t, err);
    while (!err->status && textfile_next(&t)) read_mark(marks, &t, err);
    if (!err->status && !marks->count) textfile_error(&t, err, NULL, "a line \"illuminance ...\" or \"luminance ...\"");
    textfile_release(&t);
    if (err->status) lux_marks_release(marks);
    return err->status;
}

void lux_marks_release(struct lux_marks *marks)
{
    for (int i = 0; i < marks->count; i++) {
        free(marks->items[i].name);
        free(marks->items[i].view);
        free(marks->items[i].face);
    }
    free(marks->items);
    free(marks->path);
    *marks = (struct lux_marks){0};
}
