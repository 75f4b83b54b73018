/* start_photos.c - which photos the mapper is started from again.
 *
 * COLMAP starts at the photo with the most matches. In a walk through rooms, no chain of photos may lead on from there,
 * while another start reaches most of them. */
#include "stages/sfm/start_photos.h"

#include <stdbool.h>
#include <stdlib.h>

struct start {
    int id;
    long long matches;
    bool placed, chosen, near; /* near: has a verified pair with one that is chosen */
};

static struct start *start_of(struct start *starts, int *count, int id)
{
    for (int i = 0; i < *count; i++)
        if (starts[i].id == id) return &starts[i];
    starts[*count].id = id;
    return &starts[(*count)++];
}

static bool is_before(const struct start *a, const struct start *b)
{
    if (a->near != b->near) return b->near;
    if (a->placed != b->placed) return b->placed;
    if (a->matches != b->matches) return a->matches > b->matches;
    return a->id < b->id;
}

enum status start_photos_choose(int *ids, int *chosen, int max, int *linked, const struct verified_pair *pairs,
                                int count, const int *placed, int placed_count, struct err *err)
{
    struct start *starts = calloc(2 * (size_t)count + 1, sizeof *starts);
    *chosen = *linked = 0;
    if (!starts) return err_nomem(err, "photos to start from", 2 * (size_t)count * sizeof *starts);
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 2; k++) start_of(starts, linked, pairs[i].images[k])->matches += pairs[i].matches;
    for (int i = 0; i < *linked; i++)
        for (int k = 0; k < placed_count; k++) starts[i].placed |= placed[k] == starts[i].id;
    while (*chosen < max && *chosen < *linked) {
        struct start *best = NULL;
        for (int i = 0; i < *linked; i++)
            if (!starts[i].chosen && (!best || is_before(&starts[i], best))) best = &starts[i];
        best->chosen = true;
        ids[(*chosen)++] = best->id;
        for (int i = 0; i < count; i++)
            for (int k = 0; k < 2; k++)
                if (pairs[i].images[k] == best->id) start_of(starts, linked, pairs[i].images[1 - k])->near = true;
    }
    free(starts);
    return ST_OK;
}
