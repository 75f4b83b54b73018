/* room_camera.c - cameras that a user gives; see room_camera.h.
 *
 * The renderer draws pinhole pictures. The picture of another lens is resampled, bilinear, from six of them on a cube
 * around the camera, of those that its pixels look into; their pixels are a little finer than the lens's finest. */
#include "stages/render_model/room_camera.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/capture/photo_alignment.h"

enum { FACES = 6, MAX_SIDE = 4096 };
static const double overlap = 1.02; /* tangent of half the angle of a face, so that faces share a border */
static const double finer = 1.25;   /* pixels of a face to one of the lens */
static const double max_misfit = 2; /* %: of the photographs' extent, as where lighting reference images are placed */

void room_cameras_release(struct room_cameras *cameras)
{
    for (int i = 0; i < cameras->count; i++) free(cameras->list[i].name);
    free(cameras->list);
    *cameras = (struct room_cameras){0};
}

static struct pose pose_in_model(const struct pose *scene, const struct model_axes *axes)
{
    const struct mat3 turn =
        mat3_multiply(mat3_from_quat(scene->rotation), mat3_transpose(mat3_from_quat(axes->rotation)));
    const struct vec3 centre = model_from_world_point(axes, pose_center(scene));
    return (struct pose){quat_from_mat3(turn), vec3_scale(mat3_apply(turn, centre), -1)};
}

static enum status find_similarity(struct similarity *given_from_scene, const struct camera_source *source,
                                   const struct room *room, struct provenance *prov, struct err *err)
{
    static const struct alignment_rules rules = {
        max_misfit, "Otherwise it is unknown where the cameras are. Give a model of the scene's photographs.",
        "Give a model of the same photographs."};
    const struct scene_photos scene = {room->files.views, source->records, prov};
    struct sfm_model photos = {0};
    struct frame_agreement agreement;
    if (!sfm_model_read_cameras(&photos, source->photos, NULL, err) &&
        !provenance_add_in(prov, "photos", source->photos, "images.txt", "", NULL, err))
        photo_alignment_find(given_from_scene, &agreement, &photos, source->photos, &scene, &rules, err);
    sfm_model_release(&photos);
    return err->status;
}

static char *name_without_ending(const char *image)
{
    const char *slash = strrchr(image, '/'), *name = slash ? slash + 1 : image, *dot = strrchr(name, '.');
    return strndup(name, dot && dot > name ? (size_t)(dot - name) : strlen(name));
}

enum status room_cameras_read(struct room_cameras *cameras, const struct camera_source *source, const struct room *room,
                              struct provenance *prov, struct err *err)
{
    struct sfm_model given = {0};
    struct similarity given_from_scene = {0};
    if (!sfm_model_read_cameras(&given, source->folder, NULL, err) &&
        !provenance_add_in(prov, "cameras", source->folder, "cameras.txt", "", NULL, err))
        provenance_add_in(prov, "cameras", source->folder, "images.txt", "", NULL, err);
    if (!err->status && !given.image_count)
        err_set(err, ST_DATA, "%s/images.txt has no images: wanted one for each picture to render.", source->folder);
    if (!err->status && source->frame == FRAME_PHOTOS) find_similarity(&given_from_scene, source, room, prov, err);
    cameras->list = calloc((size_t)given.image_count + 1, sizeof *cameras->list);
    if (!err->status && !cameras->list) err_nomem(err, "cameras", (size_t)given.image_count * sizeof *cameras->list);
    for (int i = 0; !err->status && i < given.image_count; i++) {
        const struct sfm_image *image = &given.images[i];
        struct pose pose = image->cam_from_world;
        if (source->frame == FRAME_PHOTOS) pose = photo_alignment_pose(&pose, &given_from_scene);
        if (source->frame != FRAME_MODEL) pose = pose_in_model(&pose, &room->in.axes);
        char *name = name_without_ending(image->name);
        if (!name)
            err_nomem(err, "cameras", strlen(image->name));
        else
            cameras->list[cameras->count++] = (struct room_camera){name, given.cameras[image->camera_idx].camera, pose};
        for (int k = 0; !err->status && k + 1 < cameras->count; k++)
            if (!strcmp(cameras->list[k].name, name))
                err_set(err, ST_DATA, "%s/images.txt has two images named %s; pictures are named like them.",
                        source->folder, name);
    }
    sfm_model_release(&given);
    return err->status;
}

static struct view view_of(const struct pose *pose, const char *name, int width, int height)
{
    return (struct view){.name = name,
                         .width = width,
                         .height = height,
                         .cam_from_world = mat3_from_quat(pose->rotation),
                         .translation = pose->translation,
                         .center = pose_center(pose)};
}

bool room_camera_view(struct view *view, const struct room_camera *camera)
{
    *view = view_of(&camera->pose, camera->name, camera->lens.width, camera->lens.height);
    camera_focal(&camera->lens, &view->fx, &view->fy, &view->cx, &view->cy);
    return camera->lens.model == CAMERA_SIMPLE_PINHOLE || camera->lens.model == CAMERA_PINHOLE;
}

/* --------------------------------------------------------------------------------------------------- other lenses */

/* Axes x, y, z of each face in the camera's frame: ahead, right, left, down, up, behind. */
static const struct mat3 face_from_camera[FACES] = {
    {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},  {{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}}, {{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}},
    {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}}, {{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}}, {{{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}}},
};

static int face_of(struct vec3 ray)
{
    int best = 0;
    double most = -INFINITY;
    for (int f = 0; f < FACES; f++) {
        const double z = mat3_apply(face_from_camera[f], ray).z;
        if (z > most) most = z, best = f;
    }
    return best;
}

static struct view face_view(const struct room_camera *camera, int face)
{
    double fx, fy, cx, cy;
    camera_focal(&camera->lens, &fx, &fy, &cx, &cy);
    const int side = (int)fmin(MAX_SIDE, ceil(2 * finer * overlap * fmax(fx, fy)));
    const struct mat3 turn = mat3_multiply(face_from_camera[face], mat3_from_quat(camera->pose.rotation));
    struct view view = view_of(&camera->pose, camera->name, side, side);
    view.cam_from_world = turn;
    view.translation = vec3_scale(mat3_apply(turn, view.center), -1);
    view.fx = view.fy = side / (2 * overlap);
    view.cx = view.cy = side / 2.0;
    return view;
}

/* Sets the pixel of a picture from a face where its ray (camera's frame, length 1) meets it. */
static void take(struct model_picture *to, size_t at, const struct model_picture *face, const struct view *view,
                 struct vec3 ray, struct vec3 in_face)
{
    const double x = view->fx * in_face.x / in_face.z + view->cx - 0.5;
    const double y = view->fy * in_face.y / in_face.z + view->cy - 0.5;
    const int x0 = (int)fmin(fmax(floor(x), 0), face->width - 2), y0 = (int)fmin(fmax(floor(y), 0), face->height - 2);
    const double fx = fmin(fmax(x - x0, 0), 1), fy = fmin(fmax(y - y0, 0), 1);
    const size_t row = (size_t)face->width, corner = (size_t)y0 * row + (size_t)x0;
    const size_t near = corner + (fx >= 0.5) + (fy >= 0.5 ? row : 0);
    for (size_t c = 0; c < 3; c++) {
        const float *p = face->rgb + 3 * corner + c;
        const double above = p[0] + fx * (p[3] - p[0]), below = p[3 * row] + fx * (p[3 * row + 3] - p[3 * row]);
        to->rgb[3 * at + c] = (float)(above + fy * (below - above));
    }
    to->id[at] = face->id[near];
    to->made[at] = face->made[near];
    to->z[at] = (float)(face->z[near] * ray.z / in_face.z);
}

static enum status draw_from_cube(struct model_picture *picture, struct room *room, const struct room_camera *camera,
                                  const struct texture_pair *pair, struct provenance *prov, struct err *err)
{
    const int width = camera->lens.width, height = camera->lens.height;
    struct model_picture face = {0};
    model_picture_resize(picture, width, height, err);
    for (int f = 0; !err->status && f < FACES; f++) {
        const struct view view = face_view(camera, f);
        bool drawn = false;
        for (int i = 0; !err->status && i < width * height; i++) {
            struct vec3 ray;
            if (!camera_unproject(&camera->lens, i % width + 0.5, i / width + 0.5, &ray) || face_of(ray) != f) continue;
            if (!drawn) room_draw(&face, room, &view, pair, -1, NULL, prov, err);
            drawn = true;
            if (!err->status) take(picture, (size_t)i, &face, &view, ray, mat3_apply(face_from_camera[f], ray));
        }
    }
    model_picture_release(&face);
    return err->status;
}

enum status room_camera_draw(struct model_picture *picture, struct room *room, const struct room_camera *camera,
                             const struct texture_pair *pair, struct provenance *prov, struct err *err)
{
    struct view view;
    if (!room_camera_view(&view, camera)) return draw_from_cube(picture, room, camera, pair, prov, err);
    return room_draw(picture, room, &view, pair, -1, NULL, prov, err);
}
