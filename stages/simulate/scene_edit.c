/* scene_edit.c - edits as differences: the items that an edited scene drops of its base, and its full description. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/file_path.h"
#include "common/base/outfile.h"
#include "stages/simulate/scene_reader.h"

/* Remembers a line of the base, so that scene_write() leaves it out. */
static enum status drop_line(struct reader *r, int line, struct err *err)
{
    struct scene *s = r->scene;
    if (!array_append(&s->dropped, (size_t)s->dropped_count, sizeof *s->dropped, "dropped lines", err))
        s->dropped[s->dropped_count++] = line;
    return err->status;
}

static bool in_wall(const struct scene_item *it, int wall)
{
    return (it->kind == ITEM_OPENING || it->kind == ITEM_WINDOW) && it->wall == wall;
}

/* Removes an item of the base, and with a wall its openings, which follow it. */
static enum status drop_item(struct reader *r, int item, struct err *err)
{
    struct scene *s = r->scene;
    const bool wall = s->items[item].kind == ITEM_WALL;
    for (int i = r->base_items - 1; !err->status && wall && i > item; i--)
        if (in_wall(&s->items[i], item)) drop_item(r, i, err);
    if (!err->status) drop_line(r, s->items[item].line, err);
    if (err->status) return err->status;
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
    if (!strcmp(name, sky->panorama.has_shape ? "sky" : "panorama") && sky->has_panorama && r->panorama_line) {
        const int line = r->panorama_line;
        sky->has_panorama = false, r->panorama_line = 0;
        return drop_line(r, line, err);
    }
    return textfile_error(&r->file, err, name, "the name of an item of the base, sun, sky or panorama");
}

enum status scene_read_drop(struct reader *r, struct err *err)
{
    char *name = NULL;
    if (!r->scene->base)
        return textfile_error(&r->file, err, "drop", "a line `base FILE` at the beginning of the file");
    if (!textfile_word(&r->file, "the name of an item of the base", &name, err)) drop_name(r, name, err);
    while (!err->status && textfile_more(&r->file))
        if (!textfile_word(&r->file, "the name of an item of the base", &name, err)) drop_name(r, name, err);
    return err->status;
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
    char path[FILE_PATH];
    struct textfile from = {0};
    if (!file_path(path, folder, file, "", err)) textfile_open(&from, path, err);
    while (!err->status && textfile_next_raw(&from))
        if (!s->base || (!about_file(from.cursor) && !(base && is_dropped(s, from.line))))
            fprintf(to, "%s\n", from.cursor);
    textfile_release(&from);
    return err->status;
}

enum status scene_write(const struct scene *s, const char *folder, const char *file, const char *path, struct err *err)
{
    struct outfile f = {0};
    outfile_open(&f, path, err);
    if (!err->status && s->base) {
        fprintf(f.fp, "remodel-scene 2\n# %s, with all that it keeps of %s\n", file, s->base);
        if (!copy_lines(s, f.fp, folder, s->base, true, err)) fprintf(f.fp, "\nfurniture off\n");
    }
    if (!err->status && !copy_lines(s, f.fp, folder, file, false, err)) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}
