/* bracket_list.c - reading brackets.txt. */
#include "stages/import_photos/bracket_list.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/textfile.h"

enum { MAX_NAME = 100 }; /* file names may have 255 bytes: leaves room for @k, extensions and temporary names */

static const char safe[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";

static enum status check_view(const struct bracket_list *list, const struct textfile *t, const char *view,
                              struct err *err)
{
    if (!*view || *view == '-' || strspn(view, safe) != strlen(view) || strlen(view) > MAX_NAME)
        return textfile_error(t, err, view,
                              "a view's name of at most %d letters, digits, _ and -, not beginning with -", MAX_NAME);
    if (!strcmp(view, "list") || !strcmp(view, "brackets"))
        return textfile_error(t, err, view, "another name for the view; this one is reserved");
    for (int i = 0; i < list->count; i++)
        if (!strcmp(list->lines[i].view, view))
            return textfile_error(t, err, view, "each view once (it is also in line %d)", list->lines[i].line);
    return ST_OK;
}

static enum status check_file(const struct bracket_list *list, const struct textfile *t, const char *file,
                              struct err *err)
{
    for (int i = 0; i < list->count; i++)
        for (int k = 0; k < list->lines[i].count; k++)
            if (!strcmp(list->lines[i].files[k], file))
                return textfile_error(t, err, file, "each photo once (it is also in line %d)", list->lines[i].line);
    return ST_OK;
}

static enum status read_file(struct bracket_list *list, struct bracket_line *line, struct textfile *t, struct err *err)
{
    char *file = NULL;
    if (!textfile_word(t, "the file name of a photo", &file, err)) check_file(list, t, file, err);
    if (err->status) return err->status;
    if (array_append(&line->files, (size_t)line->count, sizeof *line->files, "photos", err)) return err->status;
    line->files[line->count] = strdup(file);
    return line->files[line->count++] ? ST_OK : err_nomem(err, "a file name", strlen(file) + 1);
}

static enum status read_line(struct bracket_list *list, struct textfile *t, struct err *err)
{
    char *view = NULL;
    if (!textfile_word(t, "a view's name", &view, err)) check_view(list, t, view, err);
    if (err->status) return err->status;
    if (array_append(&list->lines, (size_t)list->count, sizeof *list->lines, "views", err)) return err->status;
    struct bracket_line *line = &list->lines[list->count++];
    *line = (struct bracket_line){.view = strdup(view), .line = t->line};
    if (!line->view) return err_nomem(err, "a view's name", strlen(view) + 1);
    do read_file(list, line, t, err);
    while (!err->status && textfile_more(t));
    return err->status;
}

enum status bracket_list_read(struct bracket_list *list, const char *path, struct err *err)
{
    struct textfile t = {0};
    *list = (struct bracket_list){.path = strdup(path)};
    if (list->path)
        textfile_open(&t, path, err);
    else
        err_nomem(err, "a path", strlen(path) + 1);
    while (!err->status && textfile_next(&t)) read_line(list, &t, err);
    if (!err->status && !list->count)
        err_set(err, ST_DATA, "%s contains no view; write a line VIEW FILE FILE ... for each view, or remove the file.",
                path);
    textfile_release(&t);
    if (err->status) bracket_list_release(list);
    return err->status;
}

void bracket_list_release(struct bracket_list *list)
{
    if (!list) return;
    for (int i = 0; i < list->count; i++) {
        for (int k = 0; k < list->lines[i].count; k++) free(list->lines[i].files[k]);
        free(list->lines[i].files);
        free(list->lines[i].view);
    }
    free(list->lines);
    free(list->path);
    *list = (struct bracket_list){0};
}
