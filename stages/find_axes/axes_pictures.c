/* axes_pictures.c - draws axes, floor and ceiling on photographs. */
#include "stages/find_axes/axes_pictures.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/sort.h"
#include "common/image/draw.h"

static const unsigned char X[3] = {235, 40, 40}, Y[3] = {40, 200, 60}, Z[3] = {60, 110, 255};
static const unsigned char FLOOR[3] = {255, 215, 0}, CEILING[3] = {0, 225, 235}, WALL[3] = {235, 235, 235};
static const double NEAR = 1e-3; /* near clipping plane, as a fraction of a line's length */
static const double ARROW = 0.2; /* length, as a fraction of the room's width */

struct sketch {
    unsigned char *pixels;
    const struct view *view;
    const struct model_axes *axes;
    double half; /* of a line's width, px */
};

/* --------------------------------------------------------------------------------------------------------- choosing */

/* Cosine of the angle between a view's axis and its photo's. */
static double axis_cosine(const struct lens *lens) { return mat3_from_quat(lens->view_from_photo).m[2][2]; }

static int view_of_photo(const struct room_inputs *in, const char *photo)
{
    int best = -1;
    double max_cosine = -2;
    for (int i = 0; i < in->lenses->count; i++) {
        const struct lens *lens = &in->lenses->lenses[i];
        const int at = camera_set_find(in->set, lens->view);
        if (strcmp(lens->photo, photo) || at < 0 || !(axis_cosine(lens) > max_cosine)) continue;
        best = at;
        max_cosine = axis_cosine(lens);
    }
    return best;
}

enum status pictures_choose(bool *chosen, int count, const struct room_inputs *in, struct err *err)
{
    int *photos = malloc(((size_t)in->lenses->count + 1) * sizeof *photos), known = 0; /* a lens each */
    if (!photos) return err_nomem(err, "photos", (size_t)in->lenses->count * sizeof *photos);
    for (int i = 0; i < in->lenses->count; i++) { /* the views of a photo are consecutive */
        const char *photo = in->lenses->lenses[i].photo;
        if (view_of_photo(in, photo) < 0 || (known && !strcmp(in->lenses->lenses[photos[known - 1]].photo, photo)))
            continue;
        photos[known++] = i;
    }
    if (count > known) count = known;
    for (int i = 0; i < count; i++)
        chosen[view_of_photo(in, in->lenses->lenses[photos[(int64_t)i * known / count]].photo)] = true;
    free(photos);
    for (int i = 0; in->fix && i < in->fix->count; i++) {
        const struct mark *m = &in->fix->marks[i];
        struct photo_camera camera;
        if (m->kind != MARK_CORNER) continue;
        if (photo_camera_find(&camera, m->view, in->set, in->lenses, in->fix->path, m->line, err)) return err->status;
        const int lens = lens_list_find(in->lenses, in->set->views[camera.view_idx].name);
        chosen[view_of_photo(in, in->lenses->lenses[lens].photo)] = true;
    }
    return ST_OK;
}

/* ---------------------------------------------------------------------------------------------------------- drawing */

/* Draws the line between two points of the model. */
static void line(struct sketch *k, struct vec3 a, struct vec3 b, const unsigned char color[3])
{
    const struct view *v = k->view;
    struct vec3 p = vec3_add(mat3_apply(v->cam_from_world, world_from_model_point(k->axes, a)), v->translation);
    struct vec3 q = vec3_add(mat3_apply(v->cam_from_world, world_from_model_point(k->axes, b)), v->translation);
    const double near = NEAR * vec3_length(vec3_sub(q, p));
    if (!(p.z > near) && !(q.z > near)) return;
    if (!(p.z > near)) p = vec3_add(q, vec3_scale(vec3_sub(p, q), (q.z - near) / (q.z - p.z)));
    if (!(q.z > near)) q = vec3_add(p, vec3_scale(vec3_sub(q, p), (p.z - near) / (p.z - q.z)));
    const double x0 = v->fx * p.x / p.z + v->cx, y0 = v->fy * p.y / p.z + v->cy;
    const double x1 = v->fx * q.x / q.z + v->cx, y1 = v->fy * q.y / q.z + v->cy;
    const struct canvas canvas = {k->pixels, v->width, v->height};
    if (p.z > 0 && q.z > 0) draw_line(&canvas, x0, y0, x1, y1, k->half, color);
}

static void outline(struct sketch *k, const struct room *room, double z, const unsigned char color[3])
{
    for (int i = 0; i < 4; i++) {
        static const int along[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
        struct vec3 ends[2];
        for (int e = 0; e < 2; e++)
            ends[e] = vec3_make(along[i + e][0] ? room->high[0] : room->low[0],
                                along[i + e][1] ? room->high[1] : room->low[1], z);
        line(k, ends[0], ends[1], color);
    }
}

static void arrows(struct sketch *k, struct vec3 at, double length)
{
    line(k, at, vec3_add(at, vec3_make(0, 0, length)), Z);
    line(k, at, vec3_add(at, vec3_make(0, length, 0)), Y);
    line(k, at, vec3_add(at, vec3_make(length, 0, 0)), X);
}

/* The point of the floor in the lower middle of the picture, moved into the outline. */
static struct vec3 floor_ahead(const struct view *view, const struct room *room)
{
    const struct vec3 ray = {0, (0.85 * view->height - view->cy) / view->fy, 1};
    const struct vec3 c = model_from_world_point(&room->axes, view->center);
    const struct vec3 d =
        model_from_world_direction(&room->axes, mat3_apply(mat3_transpose(view->cam_from_world), ray));
    const double t = d.z < 0 && c.z > 0 ? -c.z / d.z : 0;
    return vec3_make(fmin(fmax(c.x + t * d.x, room->low[0]), room->high[0]),
                     fmin(fmax(c.y + t * d.y, room->low[1]), room->high[1]), 0);
}

void pictures_draw_room(unsigned char *pixels, const struct view *view, const struct room *room,
                        const struct vec3 *corners, int corner_count)
{
    struct sketch k = {pixels, view, &room->axes, fmax(0.75, hypot(view->width, view->height) / 900)};
    const double length = ARROW * fmin(room->high[0] - room->low[0], room->high[1] - room->low[1]);
    if (room->axes.ceiling > 0) {
        for (int i = 0; i < 4; i++) {
            const double x = i % 2 ? room->high[0] : room->low[0], y = i / 2 ? room->high[1] : room->low[1];
            line(&k, vec3_make(x, y, 0), vec3_make(x, y, room->axes.ceiling), WALL);
        }
        outline(&k, room, room->axes.ceiling, CEILING);
    }
    outline(&k, room, 0, FLOOR);
    k.half *= 1.6;
    for (int i = 0; i < corner_count; i++) {
        struct vec3 at = model_from_world_point(&room->axes, corners[i]);
        at.z = 0;
        arrows(&k, at, length);
    }
    if (!corner_count) arrows(&k, floor_ahead(view, room), length);
}

enum status pictures_expose(unsigned char *pixels, const struct image *im, struct err *err)
{
    const size_t count = (size_t)im->width * (size_t)im->height, channels = (size_t)im->channels;
    struct image exposed = {0};
    float *bright = malloc(count * sizeof *bright);
    size_t known = 0;
    if (!bright) return err_nomem(err, "a picture", count * sizeof *bright);
    for (size_t i = 0; i < count; i++) {
        const float *p = im->data + i * channels;
        if (p[3] > 0) bright[known++] = fmaxf(p[0], fmaxf(p[1], p[2]));
    }
    sort_floats(bright, known);
    const float white = known ? bright[known - 1 - known / 20] : 0;
    free(bright);
    if (image_init(&exposed, im->width, im->height, 3, err)) return err->status;
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 3; c++)
            exposed.data[3 * i + c] = white > 0 ? im->data[i * channels + c] / white : im->data[i * channels + c];
    image_to_srgb8(&exposed, pixels);
    image_release(&exposed);
    return ST_OK;
}
