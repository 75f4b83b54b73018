/* similar_photos.c - pairs of photographs whose largest features look alike.
 *
 * Large features are found again from most viewpoints, so a few hundred of them show whether two photos overlap
 * ("preemptive matching" [Wu 2013]), at a hundredth of the cost of all features. They are matched in the same way as
 * all features: exactly, mutually, with the ratio test. */
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

/* What threads share; a photo with all later ones is a piece of work. */
struct search {
    const struct nearest_descriptors *photos;
    bool *similar;
    int count, min_matches;
    struct progress progress; /* photos */
    struct err *errs;         /* of each photo */
};

static void compare_photos(void *ctx, size_t begin, size_t end, int thread)
{
    static const struct match_limits limits = MATCH_LIMITS;
    struct search *s = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        for (size_t j = i + 1; j < (size_t)s->count && !s->errs[i].status; j++) {
            struct matched_pair pair = {0};
            mutual_matches_find(&pair, &s->photos[i], &s->photos[j], &limits, &s->errs[i]);
            s->similar[i * (size_t)s->count + j] = pair.count >= s->min_matches;
            free(pair.matches);
        }
        progress_add(&s->progress, 1);
    }
}

enum status similar_by_features(bool *similar, const struct feature_list *lists, int count, int min_matches,
                                struct err *err)
{
    struct nearest_descriptors *photos = calloc((size_t)count + 1, sizeof *photos);
    struct search s = {.photos = photos, .similar = similar, .count = count, .min_matches = min_matches};
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
