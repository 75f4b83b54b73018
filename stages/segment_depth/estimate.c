/* estimate.c - see estimate.h. */
#include "stages/segment_depth/estimate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/parallel.h"
#include "common/base/textfile.h"
#include "stages/segment_depth/neighbours.h"

/* Measured with --threads 1 on one core of a 2-core machine, user seconds and peak of a view: an interior of 0.73 megapixels with 1, 2, 4
 * and 8 neighbours, 5, 9, 12 and 15 core-seconds a megapixel in the first round and 7 in the second (4 neighbours), 250 MiB a megapixel;
 * a pair of 0.37 megapixels, 5 and 3.6; a facade of 1.9 megapixels, 16. */
static const struct {
    double seconds, seconds_neighbour; /* a megapixel: over-segmentation, features, sweep, layers */
    double pass, pass_neighbour;       /* a megapixel and pass of a segment of 64 pixels; goes with 1 / sqrt(pixels) */
    double later;                      /* a later round's passes, as a part of the first one's */
    double mib, mib_megapixel, mib_neighbour; /* the program itself; a megapixel; a megapixel and neighbour */
} cost = {1, 0.45, 0.6, 0.62, 0.42, 20, 110, 28};

struct depth_work depth_work(double pixels, int neighbours, bool first, const struct segment_params *params)
{
    const double mp = pixels * 1e-6, passes = params->passes * sqrt(64.0 / params->segment_pixels);
    return (struct depth_work){
        .core_seconds = mp * (cost.seconds + cost.seconds_neighbour * neighbours +
                              passes * (first ? 1 : cost.later) * (cost.pass + cost.pass_neighbour * neighbours)),
        .mib = cost.mib + mp * (cost.mib_megapixel + cost.mib_neighbour * neighbours),
    };
}

enum status view_work(struct depth_work *work, int *neighbours, const struct camera_set *set, int view_idx, bool first,
                      const struct segment_params *params, struct err *err)
{
    struct seen_points seen = {0};
    struct err none = ERR_INIT;
    int chosen[MAX_NEIGHBOURS];
    const struct view *view = &set->views[view_idx];
    *neighbours = 0;
    enum status st = seen_points_find(&seen, set, view_idx, err);
    /* a view that has no neighbour is told of where it is made */
    if (!st && neighbours_choose(chosen, neighbours, set, view_idx, &seen, params->neighbours, &none) == ST_NOMEM)
        st = err_nomem(err, "scores of views", (size_t)set->view_count * 12);
    *work = depth_work((double)view->width * view->height, *neighbours, first, params);
    seen_points_release(&seen);
    return st;
}

/* MiB that programs may still take; 0: the system does not say. */
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

/* Two digits are all that an estimate has. */
static double rounded(double x)
{
    const double digit = pow(10, floor(log10(fmax(x, 1))) - 1);
    return x < 10 ? ceil(x) : ceil(x / digit - 1e-9) * digit;
}

static void time_words(char words[32], double seconds)
{
    if (seconds < 180)
        snprintf(words, 32, "%.0f s", rounded(seconds));
    else if (seconds < 100 * 60)
        snprintf(words, 32, "%.0f min", rounded(seconds / 60));
    else
        snprintf(words, 32, "%.3g hours", rounded(seconds / 360) / 10);
}

static void memory_words(char words[32], double mib)
{
    if (mib < 1000)
        snprintf(words, 32, "%.0f MiB", rounded(mib));
    else
        snprintf(words, 32, "%.3g GiB", rounded(mib / 102.4) / 10);
}

static void range_words(char words[32], int least, int most)
{
    if (least == most)
        snprintf(words, 32, "%d", most);
    else
        snprintf(words, 32, "%d to %d", least, most);
}

enum { MOST_ROUNDS = 10 };

struct tally {
    int views[MOST_ROUNDS]; /* by round */
    int width, height, least_neighbours, most_neighbours;
    bool sizes_differ;
    double pixels, core_seconds, mib; /* pixels, MiB: of the largest view */
};

static void tally_add(struct tally *t, const struct view *v, int round, struct depth_work work, int neighbours)
{
    const double pixels = (double)v->width * v->height;
    const bool first = !(t->pixels > 0);
    t->views[round]++;
    t->sizes_differ = t->sizes_differ || (!first && (v->width != t->width || v->height != t->height));
    if (pixels > t->pixels) t->width = v->width, t->height = v->height, t->pixels = pixels;
    if (first || neighbours < t->least_neighbours) t->least_neighbours = neighbours;
    if (neighbours > t->most_neighbours) t->most_neighbours = neighbours;
    t->core_seconds += work.core_seconds;
    t->mib = fmax(t->mib, work.mib);
}

static enum status read_list(struct tally *t, const char *list, const struct camera_set *set,
                             const struct segment_params *params, struct err *err)
{
    struct textfile file = {0};
    enum status st = textfile_open(&file, list, err);
    while (!st && textfile_next(&file)) {
        struct depth_work work = {0, 0};
        char *name;
        int64_t round = 0;
        int neighbours = 0, view_idx = -1;
        st = textfile_word(&file, "view", &name, err);
        if (!st) st = textfile_int(&file, "round", 0, MOST_ROUNDS - 1, &round, err);
        if (!st) st = textfile_end(&file, err);
        if (!st && (view_idx = camera_set_find(set, name)) < 0)
            st = textfile_error(&file, err, name, "a view of the scene");
        if (!st) st = view_work(&work, &neighbours, set, view_idx, round == 0, params, err);
        if (!st) tally_add(t, &set->views[view_idx], (int)round, work, neighbours);
    }
    textfile_release(&file);
    return st;
}

static void advice(char words[512], double needed)
{
    char memory[32];
    const double available = available_mib();
    *words = '\0';
    if (!(available > 0 && needed > available)) return;
    memory_words(memory, available);
    snprintf(words, 512,
             "this machine has %s free. Less is needed with fewer jobs at a time (make -j1), fewer [segment_depth] "
             "neighbours, or smaller views ([sfm_import] max_megapixels)",
             memory);
}

enum status tell_work(FILE *to, const char *list, const struct camera_set *set, int jobs,
                      const struct segment_params *params, struct err *err)
{
    struct tally t = {0};
    char neighbours[32], time[32], memory[32], warning[512];
    int views = 0, rounds = 0;
    enum status st = read_list(&t, list, set, params, err);
    for (int k = 0; k < MOST_ROUNDS; k++) {
        rounds += t.views[k] > 0;
        if (t.views[k] > views) views = t.views[k];
    }
    if (st || !views) return st;
    const int cores = jobs * parallel_threads();
    range_words(neighbours, t.least_neighbours, t.most_neighbours);
    fprintf(to, "depth: %d view%s of %s%d x %d, %s neighbour%s, %d round%s: ", views, views == 1 ? "" : "s",
            t.sizes_differ ? "up to " : "", t.width, t.height, neighbours, t.most_neighbours == 1 ? "" : "s", rounds,
            rounds == 1 ? "" : "s");
    time_words(time, t.core_seconds / (jobs ? cores : 1));
    memory_words(memory, t.mib * (jobs ? jobs : 1));
    if (!jobs) {
        fprintf(to, "about %s of one core in all, up to %s a view (SLURM_ARGS=\"--mem=%.0fM\" asks for it)\n", time,
                memory, ceil(rounded(1.25 * t.mib)));
        return ST_OK;
    }
    fprintf(to, "about %s on %d core%s, %s at a time\n", time, cores, cores == 1 ? "" : "s", memory);
    advice(warning, t.mib * jobs);
    if (*warning) fprintf(to, "depth: warning: %s.\n", warning);
    return ST_OK;
}

enum status note_work(const struct camera_set *set, int view_idx, bool first, const struct segment_params *params,
                      struct err *err)
{
    struct depth_work work = {0, 0};
    char time[32], memory[32], warning[512];
    int neighbours = 0;
    enum status st = view_work(&work, &neighbours, set, view_idx, first, params, err);
    if (st) return st;
    const struct view *v = &set->views[view_idx];
    const double seconds = work.core_seconds / parallel_threads();
    time_words(time, seconds);
    memory_words(memory, work.mib);
    if (seconds > 60 || work.mib > 1024)
        log_note("%s: %d x %d, %d neighbour%s: about %s on %d thread%s, %s", v->name, v->width, v->height, neighbours,
                 neighbours == 1 ? "" : "s", time, parallel_threads(), parallel_threads() == 1 ? "" : "s", memory);
    advice(warning, work.mib);
    if (*warning) log_warn("%s needs %s, but %s", v->name, memory, warning);
    return ST_OK;
}
