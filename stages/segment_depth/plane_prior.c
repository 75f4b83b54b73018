/* plane_prior.c - the planes that most of a view's pixels are expected on. */
#include "stages/segment_depth/plane_prior.h"

#include <stdlib.h>

#define MIN_PART 0.003 /* of the view's pixels that a plane is expected for */

enum status plane_prior_init(struct plane_prior *prior, int segments, struct err *err)
{
    const size_t count = (size_t)segments + 1;
    *prior = (struct plane_prior){.count = 0};
    prior->expected = malloc(count * sizeof *prior->expected);
    prior->gain = calloc(count, sizeof *prior->gain);
    if (!prior->expected || !prior->gain) return err_nomem(err, "expected planes", count * sizeof(int));
    for (int i = 0; i < segments; i++) prior->expected[i] = -1;
    return ST_OK;
}

static int compare_pixels(const void *a, const void *b)
{
    const struct prior_candidate *const *x = a, *const *y = b;
    if ((*x)->pixels != (*y)->pixels) return (*x)->pixels > (*y)->pixels ? -1 : 1;
    return (*x > *y) - (*x < *y);
}

enum status plane_prior_keep(struct plane_prior *prior, const struct prior_candidate *candidates, int count,
                             const struct view *view, const struct segmentation *s, struct err *err)
{
    const struct prior_candidate **order = calloc((size_t)count + 1, sizeof *order);
    int *kept = malloc(((size_t)count + 1) * sizeof *kept);
    if (!order || !kept) err_nomem(err, "expected planes", (size_t)count * sizeof *order);
    for (int k = 0; !err->status && k < count; k++) {
        order[k] = &candidates[k];
        kept[k] = -1;
    }
    if (!err->status) qsort(order, (size_t)count, sizeof *order, compare_pixels);
    for (int k = 0; !err->status && k < count && prior->count < PRIOR_PLANES; k++) {
        if (!(order[k]->pixels >= MIN_PART * s->width * s->height)) break;
        kept[order[k] - candidates] = prior->count;
        prior->planes[prior->count++] = plane_of_normal(view, order[k]->normal);
    }
    for (int i = 0; !err->status && i < s->count; i++)
        if (prior->expected[i] >= 0) prior->expected[i] = kept[prior->expected[i]];
    free(order);
    free(kept);
    return err->status;
}

void plane_prior_release(struct plane_prior *prior)
{
    if (!prior) return;
    free(prior->gain);
    free(prior->expected);
    *prior = (struct plane_prior){.count = 0};
}
