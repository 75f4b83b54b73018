/* place_marks.c - see place_marks.h.
 *
 * A mark shows a place at its height: the ray of its pixel is cut with the plane of that height above each floor, and
 * the nearest cut inside a room's outline counts. Furniture may be in front of it, since a desk's own surface is where
 * people mark a desk; a wall may not. */
#include "stages/light_levels/place_marks.h"

#include <math.h>

#include "common/capture/photo_camera.h"
#include "common/product/product.h"

static const double BEFORE = 0.02; /* of the model's size: how far in front a face may be, by errors of both */

static bool room_holds(const struct model_room *r, double x, double y)
{
    bool inside = false;
    for (int i = 0, k = r->corner_count - 1; i < r->corner_count; k = i++) {
        const struct model_room_corner *a = &r->corners[i], *b = &r->corners[k];
        if ((a->y > y) != (b->y > y) && x < (b->x - a->x) * (y - a->y) / (b->y - a->y) + a->x) inside = !inside;
    }
    return inside;
}

bool place_mark_find(struct vec3 *at, const struct model_plan *plan, struct vec3 from, struct vec3 ray, double height)
{
    double nearest = INFINITY;
    for (int i = 0; i < plan->room_count; i++) {
        const double t = (plan->rooms[i].floor + height - from.z) / ray.z;
        if (!(t > 0 && t < nearest)) continue;
        const struct vec3 cut = vec3_add(from, vec3_scale(ray, t));
        if (!room_holds(&plan->rooms[i], cut.x, cut.y)) continue;
        nearest = t;
        *at = cut;
    }
    return isfinite(nearest);
}

static enum status resolve(struct light_place_mark *m, const struct place_list *l, const struct camera_set *set,
                           const struct lens_list *lenses, const struct place_marks *with, struct err *err)
{
    struct photo_camera camera;
    struct vec3 ray, at;
    struct ray_hit hit;
    if (photo_camera_find(&camera, m->photo, set, lenses, l->path, m->line, err)) return err->status;
    if (!photo_camera_ray(&camera, m->pixel[0], m->pixel[1], &ray))
        return err_set(err, ST_DATA, "%s:%d: pixel %g %g is not inside the photo %s, which has %d x %d pixels.",
                       l->path, m->line, m->pixel[0], m->pixel[1], m->photo, camera.lens.width, camera.lens.height);
    const double height = m->height < 0 ? with->work_plane : m->height;
    const struct vec3 from = model_from_world_point(with->axes, camera.center);
    ray = model_from_world_direction(with->axes, ray);
    if (!place_mark_find(&at, with->plan, from, ray, height))
        return err_set(
            err, ST_DATA,
            "%s:%d: pixel %g %g of %s shows no place of a room at a height of %g; mark the place %s lower in "
            "the photo, or give its own height.",
            l->path, m->line, m->pixel[0], m->pixel[1], m->photo, height, m->name);
    const double away = vec3_length(vec3_sub(at, from)), before = BEFORE * model_rays_size(with->model);
    if (ray_scene_hit(&with->model->rays, from, ray, &hit) && (int)hit.id < with->model->mesh.face_count &&
        hit.t < away - before)
        return err_set(err, ST_DATA,
                       "%s:%d: at pixel %g %g of %s, %s is in front of a place at a height of %g; mark the place %s in "
                       "another photo, or give its own height.",
                       l->path, m->line, m->pixel[0], m->pixel[1], m->photo,
                       solid_face_name(&with->model->mesh, (int)hit.id), height, m->name);
    m->at[0] = at.x;
    m->at[1] = at.y;
    return ST_OK;
}

enum status place_marks_resolve(struct place_list *l, const struct place_marks *with, struct provenance *prov,
                                struct err *err)
{
    struct camera_set set = {0};
    struct lens_list lenses = {0};
    char path[FILE_PATH];
    int marks = 0;
    for (int i = 0; i < l->count; i++) marks += l->items[i].photo != NULL;
    if (!marks) return ST_OK;
    if (!with->views)
        return err_set(err, ST_USAGE, "%s has places that are marked in photos, which need --views.", l->path);
    if (!camera_set_read_cameras(&set, with->views, prov, err) &&
        !product_path_in(path, with->views, PRODUCT_LENSES, &(struct product_key){0}, err))
        lens_list_read(&lenses, path, prov, err);
    for (int i = 0; !err->status && i < l->count; i++)
        if (l->items[i].photo) resolve(&l->items[i], l, &set, &lenses, with, err);
    lens_list_release(&lenses);
    camera_set_release(&set);
    return err->status;
}
