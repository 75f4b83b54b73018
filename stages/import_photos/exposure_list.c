/* exposure_list.c - reading exposures.txt. */
#include "stages/import_photos/exposure_list.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"

double exposure_value(const struct exposure *e)
{
    double value = e->seconds / (e->filter > 0 ? e->filter : 1);
    if (e->iso > 0) value *= e->iso;
    if (e->f_number > 0) value /= e->f_number * e->f_number;
    return value;
}

/* allow_zero: 0 means that the value is taken from EXIF. */
static enum status read_number(struct textfile *t, const char *what, bool allow_zero, double *value, struct err *err)
{
    char *word;
    if (textfile_word(t, what, &word, err)) return err->status;
    if (allow_zero && scan_double(word, value) && *value == 0) return ST_OK;
    return textfile_number_of(t, word, what, 1e-9, 1e9, value, err);
}

/* 0, from EXIF, needs another number behind it. */
static enum status read_seconds(struct textfile *t, double *seconds, struct err *err)
{
    static const char what[] = "an exposure time in seconds";
    char *word;
    if (textfile_word(t, what, &word, err)) return err->status;
    if (scan_double(word, seconds) && *seconds == 0 && textfile_more(t)) return ST_OK;
    return textfile_number_of(t, word, what, 1e-9, 1e9, seconds, err);
}

static enum status read_line(struct exposure_list *list, struct textfile *t, struct err *err)
{
    struct exposure e = {.filter = 1};
    char *file = NULL;
    textfile_word(t, "the file name of a photo", &file, err);
    for (int i = 0; !err->status && i < list->count; i++)
        if (!strcmp(list->lines[i].file, file))
            textfile_error(t, err, file, "each photo once (it is also in line %d)", list->lines[i].line);
    if (!err->status) read_seconds(t, &e.seconds, err);
    if (!err->status && textfile_more(t)) {
        if (!read_number(t, "an f-number (0: from EXIF)", true, &e.f_number, err))
            read_number(t, "an ISO value (0: from EXIF)", true, &e.iso, err);
        if (!err->status && textfile_more(t)) read_number(t, "a neutral density factor", false, &e.filter, err);
    }
    if (!err->status) textfile_end(t, err);
    if (err->status) return err->status;

    if (array_append(&list->lines, (size_t)list->count, sizeof *list->lines, "exposures", err)) return err->status;
    list->lines[list->count] = (struct exposure_line){strdup(file), e, t->line};
    return list->lines[list->count++].file ? ST_OK : err_nomem(err, "a file name", strlen(file) + 1);
}

enum status exposure_list_read(struct exposure_list *list, const char *path, struct err *err)
{
    struct textfile t = {0};
    *list = (struct exposure_list){.path = strdup(path)};
    if (list->path)
        textfile_open(&t, path, err);
    else
        err_nomem(err, "a path", strlen(path) + 1);
    while (!err->status && textfile_next(&t)) read_line(list, &t, err);
    textfile_release(&t);
    if (err->status) exposure_list_release(list);
    return err->status;
}

void exposure_list_release(struct exposure_list *list)
{
    if (!list) return;
    for (int i = 0; i < list->count; i++) free(list->lines[i].file);
    free(list->lines);
    free(list->path);
    *list = (struct exposure_list){0};
}
