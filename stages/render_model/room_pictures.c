/* room_pictures.c - draws and writes pictures of views, of given cameras, and of the frames of a film. Formats:
 * docs/formats.md, O/remodel/E/pictures.
 *
 * Overview. room_draw() draws the model from any camera; this file decides with which textures, and replaces what the
 * edit did not change.
 *
 * Original views. Where the edited model is what the photograph shows, the photograph is better than any texture of
 * it. own_pixels_find() marks these pixels; they are copied, and the model is drawn only if some pixel is left. A
 * view that the edit does not touch costs no rendering and gets only a record (and its radiance, if [render_model]
 * radiance = all).
 *
 * Textures. A view uses the atlas of its own photo. A given camera uses one or two viewpoints that see what it sees
 * (choose_pair()). A frame of a tour uses the pair in pairs.txt, which plan_tour chose so that textures change
 * slowly.
 *
 * Exposure. All pictures and films of a scene have one exposure (choose_exposure), unless [render_model] exposure is
 * given: what an edit, or a step along a room, does not change keeps its brightness.
 *
 * The record VIEW.txt is written last, so it stands for a complete set of files. It holds the share of the pixels by
 * origin (enum picture_made), which -sources.png shows in colours.
 *
 * Memory: one picture, and the atlases that the room keeps. */
#include "stages/render_model/room_pictures.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/file_path.h"
#include "common/base/progress.h"
#include "common/capture/view_image.h"
#include "common/image/exr.h"
#include "common/image/photo.h"
#include "common/product/product.h"
#include "common/texture/exposure.h"
#include "common/texture/picture_list.h"
#include "common/texture/picture_record.h"
#include "stages/render_model/choose_pair.h"
#include "stages/render_model/own_pixels.h"

/* What each pixel comes from, in colours. */
static enum status write_sources(const struct model_picture *p, const char *path, struct err *err)
{
    const size_t pixels = (size_t)p->width * (size_t)p->height;
    unsigned char *rgb = malloc(3 * pixels + 1);
    if (!rgb) return err_nomem(err, "a picture of sources", 3 * pixels);
    for (size_t i = 0; i < pixels; i++) memcpy(rgb + 3 * i, picture_made_kind(p->made[i])->rgb, 3);
    png_write(path, rgb, p->width, p->height, 3, err);
    free(rgb);
    return err->status;
}

/* What the pixels come from, in percent. */
static struct picture_record record_of(const struct model_picture *p, double exposure, double changed)
{
    struct picture_record record = {p->width, p->height, exposure, changed, {0}};
    const size_t pixels = (size_t)p->width * (size_t)p->height;
    size_t counts[MADE_COUNT] = {0};
    for (size_t i = 0; i < pixels; i++) counts[p->made[i]]++;
    for (int k = 0; k < MADE_COUNT; k++) record.shares[k] = 100.0 * (double)counts[k] / (double)pixels;
    return record;
}

/* camera: for the EXR's attributes. The record is written last. */
static enum status write_picture(const struct model_picture *p, const struct room *room, const struct view *camera,
                                 double changed, bool radiance, const char *out, const char *name,
                                 const struct provenance *prov, struct err *err)
{
    const struct product_key key = {.name = name};
    char path[FILE_PATH];
    if (radiance && !product_path_in(path, out, PRODUCT_PICTURE, &key, err))
        model_picture_write(p, camera, path, prov, err);
    if (!err->status && changed > 0 && !product_path_in(path, out, PRODUCT_PICTURE_JPEG, &key, err) &&
        !exposure_write(p, room->exposure, path, err) &&
        !product_path_in(path, out, PRODUCT_PICTURE_SOURCES, &key, err))
        write_sources(p, path, err);
    if (!err->status) product_path_in(path, out, PRODUCT_PICTURE_RECORD, &key, err);
    const struct picture_record record = record_of(p, room->exposure, changed);
    if (!err->status) picture_record_write(&record, path, prov, err);
    return err->status;
}

/* --------------------------------------------------------------------------------------------------- original views */

/* Draws the things of which the photo itself shows nothing: where it changes, and shows no furniture. */
static enum status draw_uncovered(struct model_picture *picture, struct room *room, const struct view *camera,
                                  const uint8_t *same, struct provenance *prov, struct err *err)
{
    const size_t pixels = (size_t)camera->width * (size_t)camera->height;
    uint8_t *stays = malloc(pixels + 1);
    if (!stays) return err_nomem(err, "pixels of a view", pixels);
    for (size_t i = 0; i < pixels; i++) stays[i] = same[i] || picture->made[i] == MADE_CLUTTER;
    if (memchr(stays, 0, pixels)) room_draw_uncovered(picture, room, camera, stays, prov, err);
    free(stays);
    return err->status;
}

static enum status draw_view(struct model_picture *picture, double *changed, struct room *room, int view,
                             struct provenance *prov, struct err *err)
{
    const struct view *camera = &room->cameras[view];
    const struct texture_pair pair = {{room_viewpoint_of(room, view), -1}, 0};
    const size_t pixels = (size_t)camera->width * (size_t)camera->height;
    uint8_t *same = malloc(pixels), *gone = malloc(pixels);
    if (!same || !gone) err_nomem(err, "pixels of a view", 2 * pixels);
    const bool own = !strcmp(room->params->photo, "where_unchanged");
    size_t differ = 0;
    if (!err->status) own_pixels_find(same, gone, room, view, prov, err);
    if (!err->status && (memchr(same, 0, pixels) || !own || room->things.placed_count))
        room_draw(picture, room, camera, &pair, view, gone, prov, err);
    else if (!err->status)
        model_picture_resize(picture, camera->width, camera->height, err);
    if (!err->status && own) own_pixels_draw(picture, same, room, view, prov, err);
    if (!err->status && own && room->things.list.count && room->files.base)
        draw_uncovered(picture, room, camera, same, prov, err);
    if (!err->status) room_draw_things(picture, room, camera, same, prov, err);
    for (size_t i = 0; !err->status && i < pixels; i++) differ += !same[i] && picture->made[i] != MADE_NOTHING;
    *changed = own ? 100.0 * (double)differ / (double)pixels : 100;
    free(same);
    free(gone);
    return err->status;
}

/* camera: in the model's frame. */
static void set_camera_of_view(struct model_picture *p, const struct view *camera)
{
    const struct camera lens = {
        CAMERA_PINHOLE, camera->width, camera->height, {camera->fx, camera->fy, camera->cx, camera->cy}};
    const struct pose pose = {quat_from_mat3(camera->cam_from_world), camera->translation};
    model_picture_set_camera(p, &lens, &pose);
}

static enum status find_views(bool *wanted, const struct room *room, const struct cli_list *names, struct err *err)
{
    for (int i = 0; i < names->count; i++) {
        const int at = camera_set_find(&room->in.set, names->items[i]);
        if (at < 0)
            return err_set(err, ST_USAGE, "there is no view %s in %s. Its images.txt lists the views.", names->items[i],
                           room->files.views);
        wanted[at] = true;
    }
    return ST_OK;
}

enum status pictures_of_views(struct room *room, const struct cli_list *views, const char *out, struct provenance *prov,
                              struct err *err)
{
    struct model_picture picture = {0};
    struct progress progress;
    const bool radiance = strcmp(room->params->radiance, "no") != 0, all = !strcmp(room->params->radiance, "all");
    bool *wanted = calloc((size_t)room->in.set.view_count + 1, sizeof *wanted);
    if (wanted)
        find_views(wanted, room, views, err);
    else
        err_nomem(err, "views", (size_t)room->in.set.view_count * sizeof *wanted);
    progress_start(&progress, "rendering", views->count, "views");
    for (int i = 0; !err->status && i < room->in.set.view_count; i++) {
        if (!wanted[i]) continue;
        const int inputs = prov->count;
        double changed = 0;
        if (!draw_view(&picture, &changed, room, i, prov, err)) set_camera_of_view(&picture, &room->cameras[i]);
        if (!err->status)
            write_picture(&picture, room, &room->in.set.views[i], changed, radiance && (all || changed > 0), out,
                          room->in.set.views[i].name, prov, err);
        provenance_keep(prov, inputs);
        progress_add(&progress, 1);
    }
    progress_end(&progress);
    model_picture_release(&picture);
    free(wanted);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------- given cameras */

static const struct room_camera *find_camera(const struct room_cameras *cameras, const char *name)
{
    for (int i = 0; i < cameras->count; i++)
        if (!strcmp(cameras->list[i].name, name)) return &cameras->list[i];
    return NULL;
}

static enum status check_names(const struct room_cameras *cameras, const struct camera_source *source,
                               const struct cli_list *names, struct err *err)
{
    for (int i = 0; i < names->count; i++)
        if (!find_camera(cameras, names->items[i]))
            return err_set(err, ST_USAGE, "there is no camera %s in %s/images.txt.", names->items[i], source->folder);
    return ST_OK;
}

static bool is_wanted(const struct cli_list *names, const char *name)
{
    for (int i = 0; i < names->count; i++)
        if (!strcmp(names->items[i], name)) return true;
    return names->count == 0;
}

/* Lists the pictures, when all are there. */
static enum status write_list(const struct room_cameras *cameras, const struct cli_list *names, const char *out,
                              const struct provenance *prov, struct err *err)
{
    struct picture_list list = {0};
    for (int i = 0; !err->status && i < cameras->count; i++)
        if (is_wanted(names, cameras->list[i].name)) picture_list_add(&list, cameras->list[i].name, err);
    if (!err->status) picture_list_write(&list, out, prov, err);
    picture_list_release(&list);
    return err->status;
}

enum status pictures_of_cameras(struct room *room, const struct camera_source *source, const struct cli_list *names,
                                const char *out, struct provenance *prov, struct err *err)
{
    struct room_cameras cameras = {0};
    struct model_picture picture = {0};
    struct progress progress;
    if (!room_cameras_read(&cameras, source, room, prov, err)) check_names(&cameras, source, names, err);
    progress_start(&progress, "rendering", names->count ? names->count : cameras.count, "pictures");
    for (int i = 0; !err->status && i < cameras.count; i++) {
        const struct room_camera *camera = &cameras.list[i];
        if (!is_wanted(names, camera->name)) continue;
        const struct texture_pair pair = choose_pair(room, camera);
        const int inputs = prov->count;
        struct view view;
        room_camera_draw(&picture, room, camera, &pair, prov, err);
        room_camera_view(&view, camera);
        model_picture_set_camera(&picture, &camera->lens, &camera->pose);
        if (!err->status) write_picture(&picture, room, &view, 100, true, out, camera->name, prov, err);
        provenance_keep(prov, inputs);
        progress_add(&progress, 1);
    }
    progress_end(&progress);
    if (!err->status) write_list(&cameras, names, out, prov, err);
    model_picture_release(&picture);
    room_cameras_release(&cameras);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------- frames of a film */

static enum status frame_pair(struct texture_pair *pair, const struct room *room, const struct view *camera,
                              const struct viewpoint_pairs *pairs, struct err *err)
{
    const struct viewpoint_pair *given = pairs ? viewpoint_pairs_find(pairs, camera->name) : NULL;
    if (!given) {
        struct room_camera c = {.lens = {.model = CAMERA_PINHOLE, .width = camera->width, .height = camera->height},
                                .pose = {quat_from_mat3(camera->cam_from_world), camera->translation}};
        const double focal[4] = {camera->fx, camera->fy, camera->cx, camera->cy};
        memcpy(c.lens.params, focal, sizeof focal);
        *pair = choose_pair(room, &c);
        return ST_OK;
    }
    for (int k = 0; k < 2; k++) {
        pair->viewpoint[k] = room_find_viewpoint(room, given->photos[k]);
        if (pair->viewpoint[k] < 0)
            return err_set(err, ST_DATA, "pairs.txt names the photo %s for frame %s, which has no view in %s.",
                           given->photos[k], given->frame, room->files.views);
    }
    pair->t = given->t;
    return ST_OK;
}

/* A frame as a picture whose light may be changed: its radiance, and its exposure in the record. */
static enum status write_film_picture(const struct model_picture *p, double exposure, const struct view *camera,
                                      const char *out, const struct provenance *prov, struct err *err)
{
    const struct product_key key = {.name = camera->name};
    char path[FILE_PATH];
    const struct picture_record record = record_of(p, exposure, 100);
    return product_path_in(path, out, PRODUCT_PICTURE, &key, err) || model_picture_write(p, camera, path, prov, err) ||
                   product_path_in(path, out, PRODUCT_PICTURE_RECORD, &key, err) ||
                   picture_record_write(&record, path, prov, err)
               ? err->status
               : ST_OK;
}

enum status pictures_of_frames(struct room *room, const struct camera_path *path, const struct viewpoint_pairs *pairs,
                               const bool *wanted, const char *out, struct provenance *prov, struct err *err)
{
    struct model_picture picture = {0};
    struct progress progress;
    const bool all = !strcmp(room->params->radiance, "all");
    int count = 0;
    for (int i = 0; i < path->frame_count; i++) count += wanted[i];
    progress_start(&progress, "rendering", count, "frames");
    for (int i = 0; !err->status && i < path->frame_count; i++) {
        const struct view *scene = &path->frames[i].camera, camera = model_from_world_view(&room->in.axes, scene);
        const int inputs = prov->count;
        struct texture_pair pair;
        char file[FILE_PATH];
        if (!wanted[i]) continue;
        if (!frame_pair(&pair, room, &camera, pairs, err) &&
            !room_draw(&picture, room, &camera, &pair, -1, NULL, prov, err) &&
            !product_path_in(file, out, PRODUCT_FRAME, &(struct product_key){.frame = scene->name}, err))
            set_camera_of_view(&picture, &camera);
        if (!err->status && all)
            write_film_picture(&picture, room->exposure, scene, out, prov, err);
        else if (!err->status)
            exposure_write_frame(&picture, room->exposure, scene, file, prov, err);
        provenance_keep(prov, inputs);
        progress_add(&progress, 1);
    }
    progress_end(&progress);
    model_picture_release(&picture);
    return err->status;
}
