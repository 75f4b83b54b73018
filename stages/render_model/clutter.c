/* clutter.c - clutter over the shell: the views that are kept, and the picture's camera in their frame; see clutter.h.
 *
 * Overview. A view's layers hold all that it shows. clutter_view.c leaves in them what stands in front of the model;
 * clutter_choose.c elects the views for a camera; clutter_blend.c draws their segments at their own depths, lets the
 * views vote on what is there, and blends what remains over the shell. From an original view itself the photo's own
 * pixels are drawn, so that no blending can change them.
 *
 * Source: soft z-buffer and segments [Colburn 2014, 3.6]. What differs: the thesis draws whole views; here the model is
 * drawn under clean texture, and the layers hold its furniture alone. */
#include "stages/render_model/clutter.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/capture/view_image.h"
#include "common/product/product.h"
#include "stages/render_model/clutter_scene.h"
#include "stages/render_model/thing_surface.h"

#define MIB ((size_t)1 << 20)

#define COVERED 0.5f /* of a pixel, that is clutter */

enum { SURFACE_VIEWS = 6 }; /* of the colours of a surface that fills holes: every thing has views of its own */
enum { FEWEST = 2 };        /* views of a picture, however little memory is allowed */

/* ------------------------------------------------------------------------------------------------------------ views */

enum status clutter_open(struct clutter_scene **scene, const struct clutter_files *files, const struct camera_set *set,
                         const struct model_axes *axes, struct err *err)
{
    struct clutter_scene *s = calloc(1, sizeof *s);
    *scene = s;
    if (!s) return err_nomem(err, "clutter", sizeof *s);
    s->set = set;
    s->axes = *axes;
    s->budget = (size_t)files->memory * MIB;
    s->views = strdup(files->views);
    s->depth = strdup(files->depth);
    s->ids = strdup(files->ids);
    s->things = files->things ? strdup(files->things) : NULL;
    s->sources = calloc((size_t)set->view_count + 1, sizeof *s->sources);
    s->walls = files->unedited;
    pane_fronts_find(&s->panes, files->unedited ? &files->unedited->mesh : NULL, err);
    if (!err->status && !(s->views && s->depth && s->ids && s->sources && !s->things == !files->things))
        err_nomem(err, "the views of the clutter", (size_t)set->view_count * sizeof *s->sources);
    if (!err->status) return ST_OK;
    clutter_close(s);
    *scene = NULL;
    return err->status;
}

static void drop(struct clutter_scene *s, struct clutter_source *source)
{
    if (source->loaded) s->bytes -= source->view.bytes;
    clutter_view_release(&source->view);
    source->loaded = false;
}

void clutter_close(struct clutter_scene *s)
{
    if (!s) return;
    for (int i = 0; s->sources && i < s->set->view_count; i++) {
        drop(s, &s->sources[i]);
        provenance_release(&s->sources[i].inputs);
    }
    for (int k = 0; k < CLUTTER_VIEWS; k++) drawn_view_release(&s->drawn[k]);
    pane_fronts_release(&s->panes);
    free(s->views);
    free(s->depth);
    free(s->ids);
    free(s->things);
    free(s->sources);
    free(s);
}

static enum status read_source(struct clutter_scene *s, int at, struct err *err)
{
    const struct view *view = &s->set->views[at];
    struct clutter_source *source = &s->sources[at];
    struct layered_depth depth = {0};
    struct view_ids ids = {0};
    struct thing_mask things = {0};
    const struct product_key key = {.view = view->name};
    char path[FILE_PATH];
    if (!product_path_in(path, s->depth, PRODUCT_DEPTH, &key, err) &&
        !layered_depth_read(&depth, path, &source->inputs, err) &&
        !product_path_in(path, s->ids, PRODUCT_IDS, &key, err))
        view_ids_read(&ids, view, path, &source->inputs, err);
    if (!err->status && s->things && !product_path_in(path, s->things, PRODUCT_THING_MASK, &key, err))
        thing_mask_read(&things, view, path, UINT32_MAX, &source->inputs, err);
    if (!err->status) {
        const struct view camera = model_from_world_view(&s->axes, view);
        pane_fronts_apply(&ids, &s->panes, &camera, s->axes.scale);
    }
    if (!err->status && !clutter_view_make(&source->view, &depth, &ids, s->things ? &things : NULL, view->name, err)) {
        source->loaded = true;
        s->bytes += source->view.bytes;
    }
    view_ids_release(&ids);
    thing_mask_release(&things);
    layered_depth_release(&depth);
    return err->status;
}

/* Drops views that the present picture does not need, until `more` bytes fit into the budget. */
static void make_room(struct clutter_scene *s, size_t more)
{
    while (s->bytes + more > s->budget) {
        struct clutter_source *oldest = NULL;
        for (int i = 0; i < s->set->view_count; i++) {
            struct clutter_source *source = &s->sources[i];
            if (source->loaded && source->used < s->picture && (!oldest || source->used < oldest->used))
                oldest = source;
        }
        if (!oldest) return;
        drop(s, oldest);
    }
}

enum status clutter_load(struct clutter_scene *s, const struct clutter_choice *choice, struct provenance *prov,
                         struct err *err)
{
    s->picture++;
    for (int k = 0; k < choice->count; k++) s->sources[choice->view[k]].used = s->picture;
    for (int k = 0; !err->status && k < choice->count; k++) {
        struct clutter_source *source = &s->sources[choice->view[k]];
        if (!source->loaded) {
            make_room(s, clutter_view_bytes(&s->set->views[choice->view[k]]));
            read_source(s, choice->view[k], err);
        }
        if (!err->status && prov) provenance_add_all(prov, &source->inputs, err);
    }
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- picture */

/* The inverse of model_from_world_view(). */
static struct view world_from_model_view(const struct model_axes *axes, const struct view *model)
{
    struct view v = *model;
    v.cam_from_world = mat3_multiply(model->cam_from_world, mat3_from_quat(axes->rotation));
    v.center = world_from_model_point(axes, model->center);
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, v.center), -1);
    return v;
}

/* Whether the camera, of the model's frame, is that view of the set. */
static bool is_camera_of(const struct clutter_scene *s, const struct view *camera, int view)
{
    const struct view own = model_from_world_view(&s->axes, &s->set->views[view]);
    return own.width == camera->width && own.height == camera->height && own.fx == camera->fx && own.fy == camera->fy &&
           own.cx == camera->cx && own.cy == camera->cy && own.center.x == camera->center.x &&
           own.center.y == camera->center.y && own.center.z == camera->center.z &&
           !memcmp(&own.cam_from_world, &camera->cam_from_world, sizeof own.cam_from_world);
}

/* The set's view whose camera this is; -1: none. */
static int find_own(const struct clutter_scene *s, const struct view *camera, const int *views, int count)
{
    for (int i = 0; i < (views ? count : s->set->view_count); i++)
        if (is_camera_of(s, camera, views ? views[i] : i)) return views ? views[i] : i;
    return -1;
}

/* As many views as fit into memory. */
static int max_views(const struct clutter_scene *s)
{
    size_t largest = 1;
    for (int i = 0; i < s->set->view_count; i++) {
        const size_t bytes = clutter_view_bytes(&s->set->views[i]);
        if (bytes > largest) largest = bytes;
    }
    const size_t fit = s->budget / largest;
    return fit < FEWEST ? FEWEST : fit < CLUTTER_VIEWS ? (int)fit : CLUTTER_VIEWS;
}

static void take_given(struct clutter_choice *choice, const int *views, int count)
{
    choice->count = count < CLUTTER_VIEWS ? count : CLUTTER_VIEWS;
    for (int k = 0; k < choice->count; k++) {
        choice->view[k] = views[k];
        choice->fade[k] = 1;
    }
}

/* Lays rows of a layer over the picture. photo: what the camera's own view shows, which takes the place of the layer's
 * colours: whatever covers at least half of a pixel hides the shell there. NULL: no view has this camera. */
static void lay(struct model_picture *p, float *front, const struct clutter_layer *l, const struct image *photo,
                double scale, struct thing_rows rows)
{
    for (size_t i = rows.first * (size_t)p->width; i < rows.last * (size_t)p->width; i++) {
        const float *c = l->rgba + 4 * i, part = !photo ? c[3] : c[3] < 0.5f ? 2 * c[3] : 1;
        if (p->made[i] == MADE_NOTHING && c[3] < COVERED) continue; /* a rim alone makes no picture */
        for (size_t k = 0; k < 3 && part > 0; k++) {
            const float own = photo ? part * photo->data[4 * i + k] : fmaxf(0, c[k]);
            p->rgb[3 * i + k] = p->rgb[3 * i + k] * (1 - part) + own;
        }
        if (front && c[3] >= COVERED) front[i] = l->z[i] * (float)scale;
        if (c[3] >= COVERED)
            p->made[i] = MADE_CLUTTER;
        else if (l->doubt[i] >= COVERED && p->made[i] != MADE_NOTHING)
            p->made[i] = MADE_UNSURE;
    }
}

static struct thing_rows all_rows(const struct model_picture *p) { return (struct thing_rows){0, (size_t)p->height}; }

static enum status check_size(const struct model_picture *p, const struct view *camera, struct err *err)
{
    if (p->width == camera->width && p->height == camera->height) return ST_OK;
    return err_set(err, ST_INTERNAL, "the picture has %d x %d pixels, but its camera %d x %d.", p->width, p->height,
                   camera->width, camera->height);
}

enum status clutter_draw(struct model_picture *p, float *front, struct clutter_scene *s, const struct view *camera,
                         const struct clutter_filter *filter, const int *views, int count, struct provenance *prov,
                         struct err *err)
{
    const struct view scene_camera = world_from_model_view(&s->axes, camera);
    const int own = find_own(s, camera, views, count);
    struct clutter_choice choice = {.view = {own}, .fade = {1}, .count = 1};
    struct clutter_layer layer = {0};
    struct image photo = {0};
    if (check_size(p, camera, err) || clutter_layer_init(&layer, p->width, p->height, err)) return err->status;
    if (own < 0 && views)
        take_given(&choice, views, count);
    else if (own < 0)
        clutter_choose(&choice, s, &scene_camera, p->z, 1 / s->axes.scale, max_views(s), err);
    if (!err->status && !clutter_load(s, &choice, prov, err) &&
        !clutter_blend(&layer, p->z, s, &choice, &scene_camera, filter, err) && own >= 0)
        view_image_read(&photo, s->views, &s->set->views[own], prov, err);
    if (!err->status && front) memcpy(front, p->z, (size_t)p->width * (size_t)p->height * sizeof *front);
    if (!err->status) lay(p, front, &layer, own >= 0 ? &photo : NULL, s->axes.scale, all_rows(p));
    image_release(&photo);
    clutter_layer_release(&layer);
    return err->status;
}

/* Takes a layer off the pixels that are to stay. */
static void leave_pixels(struct clutter_layer *l, const uint8_t *stays, size_t pixels)
{
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < 4 && stays[i]; c++) l->rgba[4 * i + c] = 0;
}

/* Chooses and loads the views that a thing is drawn from, with an empty layer. camera: scene frame. */
static enum status prepare_thing(struct clutter_layer *layer, struct clutter_choice *choice,
                                 const struct model_picture *p, struct clutter_scene *s, const struct view *camera,
                                 const struct thing_points *points, int most, struct provenance *prov, struct err *err)
{
    struct vec3 places[THING_POINTS];
    for (int k = 0; k < points->count; k++) places[k] = world_from_model_point(&s->axes, points->at[k]);
    if (check_size(p, camera, err) || clutter_layer_init(layer, p->width, p->height, err)) return err->status;
    if (!clutter_choose_for(choice, s, camera->center, places, points->count, most, err))
        clutter_load(s, choice, prov, err);
    return err->status;
}

enum status clutter_draw_thing(struct model_picture *p, float *front, const struct thing_pixels *pixels,
                               struct clutter_scene *s, const struct view *camera, const struct thing_shape *thing,
                               struct provenance *prov, struct err *err)
{
    const struct clutter_filter filter = {.volume = thing->volume, .only = thing->id};
    const struct view scene_camera = world_from_model_view(&s->axes, camera);
    const size_t count = (size_t)p->width * (size_t)p->height;
    struct clutter_choice choice;
    struct clutter_layer layer = {0};
    struct thing_rows drawn;
    if (!prepare_thing(&layer, &choice, p, s, &scene_camera, thing->points, max_views(s), prov, err) &&
        (thing->outline->count || !clutter_blend(&layer, front, s, &choice, &scene_camera, &filter, err)))
        thing_surface_draw(&drawn, &layer, front, s, &choice, &scene_camera, thing, err);
    if (!err->status && pixels->stays) leave_pixels(&layer, pixels->stays, count);
    for (size_t i = 0; !err->status && i < count; i++) {
        layer.doubt[i] = 0; /* what is not drawn of a thing is not there: the shell is sure */
        if (pixels->shown && layer.rgba[4 * i + 3] > 0) pixels->shown[i] = 0;
    }
    if (!err->status) lay(p, front, &layer, NULL, s->axes.scale, all_rows(p));
    clutter_layer_release(&layer);
    return err->status;
}

enum status clutter_draw_surface(struct model_picture *p, float *front, struct clutter_scene *s,
                                 const struct view *camera, const struct thing_shape *thing, struct provenance *prov,
                                 struct err *err)
{
    const struct view scene_camera = world_from_model_view(&s->axes, camera);
    const size_t count = (size_t)p->width * (size_t)p->height;
    struct clutter_choice choice;
    struct clutter_layer layer = {0};
    struct thing_rows rows;
    const int most = max_views(s) < SURFACE_VIEWS ? max_views(s) : SURFACE_VIEWS;
    if (!prepare_thing(&layer, &choice, p, s, &scene_camera, thing->points, most, prov, err)) {
        for (size_t i = 0; i < count; i++)
            if (p->made[i] == MADE_CLUTTER) layer.rgba[4 * i + 3] = 1;
        thing_surface_draw(&rows, &layer, front, s, &choice, &scene_camera, thing, err);
        for (size_t i = 0; i < count; i++)
            if (p->made[i] == MADE_CLUTTER) layer.rgba[4 * i + 3] = 0;
        if (!err->status) lay(p, front, &layer, NULL, s->axes.scale, rows);
    }
    clutter_layer_release(&layer);
    return err->status;
}
