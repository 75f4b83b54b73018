/* transport.c - see transport.h.
 *
 * Overview. From each sample, `rays` rays go by the cosine into the edited model. Where one meets a face, its colour
 * there is added to the entries of the samples that the place lies between; what it brings from elsewhere (the sky, a
 * texel of a face without samples) is fixed. Light of lamps and of the sky in the directions of emitters is gathered by
 * rays towards them. The unedited model is gathered with the same random numbers, so that a sample whose surroundings
 * are unchanged gets the same irradiance in both, and a quotient of 1 but for the order of sums. */
#include "stages/update_vita/transport.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/gather/mixture.h"
#include "common/light/frame.h"
#include "common/light/sobol.h"
#include "common/math/numbers.h"
#include "common/relight/light_quotient.h"

enum { DIRECT_SHARE = 4 };             /* rays / this go towards emitters */
static const double IN_SIGHT = 0.5;    /* of a place's hemisphere: things that stand beside it cover so much */
static const double HIDDEN = 0.75;     /* what is covered so far is in a gap that nobody looks into */
static const double AROUND = 1.0 / 16; /* of the spacing: how far around a sample colours are averaged */

/* ---------------------------------------------------------------------------------------------------------- samples */

/* The mean colour of the places of one kind around a sample. */
static void set_place(struct transport_sample *s, const struct light_change *c, int face, double spacing)
{
    struct vec3 x, y;
    struct rgb sum = {0, 0, 0};
    int count = 0;
    light_change_place(&s->place, c, face, s->after.at);
    frame_from_normal(s->after.normal, &x, &y);
    for (int j = -1; j <= 1 && s->place.kind != LIGHT_PLACE_NONE; j++)
        for (int i = -1; i <= 1; i++) {
            struct light_place near;
            const struct vec3 by = vec3_add(vec3_scale(x, i * AROUND * spacing), vec3_scale(y, j * AROUND * spacing));
            light_change_place(&near, c, face, vec3_add(s->after.at, by));
            if (near.kind != s->place.kind) continue;
            sum = rgb_add(sum, near.colour);
            count++;
        }
    if (count) s->place.colour = rgb_scale(sum, 1.0 / count);
}

struct place_job {
    struct transport *t;
    int first;
};

static void set_places(void *ctx, size_t begin, size_t end, int thread)
{
    const struct place_job *j = ctx;
    struct transport *t = j->t;
    (void)thread;
    for (size_t i = (size_t)j->first + begin; i < (size_t)j->first + end; i++) {
        const struct net_sample *s = &t->nets->samples[i];
        t->samples[i].after = (struct gather_point){s->at, t->nets->mesh->faces[s->face].normal};
        set_place(&t->samples[i], t->change, s->face, t->nets->spacing);
    }
}

static void mark_coloured(struct transport *t)
{
    const struct light_change *c = t->change;
    for (int i = 0; i < t->nets->mesh->face_count; i++) {
        const struct solid_face *f = &t->nets->mesh->faces[i];
        const struct texture_face *listed =
            texture_map_find(&c->map, solid_face_id(t->nets->mesh, i), vec3_scale(f->normal, f->offset));
        for (int k = 0; listed && k < listed->rule_count; k++)
            t->coloured[i] |= listed->rules[k].kind == TEXTURE_COLOUR;
    }
}

enum status transport_init(struct transport *t, const struct light_change *change, const struct face_nets *nets,
                           struct err *err)
{
    const struct light_objects *o = &change->objects;
    *t = (struct transport){.change = change, .nets = nets, .count = o->element_count};
    t->samples = calloc((size_t)t->count + 1, sizeof *t->samples);
    t->rows = calloc((size_t)t->count + 1, sizeof *t->rows);
    t->coloured = calloc((size_t)nets->mesh->face_count + 1, sizeof *t->coloured);
    if (!t->samples || !t->rows || !t->coloured)
        return err_nomem(err, "samples", (size_t)t->count * sizeof *t->samples);
    mark_coloured(t);
    for (int i = 0; i < o->element_count; i++)
        t->samples[i] = (struct transport_sample){
            .after = o->elements[i].point,
            .place = {.kind = LIGHT_PLACE_COLOUR, .colour = o->list.items[o->elements[i].object].brdf.albedo}};
    return transport_grow(t, err);
}

/* What rows send to the objects' elements follows them by `by` samples. */
static void move_elements(struct transport *t, int elements, int by)
{
    for (int i = 0; i < t->count; i++)
        for (int k = 0; k < t->rows[i].count; k++)
            if (t->rows[i].entries[k].from >= 2 * elements) t->rows[i].entries[k].from += 2 * by;
}

enum status transport_grow(struct transport *t, struct err *err)
{
    const size_t elements = (size_t)t->change->objects.element_count, old = (size_t)t->count - elements;
    const size_t added = (size_t)t->nets->sample_count - old, all = (size_t)t->count + added;
    struct transport_sample *samples = realloc(t->samples, (all + 1) * sizeof *samples);
    if (samples) t->samples = samples;
    struct transport_row *rows = realloc(t->rows, (all + 1) * sizeof *rows);
    if (rows) t->rows = rows;
    if (!samples || !rows) return err_nomem(err, "samples", all * sizeof *samples);
    move_elements(t, (int)old, (int)added);
    memmove(samples + old + added, samples + old, elements * sizeof *samples);
    memmove(rows + old + added, rows + old, elements * sizeof *rows);
    memset(samples + old, 0, added * sizeof *samples);
    memset(rows + old, 0, added * sizeof *rows);
    t->count = (int)all;
    parallel_for(added, 64, set_places, &(struct place_job){t, (int)old});
    return ST_OK;
}

void transport_release(struct transport *t)
{
    if (!t) return;
    for (int i = 0; t->rows && i < t->count; i++) free(t->rows[i].entries);
    free(t->rows);
    free(t->samples);
    free(t->coloured);
    *t = (struct transport){0};
}

/* ------------------------------------------------------------------------------------------------------------- rays */

/* What the rays of one sample add up to; one for each thread. */
struct tally {
    double (*sums)[3]; /* by value */
    bool *is_touched;
    int values, count; /* of them touched */
};

static void add_entry(struct tally *l, int from, struct rgb colour, double weight)
{
    if (!l->is_touched[from]) {
        l->is_touched[from] = true;
        l->count++;
    }
    l->sums[from][0] += weight * colour.r;
    l->sums[from][1] += weight * colour.g;
    l->sums[from][2] += weight * colour.b;
}

/* A colour of the edit is an albedo in the field's texels (edited_atlas.h), as it is on objects. */
static void add_face(struct tally *l, const struct transport *t, const struct light_look *seen, struct vec3 at,
                     struct rgb *fixed)
{
    const struct light_change *c = t->change;
    const int faces = t->nets->mesh->face_count;
    struct net_weights w;
    if (seen->face >= faces) {
        const int k = (seen->face - faces) / 2, side = (seen->face - faces) % 2;
        if (k >= c->objects.count) { /* furniture: its radiance is given */
            *fixed = rgb_add(*fixed, seen->radiance);
            return;
        }
        const int element = c->objects.element[k][side];
        const struct rgb albedo = c->objects.list.items[c->objects.object[k]].brdf.albedo;
        add_entry(l, 2 * (t->nets->sample_count + element) + 1, albedo, 1 / PI);
        return;
    }
    if (!face_nets_find(t->nets, seen->face, at, &w)) {
        *fixed = rgb_add(*fixed, seen->radiance);
        return;
    }
    bool is_colour = false;
    if (t->coloured[seen->face]) {
        struct light_place place;
        light_change_place(&place, c, seen->face, at);
        is_colour = place.kind == LIGHT_PLACE_COLOUR;
    }
    for (int k = 0; k < 3; k++)
        if (w.weight[k] > 0)
            add_entry(l, 2 * w.sample[k] + is_colour, seen->radiance, is_colour ? w.weight[k] / PI : w.weight[k]);
}

struct ray_job {
    const struct transport *t;
    int *covered;        /* counts rays that meet things that stay; NULL: after the edit */
    struct tally *tally; /* NULL: all is fixed */
    struct gather_point point;
    const struct mixture *lights;
    struct rgb fixed;
};

static bool is_staying_thing(const struct light_change *c, int face)
{
    const int faces = c->before.model.mesh.face_count;
    return face >= faces && c->things.stays[(face - faces) / 2];
}

static void look(struct ray_job *j, const struct light_field *f, const struct vec3 direction[RAY_PACKET], int count)
{
    struct light_look seen[RAY_PACKET];
    struct vec3 from[RAY_PACKET];
    for (int k = 0; k < RAY_PACKET; k++) from[k] = j->point.at;
    f->look(f->ctx, from, j->point.normal, direction, (1u << count) - 1, seen);
    for (int k = 0; k < count; k++) {
        if (j->covered) *j->covered += is_staying_thing(j->t->change, seen[k].face);
        if (mixture_is_light(j->lights, direction[k], seen[k].source)) continue;
        const bool is_face = j->tally && seen[k].face >= 0 && seen[k].source != LIGHT_NONE;
        if (is_face)
            add_face(j->tally, j->t, &seen[k], vec3_add(j->point.at, vec3_scale(direction[k], seen[k].distance)),
                     &j->fixed);
        else
            j->fixed = rgb_add(j->fixed, seen[k].radiance);
    }
}

/* Irradiance at a point by `rays` rays, pi / rays not yet applied to what is in the tally. */
static struct rgb gather(const struct transport *t, struct tally *tally, int *covered, const struct light_field *f,
                         struct gather_point p, int rays, uint64_t key)
{
    const struct rng rng = rng_make(key, "update_vita", "rays");
    struct sobol points = sobol_make(&rng, 0, rays);
    struct strategy cosine;
    struct mixture lights;
    struct irradiance direct = {.rays = 0};
    struct ray_job j = {.t = t, .tally = tally, .covered = covered, .point = p, .lights = &lights};
    mixture_init(&lights, f, p, MIXTURE_LIGHTS);
    if (lights.count) mixture_gather(&direct, &lights, rays / DIRECT_SHARE, key, false);
    strategy_cosine(&cosine, p);
    for (int i = 0; i < rays; i += RAY_PACKET) {
        struct vec3 direction[RAY_PACKET];
        const int most = rays - i < RAY_PACKET ? rays - i : RAY_PACKET;
        points.sample = (uint32_t)i;
        look(&j, f, direction, strategy_packet(&cosine, &points, 0, most, direction));
    }
    return rgb_add(direct.value, rgb_scale(j.fixed, PI / rays));
}

/* ------------------------------------------------------------------------------------------------------------- rows */

struct trace_job {
    struct transport *t;
    struct tally *tallies; /* of each thread */
    int first, rays;
    void (*done)(void *ctx, int64_t samples);
    void *done_ctx;
    atomic_bool is_short; /* of memory */
};

/* Values come in order: to pass over those that no ray touched takes less time than to sort the others. */
static bool keep_entries(struct transport_row *row, struct tally *l, double scale)
{
    free(row->entries);
    row->entries = malloc(((size_t)l->count + 1) * sizeof *row->entries);
    row->count = 0;
    for (const bool *at = l->is_touched; l->count; at++, l->count--) {
        at = memchr(at, true, (size_t)(l->is_touched + l->values - at));
        const int from = (int)(at - l->is_touched);
        double *sum = l->sums[from];
        if (row->entries) {
            struct transport_entry *e = &row->entries[row->count++];
            e->from = from;
            for (int c = 0; c < 3; c++) e->rgb[c] = (float)(scale * sum[c]);
        }
        sum[0] = sum[1] = sum[2] = 0;
        l->is_touched[from] = false;
    }
    return row->entries != NULL;
}

static void trace_some(void *ctx, size_t begin, size_t end, int thread)
{
    struct trace_job *j = ctx;
    struct transport *t = j->t;
    for (size_t n = begin; n < end; n++) {
        const size_t i = (size_t)j->first + n;
        const struct transport_sample *s = &t->samples[i];
        struct transport_row *row = &t->rows[i];
        int covered = 0;
        row->gathered = rgb_grey(0);
        if (s->place.kind == LIGHT_PLACE_TEXTURE)
            row->gathered = gather(t, NULL, &covered, &t->change->before.field, s->place.before, j->rays, i);
        row->before = row->gathered;
        row->own = clamp((covered / (double)j->rays - IN_SIGHT) / (HIDDEN - IN_SIGHT), 0, 1);
        row->fixed = gather(t, &j->tallies[thread], NULL, &t->change->after.field, s->after, j->rays, i);
        row->fixed =
            rgb_add(row->fixed, edit_lamps_light(&t->change->lamps, -1, &t->change->after, s->after, (uint64_t)i));
        if (!keep_entries(row, &j->tallies[thread], PI / j->rays)) j->is_short = true;
    }
    if (j->done) j->done(j->done_ctx, (int64_t)(end - begin));
}

/* ------------------------------------------------------------------------------------------------------------ holes */

enum { MAX_SWEEPS = 5000 };
static const double SETTLED = 1e-5; /* largest change of a sweep that ends them, as a part of the light */

bool transport_is_hole(const struct transport *t, int sample)
{
    const struct light_place *p = &t->samples[sample].place;
    return p->kind == LIGHT_PLACE_TEXTURE && p->source == LIGHT_SYNTHESISED;
}

/* Whether photographs show the place brighter than a white one is under the light that was found before the edit. */
static bool is_too_bright(const struct transport *t, int sample)
{
    const struct light_place *p = &t->samples[sample].place;
    return p->kind == LIGHT_PLACE_TEXTURE &&
           rgb_max(light_albedo(t->rows[sample].before, p->colour)) > LIGHT_ALBEDO_MAX;
}

/* Marks the samples of a face whose light is to be continued; the result is their number. Places that are too bright
 * count, unless most are: furniture is found a little too large, and what photographs show beside it seems to lie
 * inside. */
static int mark_holes(bool *hole, const struct transport *t, const struct face_net *net)
{
    int holes = 0, bright = 0;
    for (int i = 0; i < net->count; i++) {
        holes += hole[i] = transport_is_hole(t, net->samples[i]);
        bright += !hole[i] && is_too_bright(t, net->samples[i]);
    }
    if (2 * bright > net->count - holes) return holes;
    for (int i = 0; i < net->count; i++)
        if (!hole[i] && is_too_bright(t, net->samples[i])) hole[i] = true;
    return holes + bright;
}

/* One sweep over a face: samples in holes become the mean of those beside them that have light before the edit; paint
 * has none. The result is the largest change, as a part of the light. */
static double smooth_holes(struct transport *t, const struct face_net *net, const bool *hole, double (*sums)[4])
{
    memset(sums, 0, (size_t)net->count * sizeof *sums);
    for (int i = 0; i < net->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            for (int o = 1; o < 3; o++) {
                const int to = net->triangles[i][k], from = net->triangles[i][(k + o) % 3];
                if (t->samples[net->samples[from]].place.kind != LIGHT_PLACE_TEXTURE) continue;
                const struct rgb e = t->rows[net->samples[from]].before;
                const double dx = net->at[to][0] - net->at[from][0], dy = net->at[to][1] - net->at[from][1];
                const double weight = 1 / fmax(sqrt(dx * dx + dy * dy), 1e-9);
                sums[to][0] += weight * e.r, sums[to][1] += weight * e.g, sums[to][2] += weight * e.b;
                sums[to][3] += weight;
            }
    double largest = 0;
    for (int i = 0; i < net->count; i++) {
        if (!hole[i] || !(sums[i][3] > 0)) continue;
        struct rgb *light = &t->rows[net->samples[i]].before;
        const struct rgb mean = rgb_scale(rgb_make(sums[i][0], sums[i][1], sums[i][2]), 1 / sums[i][3]);
        const double change = fmax(fabs(mean.r - light->r), fmax(fabs(mean.g - light->g), fabs(mean.b - light->b)));
        largest = fmax(largest, change / fmax(rgb_max(mean), 1e-30));
        *light = mean;
    }
    return largest;
}

static enum status continue_into_face(struct transport *t, const struct face_net *net, const bool *hole,
                                      struct err *err)
{
    double(*sums)[4] = malloc((size_t)net->count * sizeof *sums);
    if (!sums) return err_nomem(err, "samples", (size_t)net->count * sizeof *sums);
    for (int i = 0; i < net->count; i++) {
        struct transport_row *row = &t->rows[net->samples[i]];
        row->before = row->gathered;
    }
    for (int k = 0; k < MAX_SWEEPS && smooth_holes(t, net, hole, sums) > SETTLED; k++) continue;
    for (int i = 0; i < net->count; i++) {
        struct transport_row *row = &t->rows[net->samples[i]];
        if (row->own > 0)
            row->before = rgb_add(rgb_scale(row->before, 1 - row->own), rgb_scale(row->gathered, row->own));
    }
    free(sums);
    return ST_OK;
}

/* Where furniture hid a face, the bake continued the texture from around the hole, and with it the light of there: the
 * irradiance before the edit is continued alike. In gaps behind furniture that stays, the light before stays its
 * own: such a texel is too bright before and after alike, and furniture beside it sees no change that is none. */
static enum status continue_into_holes(struct transport *t, struct err *err)
{
    bool *hole = malloc((size_t)t->count + 1);
    if (!hole) return err_nomem(err, "samples", (size_t)t->count);
    for (int f = 0; !err->status && f < t->nets->mesh->face_count; f++) {
        const struct face_net *net = &t->nets->nets[f];
        const int holes = mark_holes(hole, t, net);
        if (holes && holes < net->count) continue_into_face(t, net, hole, err);
    }
    free(hole);
    return err->status;
}

enum status transport_trace(struct transport *t, int first, int count, int rays,
                            void (*done)(void *ctx, int64_t samples), void *done_ctx, struct err *err)
{
    const size_t values = 2 * (size_t)t->count + 1, threads = (size_t)parallel_threads();
    struct trace_job j = {.t = t, .first = first, .rays = rays, .done = done, .done_ctx = done_ctx};
    j.tallies = calloc(threads, sizeof *j.tallies);
    if (!j.tallies) err_nomem(err, "sums", threads * sizeof *j.tallies);
    for (size_t k = 0; !err->status && k < threads; k++) {
        struct tally *l = &j.tallies[k];
        l->sums = calloc(values, sizeof *l->sums);
        l->is_touched = calloc(values, sizeof *l->is_touched);
        l->values = (int)values;
        if (!l->sums || !l->is_touched) err_nomem(err, "sums", values * sizeof *l->sums);
    }
    if (!err->status) parallel_for((size_t)count, 4, trace_some, &j);
    if (!err->status && j.is_short) err_nomem(err, "what samples send to each other", sizeof(struct transport_entry));
    for (size_t k = 0; j.tallies && k < threads; k++) {
        free(j.tallies[k].sums);
        free(j.tallies[k].is_touched);
    }
    free(j.tallies);
    return err->status || !t->change->things.changes ? err->status : continue_into_holes(t, err);
}

struct rgb transport_gather(const struct transport_row *row, const struct rgb *values)
{
    struct rgb sum = row->fixed;
    for (int i = 0; i < row->count; i++) {
        const struct transport_entry *e = &row->entries[i];
        const struct rgb v = values[e->from];
        sum.r += (double)e->rgb[0] * v.r;
        sum.g += (double)e->rgb[1] * v.g;
        sum.b += (double)e->rgb[2] * v.b;
    }
    return sum;
}
