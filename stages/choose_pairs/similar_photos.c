/* similar_photos.c - pairs of photographs whose largest features look alike.
 *
 * Large features are found again from most viewpoints, so a few hundred of them show whether two photos overlap
 * ("preemptive matching" [Wu 2013]), at a hundredth of the cost of all features. They are matched in the same way as
 * all features: exactly, mutually, with the ratio test. Repeated textures, such as bricks and boards, also match by
 * chance between different rooms, so each photo keeps only its most similar ones. */
#include "stages/choose_pairs/similar_photos.h"

#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "common/capture/mutual_matches.h"

enum { NEIGHBOURS = 10, FARTHEST = 512 };

bool similar_by_name(int i, int j)
{
    const int apart = j - i;
    return apart <= NEIGHBOURS || (apart <= FARTHEST && !(apart & (apart - 1)));
}

/* Shared by the threads; one piece of work compares a photo with all later ones. */
struct search {
    const struct nearest_descriptors *photos;
    int *shared; /* [count][count]: matches */
    int count;
    struct progress progress; /* photos */
    struct err *errs;         /* of each photo */
};

static void compare_photos(void *ctx, size_t begin, size_t end, int thread)
{
    static const struct match_limits limits = MATCH_LIMITS;
    struct search *s = ctx;
    const size_t count = (size_t)s->count;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        for (size_t j = i + 1; j < count && !s->errs[i].status; j++) {
            struct matched_pair pair = {0};
            mutual_matches_find(&pair, &s->photos[i], &s->photos[j], &limits, &s->errs[i]);
            s->shared[i * count + j] = s->shared[j * count + i] = pair.count;
            free(pair.matches);
        }
        progress_add(&s->progress, 1);
    }
}

enum status similar_count_matches(int *shared, const struct feature_list *lists, int count, struct err *err)
{
    struct nearest_descriptors *photos = calloc((size_t)count + 1, sizeof *photos);
    struct search s = {.photos = photos, .shared = shared, .count = count};
    s.errs = calloc((size_t)count + 1, sizeof *s.errs);
    if (!photos || !s.errs) err_nomem(err, "descriptors", (size_t)count * sizeof *s.errs);
    for (int i = 0; !err->status && i < count; i++) nearest_descriptors_init(&photos[i], &lists[i], err);
    if (!err->status) {
        progress_start(&s.progress, "comparing photos", count, "photos");
        parallel_for((size_t)count, 1, compare_photos, &s);
        progress_end(&s.progress);
    }
    for (int i = 0; !err->status && i < count; i++)
        if (s.errs[i].status) err_set(err, s.errs[i].status, "%s", s.errs[i].text);
    for (int i = 0; photos && i < count; i++) nearest_descriptors_release(&photos[i]);
    free(photos);
    free(s.errs);
    return err->status;
}

/* A photo that may be similar: number of matches, and index. */
struct likeness {
    int shared, other;
};

static int most_first(const void *a, const void *b)
{
    const struct likeness *x = a, *y = b;
    if (x->shared != y->shared) return x->shared > y->shared ? -1 : 1;
    return (x->other > y->other) - (x->other < y->other);
}

enum status similar_choose(bool *similar, const int *shared, int count, int min_matches, int max_similar,
                           struct err *err)
{
    const size_t n = (size_t)count;
    struct likeness *others = calloc(n + 1, sizeof *others);
    if (!others) return err_nomem(err, "photos", n * sizeof *others);
    for (int i = 0; i < count; i++) {
        int found = 0;
        for (int j = 0; j < count; j++)
            if (j != i && shared[(size_t)i * n + (size_t)j] >= min_matches)
                others[found++] = (struct likeness){shared[(size_t)i * n + (size_t)j], j};
        qsort(others, (size_t)found, sizeof *others, most_first);
        for (int k = 0; k < found && k < max_similar; k++) {
            const int j = others[k].other;
            similar[i < j ? (size_t)i * n + (size_t)j : (size_t)j * n + (size_t)i] = true;
        }
    }
    free(others);
    return ST_OK;
}
