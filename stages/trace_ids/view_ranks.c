/* view_ranks.c - the best views of each face, gathered view by view.
 *
 * The lists of ten thousand views do not fit into memory side by side. Each face keeps at most max_views of those seen
 * so far, in a binary heap with the worst on top, which a better one replaces: memory is bounded for each face, and the
 * result does not depend on the order in which views come, as no two of them rank the same. Views rank by clean pixels
 * times cosine, that is by how many pixels of texture they would give, then by all pixels times cosine, then by
 * name. */
#include "stages/trace_ids/view_ranks.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"

struct face_rank {
    struct face_view *views; /* a heap; names are not owned */
    int count;
};

static int compare(const void *pa, const void *pb)
{
    const struct face_view *a = pa, *b = pb;
    const double clean_a = a->clean * a->cosine, clean_b = b->clean * b->cosine;
    if (clean_a != clean_b) return clean_a > clean_b ? -1 : 1;
    const double all_a = a->pixels * a->cosine, all_b = b->pixels * b->cosine;
    if (all_a != all_b) return all_a > all_b ? -1 : 1;
    return strcmp(a->name, b->name);
}

static void swap(struct face_view *a, struct face_view *b)
{
    const struct face_view t = *a;
    *a = *b;
    *b = t;
}

static void sift_up(struct face_view *heap, int at)
{
    for (int up = (at - 1) / 2; at > 0 && compare(&heap[at], &heap[up]) > 0; at = up, up = (at - 1) / 2)
        swap(&heap[at], &heap[up]);
}

static void sift_down(struct face_view *heap, int count)
{
    for (int at = 0;;) {
        const int left = 2 * at + 1, right = left + 1;
        int worst = at;
        if (left < count && compare(&heap[left], &heap[worst]) > 0) worst = left;
        if (right < count && compare(&heap[right], &heap[worst]) > 0) worst = right;
        if (worst == at) return;
        swap(&heap[at], &heap[worst]);
        at = worst;
    }
}

static enum status add_view(struct face_rank *f, const struct face_view *v, int max_views, struct err *err)
{
    if (f->count < max_views) {
        if (array_append(&f->views, (size_t)f->count, sizeof *f->views, "views of a face", err)) return err->status;
        f->views[f->count++] = *v;
        sift_up(f->views, f->count - 1);
    } else if (compare(v, &f->views[0]) < 0) {
        f->views[0] = *v;
        sift_down(f->views, f->count);
    }
    return ST_OK;
}

enum status view_ranks_add(struct view_ranks *r, const char *name, const struct view_record *record, struct err *err)
{
    const size_t had = r->ids, needed = record->count ? (size_t)record->faces[record->count - 1].id + 1 : 0;
    if (array_reserve(&r->faces, &r->ids, needed, sizeof *r->faces, "faces", err)) return err->status;
    for (size_t i = had; i < r->ids; i++) r->faces[i] = (struct face_rank){0};
    for (int i = 0; i < record->count; i++) {
        const struct seen_face *s = &record->faces[i];
        const struct face_view v = {(char *)name, s->pixels, s->clean, s->distance, s->cosine};
        if (add_view(&r->faces[s->id], &v, r->max_views, err)) return err->status;
    }
    return ST_OK;
}

enum status view_ranks_write(struct view_ranks *r, const char *path, const struct provenance *prov, struct err *err)
{
    int *ids = malloc((r->ids + 1) * sizeof *ids), count = 0;
    struct face_views *lists = malloc((r->ids + 1) * sizeof *lists);
    if (!ids || !lists) err_nomem(err, "an index of faces", r->ids * sizeof *lists);
    for (size_t i = 0; !err->status && i < r->ids; i++) {
        struct face_rank *f = &r->faces[i];
        if (!f->count) continue;
        qsort(f->views, (size_t)f->count, sizeof *f->views, compare);
        ids[count] = (int)i;
        lists[count++] = (struct face_views){f->views, f->count};
    }
    if (!err->status) face_index_write(path, ids, lists, count, prov, err);
    free(ids);
    free(lists);
    return err->status;
}

void view_ranks_release(struct view_ranks *r)
{
    if (!r) return;
    for (size_t i = 0; i < r->ids; i++) free(r->faces[i].views);
    free(r->faces);
    *r = (struct view_ranks){0};
}
