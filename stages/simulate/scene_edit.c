/* scene_edit.c - edits as differences: the items that an edited scene drops of its base, and its full description. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/outfile.h"
#include "stages/simulate/scene_reader.h"

/* Remembers a line of the base, so that scene_write() leaves it out. */
static enum status drop_line(struct reader *r, int line, struct err *err)
{
    struct scene *s = r->scene;
    enum status st = array_append(&s->dropped, (size_t)s->dropped_count, sizeof *s->dropped, "dropped lines", err);
    if (!st) s->dropped[s->dropped_count++] = line;
    return st;
}

static bool in_wall(const struct scene_item *it, int wall)
{
    return (it->kind == ITEM_OPENING || it->kind == ITEM_WINDOW) && it->wall == wall;
}

/* Removes an item of the base, and with a wall its openings, which follow it. */
static enum status drop_item(struct reader *r, int item, struct err *err)
{
    struct scene *s = r->scene;
    enum status st = ST_OK;
    const bool wall = s->items[item].kind == ITEM_WALL;
    for (int i = r->base_items - 1; !st && wall && i > item; i--)
        if (in_wall(&s->items[i], item)) st = drop_item(r, i, err);
    if (!st) st = drop_line(r, s->items[item].line, err);
    if (st) return st;
    scene_item_release(&s->items[item]);
    s->item_count--, r->base_items--;
    memmove(&s->items[item], &s->items[item + 1], (size_t)(s->item_count - item) * sizeof *s->items);
    for (int i = item; i < s->item_count; i++)
        if (s->items[i].wall > item) s->items[i].wall--;
    return ST_OK;
}

static enum status drop_name(struct reader *r, const char *name, struct err *err)
{
    struct sky_params *sky = &r->scene->sky;
    const int item = scene_find_name(r->scene, name, scene_next_item);
    if (item >= 0 && item < r->base_items) return drop_item(r, item, err);
    if (!strcmp(name, "sun") && sky->has_sun && r->sun_line) {
        const int line = r->sun_line;
        sky->has_sun = false, r->sun_line = 0;
        return drop_line(r, line, err);
    }
    if (!strcmp(name, "panorama") && sky->has_panorama && r->panorama_line) {
        const int line = r->panorama_line;
        sky->has_panorama = false, r->panorama_line = 0;
        return drop_line(r, line, err);
    }
    return textfile_error(&r->file, err, name, "the name of an item of the base, sun or panorama");
}

enum status scene_read_drop(struct reader *r, struct err *err)
{
    char *name = NULL;
    if (!r->scene->base)
        return textfile_error(&r->file, err, "drop", "a line `base FILE` at the beginning of the file");
    enum status st = textfile_word(&r->file, "the name of an item of the base", &name, err);
    if (!st) st = drop_name(r, name, err);
    while (!st && textfile_more(&r->file)) {
        st = textfile_word(&r->file, "the name of an item of the base", &name, err);
        if (!st) st = drop_name(r, name, err);
    }
    return st;
}

/* -------------------------------------------------------------------------------------------------- the whole scene */

static bool is_dropped(const struct scene *s, int line)
{
    for (int i = 0; i < s->dropped_count; i++)
        if (s->dropped[i] == line) return true;
    return false;
}

/* Whether a line begins with a word about the file itself, which the full description does not have. */
static bool about_file(const char *line)
{
    char word[16] = "";
    return sscanf(line, "%15s", word) == 1 &&
           (!strcmp(word, "remodel-scene") || !strcmp(word, "base") || !strcmp(word, "drop"));
}

/* Copies the lines of FOLDER/FILE; those of the base without the dropped ones. */
static enum status copy_lines(const struct scene *s, FILE *to, const char *folder, const char *file, bool base,
                              struct err *err)
{
    char *path = NULL, *text = NULL;
    size_t size = 0;
    FILE *from = NULL;
    enum status st = asprintf(&path, "%s/%s", folder, file) < 0 ? err_nomem(err, "a file name", strlen(file)) : ST_OK;
    if (st) path = NULL;
    if (!st && !(from = fopen(path, "rbe"))) st = err_errno(err, "open", path);
    for (int line = 1; !st && getline(&text, &size, from) >= 0; line++) {
        if (s->base && (about_file(text) || (base && is_dropped(s, line)))) continue;
        fputs(text, to);
        if (s->base && !strchr(text, '\n')) putc('\n', to);
    }
    if (!st && ferror(from)) st = err_errno(err, "read", path);
    if (from) fclose(from);
    free(text);
    free(path);
    return st;
}

enum status scene_write(const struct scene *s, const char *folder, const char *file, const char *path, struct err *err)
{
    struct outfile f = {0};
    enum status st = outfile_open(&f, path, err);
    if (!st && s->base) {
        fprintf(f.fp, "remodel-scene 2\n# %s, with all that it keeps of %s\n", file, s->base);
        st = copy_lines(s, f.fp, folder, s->base, true, err);
        if (!st) fprintf(f.fp, "\nfurniture off\n");
    }
    if (!st) st = copy_lines(s, f.fp, folder, file, false, err);
    if (!st) st = outfile_commit(&f, err);
    outfile_discard(&f);
    return st;
}
