/* view_gloss.c - see view_gloss.h.
 *
 * A pixel of a material shows k_d E + k_s I_s. I_s is stored without k_s, so that k_s can change without a gather. The
 * rays of a pixel go on until the error of k_s I_s is at most the target of all that it shows: a dull lobe on a bright
 * surface needs few. What it reflects includes other glossy surfaces by one nested gather (field_materials.c). */
#include "stages/gather_irradiance/view_gloss.h"

#include <stdlib.h>

#include "common/base/log.h"
#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "common/gather/specular.h"
#include "common/math/numbers.h"

enum { CHUNK = 64 };
static const uint64_t KEY = 0x676c6f7373; /* other random numbers than those of the irradiance */

struct task {
    struct view_gloss *gloss;
    const struct gather_job *job;
    const struct view *view;
    const struct gather_point *points;
    const int *faces;
    const struct irradiance *irradiance;
    int *rays;
    struct progress progress;
};

void view_gloss_release(struct view_gloss *g)
{
    free(g->material);
    free(g->specular);
    *g = (struct view_gloss){0};
}

/* The luminance of k_d E in the unit of I_s. */
static double diffuse_beside(const struct brdf *b, const struct irradiance *e)
{
    return rgb_luminance(rgb_multiply(b->albedo, e->value)) / (PI * b->ks);
}

static void gather_pixel(const struct task *t, size_t i)
{
    const struct model_field *f = &t->job->field;
    const int material = model_field_material(f, t->faces[i], t->points[i].at);
    struct irradiance e;
    if (material < 0) return;
    t->gloss->material[i] = (uint32_t)material + 1;
    struct brdf b = f->materials.brdfs[material];
    if (!(b.gloss > 0)) return;
    const double beside = diffuse_beside(&b, &t->irradiance[i]);
    b.ks = 1;
    specular_integral_beside(&e, &f->field, t->points[i], &b,
                             vec3_normalize(vec3_sub(t->view->center, t->points[i].at)), beside,
                             t->job->params.target_error, t->job->params.rays, KEY + i);
    t->gloss->specular[i] = e.value;
    t->rays[i] = e.rays;
}

static void gather_pixels(void *ctx, size_t begin, size_t end, int thread)
{
    struct task *t = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++)
        if (t->faces[i]) gather_pixel(t, i);
    progress_add(&t->progress, (int64_t)(end - begin));
}

static void report(const struct task *t, size_t pixels)
{
    size_t glossy = 0;
    double rays = 0;
    for (size_t i = 0; i < pixels; i++) {
        glossy += t->rays[i] > 0;
        rays += t->rays[i];
    }
    log_note("%zu of %zu pixels show a glossy material, %.3g rays each", glossy, pixels,
             glossy ? rays / (double)glossy : 0);
}

enum status view_gloss_gather(struct view_gloss *g, const struct gather_job *j, const struct view *view,
                              const struct gather_point *points, const int *faces, const struct irradiance *irradiance,
                              struct err *err)
{
    const size_t pixels = (size_t)view->width * (size_t)view->height;
    struct task t = {.gloss = g, .job = j, .view = view, .points = points, .faces = faces, .irradiance = irradiance};
    g->material = calloc(pixels + 1, sizeof *g->material);
    g->specular = calloc(pixels + 1, sizeof *g->specular);
    t.rays = calloc(pixels + 1, sizeof *t.rays);
    if (!g->material || !g->specular || !t.rays) {
        free(t.rays);
        return err_nomem(err, "glossy pixels", pixels * sizeof *g->specular);
    }
    progress_start(&t.progress, "gloss", (int64_t)pixels, "pixels");
    parallel_for(pixels, CHUNK, gather_pixels, &t);
    progress_end(&t.progress);
    report(&t, pixels);
    free(t.rays);
    return ST_OK;
}
