/* materials.c - how near fitted materials are to simulated ones.
 *
 *   materials [--kind lambert|phong|ward] [--views N] [--truths N] [--samples N] [--noise F] [--threads N]
 *
 * Each truth is a random floor in a random box room (tests/unit/glossy_room.h), whose lamps, windows and walls have
 * known radiance: N samples on a grid of points, seen from random places, with noise. Truths have k_d of 0.1 to 0.8 /
 * pi, n of 5 to 500 or alpha of 0.05 to 0.5, and a lobe that gives 10 to 90 % of the light of the brightest sample. The
 * fit gets the light from its own rays, knows neither model nor parameters, and chooses the model.
 *
 * A truth is met if the right model is chosen, k_d is within 2 % in each channel, k_s within 10 % and n or alpha within
 * 15 %. Prints "seconds S", "error F" (fraction of truths that are not met), "chosen F" (the right model), percentiles
 * of the relative errors where it was, and a histogram of the largest error of a truth over its target:
 * "to_quarter", "to_half", "to_1" (met), "to_2", "beyond", "other_model". */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/clock.h"
#include "common/base/parallel.h"
#include "common/base/sort.h"
#include "stages/fit_materials/choose_material.h"
#include "stages/fit_materials/incident.h"
#include "tests/unit/glossy_room.h"

#define SHARE_MIN 0.1
#define SHARE_MAX 0.9

static const struct incident_effort effort = {1024, 128, 2048};

struct trial {
    enum brdf_kind chosen;
    double k_d, ks, shape; /* relative errors */
    bool inside[3];        /* the truth is in the intervals: k_d of all channels, ks, shape */
};

struct work {
    enum brdf_kind kind;
    int views, samples, truths;
    double noise;
    struct trial *trials;
    bool failed;
};

struct view_of {
    struct vec3 at, view;
};

/* A random reflectance. k_s makes the lobe `share` of the brightest sample. */
static struct brdf random_brdf(enum brdf_kind kind, uint64_t seed, double *share)
{
    const struct rng rng = rng_make(seed, "bench", "material");
    int at = 0;
    struct brdf b = {.kind = kind, .gloss = 1, .ks = 1};
    b.albedo.r = room_random(&rng, seed, &at, 0.1, 0.8);
    b.albedo.g = room_random(&rng, seed, &at, 0.1, 0.8);
    b.albedo.b = room_random(&rng, seed, &at, 0.1, 0.8);
    const double shape = room_random(&rng, seed, &at, 0, 1);
    if (kind != BRDF_LAMBERT) b.shape = kind == BRDF_WARD ? 0.05 * pow(10, shape) : 5 * pow(100, shape);
    *share = room_random(&rng, seed, &at, SHARE_MIN, SHARE_MAX);
    return b;
}

/* Diffuse and glossy light (ks = 1) of all samples. */
static void light_samples(struct rgb *diffuse, struct rgb *gloss, const struct glossy_room *room, const struct brdf *b,
                          const struct view_of *views, int count)
{
    struct brdf lobe = *b;
    lobe.albedo = rgb_grey(0);
    for (int i = 0; i < count; i++) {
        diffuse[i] = rgb_scale(rgb_multiply(b->albedo, room_irradiance(room, views[i].at)), 1 / PI);
        gloss[i] = b->kind == BRDF_LAMBERT ? rgb_grey(0) : room_reflection(room, &lobe, views[i].at, views[i].view);
    }
}

/* The ks with which the lobe has `share` of the light of the sample that is then the brightest: by bisection. */
static double ks_for_share(const struct rgb *diffuse, const struct rgb *gloss, int count, double share)
{
    double low = 1e-9, high = 1e9;
    for (int round = 0; round < 100; round++) {
        const double ks = sqrt(low * high);
        double brightest = -1, its_share = 0;
        for (int i = 0; i < count; i++) {
            const double d = rgb_luminance(diffuse[i]), g = ks * rgb_luminance(gloss[i]);
            if (d + g > brightest) brightest = d + g, its_share = g / (d + g);
        }
        *(its_share < share ? &low : &high) = ks;
    }
    return high;
}

static void place_views(struct view_of *views, struct material_samples *s, const struct glossy_room *room,
                        uint64_t seed, int per_point, int columns, int rows)
{
    for (int p = 0; p < columns * rows; p++)
        for (int v = 0; v < per_point; v++) {
            const int i = p * per_point + v;
            views[i].at = room_grid_point(room, p, columns, rows);
            views[i].view = vec3_normalize(vec3_sub(room_viewer(room, seed, v), views[i].at));
            s->point[i] = p;
        }
}

static void observe(struct material_samples *s, const struct rgb *diffuse, const struct rgb *gloss, double ks,
                    double noise, uint64_t seed)
{
    const struct rng rng = rng_make(seed, "bench", "noise");
    for (int i = 0; i < s->count; i++) {
        const struct rgb sum = rgb_add(diffuse[i], rgb_scale(gloss[i], ks));
        const double light[3] = {sum.r, sum.g, sum.b};
        for (int c = 0; c < 3; c++) {
            const double seen = light[c] * (1 + noise * room_normal(&rng, (uint64_t)i, (uint64_t)c));
            s->radiance[3 * i + c] = seen;
            s->variance[3 * i + c] = noise * seen * noise * seen;
        }
    }
}

static bool within(struct interval range, double value) { return value >= range.low && value <= range.high; }

static void judge(struct trial *t, const struct material_choice *choice, const struct brdf *truth)
{
    const struct material_fit *f = &choice->fit[choice->kind];
    const double k_d[3] = {truth->albedo.r / PI, truth->albedo.g / PI, truth->albedo.b / PI};
    *t = (struct trial){.chosen = choice->kind,
                        .inside = {true, within(f->ks_range, truth->ks), within(f->shape_range, truth->shape)}};
    for (int c = 0; c < 3; c++) {
        t->k_d = fmax(t->k_d, fabs(f->k_d[c] / k_d[c] - 1));
        t->inside[0] &= within(f->k_d_range[c], k_d[c]);
    }
    if (truth->kind == BRDF_LAMBERT || choice->kind != truth->kind) return;
    t->ks = fabs(f->ks / truth->ks - 1);
    t->shape = fabs(f->shape / truth->shape - 1);
}

static enum status fit_samples(struct trial *t, struct material_samples *s, const struct glossy_room *room,
                               const struct view_of *views, const struct brdf *truth, const struct work *w,
                               uint64_t seed, struct err *err)
{
    const struct light_field field = room_field(room);
    struct vec3 view[64];
    for (int i = 0; i < s->count; i += w->views) {
        for (int v = 0; v < w->views; v++) view[v] = views[i + v].view;
        incident_light_at(s, i, w->views, &field, views[i].at, vec3_make(0, 0, 1), view, &effort,
                          seed * 1000 + (uint64_t)i, NULL);
    }
    struct material_choice *choice = malloc(sizeof *choice);
    if (!choice) return err_nomem(err, "a choice", sizeof *choice);
    if (!material_choose(choice, s, err)) judge(t, choice, truth);
    free(choice);
    return err->status;
}

static enum status run_trial(struct trial *t, const struct work *w, uint64_t seed, struct err *err)
{
    const int points = w->samples / w->views, columns = (int)sqrt(points * 1.25), rows = points / columns;
    const int count = columns * rows * w->views;
    struct glossy_room room;
    struct material_samples s = {0};
    struct view_of *views = malloc((size_t)count * sizeof *views);
    struct rgb *diffuse = malloc((size_t)count * sizeof *diffuse), *gloss = malloc((size_t)count * sizeof *gloss);
    double share;
    struct brdf b = random_brdf(w->kind, seed, &share);
    room_make(&room, seed);
    if (views && diffuse && gloss)
        material_samples_init(&s, count, err);
    else
        err_nomem(err, "samples", 0);
    if (!err->status) {
        place_views(views, &s, &room, seed, w->views, columns, rows);
        light_samples(diffuse, gloss, &room, &b, views, count);
        b.ks = w->kind == BRDF_LAMBERT ? 0 : ks_for_share(diffuse, gloss, count, share);
        observe(&s, diffuse, gloss, b.ks, w->noise, seed);
        fit_samples(t, &s, &room, views, &b, w, seed, err);
    }
    if (!err->status && getenv("MATERIALS_VERBOSE"))
        fprintf(stderr, "%d: shape %.3g share %.2f ks %.3g chosen %s errors %.4f %.4f %.4f\n", (int)seed, b.shape,
                share, b.ks, material_kind_name(t->chosen), t->k_d, t->ks, t->shape);
    material_samples_release(&s);
    free(views);
    free(diffuse);
    free(gloss);
    return err->status;
}

static void run_trials(void *ctx, size_t begin, size_t end, int thread)
{
    struct work *w = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct err err = ERR_INIT;
        if (run_trial(&w->trials[i], w, i + 1, &err)) {
            fprintf(stderr, "truth %zu: %s\n", i, err.text);
            w->failed = true;
        }
    }
}

/* ----------------------------------------------------------------------------------------------------------- report */

static void print_percentiles(const char *name, const struct work *w, size_t offset)
{
    double *values = malloc((size_t)w->truths * sizeof *values);
    size_t count = 0;
    for (int i = 0; values && i < w->truths; i++)
        if (w->trials[i].chosen == w->kind)
            values[count++] = *(const double *)(const void *)((const char *)&w->trials[i] + offset);
    if (count) sort_doubles(values, count);
    printf("%s_50 %.5f\n%s_90 %.5f\n", name, count ? values[count / 2] : 0.0, name,
           count ? values[count * 9 / 10] : 0.0);
    free(values);
}

static void report(const struct work *w)
{
    static const char *const names[] = {"to_quarter", "to_half", "to_1", "to_2", "beyond"};
    static const double ends[] = {0.25, 0.5, 1, 2, INFINITY};
    int histogram[5] = {0}, other = 0, inside[3] = {0};
    for (int i = 0; i < w->truths; i++) {
        const struct trial *t = &w->trials[i];
        const double worst = fmax(t->k_d / 0.02, fmax(t->ks / 0.1, t->shape / 0.15));
        int bin = 0;
        while (worst > ends[bin]) bin++;
        *(t->chosen == w->kind ? &histogram[bin] : &other) += 1;
        for (int k = 0; k < 3; k++) inside[k] += t->chosen == w->kind && t->inside[k];
    }
    const int met = histogram[0] + histogram[1] + histogram[2], right = w->truths - other;
    printf("error %.4f\nunit fraction\nchosen %.4f\n", 1 - (double)met / w->truths, (double)right / w->truths);
    print_percentiles("k_d", w, offsetof(struct trial, k_d));
    print_percentiles("k_s", w, offsetof(struct trial, ks));
    print_percentiles("shape", w, offsetof(struct trial, shape));
    for (int k = 0; k < 5; k++) printf("%s %d\n", names[k], histogram[k]);
    printf("other_model %d\n", other);
    printf("in_k_d %.3f\nin_k_s %.3f\nin_shape %.3f\n", (double)inside[0] / right, (double)inside[1] / right,
           (double)inside[2] / right);
}

int main(int argc, char **argv)
{
    struct work w = {.kind = BRDF_PHONG, .views = 6, .samples = 400, .truths = 200, .noise = 0.01};
    const char *kind = "phong";
    int per_mille = 10;
    const struct cli_opt opts[] = {
        CLI_ABOUT("measures how near fitted materials are to simulated ones"),
        CLI_STR("kind", &kind, CLI_OPTIONAL, "lambert, phong or ward: the model of the truths"),
        CLI_INT("views", &w.views, CLI_OPTIONAL, "number of views"),
        CLI_INT("truths", &w.truths, CLI_OPTIONAL, "number of truths"),
        CLI_INT("samples", &w.samples, CLI_OPTIONAL, "largest number of samples of a truth"),
        CLI_INT("noise", &per_mille, CLI_OPTIONAL, "noise, thousandths of the radiance"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "materials", opts, &prov, &err) != CLI_RUN) {
        err_report(&err);
        return err_exit_code(&err);
    }
    w.kind = !strcmp(kind, "lambert") ? BRDF_LAMBERT : !strcmp(kind, "ward") ? BRDF_WARD : BRDF_PHONG;
    w.noise = per_mille / 1000.0;
    w.trials = calloc((size_t)w.truths, sizeof *w.trials);
    if (!w.trials || w.views < 1 || w.views > 64 || w.samples < 8 * w.views) return 2;
    const double began = clock_seconds();
    parallel_for((size_t)w.truths, 1, run_trials, &w);
    printf("seconds %.3f\n", clock_seconds() - began);
    if (!w.failed) report(&w);
    free(w.trials);
    provenance_release(&prov);
    return w.failed;
}
