/* mutual_matches.c - features of two photos that look alike. */
#include "common/capture/mutual_matches.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

static double angle_of(int32_t product)
{
    const double cosine = (double)product / ((double)DESCRIPTOR_LENGTH * DESCRIPTOR_LENGTH);
    return acos(cosine < 1 ? cosine : 1);
}

static bool is_clear(const struct nearest *n, const struct match_limits *limits)
{
    if (n->at < 0) return false;
    const double best = angle_of(n->best);
    return best <= limits->angle && (n->second < 0 || best < limits->ratio * angle_of(n->second));
}

enum status mutual_matches_find(struct matched_pair *pair, const struct nearest_descriptors *a,
                                const struct nearest_descriptors *b, const struct match_limits *limits, struct err *err)
{
    struct nearest *ab = malloc(((size_t)a->count + 1) * sizeof *ab), *ba = malloc(((size_t)b->count + 1) * sizeof *ba);
    pair->matches = malloc(((size_t)a->count + 1) * sizeof *pair->matches);
    if (!ab || !ba || !pair->matches)
        err_nomem(err, "matches", ((size_t)a->count + (size_t)b->count) * sizeof *ab);
    else if (!nearest_descriptors_find(ab, ba, a, b, err))
        for (int i = 0; i < a->count; i++)
            if (is_clear(&ab[i], limits) && ba[ab[i].at].at == i && is_clear(&ba[ab[i].at], limits))
                pair->matches[pair->count++] = (struct index_match){i, ab[i].at};
    free(ab);
    free(ba);
    return err->status;
}
