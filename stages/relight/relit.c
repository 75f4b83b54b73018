/* relit.c - see relit.h.
 *
 * Overview. Irradiance at all pixels before and after the edit comes from one cache of irradiance with the same rays in
 * both fields (irradiance_cache.c), or from rays at each pixel if there are more emitters than a cache can tell apart.
 * A texture's radiance is multiplied by the quotient (light_quotient.c), as far as it is sure (quotients.c); a colour
 * of the edit gets albedo / pi times the irradiance after it; a synthetic object is shaded with irradiance of its own.
 * Edges of old light are moved to where the photograph has them (penumbra.c). A place that the edit made had the light
 * of the rim around it (rim_light.c); furniture whose point lies in the dark takes the quotient beside it
 * (dark_points.c).
 *
 * Gloss. A glossy surface of albedo a sends out L = a E / pi + k_s I_s. Its texture is what remains of the photograph
 * without k_s I_s, in the light before, towards the place that the texel was photographed from; the gloss after the
 * edit is that towards the picture's camera:
 *   L' = (L - k_s I_s) q + k_s I_s'.
 * Where neither the light nor the gloss has changed, L' is L bit for bit. The light itself is gathered in fields whose
 * texels look as they were photographed: the edited model's atlas has no marks of materials, and a difference between
 * the fields would be taken for the edit's.
 *
 * The light of the atlas. For films the quotient is that of the texels of both atlases (update_vita): no ray is traced,
 * and a place looks alike in all frames.
 *
 * What furniture hid was filled from around it, in the light of there (update_vita): where the edit changes furniture,
 * such texels take the quotient of the atlas, too.
 *
 * Lamps that the edit adds (edit_lamps.h) are in neither field: their light is added to that after the edit at each
 * pixel, and their openings are drawn.
 *
 * Furniture that no depth tells (free cameras) gets the quotient of the shell behind it. */
#include "stages/relight/relit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "common/gather/specular.h"
#include "common/math/numbers.h"
#include "common/relight/light_quotient.h"
#include "stages/relight/dark_points.h"
#include "stages/relight/rim_light.h"

static const float COVERED = 0.5f; /* part of a pixel from which it is an object's */
static const double DARK =
    1e-6; /* of the picture's mean irradiance; a place with less counts as unlit before the edit */
static const double OFF_ALBEDO = 0.5; /* of a lamp that is off: white glass */

struct apply_job {
    struct relit *r;
    struct model_picture *picture;
    const struct pixels *p;
    const struct light_change *c;
    const struct relight_params *params;
    const struct object_pixel *objects;
    float (*shaded)[3]; /* of the object pixels */
    double dark;
    struct brdf *glosses; /* of each face of the edited model, as the edit gives it */
    bool *has_gloss;      /* the edit gives it one */
};

void relit_release(struct relit *r)
{
    if (!r) return;
    free(r->before);
    free(r->after);
    free(r->error);
    free(r->quotient);
    free(r->albedo);
    free(r->specular);
    *r = (struct relit){0};
}

static enum status init(struct relit *r, const struct pixels *p, struct err *err)
{
    const size_t n = (size_t)p->width * (size_t)p->height;
    *r = (struct relit){.width = p->width, .height = p->height};
    r->before = calloc(n + 1, sizeof *r->before);
    r->after = calloc(n + 1, sizeof *r->after);
    r->error = calloc(n + 1, sizeof *r->error);
    r->quotient = calloc(n + 1, sizeof *r->quotient);
    r->albedo = calloc(n + 1, sizeof *r->albedo);
    if (r->before && r->after && r->error && r->quotient && r->albedo) return ST_OK;
    return err_nomem(err, "light of the pixels", 2 * n * sizeof *r->before);
}

/* ----------------------------------------------------------------------------------------------------------- gather */

static void cache_done(void *ctx, size_t points) { progress_add(ctx, (int64_t)points); }

struct ray_job {
    struct relit *r;
    const struct pixels *p;
    const struct light_change *c;
    const struct relight_params *params;
    struct progress *progress;
};

static double relative_error(const struct irradiance *e)
{
    const double light = rgb_luminance(e->value);
    return light > 0 ? rgb_luminance(e->error) / light : 0;
}

/* The same rays in both fields, as long as their noise is alike; what they share is not known. */
static void gather_some(void *ctx, size_t begin, size_t end, int thread)
{
    const struct ray_job *j = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        if (!(vec3_length(j->p->before[i].normal) > 0)) continue;
        ray_irradiance_to(&j->r->before[i], &j->c->before.plain, j->p->before[i], j->params->target_error,
                          j->params->rays, i);
        ray_irradiance_to(&j->r->after[i], &j->c->after.plain, j->p->after[i], j->params->target_error, j->params->rays,
                          i);
        const double was = relative_error(&j->r->before[i]), is = relative_error(&j->r->after[i]);
        j->r->error[i] = (float)sqrt(was * was + is * is);
    }
    cache_done(j->progress, end - begin);
}

static enum status gather(struct relit *r, const struct pixels *p, const struct light_change *c,
                          const struct relight_params *params, struct err *err)
{
    struct progress progress;
    struct irradiance_cache_stats stats;
    const size_t n = (size_t)p->width * (size_t)p->height;
    unsigned char *whole = calloc(n + 1, 1);
    if (!whole) return err_nomem(err, "pixels", n);
    for (size_t i = 0; i < n; i++) whole[i] = p->kind[i] == PIXEL_COLOUR || p->kind[i] == PIXEL_LAMP || p->is_new[i];
    const struct irradiance_cache_job job = {
        .field = &c->before.plain,
        .points = p->before,
        .other = {&c->after.plain, p->after, r->after, r->error, whole, params->step},
        .width = p->width,
        .height = p->height,
        .target = params->target_error,
        .rays = params->rays,
        .done = cache_done,
        .done_ctx = &progress};
    progress_start(&progress, "light", (int64_t)p->width * p->height, "pixels");
    struct ray_job rays = {r, p, c, params, &progress};
    const bool is_cached = irradiance_cache_suits(job.field);
    if (is_cached)
        irradiance_cache_fill(r->before, &job, &stats, err);
    else
        parallel_for(n, 64, gather_some, &rays);
    progress_end(&progress);
    free(whole);
    r->records = err->status || !is_cached ? 0 : stats.records;
    if (!err->status) rim_light_fill(r->before, r->error, r->after, p, c, params, err);
    return err->status;
}

/* -------------------------------------------------------------------------------------------- lamps of the edit */

struct lamps_job {
    struct relit *r;
    const struct pixels *p;
    const struct light_change *c;
};

static void light_some(void *ctx, size_t begin, size_t end, int thread)
{
    const struct lamps_job *j = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        const struct gather_point *p = &j->p->after[i];
        if (!(vec3_length(p->normal) > 0)) continue;
        struct rgb *light = &j->r->after[i].value;
        *light = rgb_add(*light, edit_lamps_light(&j->c->lamps, -1, &j->c->after, *p, i));
    }
}

/* Lamps that the edit adds shine on each pixel, beyond what caches interpolate. */
static void add_lamps(struct relit *r, const struct pixels *p, const struct light_change *c)
{
    struct lamps_job j = {r, p, c};
    if (c->lamps.planned.count) parallel_for((size_t)p->width * (size_t)p->height, 64, light_some, &j);
}

/* ------------------------------------------------------------------------------------------------------------ gloss */

/* The reflectance of a pixel's gloss; false: it is matt. *viewpoint: from where its texel was photographed. */
static bool gloss_of(struct brdf *after, struct brdf *before, struct vec3 *viewpoint, const struct apply_job *j,
                     size_t i)
{
    const struct pixels *p = j->p;
    *after = *before = (struct brdf){.kind = BRDF_LAMBERT};
    *viewpoint = p->centre;
    if (p->face[i] < 0 || p->kind[i] == PIXEL_CLUTTER || p->kind[i] == PIXEL_LAMP) return false;
    if (p->kind[i] == PIXEL_TEXTURE) {
        const struct vec3 at = vec3_make((double)p->texel[i][0], (double)p->texel[i][1], (double)p->texel[i][2]);
        const int material = model_field_material(&j->c->before, p->from[i], at);
        if (material >= 0) *before = *after = j->c->before.materials.brdfs[material];
        if (material >= 0 && j->picture->made[i] != MADE_PHOTO && j->picture->made[i] != MADE_ORIGINAL)
            model_field_viewpoint(&j->c->before, p->from[i], at, viewpoint);
    }
    if (j->has_gloss[p->face[i]]) *after = j->glosses[p->face[i]];
    return before->gloss > 0 || after->gloss > 0;
}

static struct rgb reflected(const struct light_field *f, struct gather_point p, const struct brdf *b, struct vec3 from,
                            const struct relight_params *params, uint64_t key)
{
    struct irradiance e = {.rays = 0};
    if (!(b->gloss > 0)) return rgb_grey(0);
    specular_integral(&e, f, p, b, vec3_normalize(vec3_sub(from, p.at)), params->target_error, params->rays, key);
    return e.value;
}

/* ------------------------------------------------------------------------------------------------------------ apply */

static struct rgb get(const float *rgb) { return rgb_make((double)rgb[0], (double)rgb[1], (double)rgb[2]); }
static void set(float *to, struct rgb rgb) { to[0] = (float)rgb.r, to[1] = (float)rgb.g, to[2] = (float)rgb.b; }

static void set_quotient(struct relit *r, size_t i, struct rgb q, float a)
{
    set(r->quotient[i], q);
    r->quotient[i][3] = a;
}

/* What remains of a texture's radiance without its gloss. */
static struct rgb matt_part(struct rgb radiance, struct rgb gloss)
{
    return rgb_make(fmax(radiance.r - gloss.r, 0), fmax(radiance.g - gloss.g, 0), fmax(radiance.b - gloss.b, 0));
}

/* Whether the pixel takes the quotient of the atlas: its texture was filled from around it. */
static bool is_of_atlas(const struct apply_job *j, size_t i)
{
    return j->c->things.changes && j->picture->made[i] == MADE_SYNTHESISED;
}

static bool is_surface(const struct apply_job *j, size_t i)
{
    const uint8_t kind = j->p->kind[i];
    return j->picture->made[i] != MADE_NOTHING && kind != PIXEL_KEPT && kind != PIXEL_LAMP && !is_of_atlas(j, i);
}

/* The quotient of a texture, or of furniture, with the part of its radiance that it holds for. */
static void find_quotient(struct apply_job *j, size_t i)
{
    struct relit *r = j->r;
    const struct rgb radiance = get(j->picture->rgb + 3 * i);
    const struct rgb base = r->specular ? matt_part(radiance, get(r->specular[i][0])) : radiance;
    bool is_bounded = !(rgb_luminance(r->before[i].value) > j->dark);
    const struct rgb q = light_quotient(r->before[i].value, r->after[i].value, base, &is_bounded);
    const struct rgb albedo = light_albedo(r->before[i].value, base);
    set_quotient(r, i, q, is_bounded ? RELIT_BOUNDED : RELIT_SURE);
    set(r->albedo[i],
        rgb_make(fmin(albedo.r, LIGHT_ALBEDO_MAX), fmin(albedo.g, LIGHT_ALBEDO_MAX), fmin(albedo.b, LIGHT_ALBEDO_MAX)));
}

static void find_some(void *ctx, size_t begin, size_t end, int thread)
{
    struct apply_job *j = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct brdf after, before;
        struct vec3 viewpoint;
        set_quotient(j->r, i, rgb_grey(1), RELIT_NONE);
        if (!is_surface(j, i)) continue;
        if (j->r->specular && gloss_of(&after, &before, &viewpoint, j, i)) {
            set(j->r->specular[i][0],
                reflected(&j->c->before.plain, j->p->before[i], &before, viewpoint, j->params, i));
            const struct vec3 view = vec3_normalize(vec3_sub(j->p->centre, j->p->after[i].at));
            set(j->r->specular[i][1],
                rgb_add(reflected(&j->c->after.plain, j->p->after[i], &after, j->p->centre, j->params, i),
                        edit_lamps_gloss(&j->c->lamps, &j->c->after, j->p->after[i], &after, view, i)));
        }
        if (j->p->kind[i] != PIXEL_COLOUR) find_quotient(j, i);
    }
}

/* Moves edges of old light to where the picture has them. */
static enum status fit_penumbra(struct apply_job *j, struct err *err)
{
    struct relit *r = j->r;
    const size_t n = (size_t)r->width * (size_t)r->height;
    float(*matt)[3] = calloc(n + 1, sizeof *matt);
    if (!matt) return err_nomem(err, "edges of light", n * sizeof *matt);
    for (size_t i = 0; i < n; i++)
        set(matt[i], matt_part(get(j->picture->rgb + 3 * i), r->specular ? get(r->specular[i][0]) : rgb_grey(0)));
    penumbra_fit(r->quotient, &r->penumbra, (const float(*)[3])matt, r->before, j->p, j->params, err);
    free(matt);
    return err->status;
}

static bool equal(struct rgb a, struct rgb b) { return a.r == b.r && a.g == b.g && a.b == b.b; }

static void apply_surface(struct apply_job *j, size_t i)
{
    float *pixel = j->picture->rgb + 3 * i;
    struct rgb gloss = {0, 0, 0}, shine = {0, 0, 0};
    if (j->r->specular) gloss = get(j->r->specular[i][0]), shine = get(j->r->specular[i][1]);
    if (j->p->kind[i] == PIXEL_COLOUR) {
        const struct rgb albedo = get(j->p->albedo[i]);
        set(j->r->albedo[i], albedo);
        set_quotient(j->r, i, rgb_grey(1), RELIT_SURE);
        set(pixel, rgb_add(rgb_scale(rgb_multiply(albedo, j->r->after[i].value), 1 / PI), shine));
        return;
    }
    const struct rgb q = get(j->r->quotient[i]);
    if (equal(q, rgb_grey(1)) && equal(gloss, shine)) return;
    set(pixel, rgb_add(rgb_multiply(matt_part(get(pixel), gloss), q), shine));
}

static void apply_lamp(struct apply_job *j, size_t i)
{
    const struct rgb scale = get(j->p->albedo[i]);
    float *pixel = j->picture->rgb + 3 * i;
    set_quotient(j->r, i, scale, RELIT_SURE);
    if (rgb_max(scale) > 0)
        set(pixel, rgb_multiply(get(pixel), scale));
    else
        set(pixel, rgb_scale(j->r->after[i].value, OFF_ALBEDO / PI));
}

/* -------------------------------------------------------------------------------------------------------- the atlas */

static double texel_quotient(double before, double after) { return before > 0 ? after / before : 1; }

static void apply_atlas_at(struct apply_job *j, size_t i)
{
    const struct pixels *p = j->p;
    float *pixel = j->picture->rgb + 3 * i;
    if (p->kind[i] != PIXEL_TEXTURE && p->kind[i] != PIXEL_COLOUR) return;
    const int id = solid_face_id(&j->c->after.model.mesh, p->face[i]);
    const struct field_texel now = field_atlas_look(&j->c->after.atlas, id, p->after[i].at);
    if (now.source == LIGHT_NONE) return;
    if (p->kind[i] == PIXEL_COLOUR) {
        set(pixel, now.radiance);
        set_quotient(j->r, i, rgb_grey(1), RELIT_SURE);
        return;
    }
    const struct vec3 at = vec3_make((double)p->texel[i][0], (double)p->texel[i][1], (double)p->texel[i][2]);
    const struct field_texel was = field_atlas_look(&j->c->before.atlas, p->from[i], at);
    if (was.source == LIGHT_NONE) return;
    const struct rgb q =
        rgb_make(texel_quotient(was.radiance.r, now.radiance.r), texel_quotient(was.radiance.g, now.radiance.g),
                 texel_quotient(was.radiance.b, now.radiance.b));
    set_quotient(j->r, i, q, RELIT_SURE);
    set(pixel, rgb_multiply(get(pixel), q));
}

static void apply_some(void *ctx, size_t begin, size_t end, int thread)
{
    struct apply_job *j = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        if (j->picture->made[i] == MADE_NOTHING || j->p->kind[i] == PIXEL_KEPT) continue;
        if (j->p->kind[i] == PIXEL_LAMP)
            apply_lamp(j, i);
        else if (is_of_atlas(j, i))
            apply_atlas_at(j, i);
        else
            apply_surface(j, i);
    }
}

static void apply_atlas(void *ctx, size_t begin, size_t end, int thread)
{
    struct apply_job *j = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        set_quotient(j->r, i, rgb_grey(1), RELIT_NONE);
        if (j->picture->made[i] == MADE_NOTHING) continue;
        if (j->p->kind[i] == PIXEL_LAMP)
            apply_lamp(j, i);
        else
            apply_atlas_at(j, i);
    }
}

/* ---------------------------------------------------------------------------------------------------------- objects */

static void shade_some(void *ctx, size_t begin, size_t end, int thread)
{
    struct apply_job *j = ctx;
    (void)thread;
    for (size_t k = begin; k < end; k++) {
        const struct object_pixel *o = &j->objects[k];
        const struct brdf *b = &j->c->objects.list.items[o->object].brdf;
        const struct light_field *f = &j->c->after.plain;
        const uint64_t key = (uint64_t)o->pixel;
        struct irradiance e, s = {.rays = 0};
        ray_irradiance_to(&e, f, o->point, j->params->target_error, j->params->rays, key);
        if (b->gloss > 0)
            specular_integral(&s, f, o->point, b, o->to_viewer, j->params->target_error, j->params->rays, key);
        e.value = rgb_add(e.value, edit_lamps_light(&j->c->lamps, -1, &j->c->after, o->point, key));
        s.value = rgb_add(s.value, edit_lamps_gloss(&j->c->lamps, &j->c->after, o->point, b, o->to_viewer, key));
        set(j->shaded[k], rgb_add(rgb_scale(rgb_multiply(b->albedo, e.value), 1 / PI), s.value));
        if (o->cover < COVERED) continue;
        j->r->after[o->pixel] = e;
        set_quotient(j->r, (size_t)o->pixel, rgb_grey(1), RELIT_SURE);
        if (j->r->specular) set(j->r->specular[o->pixel][1], s.value);
    }
}

static enum status shade_objects(struct apply_job *j, struct err *err)
{
    const size_t count = (size_t)j->p->object_count;
    if (!count) return ST_OK;
    j->shaded = calloc(count, sizeof *j->shaded);
    if (!j->shaded) return err_nomem(err, "pixels of objects", count * sizeof *j->shaded);
    parallel_for(count, 16, shade_some, j);
    for (size_t k = 0; k < count; k++) {
        const struct object_pixel *o = &j->objects[k];
        float *pixel = j->picture->rgb + 3 * (size_t)o->pixel;
        for (int c = 0; c < 3; c++) pixel[c] = (1 - o->cover) * pixel[c] + o->cover * j->shaded[k][c];
        if (o->cover >= COVERED || j->picture->made[o->pixel] == MADE_NOTHING) j->picture->made[o->pixel] = MADE_COLOUR;
    }
    free(j->shaded);
    return ST_OK;
}

/* Lamps that the edit adds are as bright as they are, whatever light falls on them. */
static void show_openings(struct apply_job *j)
{
    for (int k = 0; k < j->p->opening_count; k++) {
        const struct opening_pixel *o = &j->p->openings[k];
        float *pixel = j->picture->rgb + 3 * (size_t)o->pixel;
        if (j->picture->made[o->pixel] == MADE_NOTHING) continue; /* beyond what is drawn */
        for (int c = 0; c < 3; c++) pixel[c] = (1 - o->cover) * pixel[c] + o->rgb[c];
        if (o->cover < COVERED) continue;
        set_quotient(j->r, (size_t)o->pixel, rgb_grey(1), RELIT_SURE);
        j->picture->made[o->pixel] = MADE_COLOUR;
    }
}

static double mean_light(const struct relit *r)
{
    const size_t n = (size_t)r->width * (size_t)r->height;
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < n; i++) {
        if (!r->before[i].rays && !(rgb_luminance(r->before[i].value) > 0)) continue;
        sum += rgb_luminance(r->before[i].value);
        count++;
    }
    return count ? sum / (double)count : 0;
}

static int by_value(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Median luminance of the surfaces that are relit; lamps and the outdoors say nothing of how bright a room is. */
static enum status find_median(double *median, const struct apply_job *j, struct err *err)
{
    const size_t n = (size_t)j->p->width * (size_t)j->p->height;
    float *values = malloc((n + 1) * sizeof *values);
    size_t count = 0;
    if (!values) return err_nomem(err, "pixels", n * sizeof *values);
    for (size_t i = 0; i < n; i++)
        if (is_surface(j, i)) values[count++] = (float)rgb_luminance(get(j->picture->rgb + 3 * i));
    qsort(values, count, sizeof *values, by_value);
    *median = count ? (double)values[count / 2] : 0;
    free(values);
    return ST_OK;
}

/* Sets the gloss that the edit gives to faces; *any: some surface of the scene may be glossy. */
static enum status find_glosses(struct apply_job *j, bool *any, struct err *err)
{
    const struct solid_mesh *mesh = &j->c->after.model.mesh;
    j->glosses = calloc((size_t)mesh->face_count + 1, sizeof *j->glosses);
    j->has_gloss = calloc((size_t)mesh->face_count + 1, sizeof *j->has_gloss);
    if (!j->glosses || !j->has_gloss) return err_nomem(err, "faces", (size_t)mesh->face_count * sizeof *j->glosses);
    *any = j->c->before.materials.list.count > 0;
    for (int i = 0; i < j->c->objects.list.count; i++) *any |= j->c->objects.list.items[i].brdf.gloss > 0;
    for (int i = 0; i < mesh->face_count; i++) {
        const struct solid_face *f = &mesh->faces[i];
        const struct texture_face *face =
            texture_map_find(&j->c->map, solid_face_id(mesh, i), vec3_scale(f->normal, f->offset));
        if (!face || !face->has_gloss) continue;
        j->has_gloss[i] = *any = true;
        j->glosses[i] = gloss_brdf(&face->gloss, rgb_grey(0));
    }
    return ST_OK;
}

enum status relit_make(struct relit *r, struct model_picture *picture, const struct pixels *p,
                       const struct light_change *c, const struct relight_params *params, struct err *err)
{
    const size_t n = (size_t)p->width * (size_t)p->height;
    struct apply_job j = {.r = r, .picture = picture, .p = p, .c = c, .params = params, .objects = p->objects};
    bool is_glossy = false;
    if (!init(r, p, err)) find_glosses(&j, &is_glossy, err);
    if (!err->status && is_glossy && !(r->specular = calloc(n + 1, sizeof *r->specular)))
        err_nomem(err, "gloss", n * sizeof *r->specular);
    const bool is_gathered = strcmp(params->light, "atlas") != 0;
    if (!err->status) find_median(&r->median[0], &j, err);
    if (!err->status && is_gathered && !p->is_black) gather(r, p, c, params, err);
    if (!err->status && is_gathered) add_lamps(r, p, c);
    if (!err->status) {
        j.dark = DARK * mean_light(r);
        if (is_gathered) parallel_for(n, 256, find_some, &j);
        if (is_gathered && !quotients_settle(r->quotient, r->error, p, params, err)) fit_penumbra(&j, err);
        if (is_gathered && !err->status) dark_points_fill(r->quotient, r->before, r->after, p, c->things.changes, err);
        if (!err->status) parallel_for(n, 256, is_gathered ? apply_some : apply_atlas, &j);
        if (!err->status && !shade_objects(&j, err)) show_openings(&j);
    }
    if (!err->status) find_median(&r->median[1], &j, err);
    free(j.glosses);
    free(j.has_gloss);
    return err->status;
}
