/* irradiance.c - error and time of the estimators of irradiance, on fields of light that are known.
 *
 *   irradiance --case sphere|patch|box|window|sun|room --converge FILE
 *   irradiance --case cornell --folder MESHES --converge FILE
 *   irradiance --case model --folder PRODUCTS --converge FILE
 *   irradiance --case ... --estimator rays|blind|hemicube --effort N --truth FILE
 *
 * The first three write the true irradiance at the case's points: in closed form, or where there is none by rays, 2^21
 * at each point, other random numbers than those of the measurement. MESHES has the OBJ files of the Cornell box.
 * PRODUCTS is out/SCENE of a textured model with outdoors, lights and evaluate/irradiance_points.txt, of which 35
 * points are used.
 *
 * The last one gathers at all points with N rays each, or with hemicubes of N x N pixels, by as many threads as there
 * are cores; `blind` are rays that know of no emitter. It prints "seconds S" (wall time for all points, repeated for at
 * least 0.2 s), "core_s S", "error E" (root mean square over the points of the luminance's relative error), "unit 1",
 * "points N", "rays N" (each) and "rays_per_core_s R". */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/clock.h"
#include "common/base/err.h"
#include "common/base/file_path.h"
#include "common/base/parallel.h"
#include "common/gather/model_field.h"
#include "common/light/surface_points.h"
#include "tests/bench/cornell_field.h"
#include "tests/unit/common/gather/fields.h"

enum { POINTS = 35, WIDTH = 7, HEIGHT = 5, CONVERGED = 1 << 21, KEY = 20 };
static const double SECONDS_MIN = 0.2;
static const double LIFT = 0.02; /* of the model's size, as gather_irradiance does */

struct bench {
    const char *folder; /* --folder */
    struct patch_field scene;
    struct cornell_field cornell;
    struct model_field model;
    struct light_field field;
    struct gather_point points[POINTS];
    double truth[POINTS];
    struct irradiance found[POINTS];
    struct hemicube *cube; /* NULL: rays */
    int effort;
    uint64_t key;
};

/* On the floor, each a little further from the middle and turned by the golden angle. */
static void spread_points(struct bench *b, double radius)
{
    for (int i = 0; i < POINTS; i++) {
        const double r = radius * sqrt((i + 0.5) / POINTS), angle = 2.399963 * i;
        b->points[i] = (struct gather_point){{r * cos(angle), r * sin(angle), 0}, {0, 0, 1}};
    }
}

/* A sphere about the points, so large that all are in its middle, whose radiance is 1 + slope . direction. */
static const struct vec3 sphere_slope = {0.3, -0.4, 0.7};

static void look_at_sphere(const void *ctx, const struct vec3 from[RAY_PACKET], struct vec3 normal,
                           const struct vec3 direction[RAY_PACKET], unsigned active, struct light_look seen[RAY_PACKET])
{
    (void)ctx, (void)from, (void)normal;
    for (int k = 0; k < RAY_PACKET; k++)
        if (active >> k & 1)
            seen[k] =
                (struct light_look){rgb_grey(1 + vec3_dot(sphere_slope, direction[k])), INFINITY, LIGHT_TEXTURE, -1};
}

/* Points whose normals are spread over all directions. */
static void make_sphere(struct bench *b)
{
    b->field = (struct light_field){.look = look_at_sphere};
    for (int i = 0; i < POINTS; i++) {
        const double z = (2 * i + 1.0) / POINTS - 1, r = sqrt(1 - z * z), angle = 2.399963 * i;
        b->points[i] = (struct gather_point){{0, 0, 0}, {r * cos(angle), r * sin(angle), z}};
    }
}

static void make_patch(struct bench *b)
{
    field_start(&b->scene, rgb_grey(0));
    field_name(&b->scene, field_add(&b->scene, EMITTER_QUAD, vec3_make(0, 0, 1), vec3_make(0.5, 0, 0),
                                    vec3_make(0, 0.5, 0), vec3_make(0, 0, -1), rgb_grey(1)));
    spread_points(b, 1);
}

static void make_box(struct bench *b)
{
    static const struct rgb sides[6] = {{1, 1, 1}, {2, 2, 2}, {.5, .5, .5}, {.1, .1, .1}, {9, 9, 9}, {4, 4, 4}};
    field_start(&b->scene, rgb_grey(0));
    field_add_box(&b->scene, vec3_make(-1, -2, 0), vec3_make(2, 1, 1.5), sides, true);
    spread_points(b, 0.9);
}

/* A window of 1 % of the hemisphere as the middle sees it, 1000 times as bright as all else. */
static void make_window(struct bench *b)
{
    field_start(&b->scene, rgb_grey(1));
    field_name(&b->scene, field_add(&b->scene, EMITTER_QUAD, vec3_make(1, 0, 1), vec3_make(0, 0.1772, 0),
                                    vec3_make(0, 0, 0.1772), vec3_make(-1, 0, 0), rgb_grey(1000)));
    spread_points(b, 0.5);
}

/* The sun, 0.5 degrees wide, behind the edge of a wall: points across the penumbra. */
static void make_sun(struct bench *b)
{
    const double height = 50 * DEGREE;
    field_start(&b->scene, rgb_grey(1));
    field_add_sun(&b->scene, vec3_make(cos(height), 0, sin(height)), 0.25 * DEGREE, rgb_grey(1e5));
    field_add(&b->scene, EMITTER_QUAD, vec3_make(3, 50, 50), vec3_make(0, 50, 0), vec3_make(0, 0, 50),
              vec3_make(-1, 0, 0), rgb_grey(0));
    for (int i = 0; i < POINTS; i++)
        b->points[i] = (struct gather_point){{0.01 * i, 0.0009 * (i - POINTS / 2), 0}, {0, 0, 1}};
}

static void make_room(struct bench *b)
{
    field_make_room(&b->scene);
    field_see_room(b->points, WIDTH, HEIGHT, &b->scene);
}

static enum status make_cornell(struct bench *b, struct err *err)
{
    if (cornell_make(&b->cornell, b->folder, err)) return err->status;
    b->field = b->cornell.field;
    cornell_see(b->points, WIDTH, HEIGHT, &b->cornell);
    return ST_OK;
}

static enum status read_field(struct bench *b, struct err *err)
{
    char model[FILE_PATH], vita[FILE_PATH], outdoors[FILE_PATH], lights[FILE_PATH];
    if (file_path(model, b->folder, "model/model.txt", "", err) || file_path(vita, b->folder, "vita", "", err) ||
        file_path(outdoors, b->folder, "outdoors/outdoors.exr", "", err) ||
        file_path(lights, b->folder, "lights/lights.txt", "", err))
        return err->status;
    const struct model_field_files files = {model, vita, outdoors, lights, NULL};
    if (model_field_read(&b->model, &files, NULL, err)) return err->status;
    b->field = b->model.field;
    return ST_OK;
}

/* 35 of the points at which the scene's irradiance is evaluated, evenly out of their list. */
static enum status read_points(struct bench *b, const struct model_axes *axes, struct err *err)
{
    struct surface_points all = {0};
    char path[FILE_PATH];
    if (!file_path(path, b->folder, "evaluate/irradiance_points.txt", "", err)) surface_points_read(&all, path, err);
    for (int i = 0; !err->status && i < POINTS; i++) {
        const struct surface_point *p = &all.list[(size_t)i * (size_t)all.count / POINTS];
        b->points[i] =
            (struct gather_point){model_from_world_point(axes, p->at), model_from_world_direction(axes, p->normal)};
        model_field_lift(&b->model, &b->points[i], LIFT * model_rays_size(&b->model.model));
    }
    surface_points_release(&all);
    return err->status;
}

static enum status make_model(struct bench *b, struct err *err)
{
    struct model_axes axes;
    char path[FILE_PATH];
    if (file_path(path, b->folder, "model/axes.txt", "", err) || model_axes_read(&axes, path, NULL, err) ||
        read_field(b, err) || read_points(b, &axes, err))
        return err->status;
    return ST_OK;
}

/* By closed form. False: there is none. */
static bool is_known(struct bench *b, const char *name)
{
    static const char *const known[] = {"patch", "box", "window"};
    bool is_closed = false;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) is_closed |= !strcmp(name, known[i]);
    for (int i = 0; !strcmp(name, "sphere") && i < POINTS; i++)
        b->truth[i] = PI * (1 + 2.0 / 3 * vec3_dot(sphere_slope, b->points[i].normal));
    if (!is_closed) return !strcmp(name, "sphere");
    for (int i = 0; i < POINTS; i++) {
        double sum = 0, seen = 0;
        for (int k = 0; k < b->scene.count; k++) {
            const double factor = patch_factor(&b->scene.patches[k], b->points[i]);
            sum += factor * rgb_luminance(b->scene.patches[k].radiance);
            seen += factor;
        }
        b->truth[i] = PI * (sum + (1 - seen) * rgb_luminance(b->scene.background));
    }
    return true;
}

static void gather(void *ctx, size_t begin, size_t end, int thread)
{
    struct bench *b = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++)
        if (b->cube)
            hemicube_irradiance(&b->found[i], b->cube, &b->field, b->points[i]);
        else
            ray_irradiance(&b->found[i], &b->field, b->points[i], b->effort, b->key + i);
}

static enum status write_truth(struct bench *b, const char *name, const char *path, struct err *err)
{
    FILE *fp = fopen(path, "w");
    if (!fp) return err_set(err, ST_IO, "cannot write %s.", path);
    if (!is_known(b, name)) {
        b->effort = CONVERGED;
        b->key = 1000 * KEY;
        parallel_for(POINTS, 1, gather, b);
        for (int i = 0; i < POINTS; i++) b->truth[i] = rgb_luminance(b->found[i].value);
    }
    for (int i = 0; i < POINTS; i++) fprintf(fp, "%.17g\n", b->truth[i]);
    return fclose(fp) ? err_set(err, ST_IO, "cannot write %s.", path) : ST_OK;
}

static enum status read_truth(struct bench *b, const char *path, struct err *err)
{
    FILE *fp = fopen(path, "r");
    int count = 0;
    while (fp && count < POINTS && fscanf(fp, "%lf", &b->truth[count]) == 1) count++;
    if (fp) fclose(fp);
    if (count == POINTS) return ST_OK;
    return err_set(err, ST_DATA, "%s has %d values, wanted %d; write it with --converge.", path, count, POINTS);
}

static void measure(struct bench *b)
{
    const double begin = clock_seconds();
    const double cpu = clock_cpu_seconds();
    double squares = 0, rays = 0, seconds, core;
    int rounds = 0;
    b->key = KEY;
    do {
        parallel_for(POINTS, 1, gather, b);
        rounds++;
        seconds = clock_seconds() - begin;
    } while (seconds < SECONDS_MIN);
    core = (clock_cpu_seconds() - cpu) / rounds;
    for (int i = 0; i < POINTS; i++) {
        squares += pow(rgb_luminance(b->found[i].value) / b->truth[i] - 1, 2) / POINTS;
        rays += (double)b->found[i].rays / POINTS;
    }
    printf("seconds %.6g\ncore_s %.6g\nerror %.6g\nunit 1\npoints %d\nrays %.6g\nrays_per_core_s %.4g\n",
           seconds / rounds, core, sqrt(squares), (int)POINTS, rays, rays * POINTS / fmax(core, 1e-9));
}

/* Either of the two makes a case: fields of patches, or what is read from files. */
static const struct bench_case {
    const char *name;
    void (*make)(struct bench *);
    enum status (*read)(struct bench *, struct err *);
} cases[] = {{"sphere", make_sphere, NULL}, {"patch", make_patch, NULL},    {"box", make_box, NULL},
             {"window", make_window, NULL}, {"sun", make_sun, NULL},        {"room", make_room, NULL},
             {"model", NULL, make_model},   {"cornell", NULL, make_cornell}};

static enum status make_case(struct bench *b, const char *name, struct err *err)
{
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        if (strcmp(cases[i].name, name)) continue;
        if (cases[i].read && !b->folder) return err_set(err, ST_USAGE, "--case %s needs --folder.", name);
        if (cases[i].read) return cases[i].read(b, err);
        cases[i].make(b);
        if (b->scene.field.look) b->field = b->scene.field;
        return ST_OK;
    }
    return err_set(err, ST_USAGE, "unknown case %s; irradiance.c lists the cases at its top.", name);
}

static const char *option(int argc, char **argv, const char *name)
{
    for (int i = 1; i + 1 < argc; i += 2)
        if (!strcmp(argv[i], name)) return argv[i + 1];
    return NULL;
}

static enum status run(struct bench *b, int argc, char **argv, struct err *err)
{
    const char *name = option(argc, argv, "--case"), *converge = option(argc, argv, "--converge");
    const char *estimator = option(argc, argv, "--estimator"), *effort = option(argc, argv, "--effort");
    const char *truth = option(argc, argv, "--truth");
    if (!name || !(converge || (estimator && effort && truth)))
        return err_set(err, ST_USAGE, "wanted --case NAME with --converge FILE, or --estimator, --effort and --truth.");
    b->folder = option(argc, argv, "--folder");
    if (make_case(b, name, err)) return err->status;
    if (converge) return write_truth(b, name, converge, err);
    b->effort = atoi(effort);
    if (!strcmp(estimator, "blind")) b->field.emitter_count = 0;
    if (read_truth(b, truth, err)) return err->status;
    if (!strcmp(estimator, "hemicube") && hemicube_make(&b->cube, b->effort, err)) return err->status;
    measure(b);
    return ST_OK;
}

int main(int argc, char **argv)
{
    static struct bench b;
    struct err err = ERR_INIT;
    run(&b, argc, argv, &err);
    hemicube_free(b.cube);
    cornell_release(&b.cornell);
    model_field_release(&b.model);
    err_report(&err);
    return err_exit_code(&err);
}
