/* place_memory.c - keeps the last walls in a ring; see place_memory.h. */
#include "stages/build_model/place/place_memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PLACES = 256, VIEW_NAME = 128 };

struct placed { /* compared by its bytes */
    char view[VIEW_NAME];
    double a[4], normal[2], along[2];
    int has_normal, has_along, is_free, is_set;
};

struct place_memory {
    struct placed places[PLACES];
    struct placed_wall walls[PLACES];
    int next;
};

struct place_memory *place_memory_new(void) { return calloc(1, sizeof(struct place_memory)); }

void place_memory_free(struct place_memory *memory) { free(memory); }

/* False: its name is too long. */
static bool make_key(struct placed *key, const struct script_place *place, const struct place_direction *wanted)
{
    memset(key, 0, sizeof *key);
    memcpy(key->a, place->a, sizeof key->a);
    if (wanted->normal) memcpy(key->normal, wanted->normal, sizeof key->normal);
    if (wanted->along) memcpy(key->along, wanted->along, sizeof key->along);
    key->has_normal = wanted->normal != NULL;
    key->has_along = wanted->along != NULL;
    key->is_free = wanted->is_free;
    key->is_set = 1;
    return snprintf(key->view, sizeof key->view, "%s", place->view) < VIEW_NAME;
}

const struct placed_wall *place_memory_find(const struct place_memory *memory, const struct script_place *place,
                                            const struct place_direction *wanted)
{
    struct placed key;
    if (!memory || !make_key(&key, place, wanted)) return NULL;
    for (int i = 0; i < PLACES; i++)
        if (!memcmp(&key, &memory->places[i], sizeof key)) return &memory->walls[i];
    return NULL;
}

void place_memory_add(struct place_memory *memory, const struct script_place *place,
                      const struct place_direction *wanted, const struct placed_wall *wall)
{
    struct placed key;
    if (!memory || !make_key(&key, place, wanted)) return;
    memory->places[memory->next] = key;
    memory->walls[memory->next] = *wall;
    memory->next = (memory->next + 1) % PLACES;
}
