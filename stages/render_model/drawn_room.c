/* drawn_room.c - opens what pictures are drawn from, and draws a picture; see drawn_room.h. */
#include "stages/render_model/drawn_room.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/capture/photo_camera.h"
#include "common/texture/scene_exposure.h"

/* Views are in order of name, so those of a photo follow each other. */
static enum status find_viewpoints(struct room *room, struct err *err)
{
    const size_t views = (size_t)room->in.set.view_count + 1;
    room->viewpoints = calloc(views, sizeof *room->viewpoints);
    room->cameras = calloc(views, sizeof *room->cameras);
    if (!room->viewpoints || !room->cameras) return err_nomem(err, "viewpoints", views * sizeof *room->viewpoints);
    for (int i = 0; i < room->in.set.view_count; i++) {
        const struct lens *lens = photo_lens_of_view(&room->in.set, &room->in.lenses, i);
        if (!lens)
            return err_set(err, ST_DATA, "%s/lenses.txt has no line of view %s. Run make views again.",
                           room->files.views, room->in.set.views[i].name);
        room->cameras[i] = model_from_world_view(&room->in.axes, &room->in.set.views[i]);
        struct viewpoint *last = room->viewpoints + room->viewpoint_count - 1;
        if (room->viewpoint_count && !strcmp(last->photo, lens->photo))
            last->count++;
        else
            room->viewpoints[room->viewpoint_count++] =
                (struct viewpoint){.photo = lens->photo, .centre = room->cameras[i].center, .first = i, .count = 1};
    }
    return ST_OK;
}

static enum status read_cameras(struct room *room, struct provenance *prov, struct err *err)
{
    const struct scene_files files = {.views = room->files.views, .axes = room->files.axes};
    return scene_inputs_read(&room->in, SCENE_CAMERAS | SCENE_LENSES | SCENE_AXES, &files, prov, err) ||
                   find_viewpoints(room, err)
               ? err->status
               : ST_OK;
}

enum status room_open(struct room *room, const struct room_files *files, const struct render_model_params *params,
                      struct provenance *prov, struct err *err)
{
    const struct shell_files shell = {files->model, files->map, files->vdta, files->vita, params->memory};
    const struct model_rays *unedited = files->base ? &room->base : &room->model;
    const struct clutter_files clutter = {files->views,  files->depth, files->ids,
                                          files->things, unedited,     params->memory};
    *room = (struct room){.files = *files, .params = params, .exposure = params->exposure > 0 ? params->exposure : 1};
    if (!read_cameras(room, prov, err)) model_rays_read(&room->model, files->model, MODEL_WITH_GLASS, NULL, err);
    if (!err->status && files->base) model_rays_read(&room->base, files->base, MODEL_WITH_GLASS, prov, err);
    if (!err->status && files->exposure && !(params->exposure > 0))
        scene_exposure_read(&room->exposure, files->exposure, prov, err);
    if (!err->status && files->outdoors) outdoors_read(&room->outdoors, files->outdoors, prov, err);
    if (!err->status && !shell_open(&room->shell, &shell, prov, err)) shell_set_samples(room->shell, params->samples);
    if (!err->status && files->depth && !strcmp(params->clutter, "drawn"))
        clutter_open(&room->clutter, &clutter, &room->in.set, &room->in.axes, err);
    if (!err->status)
        placed_things_read(&room->things, files->things, shell_map(room->shell),
                           files->base ? &room->base : &room->model, &room->model, prov, err);
    return err->status;
}

void room_close(struct room *room)
{
    placed_things_release(&room->things);
    free(room->front);
    clutter_close(room->clutter);
    shell_close(room->shell);
    outdoors_release(&room->outdoors);
    model_rays_release(&room->base);
    model_rays_release(&room->model);
    free(room->viewpoints);
    free(room->cameras);
    scene_inputs_release(&room->in);
    *room = (struct room){0};
}

int room_viewpoint_of(const struct room *room, int view)
{
    for (int i = 0; i < room->viewpoint_count; i++)
        if (view < room->viewpoints[i].first + room->viewpoints[i].count) return i;
    return -1;
}

int room_find_viewpoint(const struct room *room, const char *photo)
{
    for (int i = 0; i < room->viewpoint_count; i++)
        if (!strcmp(room->viewpoints[i].photo, photo)) return i;
    return -1;
}

static void photos_of(const char *photos[2], const struct room *room, const struct texture_pair *pair)
{
    for (int k = 0; k < 2; k++) photos[k] = pair->viewpoint[k] < 0 ? NULL : room->viewpoints[pair->viewpoint[k]].photo;
}

static enum status make_front(struct room *room, size_t pixels, struct err *err)
{
    if (pixels <= room->front_size) return ST_OK;
    free(room->front);
    room->front_size = 0;
    if (!(room->front = malloc(pixels * sizeof *room->front)))
        return err_nomem(err, "depths of a picture", pixels * sizeof *room->front);
    room->front_size = pixels;
    return ST_OK;
}

enum status room_draw_things(struct model_picture *picture, struct room *room, const struct view *camera, uint8_t *same,
                             struct provenance *prov, struct err *err)
{
    const struct placed_things *t = &room->things;
    const struct thing_pixels pixels = {.shown = same};
    for (int i = 0; !err->status && room->clutter && i < t->placed_count; i++) {
        const struct placed_thing *p = &t->placed[i];
        const struct view moved = placed_thing_camera(p, camera);
        const struct thing_shape shape = placed_things_shape(t, p->id);
        clutter_draw_thing(picture, room->front, &pixels, room->clutter, &moved, &shape, prov, err);
    }
    return err->status;
}

/* Whether a box may cover a pixel that does not stay. stays: NULL: none does. */
static bool box_matters(const struct view *camera, struct vec3 low, struct vec3 high, const uint8_t *stays)
{
    double left = INFINITY, top = INFINITY, right = -INFINITY, below = -INFINITY;
    for (int k = 0; k < 8; k++) {
        double u, v;
        const struct vec3 corner = vec3_make(k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z);
        if (!(view_project(camera, corner, &u, &v) > 0)) u = v = NAN; /* behind the camera: it may be anywhere */
        left = isnan(u) ? 0 : fmin(left, u), right = isnan(u) ? camera->width : fmax(right, u);
        top = isnan(v) ? 0 : fmin(top, v), below = isnan(v) ? camera->height : fmax(below, v);
    }
    for (int y = (int)fmax(0, top); y < camera->height && y < below; y++)
        for (int x = (int)fmax(0, left); x < camera->width && x < right; x++)
            if (!stays || !stays[(size_t)y * (size_t)camera->width + (size_t)x]) return true;
    return false;
}

enum status room_draw_uncovered(struct model_picture *picture, struct room *room, const struct view *camera,
                                const uint8_t *stays, struct provenance *prov, struct err *err)
{
    const struct placed_things *t = &room->things;
    const struct thing_pixels pixels = {.stays = stays};
    for (int i = 0; !err->status && room->clutter && i < t->list.count; i++) {
        const struct thing *thing = &t->list.things[i];
        if (t->fate[i + 1] == THING_IS_GONE || !box_matters(camera, thing->low, thing->high, stays)) continue;
        const struct thing_shape shape = placed_things_shape(t, (uint32_t)i + 1);
        clutter_draw_thing(picture, room->front, &pixels, room->clutter, camera, &shape, prov, err);
    }
    return err->status;
}

/* Draws what the views' own layers have not of the things that stay: legs, and sides that no view shows well. */
static enum status draw_surfaces(struct model_picture *picture, struct room *room, const struct view *camera,
                                 struct provenance *prov, struct err *err)
{
    const struct placed_things *t = &room->things;
    for (int i = 0; !err->status && room->clutter && i < t->list.count; i++) {
        const struct thing *thing = &t->list.things[i];
        if (t->fate[i + 1] == THING_IS_GONE || !box_matters(camera, thing->low, thing->high, NULL)) continue;
        const struct thing_shape shape = placed_things_shape(t, (uint32_t)i + 1);
        clutter_draw_surface(picture, room->front, room->clutter, camera, &shape, prov, err);
    }
    return err->status;
}

enum status room_draw(struct model_picture *picture, struct room *room, const struct view *camera,
                      const struct texture_pair *pair, int own, const uint8_t *gone, struct provenance *prov,
                      struct err *err)
{
    const char *photos[2];
    photos_of(photos, room, pair);
    const struct outdoors *outdoors = room->files.outdoors ? &room->outdoors : NULL;
    const struct texture_map unedited = {0}, *map = shell_map(room->shell);
    struct clutter_filter filter = clutter_filter_of(&room->things, map ? map : &unedited);
    filter.gone = gone;
    if (!shell_draw(picture, room->shell, camera, photos, pair->t, outdoors, err) && room->clutter &&
        !make_front(room, (size_t)camera->width * (size_t)camera->height, err))
        clutter_draw(picture, room->front, room->clutter, camera, &filter, own < 0 ? NULL : &own, own >= 0, prov, err);
    if (err->status || own >= 0 || draw_surfaces(picture, room, camera, prov, err)) return err->status;
    return room_draw_things(picture, room, camera, NULL, prov, err);
}
