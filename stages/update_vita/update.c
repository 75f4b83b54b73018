/* update.c - see update.h.
 *
 * Overview. Samples are spread over the faces of the edited model. Where the quotient of light differs between
 * neighbouring samples, more are put between them: at the edge of a new patch of sun, in a shadow. Then rays are traced
 * once from each (transport.h), light is passed between the samples until it settles (light_rounds.h), and the texels
 * are multiplied by what the samples around them say (edited_atlas.h).
 *
 * Faces from which almost nothing but the outdoors is seen, the outer sides of the walls, keep their texels. */
#include "stages/update_vita/update.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/progress.h"
#include "common/model/model_metre.h"
#include "common/product/product.h"
#include "common/relight/light_quotient.h"
#include "stages/update_vita/edited_atlas.h"
#include "stages/update_vita/light_rounds.h"

enum { GLANCES = 64, FEW_RAYS = 4 }; /* rays that tell an outer face; rays / this choose where samples are needed */
static const double OUTSIDE = 0.9;   /* of the rays see the outdoors */
/* A room reflects less than 95 % of its light: if lamps and windows give a smaller share of it than the rest, they are
 * not known. Then rooms are taken to reflect what bright ones do. */
enum { ASKED = 512 }; /* samples that tell of it */
static const double LEAST_KNOWN = 0.05, REFLECTING = 0.8;

struct work {
    struct update_job *job;
    struct light_change change;
    struct edited_atlas atlas;
    struct face_nets nets;
    struct transport transport;
    struct rounds rounds;
    struct progress progress;
    double known;      /* share of the light before the edit that comes from lamps and from outdoors */
    double reflecting; /* for rounds_run() */
};

/* ------------------------------------------------------------------------------------------------------------ faces */

/* Whether the middle of a face sees little but the outdoors. */
static bool is_outside(const struct light_change *c, int face)
{
    const struct solid_mesh *mesh = &c->after.model.mesh;
    const int h = mesh->loops[mesh->faces[face].loop].half_edge;
    struct gather_point p = {{0, 0, 0}, mesh->faces[face].normal};
    struct irradiance e;
    int corners = 0, at = h;
    do {
        p.at = vec3_add(p.at, mesh->vertices[mesh->half_edges[at].origin].p);
        corners++;
        at = mesh->half_edges[at].next;
    } while (at != h);
    p.at = vec3_scale(p.at, 1.0 / corners);
    ray_irradiance(&e, &c->after.field, p, GLANCES, (uint64_t)face);
    return e.from[LIGHT_SKY] + e.from[LIGHT_SKY_GUESSED] > OUTSIDE &&
           e.mean_inverse * model_rays_size(&c->after.model) < 1;
}

static enum status make_nets(struct work *w, struct err *err)
{
    const struct solid_mesh *mesh = &w->change.after.model.mesh;
    const double size = model_rays_size(&w->change.after.model);
    bool *wanted = calloc((size_t)mesh->face_count + 1, sizeof *wanted);
    if (!wanted) return err_nomem(err, "faces", (size_t)mesh->face_count);
    for (int i = 0; i < mesh->face_count; i++) wanted[i] = !solid_face_is_pane(mesh, i) && !is_outside(&w->change, i);
    face_nets_make(&w->nets, mesh, wanted, w->job->params.spacing * size, err);
    free(wanted);
    return err->status;
}

/* Finds which share of the light before the edit comes from what is known to shine. */
static void ask_for_light(struct work *w)
{
    const struct transport *t = &w->transport;
    const int step = t->count / ASKED + 1;
    double known = 0, all = 0;
    for (int i = 0; i < t->count; i += step) {
        struct irradiance e;
        if (t->samples[i].place.kind != LIGHT_PLACE_TEXTURE) continue;
        ray_irradiance(&e, &w->change.before.field, t->samples[i].place.before, GLANCES, (uint64_t)i);
        const double light = rgb_luminance(e.value);
        known += light * (e.from[LIGHT_SKY] + e.from[LIGHT_SKY_GUESSED] + e.from[LIGHT_LAMP]);
        all += light;
    }
    w->known = all > 0 ? known / all : 1;
    w->reflecting = w->known < LEAST_KNOWN ? REFLECTING : 1;
}

/* ------------------------------------------------------------------------------------------------------- refinement */

static void count_done(void *ctx, int64_t samples) { progress_add(ctx, samples); }

/* Few rays tell where samples are needed. Rows of earlier samples stay: what they send to samples that lay further
 * apart differs little. */
static enum status trace_few(struct work *w, int first, int count, struct err *err)
{
    const int rays = w->job->params.rays / FEW_RAYS;
    return transport_trace(&w->transport, first, count, rays < GLANCES ? GLANCES : rays, NULL, NULL, err);
}

/* The quotients, or irradiances, of all samples after two rounds. */
static enum status first_values(const struct work *w, struct rgb **values, struct err *err)
{
    struct rounds r = {0};
    rounds_run(&r, &w->transport, w->reflecting, 2, w->job->params.tolerance, err);
    *values = r.values;
    r.values = NULL;
    rounds_release(&r);
    return err->status;
}

/* How far light differs between two samples. The rim of a hole behind furniture always counts: there the shadow is
 * deepest, and the hole continues the light of the samples beside it. */
static double difference(const struct work *w, const struct rgb *values, int a, int b)
{
    const struct transport *t = &w->transport;
    if (w->change.things.changes && transport_is_hole(t, a) != transport_is_hole(t, b)) return INFINITY;
    const bool is_colour = w->transport.samples[a].place.kind == LIGHT_PLACE_COLOUR;
    const double x = rgb_luminance(values[2 * a + is_colour]), y = rgb_luminance(values[2 * b + is_colour]);
    return x + y > 0 ? 2 * fabs(x - y) / (x + y) : 0;
}

/* Adds a sample in the middle of each side of the triangles of a face across which light differs. */
static enum status refine_face(struct work *w, int face, const struct rgb *values, double finest, struct err *err)
{
    const struct face_net *f = &w->nets.nets[face]; /* its triangles stay while samples are added */
    for (int t = 0; t < f->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            const int a = f->samples[f->triangles[t][k]], b = f->samples[f->triangles[t][(k + 1) % 3]];
            const struct vec3 p = w->nets.samples[a].at, q = w->nets.samples[b].at;
            if (f->beside[t][k] >= 0 && f->beside[t][k] < t) continue; /* the other triangle had it */
            if (vec3_length(vec3_sub(p, q)) < 2 * finest) continue;
            if (!(difference(w, values, a, b) > w->job->params.bend)) continue;
            if (w->nets.sample_count >= w->job->params.max_samples) return ST_OK;
            if (face_nets_add(&w->nets, face, vec3_scale(vec3_add(p, q), 0.5), err)) return err->status;
        }
    return ST_OK;
}

static enum status refine(struct work *w, struct err *err)
{
    const double finest = w->job->params.finest * model_rays_size(&w->change.after.model);
    struct transport *t = &w->transport;
    int first = 0, count = t->count; /* samples without rows */
    for (int halvings = 0; count && ldexp(w->nets.spacing, -halvings) > finest; halvings++) {
        struct rgb *values = NULL;
        if (trace_few(w, first, count, err)) return err->status;
        first = w->nets.sample_count;
        first_values(w, &values, err);
        for (int i = 0; values && !err->status && i < w->nets.mesh->face_count; i++)
            refine_face(w, i, values, finest, err);
        free(values);
        if (err->status || face_nets_connect(&w->nets, err) || transport_grow(t, err)) return err->status;
        count = w->nets.sample_count - first;
    }
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------ light */

static enum status trace(struct work *w, struct err *err)
{
    progress_start(&w->progress, "light", w->transport.count, "samples");
    transport_trace(&w->transport, 0, w->transport.count, w->job->params.rays, count_done, &w->progress, err);
    progress_end(&w->progress);
    return err->status;
}

static enum status write_rounds(const struct work *w, struct err *err)
{
    const struct rounds *r = &w->rounds;
    char path[FILE_PATH];
    struct outfile f = {0};
    if (product_path_in(path, w->job->out, PRODUCT_LIGHT_ROUNDS, NULL, err) || outfile_open(&f, path, err))
        return err->status;
    fprintf(f.fp, "%s\n", products[PRODUCT_LIGHT_ROUNDS].head);
    provenance_print(&w->job->prov, f.fp);
    fprintf(f.fp, "samples %d\nbounded %d\nsettled %s\n", w->transport.count, r->bounded, r->settled ? "yes" : "no");
    for (int i = 0; i < r->count; i++) {
        fprintf(f.fp, "round %d change %.6g left ", i + 1, r->list[i].change);
        fprintf(f.fp, isfinite(r->list[i].left) ? "%.6g\n" : "unknown\n", r->list[i].left);
    }
    outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

static enum status write_objects(struct work *w, struct err *err)
{
    struct light_objects *o = &w->change.objects;
    char path[FILE_PATH];
    for (int i = 0; i < o->element_count; i++)
        o->elements[i].irradiance = w->rounds.values[2 * (w->nets.sample_count + i) + 1];
    if (product_path_in(path, w->job->out, PRODUCT_OBJECT_LIGHT, NULL, err)) return err->status;
    return light_objects_write_light(o, path, &w->job->prov, err);
}

/* Lamps that the edit adds, in a scene where nothing says how bright they are beside the photographs. */
static void warn_of_lamps(const struct light_change *c)
{
    if (c->map.planned_count > c->lamps.planned.count)
        log_warn("lx of the photographs' light are not known, so that lamps which the edit adds do not shine in relit "
                 "pictures. Measure a point (scenes/NAME/lux.txt), or run make luminance.");
    else if (c->lamps.planned.count && !c->axes.metric)
        log_warn("the scene has no scale, so that a metre is a guess: %.3g units, by rooms %g m high. It sets how "
                 "bright the lamps are that the edit adds. Give the scale as docs/model-script.md explains.",
                 c->lamps.metre, MODEL_METRE_ROOM);
}

static void tell(const struct work *w)
{
    const struct rounds *r = &w->rounds;
    const struct round *last = r->count ? &r->list[r->count - 1] : NULL;
    log_note("%d samples, %d of them brighter than a white surface could be under the light that was found",
             w->transport.count, r->bounded);
    if (w->reflecting < 1)
        log_warn("the lamps and windows that are known give %.2g %% of the rooms' light, so that %.0f %% of what each "
                 "surface sends out stays as photographed. Mark lamps in lights.txt, and cut windows into the model.",
                 100 * w->known, 100 * (1 - w->reflecting));
    if (last && r->settled)
        log_note("%d rounds; at most %.2g %% of a sample's light is missing", r->count, 100 * last->left);
    else if (last)
        log_warn(
            "light did not settle in %d rounds: the last one changed a sample by %.2g %%; raise [update_vita] rounds.",
            r->count, 100 * last->change);
}

static enum status run(struct work *w, struct err *err)
{
    struct update_job *j = w->job;
    char vita[FILE_PATH];
    if (light_change_read(&w->change, &j->files, &j->prov, err) ||
        edited_atlas_make(&w->atlas, &w->change, j->files.vita, err) || make_nets(w, err) ||
        transport_init(&w->transport, &w->change, &w->nets, err))
        return err->status;
    ask_for_light(w);
    if (refine(w, err) || trace(w, err) ||
        rounds_run(&w->rounds, &w->transport, w->reflecting, j->params.rounds, j->params.tolerance, err))
        return err->status;
    tell(w);
    warn_of_lamps(&w->change);
    if (write_rounds(w, err) || write_objects(w, err) || file_path(vita, j->out, "vita", "", err)) return err->status;
    return edited_atlas_write(&w->atlas, &w->change, &w->nets, w->rounds.values, j->files.vita, vita, &j->prov, err);
}

enum status update_vita(struct update_job *j, struct err *err)
{
    struct work w = {.job = j};
    run(&w, err);
    rounds_release(&w.rounds);
    transport_release(&w.transport);
    face_nets_release(&w.nets);
    edited_atlas_release(&w.atlas);
    light_change_release(&w.change);
    return err->status;
}
