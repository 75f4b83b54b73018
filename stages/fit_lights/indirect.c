/* indirect.c - see indirect.h. */
#include "stages/fit_lights/indirect.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/outfile.h"
#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "common/base/textfile.h"

enum { LINE_STEP = 20 }; /* points of a line from node to node */
#define SAME_PLACE 1e-3  /* in parts of the distance from the origin, or scene units */

/* Points of a line follow each other, the first at 0 and the last at 1. */
static bool is_node(const struct lit_scene *s, int i)
{
    const struct lit_point *p = &s->points[i];
    int first = i;
    if (p->kind != NOTE_LINE || p->along <= 0 || p->along >= 1) return true;
    while (s->points[first].along > 0) first--;
    return (i - first) % LINE_STEP == 0;
}

void indirect_release(struct indirect *in)
{
    free(in->nodes);
    free(in->at);
    *in = (struct indirect){0};
}

enum status indirect_init(struct indirect *in, const struct lit_scene *scene, struct err *err)
{
    const size_t n = (size_t)scene->point_count + 1;
    *in = (struct indirect){calloc(n, sizeof *in->nodes), 0, calloc(n, sizeof *in->at)};
    if (!in->nodes || !in->at) {
        indirect_release(in);
        return err_nomem(err, "irradiances of points", n * sizeof *in->at);
    }
    for (int i = 0; i < scene->point_count; i++)
        if (is_node(scene, i)) in->nodes[in->count++] = i;
    return ST_OK;
}

enum status indirect_list(const struct indirect *in, const struct lit_scene *scene, const struct model_axes *axes,
                          const char *path, const struct provenance *prov, struct err *err)
{
    struct outfile f = {0};
    outfile_open(&f, path, err);
    if (!err->status && prov) provenance_print(prov, f.fp);
    for (int k = 0; !err->status && k < in->count; k++) {
        const struct lit_point *p = &scene->points[in->nodes[k]];
        const struct vec3 at = world_from_model_point(axes, p->at), n = world_from_model_direction(axes, p->normal);
        fprintf(f.fp, "%.17g %.17g %.17g %.9g %.9g %.9g\n", at.x, at.y, at.z, n.x, n.y, n.z);
    }
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

static enum status read_node(struct indirect *in, int k, struct textfile *t, struct vec3 wanted, struct err *err)
{
    static const char *const names[] = {
        "x", "y", "z", "nx", "ny", "nz", "red irradiance", "green irradiance", "blue irradiance"};
    double v[9];
    for (int i = 0; i < 6; i++)
        if (textfile_double(t, names[i], &v[i], err)) return err->status;
    for (int i = 6; i < 9; i++)
        if (textfile_number(t, names[i], 0, 1e30, &v[i], err)) return err->status;
    const double off = vec3_length(vec3_sub(vec3_make(v[0], v[1], v[2]), wanted));
    if (!(off <= SAME_PLACE * fmax(1, vec3_length(wanted))))
        return textfile_error(t, err, "another point", "the point %.6g %.6g %.6g; list the points again", wanted.x,
                              wanted.y, wanted.z);
    indirect_set(in, k, rgb_make(v[6], v[7], v[8]));
    return textfile_end(t, err);
}

enum status indirect_read(struct indirect *in, const struct lit_scene *scene, const struct model_axes *axes,
                          const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    provenance_open(prov, "lights/indirect.txt", &t, path, err);
    for (int k = 0; !err->status && k < in->count; k++) {
        const struct vec3 at = world_from_model_point(axes, scene->points[in->nodes[k]].at);
        if (!textfile_next(&t))
            textfile_error(&t, err, NULL, "%d points, one for each that was listed", in->count);
        else
            read_node(in, k, &t, at, err);
    }
    if (!err->status) textfile_end_of_file(&t, err);
    textfile_release(&t);
    if (!err->status) indirect_spread(in, scene);
    return err->status;
}

struct gather_job {
    struct indirect *in;
    const struct lit_scene *scene;
    const struct light_field *field;
    const struct gatherer *gatherer;
    struct progress progress;
};

static void gather_nodes(void *ctx, size_t begin, size_t end, int thread)
{
    struct gather_job *j = ctx;
    (void)thread;
    for (size_t k = begin; k < end; k++) {
        const struct lit_point *p = &j->scene->points[j->in->nodes[k]];
        struct irradiance e;
        gatherer_irradiance(&e, j->gatherer, j->field, (struct gather_point){p->at, p->normal}, k);
        indirect_set(j->in, (int)k, e.value);
        progress_add(&j->progress, 1);
    }
}

void indirect_gather(struct indirect *in, const struct lit_scene *scene, const struct light_field *field,
                     const struct gatherer *gatherer)
{
    struct gather_job job = {.in = in, .scene = scene, .field = field, .gatherer = gatherer};
    progress_start(&job.progress, "indirect light", (size_t)in->count, "points");
    parallel_for((size_t)in->count, 1, gather_nodes, &job);
    progress_end(&job.progress);
    indirect_spread(in, scene);
}

void indirect_set(struct indirect *in, int k, struct rgb e)
{
    double *at = in->at[in->nodes[k]];
    at[0] = e.r;
    at[1] = e.g;
    at[2] = e.b;
}

void indirect_spread(struct indirect *in, const struct lit_scene *scene)
{
    for (int k = 0; k + 1 < in->count; k++) {
        const int from = in->nodes[k], to = in->nodes[k + 1];
        if (scene->points[to].along <= scene->points[from].along) continue; /* another line, or no line */
        for (int i = from + 1; i < to; i++)
            for (int c = 0; c < 3; c++) {
                const double t = (i - from) / (double)(to - from);
                in->at[i][c] = (1 - t) * in->at[from][c] + t * in->at[to][c];
            }
    }
}
