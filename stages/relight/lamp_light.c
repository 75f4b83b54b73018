/* lamp_light.c - see lamp_light.h. */
#include "stages/relight/lamp_light.h"

#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/gather/mixture.h"

struct lamp_job {
    const struct pixels *p;
    const struct light_change *c;
    struct light_field field; /* of one emitter */
    int planned;              /* of the edit's lamps; -1: the emitter */
    float (*light)[3];
    int rays;
};

void lamp_light_release(struct lamp_light *l)
{
    if (!l) return;
    for (int i = 0; l->light && i < l->count; i++) free(l->light[i]);
    free(l->light);
    free(l->names);
    *l = (struct lamp_light){0};
}

static void gather_some(void *ctx, size_t begin, size_t end, int thread)
{
    const struct lamp_job *j = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct mixture m;
        struct irradiance e;
        if (!(vec3_length(j->p->after[i].normal) > 0)) continue;
        mixture_init(&m, &j->field, j->p->after[i], MIXTURE_LIGHTS);
        if (!m.count) continue;
        mixture_gather(&e, &m, j->rays, i, false);
        j->light[i][0] = (float)e.value.r;
        j->light[i][1] = (float)e.value.g;
        j->light[i][2] = (float)e.value.b;
    }
}

static void light_some(void *ctx, size_t begin, size_t end, int thread)
{
    const struct lamp_job *j = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        if (!(vec3_length(j->p->after[i].normal) > 0)) continue;
        const struct rgb e = edit_lamps_light(&j->c->lamps, j->planned, &j->c->after, j->p->after[i], i);
        j->light[i][0] = (float)e.r;
        j->light[i][1] = (float)e.g;
        j->light[i][2] = (float)e.b;
    }
}

static enum status add_lamp(struct lamp_light *l, struct lamp_job *j, const char *name, size_t n, struct err *err)
{
    j->light = l->light[l->count] = calloc(n + 1, sizeof *j->light);
    if (!j->light) return err_nomem(err, "the light of a lamp", n * sizeof *j->light);
    l->names[l->count++] = name;
    parallel_for(n, 256, j->planned < 0 ? gather_some : light_some, j);
    return ST_OK;
}

enum status lamp_light_gather(struct lamp_light *l, const struct pixels *p, const struct light_change *c, int rays,
                              struct err *err)
{
    const struct model_field *f = &c->after;
    const size_t n = (size_t)p->width * (size_t)p->height;
    int emitter = 0; /* lamps that are not off come first among the field's own emitters, in order */
    const size_t most = (size_t)f->lights.lamp_count + (size_t)c->lamps.planned.count;
    *l = (struct lamp_light){.names = calloc(most + 1, sizeof *l->names)};
    l->light = calloc(most + 1, sizeof *l->light);
    if (!l->names || !l->light) return err_nomem(err, "lamps", most * sizeof *l->light);
    for (int i = 0; i < f->lights.lamp_count; i++) {
        if (f->lamps[i].off) continue;
        struct lamp_job j = {.p = p, .c = c, .field = f->field, .planned = -1, .rays = rays};
        j.field.emitters = &f->emitters[emitter++];
        j.field.emitter_count = 1;
        if (add_lamp(l, &j, f->lights.lamps[i].name, n, err)) return err->status;
    }
    for (int i = 0; i < c->lamps.planned.count; i++) {
        struct lamp_job j = {.p = p, .c = c, .planned = i};
        if (add_lamp(l, &j, c->lamps.planned.list[i].name, n, err)) return err->status;
    }
    return ST_OK;
}
