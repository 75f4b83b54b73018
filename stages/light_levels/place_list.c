/* place_list.c - see place_list.h. */
#include "stages/light_levels/place_list.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"

static const double FARTHEST = 1000, HIGHEST = 100, SMALLEST = 0.01; /* m */
static const double LARGEST = 1e6;                                   /* px */

void place_list_release(struct place_list *l)
{
    for (int i = 0; i < l->count; i++) {
        free(l->items[i].name);
        free(l->items[i].photo);
    }
    free(l->items);
    free(l->path);
    *l = (struct place_list){0};
}

static bool has_name(const struct place_list *l, const char *name)
{
    for (int i = 0; i < l->count; i++)
        if (!strcmp(l->items[i].name, name)) return true;
    return false;
}

static enum status read_name(struct light_place_mark *m, const struct place_list *l, struct textfile *t,
                             struct err *err)
{
    char *word;
    if (textfile_word(t, "a place's name", &word, err)) return err->status;
    if (!scan_is_name(word))
        return textfile_error(t, err, word, "a name of letters, digits, _ and -, which does not begin with -");
    if (has_name(l, word)) return textfile_error(t, err, word, "a name that no place above has");
    m->name = strdup(word);
    return m->name ? ST_OK : err_nomem(err, "a name", strlen(word));
}

static enum status read_option(struct light_place_mark *m, struct textfile *t, struct err *err)
{
    char *word;
    if (textfile_word(t, "an option", &word, err)) return err->status;
    if (!strcmp(word, "height")) return textfile_number(t, "a height in metres", 0, HIGHEST, &m->height, err);
    if (!strcmp(word, "turn")) return textfile_number(t, "degrees", -360, 360, &m->turn, err);
    if (strcmp(word, "size") != 0) return textfile_error(t, err, word, "height H, size W D or turn DEGREES");
    if (textfile_number(t, "a width in metres", SMALLEST, FARTHEST, &m->size[0], err)) return err->status;
    return textfile_number(t, "a depth in metres", SMALLEST, FARTHEST, &m->size[1], err);
}

/* `at X Y` or `in PHOTO U V`. */
static enum status read_where(struct light_place_mark *m, struct textfile *t, struct err *err)
{
    char *word;
    if (textfile_word(t, "at X Y or in PHOTO U V", &word, err)) return err->status;
    if (!strcmp(word, "at")) {
        if (textfile_number(t, "X in metres", -FARTHEST, FARTHEST, &m->at[0], err)) return err->status;
        return textfile_number(t, "Y in metres", -FARTHEST, FARTHEST, &m->at[1], err);
    }
    if (strcmp(word, "in") != 0) return textfile_error(t, err, word, "at X Y or in PHOTO U V");
    if (textfile_word(t, "a photo's id", &word, err)) return err->status;
    m->photo = strdup(word);
    if (!m->photo) return err_nomem(err, "a photo's id", strlen(word));
    if (textfile_number(t, "U, a column of pixels", 0, LARGEST, &m->pixel[0], err)) return err->status;
    return textfile_number(t, "V, a row of pixels", 0, LARGEST, &m->pixel[1], err);
}

static enum status read_place(struct place_list *l, struct textfile *t, struct err *err)
{
    if (array_append(&l->items, (size_t)l->count, sizeof *l->items, "places", err)) return err->status;
    struct light_place_mark *m = &l->items[l->count];
    *m = (struct light_place_mark){.height = -1, .line = t->line};
    if (read_name(m, l, t, err)) return err->status;
    l->count++;
    if (read_where(m, t, err)) return err->status;
    while (!err->status && textfile_more(t)) read_option(m, t, err);
    return err->status;
}

enum status place_list_read(struct place_list *l, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    int64_t version;
    *l = (struct place_list){.path = strdup(path)};
    if (!l->path) return err_nomem(err, "a path", strlen(path));
    if (!provenance_open(prov, "places.txt", &t, path, err) && !textfile_expect_line(&t, "remodel-places", err) &&
        !textfile_int(&t, "version", 1, 1, &version, err))
        textfile_end(&t, err);
    while (!err->status && textfile_next(&t))
        if (!textfile_expect(&t, "place", err)) read_place(l, &t, err);
    textfile_release(&t);
    if (err->status) place_list_release(l);
    return err->status;
}
