/* pixels.c - what each pixel of a picture of an edited model shows, and where its light is to be found before and
 * after the edit.
 *
 * A pixel's ray is traced into the edited model. In this order it is
 *   - kept, if the picture has nothing there
 *   - a lamp that the edit dims: one that is off shows what falls on it, as surfaces do. Lamps come before
 *     furniture, because estimated depth takes a hanging lamp for some
 *   - furniture, where an original view's depth says that something stands before the model: the light is that at
 *     the furniture, whose normal is that of its segment's plane. Clutter grows by a rim: where the pixel's own depth
 *     is that of the model or behind it, the face counts. Where no face lies behind, only a sure depth counts that
 *     stands clearly before the opening, for the sky takes any
 *   - a face: with the place in the unedited model that its texel came from, or with a new colour
 *
 * Synthetic objects on the ray's way are noted with the part of the pixel that they cover, by 3 x 3 rays; what lies
 * behind them is relit as if they were not there, since it shows at their edges.
 *
 * Luminous openings of lamps that the edit adds are noted in the same way. Lamps without a size are not seen.
 *
 * Furniture's depth has errors: a point that seems to lie a little below a surface of the model would get no light,
 * so points are lifted by up to 2 % of the model's size.
 *
 * Rows are independent and run in parallel. */
#include "stages/relight/pixels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/parallel.h"
#include "common/layers/layered_depth.h"
#include "common/product/product.h"
#include "common/texture/view_ids.h"

enum { SUB = 3, THROUGH = 64, AROUND = 3 }; /* rays along a pixel's side; objects behind one another; pixels */
static const double DRAWN = 0.01;           /* of a picture: with less, it counts as black */
static const double SURE = 0.5;             /* confidence of a segment before an opening */
static const double BEFORE = 0.06; /* of the distance: what stands before an opening; twice the tolerance of clutter */
static const double LIFT = 0.02;   /* of the model's size: how far below a surface furniture may seem to be */

struct find_job {
    struct pixels *p;
    const struct light_change *c;
    const struct model_picture *picture;
    struct mat3 model_from_cam;
    struct vec3 centre;
    const struct layered_depth *depth; /* NULL: none */
    const struct view_ids *ids;
    struct view camera;             /* of the layers, model frame */
    double scale;                   /* model units per scene unit */
    struct object_pixel *objects;   /* one a pixel; object -1: none */
    struct opening_pixel *openings; /* one a pixel; cover 0: none */
};

static enum status pixels_init(struct pixels *p, int width, int height, struct err *err)
{
    const size_t n = (size_t)width * (size_t)height;
    *p = (struct pixels){.width = width, .height = height};
    p->kind = calloc(n + 1, sizeof *p->kind);
    p->before = calloc(n + 1, sizeof *p->before);
    p->after = calloc(n + 1, sizeof *p->after);
    p->albedo = calloc(n + 1, sizeof *p->albedo);
    p->face = calloc(n + 1, sizeof *p->face);
    p->from = calloc(n + 1, sizeof *p->from);
    p->texel = calloc(n + 1, sizeof *p->texel);
    p->is_new = calloc(n + 1, sizeof *p->is_new);
    if (p->kind && p->before && p->after && p->albedo && p->face && p->from && p->texel && p->is_new) return ST_OK;
    return err_nomem(err, "pixels", n * (sizeof *p->before + sizeof *p->after));
}

void pixels_release(struct pixels *p)
{
    if (!p) return;
    free(p->kind);
    free(p->before);
    free(p->after);
    free(p->albedo);
    free(p->face);
    free(p->from);
    free(p->texel);
    free(p->is_new);
    free(p->objects);
    free(p->openings);
    *p = (struct pixels){0};
}

/* ------------------------------------------------------------------------------------------------------------- rays */

/* What a ray meets: the first object, the first piece of furniture that the field holds, and the first face behind. */
struct met {
    bool object, thing, face;
    struct ray_hit on_object, on_thing, on_face;
};

static struct met meet(const struct find_job *j, struct vec3 direction)
{
    const struct model_rays *m = &j->c->after.model;
    struct met met = {.object = false};
    struct vec3 from = j->centre;
    struct ray_hit hit;
    double passed = 0;
    for (int k = 0; k < THROUGH && ray_scene_hit(&m->rays, from, direction, &hit); k++) {
        hit.t += passed;
        if ((int)hit.id < m->mesh.face_count) {
            met.face = true;
            met.on_face = hit;
            break;
        }
        const bool is_object = (int)hit.id - m->mesh.face_count < j->c->objects.count; /* the others are furniture */
        if (is_object && !met.object) met.on_object = hit;
        if (!is_object && !met.thing) met.on_thing = hit;
        met.object |= is_object;
        met.thing |= !is_object;
        from = vec3_add(hit.point, vec3_scale(direction, 2 * m->rays.epsilon));
        passed = hit.t + 2 * m->rays.epsilon;
    }
    return met;
}

static bool pixel_ray(const struct find_job *j, double x, double y, struct vec3 *direction)
{
    struct vec3 ray;
    if (!camera_unproject(&j->picture->lens, x, y, &ray)) return false;
    *direction = mat3_apply(j->model_from_cam, ray);
    return true;
}

/* --------------------------------------------------------------------------------------------------------- surfaces */

static void set_texture(struct find_job *j, size_t i, const struct light_place *place, struct gather_point after)
{
    j->p->kind[i] = PIXEL_TEXTURE;
    j->p->before[i] = place->before;
    j->p->after[i] = after;
    j->p->from[i] = place->face;
    j->p->is_new[i] = place->is_new;
    const double at[3] = {place->texel.x, place->texel.y, place->texel.z};
    for (int k = 0; k < 3; k++) j->p->texel[i][k] = (float)at[k];
}

static void set_face(struct find_job *j, size_t i, const struct ray_hit *hit)
{
    /* the face's own normal, as for the light before: a ray's has zeros of either sign */
    const struct gather_point after = {hit->point, j->c->after.model.mesh.faces[hit->id].normal};
    struct light_place place;
    j->p->face[i] = (int)hit->id;
    light_change_place(&place, j->c, (int)hit->id, hit->point);
    if (place.kind == LIGHT_PLACE_COLOUR) {
        const double albedo[3] = {place.colour.r, place.colour.g, place.colour.b};
        j->p->kind[i] = PIXEL_COLOUR;
        for (int k = 0; k < 3; k++) j->p->albedo[i][k] = (float)albedo[k];
        j->p->before[i] = j->p->after[i] = after;
        return;
    }
    if (place.kind == LIGHT_PLACE_NONE) { /* a texel of the viewpoint's own atlas: the face as it is */
        struct vec3 nearest;
        int face;
        bool on;
        const int id = solid_face_id(&j->c->after.model.mesh, (int)hit->id);
        if (!face_areas_nearest(&j->c->old, id, hit->point, &nearest, &face, &on)) return;
        place = (struct light_place){.face = id, .texel = nearest, .before = {nearest, hit->normal}};
    }
    set_texture(j, i, &place, after);
}

/* A lamp that is off shows what falls on it, as surfaces do. */
static void set_lamp(struct find_job *j, size_t i, const struct lamp *lamp, struct vec3 at)
{
    const double *scale = texture_map_lamp(&j->c->map, lamp->name);
    if (!scale) return; /* its texels keep their light: declared emitters are never scaled by what falls on them */
    j->p->kind[i] = PIXEL_LAMP;
    for (int k = 0; k < 3; k++) j->p->albedo[i][k] = (float)scale[k];
    if (scale[0] > 0 || scale[1] > 0 || scale[2] > 0) return;
    j->p->before[i] = j->p->after[i] = (struct gather_point){at, lamp->normal};
    model_field_lift(&j->c->before, &j->p->before[i], 2 * j->c->before.reach);
    model_field_lift(&j->c->after, &j->p->after[i], 2 * j->c->before.reach);
}

/* -------------------------------------------------------------------------------------------------------- furniture */

/* The normal of a segment's plane: 1 / z = a u + b v + c is n . X = 1 in the camera's frame. */
static struct vec3 segment_normal(const struct find_job *j, const struct depth_segment *s)
{
    const struct view *v = &j->camera;
    const struct vec3 n =
        vec3_make(s->plane[0] * v->fx, s->plane[1] * v->fy, s->plane[0] * v->cx + s->plane[1] * v->cy + s->plane[2]);
    return vec3_scale(vec3_normalize(mat3_apply(mat3_transpose(v->cam_from_world), n)), -1);
}

/* Furniture that the picture shows and the field holds: moved, or uncovered by the edit. False: neither. */
static bool set_thing(struct find_job *j, size_t i, const struct met *met)
{
    struct vec3 was;
    if (!met->thing || j->picture->made[i] != MADE_CLUTTER) return false;
    const struct ray_hit *hit = &met->on_thing;
    const struct gather_point p = {hit->point, hit->normal};
    j->p->before[i] = j->p->after[i] = p;
    j->p->kind[i] = PIXEL_CLUTTER;
    const struct placed_thing *moved = light_things_moved(&was, &j->c->things, hit->point);
    if (!moved) return true;
    j->p->before[i].at = was;
    j->p->before[i].normal = mat3_apply(mat3_transpose(moved->turn), p.normal);
    return true;
}

/* Whether a pixel's own depth, and that of most pixels around it, stands clearly before the unedited model, whose panes
 * count. Clutter grows by a rim, which shows what lies behind, and a curtain at a pane is noise about the tolerance of
 * clutter: spots of it would be relit, and the curtain around them would not. */
static bool stands_before(const struct find_job *j, int x, int y)
{
    const int width = j->p->width, height = j->p->height;
    int known = 0, before = 0;
    bool own = true;
    for (int v = y - AROUND; v <= y + AROUND; v++)
        for (int u = x - AROUND; u <= x + AROUND; u++) {
            if (u < 0 || v < 0 || u >= width || v >= height) continue;
            const size_t n = (size_t)v * (size_t)width + (size_t)u;
            const double z = (double)j->depth->interior.z[n], model = (double)j->ids->z[n];
            if (!(z > 0 && model > 0)) continue;
            const bool is_before = z < (1 - BEFORE) * model;
            known++;
            before += is_before;
            if (u == x && v == y) own = is_before;
        }
    return own && 2 * before >= known;
}

/* Where no face lies behind the pixel, the sky has no texture and takes any depth: then the depth must be sure, and
 * stand before the opening. */
static bool set_clutter(struct find_job *j, size_t i, int x, int y, const struct met *met)
{
    const struct layered_depth *d = j->depth;
    const uint8_t made = j->picture->made[i];
    if (!d || !(j->ids->clutter[i] > CLUTTER_UNSURE) || !(d->interior.z[i] > 0) || !d->interior.id[i]) return false;
    if (made != MADE_PHOTO && made != MADE_CLUTTER) return false;
    if (j->ids->z[i] > 0 && !(d->interior.z[i] < j->ids->z[i])) return false; /* a rim, which shows what lies behind */
    const struct depth_segment *s = &d->segments[d->interior.id[i] - 1];
    struct gather_point p = {view_unproject(&j->camera, x + 0.5, y + 0.5, (double)d->interior.z[i] * j->scale),
                             segment_normal(j, s)};
    if (!met->face && !(s->confidence >= SURE && model_rays_near(&j->c->before.model, p.at) && stands_before(j, x, y)))
        return false;
    /* the picture shows it, so it is not behind a wall that the edit adds */
    if (met->face && vec3_length(vec3_sub(p.at, j->centre)) > vec3_length(vec3_sub(met->on_face.point, j->centre)))
        p = (struct gather_point){met->on_face.point, j->c->after.model.mesh.faces[met->on_face.id].normal};
    const double lift = LIFT * model_rays_size(&j->c->before.model);
    j->p->kind[i] = PIXEL_CLUTTER;
    j->p->before[i] = j->p->after[i] = p;
    model_field_lift(&j->c->before, &j->p->before[i], lift);
    model_field_lift(&j->c->after, &j->p->after[i], lift);
    return true;
}

/* ---------------------------------------------------------------------------------------------------------- objects */

/* z: of furniture before the object; INFINITY: none. The first of the pixel's rays that meets an object says which. */
static void set_object(struct find_job *j, size_t i, int x, int y, double nearest)
{
    struct object_pixel *o = &j->objects[i];
    const struct light_objects *objects = &j->c->objects;
    int count = 0;
    *o = (struct object_pixel){.object = -1};
    for (int v = 0; v < SUB; v++)
        for (int u = 0; u < SUB; u++) {
            struct vec3 d;
            if (!pixel_ray(j, x + (u + 0.5) / SUB, y + (v + 0.5) / SUB, &d)) continue;
            const struct met met = meet(j, d);
            if (!met.object || met.on_object.t > nearest) continue;
            count++;
            const bool is_middle = u == SUB / 2 && v == SUB / 2;
            if (o->object >= 0 && !is_middle) continue;
            const int triangle = (int)met.on_object.id - j->c->after.model.mesh.face_count;
            o->object = objects->object[triangle];
            o->point = light_objects_point(objects, triangle, met.on_object.point, met.on_object.normal);
            o->to_viewer = vec3_scale(d, -1);
        }
    o->pixel = (int)i;
    o->cover = (float)count / (SUB * SUB);
}

/* z: of furniture before the opening; INFINITY: none */
static void set_opening(struct find_job *j, size_t i, int x, int y, double nearest)
{
    struct opening_pixel *o = &j->openings[i];
    o->pixel = (int)i;
    for (int v = 0; v < SUB; v++)
        for (int u = 0; u < SUB; u++) {
            struct vec3 d;
            struct rgb radiance;
            if (!pixel_ray(j, x + (u + 0.5) / SUB, y + (v + 0.5) / SUB, &d)) continue;
            const struct vec3 unit = vec3_normalize(d);
            const double length = vec3_length(d);
            const struct met met = meet(j, d);
            double t = met.face ? met.on_face.t * length : INFINITY;
            if (met.object) t = fmin(t, met.on_object.t * length);
            if (!edit_lamps_meet(&radiance, &j->c->lamps, &j->c->after, j->centre, unit, fmin(t, nearest))) continue;
            o->cover += 1.0f / (SUB * SUB);
            o->rgb[0] += (float)radiance.r / (SUB * SUB);
            o->rgb[1] += (float)radiance.g / (SUB * SUB);
            o->rgb[2] += (float)radiance.b / (SUB * SUB);
        }
}

/* --------------------------------------------------------------------------------------------------------- pictures */

static void find_row(struct find_job *j, int y)
{
    for (int x = 0; x < j->p->width; x++) {
        const size_t i = (size_t)y * (size_t)j->p->width + (size_t)x;
        struct vec3 d;
        double nearest = INFINITY, at = 0;
        j->p->face[i] = -1;
        if (j->objects) j->objects[i].object = -1;
        if (!pixel_ray(j, x + 0.5, y + 0.5, &d)) continue;
        const struct met met = meet(j, d);
        const struct lamp *lamp =
            model_field_lamp(&j->c->before, j->centre, d, met.face ? met.on_face.t : INFINITY, &at);
        if (j->picture->made[i] == MADE_NOTHING)
            j->p->kind[i] = PIXEL_KEPT;
        else if (lamp) /* before furniture: depth takes a lamp that hangs for some */
            set_lamp(j, i, lamp, vec3_add(j->centre, vec3_scale(d, at)));
        else if (set_thing(j, i, &met) || set_clutter(j, i, x, y, &met))
            nearest = vec3_length(vec3_sub(j->p->after[i].at, j->centre));
        else if (met.face && met.on_face.front && j->picture->made[i] != MADE_OUTDOORS)
            set_face(j, i, &met.on_face);
        if (j->objects) set_object(j, i, x, y, nearest);
        if (j->openings) set_opening(j, i, x, y, nearest);
    }
}

static void find_rows(void *ctx, size_t begin, size_t end, int thread)
{
    (void)thread;
    for (size_t y = begin; y < end; y++) find_row(ctx, (int)y);
}

static enum status read_layers(struct layered_depth *depth, struct view_ids *ids, const struct pixel_layers *l,
                               const struct model_picture *picture, struct provenance *prov, struct err *err)
{
    const struct product_key key = {.view = l->view->name};
    char path[FILE_PATH];
    if (!product_path_in(path, l->ids, PRODUCT_IDS, &key, err) && !view_ids_read(ids, l->view, path, prov, err) &&
        !product_path_in(path, l->depth, PRODUCT_DEPTH, &key, err))
        layered_depth_read_interior(depth, path, prov, err);
    if (!err->status && (depth->width != picture->width || depth->height != picture->height))
        err_set(err, ST_DATA, "%s is %d x %d px, but the picture is %d x %d px. Run make depth again.", path,
                depth->width, depth->height, picture->width, picture->height);
    return err->status;
}

static enum status list_objects(struct pixels *p, const struct object_pixel *objects, struct err *err)
{
    for (int i = 0; i < p->width * p->height; i++) {
        if (objects[i].object < 0) continue;
        if (array_append(&p->objects, (size_t)p->object_count, sizeof *p->objects, "pixels", err)) return err->status;
        p->objects[p->object_count++] = objects[i];
    }
    return ST_OK;
}

static enum status list_openings(struct pixels *p, const struct opening_pixel *openings, struct err *err)
{
    for (int i = 0; i < p->width * p->height; i++) {
        if (!(openings[i].cover > 0)) continue;
        if (array_append(&p->openings, (size_t)p->opening_count, sizeof *p->openings, "pixels", err))
            return err->status;
        p->openings[p->opening_count++] = openings[i];
    }
    return ST_OK;
}

/* Whether a picture shows something. The views of a photo that look away from it are all but black. */
static bool is_drawn(const struct model_picture *p)
{
    const size_t n = (size_t)p->width * (size_t)p->height;
    size_t drawn = 0;
    for (size_t i = 0; i < n; i++) drawn += p->made[i] != MADE_NOTHING;
    return (double)drawn >= DRAWN * (double)n;
}

enum status pixels_find(struct pixels *p, const struct light_change *c, const struct model_picture *picture,
                        const struct pixel_layers *layers, struct provenance *prov, struct err *err)
{
    const size_t n = (size_t)picture->width * (size_t)picture->height;
    const struct mat3 cam_from_model = mat3_from_quat(picture->pose.rotation);
    struct find_job j = {.p = p, .c = c, .picture = picture, .model_from_cam = mat3_transpose(cam_from_model)};
    struct layered_depth depth = {0};
    struct view_ids ids = {0};
    pixels_init(p, picture->width, picture->height, err);
    p->is_black = !c->objects.count && !is_drawn(picture);
    for (size_t i = 0; !err->status && p->is_black && i < n; i++) p->face[i] = -1;
    if (err->status || p->is_black) return err->status;
    j.centre = p->centre = pose_center(&picture->pose);
    if (!err->status && layers) {
        read_layers(&depth, &ids, layers, picture, prov, err);
        j.depth = &depth;
        j.ids = &ids;
        j.camera = model_from_world_view(&c->axes, layers->view);
        j.scale = c->axes.scale;
    }
    if (!err->status && c->objects.count && !(j.objects = calloc(n + 1, sizeof *j.objects)))
        err_nomem(err, "pixels of objects", n * sizeof *j.objects);
    if (!err->status && c->lamps.planned.count && !(j.openings = calloc(n + 1, sizeof *j.openings)))
        err_nomem(err, "pixels of lamps", n * sizeof *j.openings);
    if (!err->status) parallel_for((size_t)picture->height, 4, find_rows, &j);
    if (!err->status && j.objects) list_objects(p, j.objects, err);
    if (!err->status && j.openings) list_openings(p, j.openings, err);
    free(j.objects);
    free(j.openings);
    layered_depth_release(&depth);
    view_ids_release(&ids);
    return err->status;
}
