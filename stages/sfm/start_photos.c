/* start_photos.c - which photos the mapper is started from again.
 *
 * COLMAP starts at the photo with the most matches. In a walk through rooms, no chain of photos may lead on from there,
 * while another start reaches most of them. */
#include "stages/sfm/start_photos.h"

#include <stdbool.h>
#include <stdlib.h>

struct start {
    int id, group; /* group: place in the list of another photo of its group; its own: the group is counted there */
    int grouped;   /* photos of the group, where it is counted */
    long long matches;
    bool placed, chosen, near; /* near: has a verified pair with one that is chosen */
};

static struct start *start_of(struct start *starts, int *count, int id)
{
    for (int i = 0; i < *count; i++)
        if (starts[i].id == id) return &starts[i];
    starts[*count] = (struct start){.id = id, .group = *count};
    return &starts[(*count)++];
}

static bool is_before(const struct start *a, const struct start *b)
{
    if (a->near != b->near) return b->near;
    if (a->placed != b->placed) return b->placed;
    if (a->matches != b->matches) return a->matches > b->matches;
    return a->id < b->id;
}

static int group_of(const struct start *starts, int i)
{
    while (starts[i].group != i) i = starts[i].group;
    return i;
}

/* Lists the photos with a verified pair, and their groups; returns their number. */
static int list_starts(struct start *starts, const struct verified_pair *pairs, int count)
{
    int n = 0;
    for (int i = 0; i < count; i++) {
        int group[2];
        for (int k = 0; k < 2; k++) {
            struct start *s = start_of(starts, &n, pairs[i].images[k]);
            s->matches += pairs[i].matches;
            group[k] = group_of(starts, (int)(s - starts));
        }
        starts[group[0]].group = group[1];
    }
    for (int i = 0; i < n; i++) starts[group_of(starts, i)].grouped++;
    return n;
}

enum status start_photos_choose(int *ids, int *chosen, int max, int *linked, const struct verified_pair *pairs,
                                int count, const int *placed, int placed_count, struct err *err)
{
    struct start *starts = calloc(2 * (size_t)count + 1, sizeof *starts);
    *chosen = *linked = 0;
    if (!starts) return err_nomem(err, "photos to start from", 2 * (size_t)count * sizeof *starts);
    int n = list_starts(starts, pairs, count);
    for (int i = 0; i < n; i++) {
        if (starts[i].grouped > *linked) *linked = starts[i].grouped;
        for (int k = 0; k < placed_count; k++) starts[i].placed |= placed[k] == starts[i].id;
    }
    while (*chosen < max) {
        struct start *best = NULL;
        for (int i = 0; i < n; i++)
            if (!starts[i].chosen && starts[group_of(starts, i)].grouped > placed_count &&
                (!best || is_before(&starts[i], best)))
                best = &starts[i];
        if (!best) break;
        best->chosen = true;
        ids[(*chosen)++] = best->id;
        for (int i = 0; i < count; i++)
            for (int k = 0; k < 2; k++)
                if (pairs[i].images[k] == best->id) start_of(starts, &n, pairs[i].images[1 - k])->near = true;
    }
    free(starts);
    return ST_OK;
}
