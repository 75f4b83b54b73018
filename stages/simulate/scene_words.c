/* scene_words.c - see scene_reader.h. */
#include "stages/simulate/scene_reader.h"

#include <stdio.h>
#include <string.h>

#include "common/base/scan.h"

/* Two numbers, the second larger than the first. */
enum status scene_read_range(struct reader *r, const char *what, double *from, double *to, struct err *err)
{
    return textfile_number(&r->file, what, -MAX_METRES, MAX_METRES, from, err) ||
                   textfile_number(&r->file, what, *from + MIN_METRES, MAX_METRES, to, err)
               ? err->status
               : ST_OK;
}

enum status scene_read_colour(struct reader *r, const char *what, double max, struct rgb *c, struct err *err)
{
    return textfile_number(&r->file, what, 0, max, &c->r, err) || textfile_number(&r->file, what, 0, max, &c->g, err) ||
                   textfile_number(&r->file, what, 0, max, &c->b, err)
               ? err->status
               : ST_OK;
}

enum status scene_read_seed(struct reader *r, uint32_t *value, struct err *err)
{
    int64_t n = 0;
    textfile_int(&r->file, "a seed", 0, UINT32_MAX, &n, err);
    *value = (uint32_t)n;
    return err->status;
}

/* One of `words`; *index is its position among them. */
enum status scene_read_choice(struct reader *r, const char *const *words, int count, const char *what, int *index,
                              struct err *err)
{
    char *word = NULL, choices[300] = "";
    if (textfile_word(&r->file, what, &word, err)) return err->status;
    for (int i = 0; i < count; i++) {
        if (!strcmp(word, words[i])) {
            *index = i;
            return ST_OK;
        }
        const size_t used = strlen(choices);
        snprintf(choices + used, sizeof choices - used, "%s%s", i ? ", " : "", words[i]);
    }
    return textfile_error(&r->file, err, word, "%s: one of %s", what, choices);
}

enum status scene_name_taken(struct reader *r, const char *name, const char *what, struct err *err)
{
    return textfile_error(&r->file, err, name, "a name that no other %s of the scene has", what);
}

static enum status name_unknown(struct reader *r, const char *found, const char *what,
                                const char *(*next)(const void *ctx, int i), struct err *err)
{
    const char *near = scan_nearest(found, next, r->scene);
    if (near) return textfile_error(&r->file, err, found, "the name of a %s above; did you mean %s", what, near);
    return textfile_error(&r->file, err, found, "the name of a %s above", what);
}

const char *scene_next_texture(const void *ctx, int i)
{
    const struct scene *s = ctx;
    return i < s->texture_count ? s->textures[i].name : NULL;
}

const char *scene_next_material(const void *ctx, int i)
{
    const struct scene *s = ctx;
    return i < s->material_count ? s->materials[i].name : NULL;
}

const char *scene_next_item(const void *ctx, int i)
{
    const struct scene *s = ctx;
    return i < s->item_count ? s->items[i].name : NULL;
}

int scene_find_name(const struct scene *s, const char *name, const char *(*next)(const void *ctx, int i))
{
    const char *other;
    for (int i = 0; (other = next(s, i)); i++)
        if (!strcmp(name, other)) return i;
    return -1;
}

enum status scene_read_known_name(struct reader *r, const char *what, const char *(*next)(const void *ctx, int i),
                                  int *index, struct err *err)
{
    char *word = NULL, wanted[80];
    snprintf(wanted, sizeof wanted, "the name of a %s", what);
    textfile_word(&r->file, wanted, &word, err);
    if (!err->status && (*index = scene_find_name(r->scene, word, next)) < 0) name_unknown(r, word, what, next, err);
    return err->status;
}
