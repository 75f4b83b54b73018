/* choose.c - which picture shows each cell of the outdoors.
 *
 * Window frames, curtains and flower pots that the model does not hold are seen by some photos in a direction in which
 * others see past them, because the cameras stand in different places. So the median of the luminances, over all photos
 * that show a cell, is the outdoors as long as most of them see past what stands there. Photos that differ from it by
 * more than `agree` are left out. Of the others the one with the best score is taken whole, not an average: things
 * outside are at finite distances, so pictures from different places do not lie exactly on each other, and an average
 * is blurred. The score favours rays that pass the opening squarely and photos that show much of the outdoors, so that
 * neighbouring cells mostly come from the same photo.
 *
 * Reference images are taken in the opening or outside, where nothing stands in the way: they are all believed. */
#include <math.h>

#include "common/base/parallel.h"
#include "common/capture/photo_quality.h"
#include "common/math/weighted.h"
#include "stages/bake_outdoors/gather.h"

enum { CELLS = 256, MIN_VOTES = 3 }; /* photos that must show a cell before one can be outvoted */
#define DARKEST 1e-9f

struct choose_job {
    struct outdoors_cells *cells;
    const struct outdoors_picture *pictures;
    const double *gain;
    double agree;
};

int outdoors_rank(const struct outdoors_candidate *c, const struct outdoors_picture *pictures)
{
    return 2 * !c->clipped + pictures[c->picture].reference;
}

static double level_of(const struct choose_job *job, const struct outdoors_candidate *c)
{
    return log((double)fmaxf(photo_luminance(c->rgb), DARKEST)) + log(job->gain[job->pictures[c->picture].photo]);
}

static int choose_cell(const struct choose_job *job, const struct outdoors_candidate list[MAX_CANDIDATES])
{
    struct weighted levels[MAX_CANDIDATES];
    int count = 0, rank = -1, best = -1;
    for (int k = 0; k < MAX_CANDIDATES && list[k].picture >= 0; k++)
        if (outdoors_rank(&list[k], job->pictures) > rank) rank = outdoors_rank(&list[k], job->pictures);
    for (int k = 0; k < MAX_CANDIDATES && list[k].picture >= 0; k++)
        if (outdoors_rank(&list[k], job->pictures) == rank)
            levels[count++] = (struct weighted){level_of(job, &list[k]), 1};
    const bool vote = count >= MIN_VOTES && !(rank & 1);
    const double median = weighted_percentile(levels, (size_t)count, 0.5);
    for (int k = 0; k < MAX_CANDIDATES && list[k].picture >= 0; k++) {
        if (outdoors_rank(&list[k], job->pictures) != rank) continue;
        if (vote && fabs(level_of(job, &list[k]) - median) > job->agree) continue;
        if (best < 0 || list[k].score > list[best].score) best = k;
    }
    return best < 0 ? -1 : list[best].picture;
}

static void choose_cells(void *ctx, size_t begin, size_t end, int thread)
{
    const struct choose_job *job = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) job->cells->chosen[i] = choose_cell(job, job->cells->lists[i]);
}

void outdoors_choose(struct outdoors_cells *cells, const struct outdoors_picture *pictures, const double *gain,
                     double agree)
{
    struct choose_job job = {cells, pictures, gain, agree};
    parallel_for((size_t)cells->width * (size_t)cells->height, CELLS, choose_cells, &job);
}
