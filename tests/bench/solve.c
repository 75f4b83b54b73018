/* solve.c - time and error of gradient solves: a picture composed of several sources.
 *
 *   solve [--solver chosen|multigrid|direct] [--kind KIND] [--size N] [--threads N]
 *
 * The picture has N x N pixels: waves, bricks with joints, grain. Each of 4 sources has its own gain and grain; each
 * pixel belongs to one of them. As in an atlas [Colburn 2014, 4.5.2], data have weight 1e-5, and a pair of neighbours
 * gets the differences of the sources of both, weight 1, or 1e-5 above 0.1. Kinds: `weak` has nothing else; in `half`
 * about half the pixels are fixed, in patches; `parts` is weak, cut into many small irregular parts by pixels that are
 * out; in `rough` the grain takes four differences of five above 0.1.
 *
 * Solves until half a second has passed. Prints "seconds S" (CPU time of the fastest solve), "peak_mib M", "error E"
 * (largest difference from the direct solve, over the range of its values), "residual R", "iterations N" (0: direct),
 * "free N". */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "common/base/cli.h"
#include "common/base/clock.h"
#include "common/base/parallel.h"
#include "common/base/rng.h"
#include "common/base/scan.h"
#include "common/math/gradient_solve.h"

enum { SOURCES = 4, SEEDS = 16 };

struct picture {
    struct gradient_problem p;
    uint8_t *role, *best;
    float *data_weight, *data, *weight_x, *gradient_x, *weight_y, *gradient_y;
    float *source[SOURCES];
};

static struct rng rng;

static int allocate(struct picture *w, int size)
{
    const size_t n = (size_t)size * (size_t)size;
    w->role = malloc(n);
    w->best = malloc(n);
    w->data_weight = calloc(n, sizeof(float));
    w->data = calloc(3 * n, sizeof(float));
    w->weight_x = calloc(n, sizeof(float));
    w->gradient_x = calloc(3 * n, sizeof(float));
    w->weight_y = calloc(n, sizeof(float));
    w->gradient_y = calloc(3 * n, sizeof(float));
    float *value = calloc(3 * n, sizeof(float));
    int ok = w->role && w->best && w->data_weight && w->data && w->weight_x && w->gradient_x && w->weight_y &&
             w->gradient_y && value;
    for (int k = 0; k < SOURCES; k++) ok = (w->source[k] = malloc(3 * n * sizeof(float))) && ok;
    w->p = (struct gradient_problem){size,        size,          w->role,     w->data_weight, w->data,
                                     w->weight_x, w->gradient_x, w->weight_y, w->gradient_y,  value};
    return ok;
}

static void release(struct picture *w)
{
    free(w->role);
    free(w->best);
    free(w->data_weight);
    free(w->data);
    free(w->weight_x);
    free(w->gradient_x);
    free(w->weight_y);
    free(w->gradient_y);
    free(w->p.value);
    for (int k = 0; k < SOURCES; k++) free(w->source[k]);
}

/* What source k shows at (x, y). */
static double shown(int k, int x, int y, int c, double grain)
{
    static const double gains[SOURCES] = {1, 0.8, 1.3, 1.05};
    const int joint = y % 24 < 2 || (x + (y / 24 % 2) * 20) % 40 < 2;
    const double wave = 0.1 * sin(0.021 * x + c) + 0.08 * cos(0.037 * y - 0.013 * x);
    const double base = (joint ? 0.25 : 0.55 + 0.05 * c) + wave;
    const uint64_t pixel = (uint64_t)y * 65536 + (uint64_t)x;
    return gains[k] * (base + grain * (rng_uniform(&rng, pixel, (uint64_t)c) - 0.5) +
                       0.01 * rng_uniform(&rng, pixel, (uint64_t)(16 + 4 * k + c)));
}

/* Adds what source k says about the pair of pixels a and b. */
static void add_difference(float *weight, float *gradient, const float *source, size_t a, size_t b)
{
    double most = 0, sum = *weight;
    for (size_t c = 0; c < 3; c++) most = fmax(most, fabs((double)source[3 * b + c] - (double)source[3 * a + c]));
    const double w = most > 0.1 ? 1e-5 : 1;
    for (size_t c = 0; c < 3; c++) {
        const double difference = (double)source[3 * b + c] - (double)source[3 * a + c];
        gradient[c] = (float)((sum * (double)gradient[c] + w * difference) / (sum + w));
    }
    *weight = (float)(sum + w);
}

static void add_pair(struct picture *w, float *weight, float *gradient, size_t a, size_t b)
{
    add_difference(weight, gradient, w->source[w->best[a]], a, b);
    if (w->best[b] != w->best[a]) add_difference(weight, gradient, w->source[w->best[b]], a, b);
}

static void choose(struct picture *w, const char *kind)
{
    const int size = w->p.width;
    double at[SEEDS][2];
    for (int s = 0; s < SEEDS; s++)
        for (int k = 0; k < 2; k++) at[s][k] = size * rng_uniform(&rng, UINT64_MAX, (uint64_t)(2 * s + k));
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++) {
            const size_t p = (size_t)y * (size_t)size + (size_t)x;
            int nearest = 0;
            for (int s = 1; s < SEEDS; s++)
                if (hypot(x - at[s][0], y - at[s][1]) < hypot(x - at[nearest][0], y - at[nearest][1])) nearest = s;
            w->best[p] = (uint8_t)(nearest % SOURCES);
            const double ripple = 0.3 * (sin(0.4 * x) * sin(0.5 * y) + sin(0.23 * x + 0.31 * y));
            const double patch = sin(9.0 * x / size + 1) + sin(7.0 * y / size) + ripple;
            w->role[p] = GRADIENT_FREE;
            if (!strcmp(kind, "half") && patch > 0) w->role[p] = GRADIENT_FIXED;
            if (!strcmp(kind, "parts") && fabs(sin(0.3 * x + ripple) * sin(0.27 * y + ripple)) < 0.25)
                w->role[p] = GRADIENT_OUT;
        }
}

static void compose(struct picture *w, const char *kind)
{
    const size_t size = (size_t)w->p.width;
    const double grain = strcmp(kind, "rough") ? 0.08 : 0.28;
    for (size_t p = 0; p < size * size; p++)
        for (int k = 0; k < SOURCES; k++)
            for (int c = 0; c < 3; c++)
                w->source[k][3 * p + (size_t)c] = (float)shown(k, (int)(p % size), (int)(p / size), c, grain);
    choose(w, kind);
    for (size_t p = 0; p < size * size; p++) {
        const float *best = w->source[w->best[p]] + 3 * p;
        memcpy(w->p.value + 3 * p, w->role[p] == GRADIENT_FIXED ? w->source[0] + 3 * p : best, 3 * sizeof *best);
        memcpy(w->data + 3 * p, best, 3 * sizeof *best);
        w->data_weight[p] = 1e-5F;
        if ((p + 1) % size) add_pair(w, w->weight_x + p, w->gradient_x + 3 * p, p, p + 1);
        if (p + size < size * size) add_pair(w, w->weight_y + p, w->gradient_y + 3 * p, p, p + size);
    }
}

typedef enum status solver(const struct gradient_problem *, struct gradient_report *, struct err *);

static double measure(struct picture *w, solver *solve, struct gradient_report *report, struct err *err)
{
    const size_t bytes = 3 * (size_t)w->p.width * (size_t)w->p.width * sizeof(float);
    float *start = malloc(bytes);
    if (!start) err_nomem(err, "the start", bytes);
    double least = INFINITY, total = 0;
    if (start) memcpy(start, w->p.value, bytes);
    while (!err->status && total < 0.5) {
        memcpy(w->p.value, start, bytes);
        const double began = clock_cpu_seconds();
        solve(&w->p, report, err);
        const double seconds = clock_cpu_seconds() - began;
        total += seconds;
        least = fmin(least, seconds);
    }
    free(start);
    return least;
}

static double peak_mib(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return (double)usage.ru_maxrss / 1024;
}

/* Largest difference of value from that of the direct solve, over its range. */
static double error_of(struct picture *w, const float *value, struct err *err)
{
    const size_t count = 3 * (size_t)w->p.width * (size_t)w->p.width;
    struct gradient_report report;
    double most = 0, low = INFINITY, high = -INFINITY;
    if (gradient_solve_direct(&w->p, &report, err)) return 0;
    for (size_t i = 0; i < count; i++) {
        if (w->role[i / 3] == GRADIENT_OUT) continue;
        most = fmax(most, fabs((double)value[i] - (double)w->p.value[i]));
        low = fmin(low, w->p.value[i]);
        high = fmax(high, w->p.value[i]);
    }
    return most / (high - low);
}

static solver *solver_of(const char *name)
{
    if (!strcmp(name, "chosen")) return gradient_solve;
    if (!strcmp(name, "multigrid")) return gradient_solve_multigrid;
    return strcmp(name, "direct") ? NULL : gradient_solve_direct;
}

static enum status run(solver *solve, const char *kind, int size, struct err *err)
{
    const size_t bytes = 3 * (size_t)size * (size_t)size * sizeof(float);
    struct picture w = {0};
    struct gradient_report report = {0};
    float *value = malloc(bytes);
    if (!allocate(&w, size) || !value) err_nomem(err, "the picture", bytes);
    if (!err->status) compose(&w, kind);
    const double seconds = err->status ? 0 : measure(&w, solve, &report, err), peak = peak_mib();
    if (!err->status) memcpy(value, w.p.value, bytes);
    const double error = err->status || solve == gradient_solve_direct ? 0 : error_of(&w, value, err);
    if (!err->status)
        printf("seconds %.6f\npeak_mib %.0f\nerror %.3g\nunit range\nresidual %.3g\niterations %d\nfree %d\n", seconds,
               peak, error, report.residual, report.iterations, report.free);
    free(value);
    release(&w);
    return err->status;
}

int main(int argc, char **argv)
{
    const char *name = "chosen", *kind = "weak", *size_text = "256", *threads_text = "1";
    const struct cli_opt opts[] = {
        CLI_ABOUT("Measures the time of a gradient solve."),
        CLI_STR("solver", &name, 0, "chosen (by gradient_solve), multigrid or direct"),
        CLI_STR("kind", &kind, 0, "weak, half, parts or rough"),
        CLI_STR("size", &size_text, 0, "width and height of the picture"),
        CLI_STR("threads", &threads_text, 0, "threads"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    int64_t size, threads;

    if (cli_parse(argc, argv, "solve", opts, &prov, &err) != CLI_RUN) return err_exit_code(&err);
    if (!scan_int(size_text, &size) || size < 2 || size > 8192 || !scan_int(threads_text, &threads) || threads < 1 ||
        threads > 1024 || !solver_of(name))
        err_set(
            &err, ST_USAGE,
            "found --solver %s --size %s --threads %s; expected chosen, multigrid or direct, a size of 2 to 8192 and 1 "
            "to 1024 threads.",
            name, size_text, threads_text);
    if (!err.status) {
        parallel_set_threads((int)threads);
        rng = rng_make(1, "bench", "solve");
        run(solver_of(name), kind, (int)size, &err);
    }
    err_report(&err);
    return err_exit_code(&err);
}
