/* outdoors_choose.c - which picture shows each cell of the outdoors.
 *
 * Window frames, curtains and flower pots that the model does not hold are seen by some photos in a direction in which
 * others see past them, because the cameras stand in different places. So the median of the luminances, over all photos
 * that show a cell, is the outdoors as long as most of them see past what stands there. Photos that differ from it by
 * more than `agree` are outvoted there. The photo is taken that is outvoted least often in the cell and its neighbours,
 * so that the blurred edge of a frame is left out with it. Among those the one with the best score is taken whole, not
 * an average: things outside are at finite distances, so pictures from different places do not lie exactly on each
 * other, and an average is blurred. The score favours rays that pass the opening squarely and photos that show much of
 * the outdoors, so that neighbouring cells mostly come from the same photo.
 *
 * Reference images are taken in the opening or outside, where nothing stands in the way: they are all believed, and by
 * default come before photos. With `prefer = photos` they only show what no photo does. */
#include <math.h>

#include "common/base/parallel.h"
#include "common/math/weighted.h"
#include "stages/bake_outdoors/outdoors_gather.h"

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
    return c->clipped ? 0 : 1 + pictures[c->picture].order;
}

static double level_of(const struct choose_job *job, const struct outdoors_candidate *c)
{
    return log((double)fmaxf(c->luminance, DARKEST)) + log(job->gain[job->pictures[c->picture].photo]);
}

static int best_rank(const struct choose_job *job, const struct outdoors_candidate list[MAX_CANDIDATES])
{
    return list[0].picture < 0 ? -1 : outdoors_rank(&list[0], job->pictures); /* lists are in order of rank */
}

/* Marks the photos of a cell that differ from the median. */
static void vote(const struct choose_job *job, struct outdoors_candidate list[MAX_CANDIDATES])
{
    struct weighted levels[MAX_CANDIDATES];
    const int rank = best_rank(job, list);
    int count = 0;
    for (; count < MAX_CANDIDATES && list[count].picture >= 0; count++) {
        if (outdoors_rank(&list[count], job->pictures) != rank) break;
        levels[count] = (struct weighted){level_of(job, &list[count]), 1};
    }
    if (count < MIN_VOTES || job->pictures[list[0].picture].reference) return;
    const double median = weighted_percentile(levels, (size_t)count, 0.5);
    for (int k = 0; k < count; k++) list[k].outvoted = fabs(level_of(job, &list[k]) - median) > job->agree;
}

static bool is_outvoted_in(const struct outdoors_candidate list[MAX_CANDIDATES], int picture)
{
    for (int k = 0; k < MAX_CANDIDATES && list[k].picture >= 0; k++)
        if (list[k].picture == picture) return list[k].outvoted;
    return false;
}

/* In how many of the cell and its eight neighbours a picture is outvoted; the cell itself counts for all. */
static int count_outvoted(const struct outdoors_cells *cells, int x, int y, int picture)
{
    int count = 0;
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++) {
            if (y + dy < 0 || y + dy >= cells->height) continue;
            const size_t at =
                (size_t)(y + dy) * (size_t)cells->width + (size_t)((x + dx + cells->width) % cells->width);
            if (is_outvoted_in(cells->lists[at], picture)) count += dx || dy ? 1 : 9;
        }
    return count;
}

static int choose_cell(const struct choose_job *job, int x, int y)
{
    const struct outdoors_candidate *list = job->cells->lists[(size_t)y * (size_t)job->cells->width + (size_t)x];
    const int rank = best_rank(job, list);
    int best = -1, fewest = 0;
    for (int k = 0; k < MAX_CANDIDATES && list[k].picture >= 0; k++) {
        if (outdoors_rank(&list[k], job->pictures) != rank) break;
        const int outvoted = count_outvoted(job->cells, x, y, list[k].picture);
        if (best >= 0 && (outvoted > fewest || (outvoted == fewest && list[k].score <= list[best].score))) continue;
        best = k;
        fewest = outvoted;
    }
    return best < 0 ? -1 : list[best].picture;
}

static void vote_in_cells(void *ctx, size_t begin, size_t end, int thread)
{
    const struct choose_job *job = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) vote(job, job->cells->lists[i]);
}

static void choose_cells(void *ctx, size_t begin, size_t end, int thread)
{
    const struct choose_job *job = ctx;
    const size_t width = (size_t)job->cells->width;
    (void)thread;
    for (size_t i = begin; i < end; i++) job->cells->chosen[i] = choose_cell(job, (int)(i % width), (int)(i / width));
}

void outdoors_choose(struct outdoors_cells *cells, const struct outdoors_picture *pictures, const double *gain,
                     double agree)
{
    const size_t count = (size_t)cells->width * (size_t)cells->height;
    struct choose_job job = {cells, pictures, gain, agree};
    parallel_for(count, CELLS, vote_in_cells, &job);
    parallel_for(count, CELLS, choose_cells, &job);
}
