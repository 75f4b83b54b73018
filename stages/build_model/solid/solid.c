/* solid.c - lists of convex solids; each name is stored once. */
#include "stages/build_model/solid/solid.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/hash.h"

static char **slot_of(char **texts, int capacity, const char *text)
{
    size_t at = hash_text(text) & (size_t)(capacity - 1);
    while (texts[at] && strcmp(texts[at], text)) at = (at + 1) & (size_t)(capacity - 1);
    return &texts[at];
}

/* The list's copy of a text; NULL if there is no memory. */
static const char *keep_text(struct solid_list *list, const char *text)
{
    if (list->text_capacity < 2 * (list->text_count + 1)) {
        const int capacity = list->text_capacity ? 2 * list->text_capacity : 64;
        char **texts = calloc((size_t)capacity, sizeof *texts);
        if (!texts) return NULL;
        for (int i = 0; i < list->text_capacity; i++)
            if (list->texts[i]) *slot_of(texts, capacity, list->texts[i]) = list->texts[i];
        free(list->texts);
        list->texts = texts;
        list->text_capacity = capacity;
    }
    char **slot = slot_of(list->texts, list->text_capacity, text);
    if (!*slot && (*slot = strdup(text))) list->text_count++;
    return *slot;
}

enum status solid_list_add(struct solid_list *list, const char *body, const struct half_space *half_spaces, int count,
                           struct err *err)
{
    if (!body || !*body) return err_set(err, ST_DATA, "a solid has no body name, wanted one.");
    if (count < 4)
        return err_set(err, ST_DATA, "a solid of body %s has %d half-spaces, wanted 4 or more.", body, count);
    for (int i = 0; i < count; i++) {
        const struct half_space *h = &half_spaces[i];
        if (!h->name || !*h->name)
            return err_set(err, ST_DATA, "half-space %d of a solid of body %s has no name, wanted one.", i + 1, body);
        const double length = vec3_length(h->normal);
        if (!isfinite(length) || !isfinite(h->offset) || !(length > 0) || !isfinite(h->offset / length))
            return err_set(err, ST_DATA,
                           "face %s of body %s has the normal %g %g %g and the offset %g, wanted finite numbers and a "
                           "normal other than 0.",
                           h->name, body, h->normal.x, h->normal.y, h->normal.z, h->offset);
    }
    if (array_append(&list->solids, (size_t)list->count, sizeof *list->solids, "solids", err)) return err->status;
    struct solid s = {.count = count, .body = keep_text(list, body)};
    s.half_spaces = malloc((size_t)count * sizeof *s.half_spaces);
    bool complete = s.body && s.half_spaces;
    for (int i = 0; complete && i < count; i++) {
        s.half_spaces[i] = half_spaces[i];
        s.half_spaces[i].name = keep_text(list, half_spaces[i].name);
        complete = s.half_spaces[i].name;
    }
    if (!complete) {
        free(s.half_spaces);
        return err_nomem(err, "a solid", (size_t)count * sizeof *s.half_spaces);
    }
    list->solids[list->count++] = s;
    return ST_OK;
}

void solid_list_release(struct solid_list *list)
{
    if (!list) return;
    for (int i = 0; i < list->count; i++) free(list->solids[i].half_spaces);
    for (int i = 0; i < list->text_capacity; i++) free(list->texts[i]);
    free(list->solids);
    free(list->texts);
    *list = (struct solid_list){0};
}
