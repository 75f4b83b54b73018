/* bracket_list.c - see bracket_list.h. */
#include "stages/import_photos/bracket_list.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/textfile.h"

enum { NAME_MOST = 100 }; /* of 255 bytes in a file name: leaves room for @k, endings and a temporary name */

static const char safe[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";

static enum status check_view(const struct bracket_list *list, const struct textfile *t, const char *view,
                              struct err *err)
{
    if (!*view || *view == '-' || strspn(view, safe) != strlen(view) || strlen(view) > NAME_MOST)
        return textfile_error(t, err, view,
                              "a view's name of at most %d letters, digits, _ and -, the first of them not -",
                              (int)NAME_MOST);
    if (!strcmp(view, "list") || !strcmp(view, "brackets"))
        return textfile_error(t, err, view, "another name for the view; this one is taken");
    for (int i = 0; i < list->count; i++)
        if (!strcmp(list->lines[i].view, view))
            return textfile_error(t, err, view, "each view once (it also stands in line %d)", list->lines[i].line);
    return ST_OK;
}

static enum status check_file(const struct bracket_list *list, const struct textfile *t, const char *file,
                              struct err *err)
{
    for (int i = 0; i < list->count; i++)
        for (int k = 0; k < list->lines[i].count; k++)
            if (!strcmp(list->lines[i].files[k], file))
                return textfile_error(t, err, file, "each photo once (it also stands in line %d)", list->lines[i].line);
    return ST_OK;
}

static enum status read_file(struct bracket_list *list, struct bracket_line *line, struct textfile *t, struct err *err)
{
    char *file = NULL;
    enum status st = textfile_word(t, "the file name of a photo", &file, err);
    if (!st) st = check_file(list, t, file, err);
    if (st) return st;
    size_t bytes = ((size_t)line->count + 1) * sizeof *line->files;
    char **files = realloc(line->files, bytes);
    if (!files) return err_nomem(err, "a list of photos", bytes);
    line->files = files;
    files[line->count] = strdup(file);
    return files[line->count++] ? ST_OK : err_nomem(err, "a file name", strlen(file) + 1);
}

static enum status read_line(struct bracket_list *list, struct textfile *t, struct err *err)
{
    char *view = NULL;
    enum status st = textfile_word(t, "a view's name", &view, err);
    if (!st) st = check_view(list, t, view, err);
    if (st) return st;
    size_t bytes = ((size_t)list->count + 1) * sizeof *list->lines;
    struct bracket_line *lines = realloc(list->lines, bytes);
    if (!lines) return err_nomem(err, "a list of views", bytes);
    list->lines = lines;
    struct bracket_line *line = &lines[list->count++];
    *line = (struct bracket_line){.view = strdup(view), .line = t->line};
    if (!line->view) return err_nomem(err, "a view's name", strlen(view) + 1);
    do st = read_file(list, line, t, err);
    while (!st && textfile_more(t));
    return st;
}

enum status bracket_list_read(struct bracket_list *list, const char *path, struct err *err)
{
    struct textfile t = {0};
    *list = (struct bracket_list){.path = strdup(path)};
    enum status st = list->path ? textfile_open(&t, path, err) : err_nomem(err, "a path", strlen(path) + 1);
    while (!st && textfile_next(&t)) st = read_line(list, &t, err);
    if (!st && !list->count)
        st = err_set(err, ST_DATA, "%s names no view; write a line VIEW FILE FILE ... for each, or remove it.", path);
    textfile_release(&t);
    if (st) bracket_list_release(list);
    return st;
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
