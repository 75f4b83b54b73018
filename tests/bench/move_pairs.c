/* move_pairs.c - quality of the ends of a camera move, and the cost of finding them.
 *
 *   move_pairs --views DIR --depth DIR --validity FILE [--all [--anew]]
 *
 * and the parameters of plan_path. Without --all it measures the ends that plan_path chooses (ends.h). --all is the
 * reference: it renders the candidate of every cell once, measures the parallax of all pairs that keep max_angle,
 * and tests the pairs in descending order of parallax until one is valid along its whole path. With --anew it also
 * renders both ends of every pair for that pair alone, as a search without a cache would.
 *
 * Prints, for the ends found: "parallax P" (% of the frames, in pictures of JUDGE_SIDE px, which were not used for
 * the choice), "chosen P" (the same in the pictures used for the choice), "angle A" (degrees), "worst_h H" (along
 * the path), "valid 0|1", "pairs N" (with measured parallax), "renders N" (of depth pictures); with --all "best P"
 * (parallax as chosen of the best pair, valid or not); and "seconds S" and "core_s C" (CPU time), both without
 * reading. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/base/cli.h"
#include "common/base/clock.h"
#include "common/base/parallel.h"
#include "stages/plan_path/ends.h"
#include "stages/plan_path/parallax.h"

#define JUDGE_SIDE 640

struct job {
    const char *views, *depth, *validity;
    bool all, anew;
    struct plan_params params;
};

struct found {
    struct move_ends ends;
    double best; /* --all: parallax of the best pair */
    long pairs, renders;
};

struct pair {
    int cell[2];
    double parallax;
};

struct brute {
    const struct layer_scene *scene;
    const struct validity *v;
    const struct plan_params *params;
    int cells[2];
    struct depth_picture *pictures[2]; /* per cell; z NULL: not valid, or --anew */
    bool anew;
    struct pair *pairs; /* grouped by start; parallax below 0: none */
    struct err *errors; /* per cell of the end being rendered; with --anew, of the start */
    int end;
};

static double angle_of(const struct brute *b, const struct vec3 at[2])
{
    const struct vec3 p = vec3_sub(at[0], b->v->shot.centroid), q = vec3_sub(at[1], b->v->shot.centroid);
    return atan2(vec3_length(vec3_cross(p, q)), vec3_dot(p, q)) * 180 / M_PI;
}

static void draw_some(void *ctx, size_t begin, size_t end, int thread)
{
    const struct brute *b = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        if (!b->v->region[b->end].cells[i].valid) continue;
        const struct view camera =
            shot_end_camera(&b->v->shot, &b->v->move.end[b->end], ends_candidate(b->v, b->end, (int)i, SIDE_OWN));
        parallax_picture_make(&b->pictures[b->end][i], b->scene, &camera, b->params->parallax_side, &b->errors[i]);
    }
}

/* Renders both ends for this pair alone. */
static enum status measure_anew(struct pair *p, const struct brute *b, const struct vec3 at[2], struct err *err)
{
    struct depth_picture pictures[2] = {{.z = NULL}};
    for (int k = 0; !err->status && k < 2; k++) {
        const struct view camera = shot_end_camera(&b->v->shot, &b->v->move.end[k], at[k]);
        parallax_picture_make(&pictures[k], b->scene, &camera, b->params->parallax_side, err);
    }
    if (!err->status) p->parallax = parallax_between(&pictures[0], &pictures[1], parallax_tolerance(b->scene));
    for (int k = 0; k < 2; k++) parallax_picture_release(&pictures[k]);
    return err->status;
}

static void measure_some(void *ctx, size_t begin, size_t end, int thread)
{
    const struct brute *b = ctx;
    const double tolerance = parallax_tolerance(b->scene);
    (void)thread;
    for (size_t a = begin; a < end; a++)
        for (int k = 0; k < b->cells[1]; k++) {
            struct pair *p = &b->pairs[a * (size_t)b->cells[1] + (size_t)k];
            *p = (struct pair){{(int)a, k}, -1};
            if (!b->v->region[0].cells[a].valid || !b->v->region[1].cells[k].valid) continue;
            const struct vec3 at[2] = {ends_candidate(b->v, 0, (int)a, SIDE_OWN), ends_candidate(b->v, 1, k, SIDE_OWN)};
            if (angle_of(b, at) > b->params->max_angle) continue;
            if (b->anew)
                measure_anew(p, b, at, &b->errors[a]);
            else
                p->parallax = parallax_between(&b->pictures[0][a], &b->pictures[1][k], tolerance);
        }
}

static int more_parallax_first(const void *a, const void *b)
{
    const struct pair *p = a, *q = b;
    if (p->parallax != q->parallax) return p->parallax > q->parallax ? -1 : 1;
    return p->cell[0] != q->cell[0] ? p->cell[0] - q->cell[0] : p->cell[1] - q->cell[1];
}

/* Tests the whole path between the ends of a pair. */
static enum status measure_path(const struct brute *b, struct viewpoint_test *test, struct move_ends *e,
                                struct err *err)
{
    struct view cameras[PATH_SAMPLES];
    struct viewpoint seen[PATH_SAMPLES];

    for (int i = 0; i < PATH_SAMPLES; i++)
        cameras[i] = shot_camera(&b->v->shot, &b->v->move, e->at, i / (PATH_SAMPLES - 1.0));
    if (viewpoints_measure(seen, cameras, PATH_SAMPLES, test, err)) return err->status;
    e->angle = angle_of(b, e->at);
    e->valid = true;
    for (int i = 0; i < PATH_SAMPLES; i++) {
        e->valid &= seen[i].valid;
        e->worst_h = fmax(e->worst_h, seen[i].h);
    }
    return ST_OK;
}

static enum status draw_candidates(struct brute *b, struct found *f, struct err *err)
{
    for (b->end = 0; !err->status && b->end < 2; b->end++) {
        const size_t cells = (size_t)b->cells[b->end];
        b->pictures[b->end] = calloc(cells + 1, sizeof **b->pictures);
        b->errors = calloc(cells + 1, sizeof *b->errors);
        if (!b->pictures[b->end] || !b->errors) err_nomem(err, "pictures", cells * sizeof **b->pictures);
        if (!err->status) parallel_for(cells, 1, draw_some, b);
        for (size_t i = 0; !err->status && i < cells; i++)
            if (b->errors[i].status) err_set(err, b->errors[i].status, "%s", b->errors[i].text);
        if (!err->status) f->renders += validity_region_count(&b->v->region[b->end]);
        free(b->errors);
        b->errors = NULL;
    }
    return err->status;
}

static enum status measure_pairs(struct brute *b, struct found *f, struct err *err)
{
    const size_t starts = (size_t)b->cells[0];
    if (!b->anew && draw_candidates(b, f, err)) return err->status;
    b->errors = calloc(starts + 1, sizeof *b->errors);
    if (!b->errors) return err_nomem(err, "errors", starts * sizeof *b->errors);
    parallel_for(starts, 1, measure_some, b);
    for (size_t i = 0; !err->status && i < starts; i++)
        if (b->errors[i].status) err_set(err, b->errors[i].status, "%s", b->errors[i].text);
    free(b->errors);
    return err->status;
}

static enum status best_of_all(struct found *f, const struct layer_scene *scene, const struct validity *v, bool anew,
                               const struct plan_params *params, struct err *err)
{
    struct brute b = {.scene = scene, .v = v, .params = params, .anew = anew};
    struct scene_points points = {0};
    struct viewpoint_test test = {.scene = scene, .points = &points, .shot = &v->shot, .limits = v->limits};
    for (int k = 0; k < 2; k++) b.cells[k] = v->region[k].columns * v->region[k].rows;
    const size_t count = (size_t)b.cells[0] * (size_t)b.cells[1];

    b.pairs = malloc(count * sizeof *b.pairs);
    if (!b.pairs) err_nomem(err, "pairs", count * sizeof *b.pairs);
    if (!err->status && !scene_points_collect(&points, scene, err)) measure_pairs(&b, f, err);
    if (!err->status) {
        qsort(b.pairs, count, sizeof *b.pairs, more_parallax_first);
        f->best = fmax(0, b.pairs[0].parallax);
    }
    for (size_t i = 0; !err->status && i < count && b.pairs[i].parallax >= 0; i++) {
        f->pairs++;
        f->renders += anew ? 2 : 0;
        if (f->ends.valid) continue;
        f->ends = (struct move_ends){.parallax = b.pairs[i].parallax};
        for (int k = 0; k < 2; k++) f->ends.at[k] = ends_candidate(v, k, b.pairs[i].cell[k], SIDE_OWN);
        measure_path(&b, &test, &f->ends, err);
    }
    f->renders += test.renders;
    for (int k = 0; k < 2; k++) {
        for (int i = 0; b.pictures[k] && i < b.cells[k]; i++) parallax_picture_release(&b.pictures[k][i]);
        free(b.pictures[k]);
    }
    free(b.pairs);
    viewpoint_test_release(&test);
    scene_points_release(&points);
    return err->status;
}

/* The parallax of the ends in pictures of JUDGE_SIDE px. */
static enum status judge(double *parallax, const struct found *f, const struct layer_scene *scene,
                         const struct validity *v, struct err *err)
{
    struct depth_picture pictures[2] = {{.z = NULL}};
    for (int k = 0; !err->status && k < 2; k++) {
        const struct view camera = shot_end_camera(&v->shot, &v->move.end[k], f->ends.at[k]);
        parallax_picture_make(&pictures[k], scene, &camera, JUDGE_SIDE, err);
    }
    if (!err->status) *parallax = parallax_between(&pictures[0], &pictures[1], parallax_tolerance(scene));
    for (int k = 0; k < 2; k++) parallax_picture_release(&pictures[k]);
    return err->status;
}

static enum status run(const struct job *job, struct err *err)
{
    struct camera_set set = {0};
    struct layer_scene scene = {0};
    struct validity v = {0};
    struct ends_notes notes = {0};
    struct found f = {.best = 0};
    double judged = 0;

    if (!camera_set_read(&set, job->views, NULL, err) && !validity_read(&v, job->validity, NULL, err))
        layer_scene_read(&scene, &set, job->depth, NULL, err);
    const double wall = clock_seconds(), core = clock_cpu_seconds();
    if (!err->status && job->all) best_of_all(&f, &scene, &v, job->anew, &job->params, err);
    if (!err->status && !job->all) {
        ends_choose(&f.ends, &notes, &scene, &v, &job->params, err);
        f.pairs = notes.pairs;
        f.renders = notes.renders;
    }
    const double seconds = clock_seconds() - wall, core_s = clock_cpu_seconds() - core;
    if (!err->status) judge(&judged, &f, &scene, &v, err);
    if (!err->status) {
        printf("seconds %.6g\ncore_s %.6g\nparallax %.3f\nchosen %.3f\n", seconds, core_s, 1e2 * judged,
               1e2 * f.ends.parallax);
        if (job->all) printf("best %.3f\n", 1e2 * f.best);
        printf("angle %.3g\nworst_h %.3g\nvalid %d\npairs %ld\nrenders %ld\n", f.ends.angle, f.ends.worst_h,
               f.ends.valid, f.pairs, f.renders);
    }
    validity_release(&v);
    layer_scene_release(&scene);
    camera_set_release(&set);
    return err->status;
}

int main(int argc, char **argv)
{
    struct job job = {.params = PLAN_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Measures the quality of the ends of a camera move and the cost of finding them."),
        CLI_STR("views", &job.views, CLI_REQUIRED, "folder of cameras"),
        CLI_STR("depth", &job.depth, CLI_REQUIRED, "folder of the layered depth maps"),
        CLI_STR("validity", &job.validity, CLI_REQUIRED, "file with the valid viewpoints of the move"),
        CLI_FLAG("all", &job.all, "search all pairs of cells of the two regions"),
        CLI_FLAG("anew", &job.anew, "with --all: render both ends of every pair for it alone"),
        CLI_PARAMS(plan_param_table, &job.params, plan_params_check),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;

    if (cli_parse(argc, argv, "move_pairs", opts, &prov, &err) == CLI_RUN) run(&job, &err);
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
