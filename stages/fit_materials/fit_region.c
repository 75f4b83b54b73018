/* fit_region.c - see fit_region.h. */
#include "stages/fit_materials/fit_region.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/base/textfile.h"
#include "common/math/numbers.h"

void region_fit_release(struct region_fit *f)
{
    if (!f) return;
    material_samples_release(&f->samples);
    free(f->predicted);
    *f = (struct region_fit){0};
}

/* ------------------------------------------------------------------------------------------------------------ light */

struct lighting {
    struct region_fit *f;
    const struct observations *o;
    const struct observed_scene *scene;
    const struct light_field *field;
    const int *starts; /* index of the first sample of each point, and the end */
    double (*shares)[LIGHT_SOURCES];
};

static void light_point(const struct lighting *l, int k)
{
    const struct materials_params *params = l->scene->params;
    const struct incident_effort effort = {params->lobe_rays, params->emitter_rays, params->diffuse_rays};
    const int first = l->starts[k], count = l->starts[k + 1] - first;
    const struct point_sight *sights = l->o->sights + l->f->first + first;
    const struct material_point *p = &l->o->points[sights->point];
    struct vec3 view[64];
    for (int i = 0; i < count; i++) {
        const struct vec3 eye = model_from_world_point(l->scene->axes, l->scene->set->views[sights[i].view].center);
        view[i] = vec3_normalize(vec3_sub(eye, p->at));
    }
    incident_light_at(&l->f->samples, first, count, l->field, p->at, p->normal, view, &effort, (uint64_t)sights->point,
                      l->shares[k]);
}

static void light_points(void *ctx, size_t begin, size_t end, int thread)
{
    (void)thread;
    for (size_t k = begin; k < end; k++) light_point(ctx, (int)k);
}

/* Gathers the light of all samples, and the mean of its shares over points. */
static enum status gather_light(struct region_fit *f, const struct observations *o, const struct observed_scene *scene,
                                const struct light_field *field, int *points, struct err *err)
{
    const struct material_samples *s = &f->samples;
    int *starts = calloc((size_t)s->count + 1, sizeof *starts), count = 0;
    double(*shares)[LIGHT_SOURCES] = calloc((size_t)s->count + 1, sizeof *shares);
    if (!starts || !shares) {
        free(starts);
        free(shares);
        return err_nomem(err, "the points of a material", (size_t)s->count * sizeof *shares);
    }
    for (int i = 0; i < s->count; i++)
        if (!i || s->point[i] != s->point[i - 1]) starts[count++] = i;
    starts[count] = s->count;
    struct lighting l = {f, o, scene, field, starts, shares};
    parallel_for((size_t)count, 1, light_points, &l);
    for (int k = 0; k < count; k++)
        for (int source = 0; source < LIGHT_SOURCES; source++) f->shares[source] += shares[k][source] / count;
    *points = count;
    free(starts);
    free(shares);
    return ST_OK;
}

/* -------------------------------------------------------------------------------------------------------------- fit */

/* The sights of the material, which become samples. */
static enum status find_samples(struct region_fit *f, const struct material *m, int index, const struct observations *o,
                                const struct observed_scene *scene, struct err *err)
{
    int count = 0;
    for (int i = 0; i < o->sight_count; i++)
        if (o->points[o->sights[i].point].material == index) {
            if (!count) f->first = i;
            count++;
        }
    if (!count)
        return err_set(err, ST_DATA,
                       "%s:%d: no view shows material %s free of clutter, saturation and grazing angles; mark another "
                       "part of it, or raise max_clutter.",
                       scene->path, m->regions[0].line, m->name);
    if (material_samples_init(&f->samples, count, err)) return err->status;
    for (int i = 0; i < count; i++) {
        const struct point_sight *s = &o->sights[f->first + i];
        f->samples.point[i] = s->point;
        memcpy(f->samples.radiance + 3 * i, s->radiance, sizeof s->radiance);
        memcpy(f->samples.variance + 3 * i, s->variance, sizeof s->variance);
    }
    return ST_OK;
}

static struct material_range range_of(struct interval i) { return (struct material_range){i.low, i.high}; }

static void describe(struct material *m, const struct region_fit *f)
{
    const struct material_fit *fit = &f->choice.fit[f->choice.kind];
    m->kind = f->choice.kind;
    memcpy(m->k_d, fit->k_d, sizeof m->k_d);
    m->ks = fit->ks;
    m->shape = fit->shape;
    for (int c = 0; c < 3; c++) m->k_d_range[c] = range_of(fit->k_d_range[c]);
    m->ks_range = range_of(fit->ks_range);
    m->shape_range = range_of(fit->shape_range);
    m->scale = fit->scale;
    for (int k = 0; k < MATERIAL_KINDS; k++)
        m->error[k] = f->choice.fitted[k] && f->choice.folds ? f->choice.error[k] : -1;
}

static int count_views(const struct region_fit *f, const struct observations *o, int views)
{
    int count = 0;
    for (int view = 0; view < views; view++) {
        bool seen = false;
        for (int i = 0; !seen && i < f->samples.count; i++) seen = o->sights[f->first + i].view == view;
        count += seen;
    }
    return count;
}

static enum status predict(struct region_fit *f, struct err *err)
{
    const size_t rows = 3 * (size_t)f->samples.count;
    double *scratch = malloc(2 * rows * sizeof *scratch);
    f->predicted = malloc(rows * sizeof *f->predicted);
    if (scratch && f->predicted)
        fit_predict(&f->samples, f->choice.kind, f->choice.fit[f->choice.kind].x, scratch, f->predicted, NULL);
    const bool made = scratch && f->predicted;
    free(scratch);
    return made ? ST_OK : err_nomem(err, "the residuals of a material", 3 * rows * sizeof *scratch);
}

enum status region_fit_make(struct region_fit *f, struct material *m, int index, bool declared,
                            const struct observations *o, const struct observed_scene *scene,
                            const struct light_field *field, struct err *err)
{
    *f = (struct region_fit){0};
    if (find_samples(f, m, index, o, scene, err) || gather_light(f, o, scene, field, &m->points, err))
        return err->status;
    if (declared ? material_declared(&f->choice, &f->samples, m->kind, err)
                 : material_choose(&f->choice, &f->samples, err))
        return err_context(err, "%s:%d: material %s", scene->path, m->regions[0].line, m->name);
    m->samples = f->samples.count;
    m->views = count_views(f, o, scene->set->view_count);
    m->why = strdup(f->choice.why);
    if (!m->why) return err_nomem(err, "a reason", strlen(f->choice.why) + 1);
    describe(m, f);
    return predict(f, err);
}

void region_fit_print(FILE *to, const struct region_fit *f, const struct material *m, const struct observations *o,
                      const struct observed_scene *scene)
{
    for (int i = 0; i < f->samples.count; i++) {
        const struct point_sight *s = &o->sights[f->first + i];
        fprintf(to, "%s %s %.2f %.2f", m->name, scene->set->views[s->view].name, s->x, s->y);
        for (int c = 0; c < 3; c++) fprintf(to, " %.6g", s->radiance[c]);
        for (int c = 0; c < 3; c++) fprintf(to, " %.6g", f->predicted[3 * i + c]);
        fputc('\n', to);
    }
}
