/* clip_list.c - reading and writing frames.txt. */
#include "stages/import_photos/clip_list.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/memory_text.h"
#include "common/base/outfile.h"
#include "common/base/textfile.h"

enum { QUOTED_SIZE = 1024, MAX_SIDE = 1 << 28, MAX_FRAMES = 10000 };

static enum status read_int(struct textfile *t, const char *what, int min, int max, int *value, struct err *err)
{
    int64_t wide = 0;
    if (!textfile_int(t, what, min, max, &wide, err)) *value = (int)wide;
    return err->status;
}

/* A name without a folder. */
static enum status read_name(struct textfile *t, const char *what, char **name, struct err *err)
{
    char *word = NULL;
    if (textfile_word(t, what, &word, err)) return err->status;
    if (!*word || *word == '.' || strchr(word, '/')) return textfile_error(t, err, word, "a name without a folder");
    return (*name = strdup(word)) ? ST_OK : err_nomem(err, "a name", strlen(word) + 1);
}

static enum status read_hash(struct textfile *t, char hash[HASH_TEXT], struct err *err)
{
    char *word = NULL;
    if (textfile_word(t, "hash", &word, err)) return err->status;
    if (strlen(word) != HASH_TEXT - 1 || strspn(word, "0123456789abcdef") != HASH_TEXT - 1)
        return textfile_error(t, err, word, "a hash of %d hexadecimal digits", HASH_TEXT - 1);
    strcpy(hash, word);
    return ST_OK;
}

static enum status read_picture(struct clip_picture *p, struct textfile *t, struct err *err)
{
    struct chosen_frame *f = &p->frame;
    return textfile_expect_line(t, "frame", err) || read_name(t, "file name", &p->file, err) ||
                   read_hash(t, p->hash, err) || read_int(t, "number", 0, 1 << 30, &f->number, err) ||
                   textfile_number(t, "seconds", -1e9, 1e9, &f->seconds, err) ||
                   textfile_number(t, "sharpness", 0, 1e9, &f->sharpness, err) ||
                   textfile_number(t, "parallax", 0, 1e9, &f->parallax, err) ||
                   textfile_number(t, "overlap", 0, 1, &f->overlap, err) || textfile_end(t, err)
               ? err->status
               : ST_OK;
}

static enum status read_clip(struct clip_list *list, struct textfile *t, struct err *err)
{
    int count = 0;
    if (array_append(&list->clips, (size_t)list->count, sizeof *list->clips, "clips", err)) return err->status;
    struct clip *c = &list->clips[list->count++];
    *c = (struct clip){0};
    (void)(textfile_expect(t, "clip", err) || read_name(t, "file name", &c->file, err) ||
           read_name(t, "id", &c->id, err) || read_hash(t, c->hash, err) ||
           read_int(t, "width", 1, MAX_SIDE, &c->width, err) || read_int(t, "height", 1, MAX_SIDE, &c->height, err) ||
           read_int(t, "number of frames", 0, MAX_FRAMES, &count, err) || textfile_end(t, err));
    if (!err->status && !(c->pictures = calloc((size_t)count + 1, sizeof *c->pictures)))
        err_nomem(err, "frames of a clip", (size_t)count * sizeof *c->pictures);
    while (!err->status && c->count < count) read_picture(&c->pictures[c->count++], t, err);
    return err->status;
}

enum status clip_list_read(struct clip_list *list, const char *path, struct err *err)
{
    struct textfile t = {0};
    int version = 0;
    *list = (struct clip_list){0};
    if (!textfile_open(&t, path, err) && !textfile_expect_line(&t, "remodel-frames", err) &&
        !read_int(&t, "format version", 1, 1, &version, err) && !textfile_end(&t, err) &&
        !textfile_expect_line(&t, "rule", err) && !read_int(&t, "number of frames", 2, MAX_FRAMES, &list->most, err))
        textfile_end(&t, err);
    while (!err->status && textfile_next(&t)) read_clip(list, &t, err);
    textfile_release(&t);
    if (err->status) clip_list_release(list);
    return err->status;
}

static enum status print_clip(const struct clip *c, FILE *to, struct err *err)
{
    char name[QUOTED_SIZE];
    if (textfile_quote(c->file, name, sizeof name, err)) return err->status;
    fprintf(to, "clip %s %s %s %d %d %d\n", name, c->id, c->hash, c->width, c->height, c->count);
    for (int i = 0; i < c->count; i++) {
        const struct clip_picture *p = &c->pictures[i];
        fprintf(to, "frame %s %s %d %.17g %.6g %.6g %.6g\n", p->file, p->hash, p->frame.number, p->frame.seconds,
                p->frame.sharpness, p->frame.parallax, p->frame.overlap);
    }
    return ST_OK;
}

enum status clip_list_write(const struct clip_list *list, const char *path, struct err *err)
{
    struct memory_text m = {0};
    if (memory_text_open(&m, "a list of frames", err)) return err->status;
    fprintf(m.to, "remodel-frames 1\nrule %d\n", list->most);
    for (int i = 0; !err->status && i < list->count; i++) print_clip(&list->clips[i], m.to, err);
    if (!err->status && !memory_text_close(&m, "a list of frames", err))
        outfile_write_if_changed(path, m.text, m.size, err);
    memory_text_release(&m);
    return err->status;
}

void clip_release(struct clip *c)
{
    for (int i = 0; i < c->count; i++) free(c->pictures[i].file);
    free(c->pictures);
    free(c->file);
    free(c->id);
    *c = (struct clip){0};
}

void clip_list_release(struct clip_list *list)
{
    if (!list) return;
    for (int i = 0; i < list->count; i++) clip_release(&list->clips[i]);
    free(list->clips);
    *list = (struct clip_list){0};
}
