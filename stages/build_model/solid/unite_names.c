/* unite_names.c - names of a union's faces: their order, the rooms that they belong to, and the log of merged names. */
#include "stages/build_model/solid/unite_names.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/hash.h"

/* Rank of a text: the index of its first occurrence. */
static int rank_of(const char *text, const char **texts, int *count, int *slots, int size)
{
    unsigned at = (unsigned)hash_text(text) & (unsigned)(size - 1);
    for (; slots[at] >= 0; at = (at + 1) & (unsigned)(size - 1))
        if (texts[slots[at]] == text || !strcmp(texts[slots[at]], text)) return slots[at];
    texts[*count] = text;
    return slots[at] = (*count)++;
}

/* The text after the floor or ceiling of a room's face name, and its length; 0: a face of no room. */
static size_t room_of(const char *name, const char **room)
{
    static const char *const kinds[] = {"floor/", "ceiling/"};
    for (int i = 0; i < 2; i++) {
        const size_t length = strlen(kinds[i]);
        *room = name + length;
        if (!strncmp(name, kinds[i], length)) return strcspn(*room, "/");
    }
    return 0;
}

/* Numbers the rooms of names in the order of their first occurrence. */
static enum status number_rooms(struct name_table *names, struct err *err)
{
    const char **first = malloc(((size_t)names->count + 1) * sizeof *first);
    int rooms = 0, size = 64;
    while (size < 2 * names->count) size *= 2;
    int *slots = malloc((size_t)size * sizeof *slots);
    if (!first || !slots) err_nomem(err, "rooms of names", (size_t)size * sizeof *slots);
    for (int i = 0; i < size && !err->status; i++) slots[i] = -1;
    for (int i = 0; i < names->count && !err->status; i++) {
        const char *room;
        const size_t length = room_of(names->texts[i], &room);
        names->room[i] = -1;
        if (!length) continue;
        unsigned at = 0;
        for (size_t k = 0; k < length; k++) at = at * 31 + (unsigned char)room[k];
        for (at &= (unsigned)size - 1; slots[at] >= 0; at = (at + 1) & ((unsigned)size - 1)) {
            const char *other = first[slots[at]];
            if (!strncmp(other, room, length) && (!other[length] || other[length] == '/')) break;
        }
        if (slots[at] < 0) {
            first[rooms] = room;
            slots[at] = rooms++;
        }
        names->room[i] = slots[at];
    }
    free(first);
    free(slots);
    return err->status;
}

enum status unite_rank_names(struct name_table *names, int *body, int *body_count, const struct solid_list *list,
                             struct err *err)
{
    size_t all = 1, at = 0;
    int size = 64;
    for (int i = 0; i < list->count; i++) all += (size_t)list->solids[i].count;
    while ((size_t)size < 2 * all) size *= 2;
    int *slots = malloc(2 * (size_t)size * sizeof *slots);
    const char **bodies = malloc(((size_t)list->count + 1) * sizeof *bodies);
    names->texts = malloc(all * sizeof *names->texts);
    names->rank = malloc(all * sizeof *names->rank);
    names->room = malloc(all * sizeof *names->room);
    names->present = calloc(all, 1);
    if (!slots || !bodies || !names->texts || !names->rank || !names->room || !names->present)
        err_nomem(err, "names of solids", 2 * (size_t)size * sizeof *slots);
    for (int i = 0; !err->status && i < 2 * size; i++) slots[i] = -1;
    for (int i = 0; !err->status && i < list->count; i++) {
        body[i] = rank_of(list->solids[i].body, bodies, body_count, slots + size, size);
        for (int k = 0; k < list->solids[i].count; k++)
            names->rank[at++] = rank_of(list->solids[i].half_spaces[k].name, names->texts, &names->count, slots, size);
    }
    free(slots);
    free(bodies);
    if (!err->status) number_rooms(names, err);
    return err->status;
}

static int compare_merges(const void *a, const void *b)
{
    const struct merge *p = a, *q = b;
    if (p->name != q->name) return p->name < q->name ? -1 : 1;
    return (p->into > q->into) - (p->into < q->into);
}

enum status unite_write_log(struct unite_log *log, struct merges *merges, const struct name_table *names,
                            struct err *err)
{
    const size_t max_notes = (size_t)merges->count + (size_t)names->count + 1;
    log->notes = malloc(max_notes * sizeof *log->notes);
    if (!log->notes) return err_nomem(err, "the log of a union", max_notes * sizeof *log->notes);
    if (merges->count) qsort(merges->merges, (size_t)merges->count, sizeof *merges->merges, compare_merges);
    for (int i = 0, k = 0; i < names->count; i++) {
        if (!names->present[i]) log->notes[log->count++] = (struct unite_note){UNITE_HIDDEN, names->texts[i], NULL};
        for (; k < merges->count && merges->merges[k].name == i; k++)
            if (!k || compare_merges(&merges->merges[k - 1], &merges->merges[k]))
                log->notes[log->count++] =
                    (struct unite_note){UNITE_MERGED, names->texts[i], names->texts[merges->merges[k].into]};
    }
    return ST_OK;
}
