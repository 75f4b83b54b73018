/* own_pixels.c - which pixels of a view an edit leaves alone; see own_pixels.h.
 *
 * [Colburn 2014, 4.6] compares the ids of faces. Different here: a wall that is moved keeps its id, so the planes are
 * compared too, by the inverse depth of the face at the pixel; and a wall that stands may be painted or get another
 * texture, so the rules of the texture map must keep what the face showed there. */
#include "stages/render_model/own_pixels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/capture/view_image.h"
#include "common/layers/layered_depth.h"
#include "common/math/distance.h"
#include "common/model/thing_mask.h"
#include "common/product/product.h"
#include "common/texture/view_ids.h"

static const double same_depth = 1e-5; /* relative: rounding of the models' corners */
enum { CLEARED_MARGIN = 4 };           /* px around cleared clutter: its blurred border */

struct traced { /* a view in a model */
    uint32_t *faces;
    double (*planes)[3]; /* inverse depth of each face of the model */
};

static void traced_release(struct traced *t)
{
    free(t->faces);
    free(t->planes);
}

static enum status trace(struct traced *t, const struct model_rays *model, const struct view *camera, struct err *err)
{
    const size_t pixels = (size_t)camera->width * (size_t)camera->height, faces = (size_t)model->mesh.face_count;
    t->faces = malloc(pixels * sizeof *t->faces);
    t->planes = malloc((faces + 1) * sizeof *t->planes);
    if (!t->faces || !t->planes) return err_nomem(err, "faces of a view", pixels * sizeof *t->faces);
    model_rays_view(t->faces, model, camera);
    for (size_t f = 0; f < faces; f++) model_face_inverse_depth(t->planes[f], &model->mesh.faces[f], camera);
    return ST_OK;
}

static double inverse_depth(const struct traced *t, uint32_t face, double u, double v)
{
    const double *p = t->planes[face - 1];
    return p[0] * u + p[1] * v + p[2];
}

/* Sets same to 1 where both models have one face in one plane, with the same texture. */
static void compare(uint8_t *same, const struct room *room, const struct traced *base, const struct traced *edited,
                    const struct view *camera)
{
    for (int y = 0; y < camera->height; y++)
        for (int x = 0; x < camera->width; x++) {
            const size_t i = (size_t)y * (size_t)camera->width + (size_t)x;
            const uint32_t a = base->faces[i], b = edited->faces[i];
            same[i] = !a && !b;
            if (!a || !b) continue;
            const int id = solid_face_id(&room->model.mesh, (int)b - 1);
            if (solid_face_id(&room->base.mesh, (int)a - 1) != id) continue;
            const double za = inverse_depth(base, a, x + 0.5, y + 0.5), zb = inverse_depth(edited, b, x + 0.5, y + 0.5);
            if (!(fabs(za - zb) <= same_depth * fabs(za))) continue;
            const struct vec3 at = view_unproject(camera, x + 0.5, y + 0.5, 1 / zb);
            same[i] = texture_map_keeps(shell_map(room->shell), id, at, same_depth / fabs(zb));
        }
}

/* Clears `same` within `margin` px of the pixels that have `same` 0. */
static enum status grow(uint8_t *same, const struct view *camera, double margin, struct err *err)
{
    const size_t pixels = (size_t)camera->width * (size_t)camera->height;
    float *squared = malloc(pixels * sizeof *squared);
    if (squared)
        distance_squared(squared, same, camera->width, camera->height, err);
    else
        err_nomem(err, "distances", pixels * sizeof *squared);
    for (size_t i = 0; !err->status && i < pixels; i++) same[i] = same[i] && squared[i] > margin * margin;
    free(squared);
    return err->status;
}

/* Whether the first thing on the way to the model's surface at depth z is gone: legs are too thin for depth, and where
 * a view's depth is off, others have seen what is there. What lies flat is met in its outline, behind all others. */
static bool meets_gone(const struct placed_things *t, const struct view *camera, double u, double v, double z)
{
    if (!(z > 0)) return false;
    const struct vec3 end = view_unproject(camera, u, v, z), way = vec3_sub(end, camera->center);
    const int steps = (int)(vec3_length(way) / t->volume.grid.voxel) + 1;
    for (int k = 1; k <= steps; k++) {
        const struct vec3 at = vec3_add(camera->center, vec3_scale(way, (double)k / steps));
        const uint32_t id = thing_volume_at(&t->volume, at);
        if (id && !placed_things_outline(t, id)) return t->fate[id] == THING_IS_GONE;
    }
    return placed_things_flat_at(t, end, THING_IS_GONE) > 0;
}

/* Clears `same` where the photo shows clutter that is left out, and a little around it. gone: gets 1 there. */
static enum status leave_cleared(uint8_t *same, uint8_t *gone, const struct room *room, int view,
                                 struct provenance *prov, struct err *err)
{
    const struct view *camera = &room->cameras[view], *world = &room->in.set.views[view];
    const struct clutter_filter filter = clutter_filter_of(&room->things, shell_map(room->shell));
    const size_t pixels = (size_t)camera->width * (size_t)camera->height;
    const struct product_key key = {.view = world->name};
    char path[FILE_PATH];
    struct view_ids ids = {0};
    struct layered_depth depth = {0};
    struct thing_mask mask = {0};
    if (filter.volume && room->files.things &&
        !product_path_in(path, room->files.things, PRODUCT_THING_MASK, &key, err))
        thing_mask_read(&mask, world, path, (uint32_t)room->things.list.count, prov, err);
    if (!err->status && !product_path_in(path, room->files.ids, PRODUCT_IDS, &key, err) &&
        !view_ids_read(&ids, world, path, prov, err) &&
        !product_path_in(path, room->files.depth, PRODUCT_DEPTH, &key, err))
        layered_depth_read_interior(&depth, path, prov, err);
    uint8_t *stays = malloc(pixels);
    if (!err->status && !stays) err_nomem(err, "cleared clutter", pixels);
    if (!err->status && (depth.width != camera->width || depth.height != camera->height))
        err_set(err, ST_DATA, "%s is %d x %d px, but its camera is %d x %d px. Run make depth again.", path,
                depth.width, depth.height, camera->width, camera->height);
    for (int y = 0; !err->status && y < camera->height; y++)
        for (int x = 0; x < camera->width; x++) {
            const size_t i = (size_t)y * (size_t)camera->width + (size_t)x;
            const double z = depth.interior.z[i] * room->in.axes.scale;
            const enum thing_fate fate = mask.shows ? filter.fate[mask.shows[i]] : THING_STAYS;
            stays[i] =
                fate != THING_IS_GONE &&
                !(z > 0 && ids.clutter[i] > CLUTTER_UNSURE &&
                  clutter_filter_drops(&filter, view_unproject(camera, x + 0.5, y + 0.5, z))) &&
                !(filter.volume && meets_gone(&room->things, camera, x + 0.5, y + 0.5, ids.z[i] * room->in.axes.scale));
        }
    for (size_t i = 0; !err->status && i < pixels; i++) gone[i] = !stays[i];
    if (!err->status) grow(stays, camera, CLEARED_MARGIN, err);
    for (size_t i = 0; !err->status && i < pixels; i++) same[i] &= stays[i];
    free(stays);
    thing_mask_release(&mask);
    layered_depth_release(&depth);
    view_ids_release(&ids);
    return err->status;
}

enum status own_pixels_find(uint8_t *same, uint8_t *gone, const struct room *room, int view, struct provenance *prov,
                            struct err *err)
{
    const struct view *camera = &room->cameras[view];
    struct traced base = {0}, edited = {0};
    memset(same, 1, (size_t)camera->width * (size_t)camera->height);
    memset(gone, 0, (size_t)camera->width * (size_t)camera->height);
    if (!room->files.base) return ST_OK;
    if (!trace(&base, &room->base, camera, err) && !trace(&edited, &room->model, camera, err)) {
        compare(same, room, &base, &edited, camera);
        grow(same, camera, room->params->margin, err);
    }
    const struct clutter_filter filter = clutter_filter_of(&room->things, shell_map(room->shell));
    if (!err->status && clutter_filter_is_needed(&filter) && room->files.depth && room->files.ids)
        leave_cleared(same, gone, room, view, prov, err);
    traced_release(&base);
    traced_release(&edited);
    return err->status;
}

enum status own_pixels_draw(struct model_picture *picture, const uint8_t *same, const struct room *room, int view,
                            struct provenance *prov, struct err *err)
{
    const struct view *world = &room->in.set.views[view];
    const size_t pixels = (size_t)world->width * (size_t)world->height;
    struct image photo = {0};
    view_image_read(&photo, room->files.views, world, prov, err);
    for (size_t i = 0; !err->status && i < pixels; i++) {
        const bool shown = photo.data[4 * i + 3] > 0; /* the view may look past the photo's border */
        if (!same[i] && shown) continue;
        for (size_t c = 0; c < 3; c++) picture->rgb[3 * i + c] = shown ? photo.data[4 * i + c] : 0;
        picture->made[i] = shown ? MADE_PHOTO : MADE_NOTHING;
    }
    image_release(&photo);
    return err->status;
}
