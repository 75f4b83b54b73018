/* depth_estimate.c - time and memory of depth, from measured constants.
 *
 * Model. With M megapixels, n neighbours, of which m are matched, and p passes of the local search:
 *   seconds = M (s + s_n n + p r (a + a_m m)),  MiB = b + M (c + c_n n),  bytes = 16 a pixel
 * s covers what is done once: over-segmentation, features, the sweep over planes, layers. A pass tries a few planes
 * a segment, so its cost falls with the size of the segments, as 1 / sqrt(pixels of a segment); r = 0.85 in later
 * rounds, which start from good planes. A first round in half the size costs a quarter of that, and a share for the
 * choice at full size.
 *
 * The constants were fitted to views of 0.37 megapixels. They are those of one core of one machine: a third off is
 * usual, and enough to choose the size of jobs and to warn before a machine runs out of memory.
 *
 * The number of neighbours is not a guess: it is chosen as it will be for the depth map, from the sparse points.
 *
 * Printed numbers are rounded up to two digits. */
#include "stages/segment_depth/depth_estimate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/log.h"
#include "common/base/parallel.h"
#include "common/base/textfile.h"
#include "common/base/work_estimate.h"
#include "stages/segment_depth/neighbours.h"

/* User seconds and peak memory per view, measured with --threads 1 on one core of a 2-core machine. Views of 0.37
 * megapixels with 8 neighbours, of which each segment is matched with 4: 14 core-seconds per megapixel in the first
 * round and 10 in the second, 400 MiB per megapixel. Layers and segments take up to 16 bytes per pixel (fern). */
static const struct {
    double seconds, seconds_neighbour; /* per megapixel: over-segmentation, features, sweep, pixel planes, layers */
    double pass, pass_neighbour; /* per megapixel and pass with segments of 64 pixels; x 8 / sqrt(segment_pixels) */
    double later;                /* cost of a later round's passes relative to the first round's */
    double mib, mib_megapixel, mib_neighbour; /* the program itself; per megapixel; per megapixel and neighbour */
    double bytes;                             /* per pixel */
    double choice;                            /* per megapixel: what the full size takes after a round in half of it */
} cost = {1, 0.45, 0.6, 0.62, 0.85, 20, 170, 28, 16, 0.9};

struct depth_work depth_work(double pixels, int neighbours, bool first, const struct segment_params *params)
{
    const int matched = neighbours < params->best_neighbours ? neighbours : params->best_neighbours;
    const bool half = first && depth_halves(params, pixels);
    const int size = half ? params->half_pixels : first ? params->segment_pixels : params->fine_pixels;
    const double mp = pixels * 1e-6, part = half ? 0.25 : 1, passes = depth_passes(params, first) * sqrt(64.0 / size);
    return (struct depth_work){
        .core_seconds = mp * part *
                            (cost.seconds + cost.seconds_neighbour * neighbours +
                             passes * (first ? 1 : cost.later) * (cost.pass + cost.pass_neighbour * matched)) +
                        (half ? mp * cost.choice : 0),
        .mib = cost.mib + mp * (cost.mib_megapixel + cost.mib_neighbour * neighbours),
        .bytes = pixels * cost.bytes,
    };
}

enum status estimate_view(struct depth_work *work, int *neighbours, const struct camera_set *set, int view_idx,
                          bool first, const struct segment_params *params, struct err *err)
{
    struct observed_points seen = {0};
    struct err none = ERR_INIT;
    int chosen[MAX_NEIGHBOURS];
    const struct view *view = &set->views[view_idx];
    *neighbours = 0;
    /* a view without neighbours is reported when its depth is made */
    if (!neighbours_find_points(&seen, set, view_idx, err) &&
        neighbours_choose(chosen, neighbours, set, view_idx, &seen, params->neighbours, &none) == ST_NOMEM)
        err_nomem(err, "scores of views", (size_t)set->view_count * 12);
    *work = depth_work((double)view->width * view->height, *neighbours, first, params);
    neighbours_release_points(&seen);
    return err->status;
}

/* Free memory in MiB; 0 if the system does not report it. */
static double available_mib(void)
{
    char line[256];
    double kib = 0;
    FILE *fp = fopen("/proc/meminfo", "re");
    while (fp && !(kib > 0) && fgets(line, sizeof line, fp))
        if (!strncmp(line, "MemAvailable:", 13)) kib = strtod(line + 13, NULL);
    if (fp) fclose(fp);
    return kib / 1024;
}

/* Rounds up to two digits. */
static double round_up(double x)
{
    const double digit = pow(10, floor(log10(fmax(x, 1))) - 1);
    return x < 10 ? ceil(x) : ceil(x / digit - 1e-9) * digit;
}

static void format_time(char text[32], double seconds)
{
    if (seconds < 180)
        snprintf(text, 32, "%.0f s", round_up(seconds));
    else if (seconds < 100 * 60)
        snprintf(text, 32, "%.0f min", round_up(seconds / 60));
    else
        snprintf(text, 32, "%.3g hours", round_up(seconds / 360) / 10);
}

static void format_memory(char text[32], double mib)
{
    if (mib < 1000)
        snprintf(text, 32, "%.0f MiB", round_up(mib));
    else
        snprintf(text, 32, "%.3g GiB", round_up(mib / 102.4) / 10);
}

static void format_range(char text[32], int min, int max)
{
    if (min == max)
        snprintf(text, 32, "%d", max);
    else
        snprintf(text, 32, "%d to %d", min, max);
}

enum { MAX_ROUNDS = 10 };

struct tally {
    int views[MAX_ROUNDS]; /* by round */
    int width, height, min_neighbours, max_neighbours;
    bool sizes_differ;
    double pixels; /* maximum */
    struct work_estimate work;
};

static void tally_add(struct tally *t, const struct view *v, int round, struct depth_work work, int neighbours)
{
    const double pixels = (double)v->width * v->height;
    const bool first = !(t->pixels > 0);
    t->views[round]++;
    t->sizes_differ = t->sizes_differ || (!first && (v->width != t->width || v->height != t->height));
    if (pixels > t->pixels) t->width = v->width, t->height = v->height, t->pixels = pixels;
    if (first || neighbours < t->min_neighbours) t->min_neighbours = neighbours;
    if (neighbours > t->max_neighbours) t->max_neighbours = neighbours;
    work_estimate_add(&t->work, work.core_seconds, work.mib, work.bytes);
}

static enum status read_list(struct tally *t, const char *list, const struct camera_set *set,
                             const struct segment_params *params, struct err *err)
{
    struct textfile file = {0};
    textfile_open(&file, list, err);
    while (!err->status && textfile_next(&file)) {
        struct depth_work work = {0, 0, 0};
        char *name;
        int64_t round = 0;
        int neighbours = 0, view_idx = -1;
        if (!textfile_word(&file, "view", &name, err) && !textfile_int(&file, "round", 0, MAX_ROUNDS - 1, &round, err))
            textfile_end(&file, err);
        if (!err->status && (view_idx = camera_set_find(set, name)) < 0)
            textfile_error(&file, err, name, "a view of the scene");
        if (!err->status && !estimate_view(&work, &neighbours, set, view_idx, round == 0, params, err))
            tally_add(t, &set->views[view_idx], (int)round, work, neighbours);
    }
    textfile_release(&file);
    return err->status;
}

static void memory_warning(char text[512], double needed)
{
    char memory[32];
    const double available = available_mib();
    *text = '\0';
    if (!(available > 0 && needed > available)) return;
    format_memory(memory, available);
    snprintf(text, 512,
             "this machine has %s free. To need less memory, run fewer jobs at a time (make -j1), or lower "
             "[segment_depth] neighbours or [sfm_import] max_megapixels",
             memory);
}

enum status estimate_print(FILE *to, const char *list, const struct camera_set *set, int jobs,
                           const struct segment_params *params, struct err *err)
{
    struct tally t = {0};
    char neighbours[32], time[32], memory[32], warning[512];
    int views = 0, rounds = 0;
    read_list(&t, list, set, params, err);
    for (int k = 0; k < MAX_ROUNDS; k++) {
        rounds += t.views[k] > 0;
        if (t.views[k] > views) views = t.views[k];
    }
    if (err->status || !views) return err->status;
    const int cores = jobs * parallel_threads();
    format_range(neighbours, t.min_neighbours, t.max_neighbours);
    fprintf(to, "depth: %d view%s of %s%d x %d, %s neighbour%s, %d round%s: ", views, views == 1 ? "" : "s",
            t.sizes_differ ? "up to " : "", t.width, t.height, neighbours, t.max_neighbours == 1 ? "" : "s", rounds,
            rounds == 1 ? "" : "s");
    format_time(time, t.work.seconds / (jobs ? cores : 1));
    format_memory(memory, t.work.mib * (jobs ? jobs : 1));
    *warning = '\0';
    if (jobs) {
        fprintf(to, "about %s on %d core%s, %s at a time\n", time, cores, cores == 1 ? "" : "s", memory);
        memory_warning(warning, t.work.mib * jobs);
    } else
        fprintf(to, "about %s of one core in all, up to %s a view\n", time, memory);
    if (*warning) fprintf(to, "depth: warning: %s.\n", warning);
    work_estimate_print(to, &t.work);
    return ST_OK;
}

enum status estimate_foresee(FILE *to, const char *list, const struct segment_params *params, struct err *err)
{
    struct textfile file = {0};
    struct work_estimate low = {0}, high = {0};
    double *pixels = NULL;
    int count = 0;
    textfile_open(&file, list, err);
    while (!err->status && textfile_next(&file)) {
        int64_t width = 0, height = 0;
        if (textfile_int(&file, "width", 1, 1 << 20, &width, err) ||
            textfile_int(&file, "height", 1, 1 << 20, &height, err) || textfile_end(&file, err) ||
            array_append(&pixels, (size_t)count, sizeof *pixels, "views", err))
            break;
        pixels[count++] = (double)width * (double)height;
    }
    textfile_release(&file);
    const int all = params->neighbours < count - 1 ? params->neighbours : count - 1, few = all < 2 ? all : 2;
    for (int i = 0; !err->status && i < count; i++)
        for (int round = 0; round <= params->rounds; round++) {
            const struct depth_work least = depth_work(pixels[i], few, !round, params);
            const struct depth_work most = depth_work(pixels[i], all, !round, params);
            if (!round) work_estimate_add(&low, least.core_seconds, least.mib, least.bytes);
            work_estimate_add(&high, most.core_seconds, most.mib, most.bytes);
        }
    free(pixels);
    if (!err->status) fprintf(to, "foresee %.0f %.0f %.0f %.0f\n", low.seconds, high.seconds, high.mib, high.bytes);
    return err->status;
}

enum status estimate_log(const struct camera_set *set, int view_idx, bool first, const struct segment_params *params,
                         struct err *err)
{
    struct depth_work work = {0, 0, 0};
    char time[32], memory[32], warning[512];
    int neighbours = 0;
    if (estimate_view(&work, &neighbours, set, view_idx, first, params, err)) return err->status;
    const struct view *v = &set->views[view_idx];
    const double seconds = work.core_seconds / parallel_threads();
    format_time(time, seconds);
    format_memory(memory, work.mib);
    if (seconds > 60 || work.mib > 1024)
        log_note("%s: %d x %d, %d neighbour%s: about %s on %d thread%s, %s", v->name, v->width, v->height, neighbours,
                 neighbours == 1 ? "" : "s", time, parallel_threads(), parallel_threads() == 1 ? "" : "s", memory);
    memory_warning(warning, work.mib);
    if (*warning) log_warn("%s needs %s, but %s", v->name, memory, warning);
    return ST_OK;
}
