/* daylight.c - time and error of daylight factors in a room with an unglazed window, by estimator.
 *
 *   daylight --series levels|hemicube|cosine --effort N
 *
 * A black room of 4 x 4 x 3 m with a hole of 2 x 1.5 m, below the overcast sky of daylight factors; 25 points of a
 * work plane 0.75 m up. Truth is a closed form, integrated once by a fine rule. `levels`: rows of light_levels, N rays
 * by the cosine and N to the window, which give the light of all 145 patches of the sky and of as many suns;
 * `hemicube`: a ray through each pixel of a plain hemicube, N x N; `cosine`: N rays by the cosine. Prints "seconds S"
 * (CPU time of the 25 points in one thread), "error E" (root mean square of the relative error) and "rays N" of a
 * point. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "common/base/cli.h"
#include "common/base/parallel.h"
#include "common/base/scan.h"
#include "common/daylight/sky_luminance.h"
#include "common/gather/strategy.h"
#include "common/light/sobol.h"
#include "common/math/numbers.h"
#include "stages/build_model/solid/unite.h"
#include "stages/light_levels/rows.h"

enum { SIDE = 5, POINTS = SIDE * SIDE, STEPS = 20000 };
static const double OUTDOORS = 10000, LEAST_SECONDS = 0.3;
static char window_name[] = "hole";

struct bench {
    struct model_field field;
    struct daylight opening;
    struct sky_luminance sky;
    struct gather_point points[POINTS];
    double truth[POINTS], found[POINTS]; /* lx */
    int effort;
    double rays;
};

/* ------------------------------------------------------------------------------------------------------------- room */

static enum status add_box(struct solid_list *l, const char *name, struct vec3 low, struct vec3 high, struct err *err)
{
    struct half_space s[6];
    for (int k = 0; k < 6; k++) {
        const double n[3] = {k / 2 == 0, k / 2 == 1, k / 2 == 2}, sign = k % 2 ? 1 : -1;
        s[k] = (struct half_space){vec3_make(sign * n[0], sign * n[1], sign * n[2]), 0, name};
        s[k].offset = vec3_dot(s[k].normal, k % 2 ? high : low);
    }
    return solid_list_add(l, "walls", s, 6, err);
}

static enum status make_room(struct bench *b, struct err *err)
{
    static const struct part {
        const char *name;
        double low[3], high[3];
    } parts[] = {{"floor", {-0.002, -0.002, -0.002}, {4.002, 4.002, 0}},
                 {"ceiling", {-0.002, -0.002, 3}, {4.002, 4.002, 3.002}},
                 {"west", {-0.002, -0.002, 0}, {0, 4.002, 3}},
                 {"east", {4, -0.002, 0}, {4.002, 4.002, 3}},
                 {"north", {0, 4, 0}, {4, 4.002, 3}},
                 {"below", {0, -0.002, 0}, {4, 0, 1}},
                 {"above", {0, -0.002, 2.5}, {4, 0, 3}},
                 {"left", {0, -0.002, 1}, {1, 0, 2.5}},
                 {"right", {3, -0.002, 1}, {4, 0, 2.5}}};
    struct solid_list list = {0};
    struct model_field *f = &b->field;
    for (size_t i = 0; !err->status && i < sizeof parts / sizeof *parts; i++)
        add_box(&list, parts[i].name, vec3_make(parts[i].low[0], parts[i].low[1], parts[i].low[2]),
                vec3_make(parts[i].high[0], parts[i].high[1], parts[i].high[2]), err);
    if (!err->status && !unite_solids(&f->model.mesh, &list, NULL, err))
        model_rays_build(&f->model, MODEL_WITH_GLASS, err);
    solid_list_release(&list);
    if (err->status || outdoors_init(&f->outdoors, 16, err) || field_sky_find(&f->sky, &f->outdoors, err))
        return err->status;
    f->atlas.ids = f->model.ids;
    f->atlas.first = calloc((size_t)f->model.ids + 1, sizeof *f->atlas.first);
    if (!f->atlas.first) return err_nomem(err, "faces", (size_t)f->model.ids * sizeof *f->atlas.first);
    b->opening = (struct daylight){
        .name = window_name, .centre = {2, 0, 1.75}, .x = {1, 0, 0}, .y = {0, 0, 0.75}, .normal = {0, 1, 0}};
    f->lights = (struct light_list){.openings = &b->opening, .opening_count = 1};
    b->sky = sky_of_type(SKY_TRADITIONAL, vec3_make(0, 0, 1), OUTDOORS, 0, 0);
    return ST_OK;
}

/* A window whose lower corner is at the height of a horizontal point, d in front of it, reaches w to one side and h up:
 * illuminance of a sky of luminance 1 + 2 sin(altitude). */
static double corner_light(double d, double w, double h)
{
    double sum = 0;
    for (int i = 0; i < STEPS; i++) {
        const double z = h * (i + 0.5) / STEPS, a2 = d * d + z * z, a = sqrt(a2), r2 = a2 + w * w;
        sum += d * z * (w / (2 * a2 * r2) + atan(w / a) / (2 * a2 * a)) +
               2 * d * z * z * w * (3 * a2 + 2 * w * w) / (3 * a2 * a2 * r2 * sqrt(r2));
    }
    return sum * h / STEPS;
}

static void set_points(struct bench *b)
{
    for (int i = 0; i < POINTS; i++) {
        const double x = 0.5 + 0.75 * (i % SIDE), y = 0.5 + 0.75 * (double)(i / SIDE), z = 0.75;
        const double all = corner_light(y, 3 - x, 2.5 - z) - corner_light(y, 1 - x, 2.5 - z);
        const double below = corner_light(y, 3 - x, 1 - z) - corner_light(y, 1 - x, 1 - z);
        b->points[i] = (struct gather_point){{x, y, z}, {0, 0, 1}};
        b->truth[i] = 9 * OUTDOORS / (7 * PI) / 3 * (all - below);
    }
}

/* ------------------------------------------------------------------------------------------------------- estimators */

static enum status find_levels(struct bench *b, struct err *err)
{
    struct light_groups g;
    struct light_patches p = {0};
    struct light_rows rows = {0};
    struct row_place places[POINTS];
    double luminance[146];
    for (int i = 0; i < POINTS; i++) places[i] = (struct row_place){&b->points[i], 1};
    if (!groups_make(&g, &b->field, true, err) && !patches_make(&p, &b->field, 100, NULL, NULL, err))
        rows_trace(&rows, &g, &p, places, POINTS, b->effort, 1, "points", err);
    if (!err->status) sky_patch_luminances(luminance, &g.patches, &b->sky);
    for (int i = 0; !err->status && i < POINTS; i++) {
        b->found[i] = 0;
        for (int w = 0; w < g.windows_count; w++)
            for (int k = 1; k < g.patches.count; k++)
                b->found[i] += luminance[k] *
                               (double)rows.direct[3 * ((size_t)g.count * (size_t)i + (size_t)groups_patch(&g, w, k))];
    }
    b->rays = 2.0 * b->effort;
    rows_release(&rows);
    patches_release(&p);
    groups_release(&g);
    return err->status;
}

/* Luminance that a point sees. */
static double seen(const struct bench *b, struct gather_point p, struct vec3 direction)
{
    const struct model_rays *m = &b->field.model;
    const struct vec3 from = vec3_add(p.at, vec3_scale(p.normal, m->rays.epsilon));
    return ray_scene_blocked(&m->rays, from, direction, INFINITY) ? 0 : sky_luminance_at(&b->sky, direction);
}

static void find_hemicube(struct bench *b)
{
    const int n = b->effort;
    const double cell = 2.0 / n;
    b->rays = 3.0 * n * n;
    for (int i = 0; i < POINTS; i++) {
        double sum = 0;
        for (int y = 0; y < n; y++)
            for (int x = 0; x < n; x++) {
                const double u = (x + 0.5) * cell - 1, v = (y + 0.5) * cell - 1, r2 = 1 + u * u + v * v;
                const struct vec3 top = vec3_normalize(vec3_make(u, v, 1));
                sum += seen(b, b->points[i], top) * cell * cell / (r2 * r2);
                if (!(v > 0)) continue;
                const struct vec3 sides[4] = {{1, u, v}, {-1, u, v}, {u, 1, v}, {u, -1, v}};
                for (int k = 0; k < 4; k++)
                    sum += seen(b, b->points[i], vec3_normalize(sides[k])) * v * cell * cell / (r2 * r2);
            }
        b->found[i] = sum;
    }
}

static void find_cosine(struct bench *b)
{
    b->rays = b->effort;
    for (int i = 0; i < POINTS; i++) {
        const struct rng rng = rng_make((uint64_t)i, "bench", "daylight");
        struct sobol points = sobol_make(&rng, 0, b->effort);
        struct strategy way;
        double sum = 0;
        strategy_cosine(&way, b->points[i]);
        for (int k = 0; k < b->effort; k++) {
            struct vec3 direction;
            double u[4];
            points.sample = (uint32_t)k;
            sobol_group(&points, 0, u);
            if (strategy_sample(&way, u, &direction)) sum += seen(b, b->points[i], direction);
        }
        b->found[i] = PI * sum / b->effort;
    }
}

static enum status find(struct bench *b, const char *series, struct err *err)
{
    if (!strcmp(series, "levels")) return find_levels(b, err);
    if (!strcmp(series, "hemicube"))
        find_hemicube(b);
    else
        find_cosine(b);
    return ST_OK;
}

/* -------------------------------------------------------------------------------------------------------------- all */

static void print(const struct bench *b, double seconds)
{
    double squares = 0, mean = 0;
    for (int i = 0; i < POINTS; i++) {
        const double e = b->found[i] / b->truth[i] - 1;
        squares += e * e;
        mean += e / POINTS;
    }
    printf("seconds %.6f\nerror %.5g\nunit 1\nbias %.4g\nrays %.0f\n", seconds, sqrt(squares / POINTS), mean, b->rays);
}

int main(int argc, char **argv)
{
    const char *series = NULL, *effort_text = "256";
    const struct cli_opt opts[] = {
        CLI_ABOUT("Measures time and error of daylight factors in a room with an unglazed window."),
        CLI_STR("series", &series, CLI_REQUIRED, "levels, hemicube or cosine"),
        CLI_STR("effort", &effort_text, 0, "rays of a point, or pixels of a side of the hemicube"),
        CLI_END,
    };
    static struct bench b;
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    int64_t effort;
    if (cli_parse(argc, argv, "daylight", opts, &prov, &err) != CLI_RUN) return err_exit_code(&err);
    if (!scan_int(effort_text, &effort) || effort < 2 || effort > 65536 ||
        (strcmp(series, "levels") && strcmp(series, "hemicube") && strcmp(series, "cosine")))
        err_set(&err, ST_USAGE, "found --series %s --effort %s, wanted levels, hemicube or cosine, and 2 to 65536.",
                series, effort_text);
    b.effort = (int)effort;
    parallel_set_threads(1);
    if (!err.status && !make_room(&b, &err)) {
        set_points(&b);
        const clock_t began = clock();
        double seconds = 0;
        int runs = 0;
        while (!err.status && seconds < LEAST_SECONDS) {
            find(&b, series, &err);
            runs++;
            seconds = (double)(clock() - began) / CLOCKS_PER_SEC;
        }
        if (!err.status) print(&b, seconds / runs);
    }
    if (err.status) err_report(&err);
    free(b.field.atlas.first);
    outdoors_release(&b.field.outdoors);
    model_rays_release(&b.field.model);
    provenance_release(&prov);
    return err_exit_code(&err);
}
