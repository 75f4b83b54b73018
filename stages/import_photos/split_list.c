/* split_list.c - reading and writing split.txt. */
#include "stages/import_photos/split_list.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/outfile.h"
#include "common/base/textfile.h"

enum { QUOTED_SIZE = 1024, MAX_SIDE = 1 << 28 };

static enum status read_int(struct textfile *t, const char *what, int min, int max, int *value, struct err *err)
{
    int64_t wide = 0;
    if (!textfile_int(t, what, min, max, &wide, err)) *value = (int)wide;
    return err->status;
}

/* A file name, without folder, and a hash. */
static enum status read_file(struct textfile *t, char **file, char hash[HASH_TEXT], struct err *err)
{
    char *word = NULL;
    textfile_word(t, "file name", &word, err);
    if (!err->status && (!*word || *word == '.' || strchr(word, '/')))
        textfile_error(t, err, word, "a file name without a folder");
    if (!err->status && !(*file = strdup(word))) err_nomem(err, "a file name", strlen(word) + 1);
    if (!err->status) textfile_word(t, "hash", &word, err);
    if (!err->status && (strlen(word) != HASH_TEXT - 1 || strspn(word, "0123456789abcdef") != HASH_TEXT - 1))
        textfile_error(t, err, word, "a hash of %d hexadecimal digits", HASH_TEXT - 1);
    if (!err->status) strcpy(hash, word);
    return err->status;
}

static enum status read_cut(struct split_cut *c, struct textfile *t, struct err *err)
{
    return textfile_expect_line(t, "cut", err) || read_file(t, &c->file, c->hash, err) ||
                   read_int(t, "first column", 0, MAX_SIDE, &c->x, err) ||
                   read_int(t, "first row", 0, MAX_SIDE, &c->y, err) || textfile_end(t, err)
               ? err->status
               : ST_OK;
}

static enum status read_photo(struct split_list *list, struct textfile *t, struct err *err)
{
    const size_t cuts = (size_t)(list->grid.columns * list->grid.rows);
    if (array_append(&list->photos, (size_t)list->count, sizeof *list->photos, "photos", err)) return err->status;
    struct split_photo *p = &list->photos[list->count++];
    *p = (struct split_photo){.cuts = calloc(cuts, sizeof *p->cuts)};
    if (p->cuts)
        textfile_expect(t, "photo", err);
    else
        err_nomem(err, "a list of pictures", cuts * sizeof *p->cuts);
    if (!err->status && !read_file(t, &p->file, p->hash, err) && !read_int(t, "width", 1, MAX_SIDE, &p->width, err) &&
        !read_int(t, "height", 1, MAX_SIDE, &p->height, err))
        textfile_end(t, err);
    while (!err->status && p->count < (int)cuts) read_cut(&p->cuts[p->count++], t, err);
    return err->status;
}

static enum status read_all(struct split_list *list, struct textfile *t, struct err *err)
{
    struct split_grid *g = &list->grid;
    int version = 0;
    if (!textfile_expect_line(t, "remodel-split", err) && !read_int(t, "format version", 1, 1, &version, err))
        textfile_end(t, err);
    if (!err->status && !textfile_expect_line(t, "grid", err) &&
        !read_int(t, "columns", 1, MAX_SPLIT, &g->columns, err) && !read_int(t, "rows", 1, MAX_SPLIT, &g->rows, err) &&
        !read_int(t, "border", 0, MAX_SIDE, &g->border, err) && !read_int(t, "gap", 0, MAX_SIDE, &g->gap, err) &&
        !read_int(t, "darkness", 0, 255, &g->dark, err))
        textfile_end(t, err);
    while (!err->status && textfile_next(t)) read_photo(list, t, err);
    return err->status;
}

enum status split_list_read(struct split_list *list, const char *path, struct err *err)
{
    struct textfile t = {0};
    *list = (struct split_list){0};
    if (!textfile_open(&t, path, err)) read_all(list, &t, err);
    textfile_release(&t);
    if (err->status) split_list_release(list);
    return err->status;
}

enum status split_list_write(const struct split_list *list, const char *path, struct err *err)
{
    const struct split_grid *g = &list->grid;
    struct outfile f = {0};
    char name[QUOTED_SIZE];
    if (!outfile_open(&f, path, err))
        fprintf(f.fp, "remodel-split 1\ngrid %d %d %d %d %d\n", g->columns, g->rows, g->border, g->gap, g->dark);
    for (int i = 0; !err->status && i < list->count; i++) {
        const struct split_photo *p = &list->photos[i];
        if (textfile_quote(p->file, name, sizeof name, err)) break;
        fprintf(f.fp, "photo %s %s %d %d\n", name, p->hash, p->width, p->height);
        for (int k = 0; !err->status && k < p->count; k++) {
            const struct split_cut *c = &p->cuts[k];
            if (!textfile_quote(c->file, name, sizeof name, err))
                fprintf(f.fp, "cut %s %s %d %d\n", name, c->hash, c->x, c->y);
        }
    }
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

void split_photo_release(struct split_photo *p)
{
    for (int i = 0; i < p->count; i++) free(p->cuts[i].file);
    free(p->cuts);
    free(p->file);
    *p = (struct split_photo){0};
}

void split_list_release(struct split_list *list)
{
    if (!list) return;
    for (int i = 0; i < list->count; i++) split_photo_release(&list->photos[i]);
    free(list->photos);
    *list = (struct split_list){0};
}
