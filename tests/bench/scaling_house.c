/* scaling_house.c - a house of any size, to measure how the cost of a view grows with the number of views and faces.
 *
 *   scaling_house --out DIR --views N [--size PX] [--first I --count K]
 *
 * The house is a square grid of equal rooms, as many as N views need at twelve a room. Walls stand between the points
 * of the grid; those between rooms have a doorway; pillars stand on the points, so that neighbouring solids touch along
 * whole faces. A room has about twelve faces. The cameras of a room stand in a ring around its middle and look across
 * it. The frames of the model and of the scene are the same.
 *
 * Writes DIR/model/model.txt, axes.txt; DIR/views/cameras.txt, images.txt, points3D.txt (forty points a room, each
 * observed by the room's views that see it), lenses.txt (one view a photograph); and the pictures and layered depth of
 * views I to I + K - 1 only, DIR/views/VIEW.exr, DIR/depth/VIEW.exr, VIEW.txt, with one segment for each face. Radiance
 * is a pattern of stripes of each face's own. Prints "views N", "rooms N", "faces N". */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/outfile.h"
#include "common/capture/lens_list.h"
#include "common/capture/view_image.h"
#include "common/image/luminance.h"
#include "common/layers/layered_depth.h"
#include "common/light/model_rays.h"
#include "common/model/model_axes.h"
#include "stages/build_model/solid/unite.h"

#define ROOM_X 5.0 /* between grid points, m */
#define ROOM_Y 4.0
#define WALL   0.2
#define HEIGHT 2.6
#define DOOR   0.9
#define LINTEL 2.1
#define RING   1.0 /* radius of the ring of cameras */
#define EYE    1.5

enum { VIEWS = 12, POINTS = 40, NAME = 64, PATH = 4200 };

struct house {
    const char *out;
    int views, size, first, count;
    int columns, rows; /* of rooms */
    struct solid_list solids;
    const struct provenance *prov;
};

/* A box from low to high; its faces are called NAME/SIDE. */
static enum status add_box(struct house *h, const char *name, struct vec3 low, struct vec3 high, struct err *err)
{
    static const char *const sides[6] = {"west", "east", "south", "north", "bottom", "top"};
    const double from[3] = {low.x, low.y, low.z}, to[3] = {high.x, high.y, high.z};
    struct half_space spaces[6];
    char names[6][NAME + 8];
    for (int i = 0; i < 6; i++) {
        const double sign = i % 2 ? 1 : -1;
        snprintf(names[i], sizeof names[i], "%s/%s", name, sides[i]);
        spaces[i].normal = vec3_make(i / 2 == 0 ? sign : 0, i / 2 == 1 ? sign : 0, i / 2 == 2 ? sign : 0);
        spaces[i].offset = i % 2 ? to[i / 2] : -from[i / 2];
        spaces[i].name = names[i];
    }
    return solid_list_add(&h->solids, "walls", spaces, 6, err);
}

/* A wall of thickness WALL from (x0, y0) to (x1, y1), with a doorway in its middle. along: 0: in x, 1: in y. */
static enum status add_wall(struct house *h, const char *name, int along, double x0, double y0, double x1, double y1,
                            bool doorway, struct err *err)
{
    const double from = along ? y0 : x0, to = along ? y1 : x1, middle = (from + to) / 2;
    const double cut[4] = {from, middle - DOOR / 2, middle + DOOR / 2, to};
    if (!doorway) return add_box(h, name, vec3_make(x0, y0, 0), vec3_make(x1, y1, HEIGHT), err);
    for (int k = 0; k < 3; k++) {
        const double foot = k == 1 ? LINTEL : 0;
        const struct vec3 low = along ? vec3_make(x0, cut[k], foot) : vec3_make(cut[k], y0, foot);
        const struct vec3 high = along ? vec3_make(x1, cut[k + 1], HEIGHT) : vec3_make(cut[k + 1], y1, HEIGHT);
        if (add_box(h, name, low, high, err)) return err->status;
    }
    return ST_OK;
}

/* The pillar at grid point (i, j), the walls that begin there, and the floor and ceiling of the room there. */
static enum status add_cell(struct house *h, int i, int j, struct err *err)
{
    const double x = i * ROOM_X, y = j * ROOM_Y, x1 = x + ROOM_X, y1 = y + ROOM_Y;
    char name[NAME];
    snprintf(name, sizeof name, "pillar/%d-%d", i, j);
    add_box(h, name, vec3_make(x, y, 0), vec3_make(x + WALL, y + WALL, HEIGHT), err);
    snprintf(name, sizeof name, "wall/x%d-%d", i, j);
    if (!err->status && i < h->columns) add_wall(h, name, 0, x + WALL, y, x1, y + WALL, j > 0 && j < h->rows, err);
    snprintf(name, sizeof name, "wall/y%d-%d", i, j);
    if (!err->status && j < h->rows) add_wall(h, name, 1, x, y + WALL, x + WALL, y1, i > 0 && i < h->columns, err);
    if (err->status || i == h->columns || j == h->rows) return err->status;
    snprintf(name, sizeof name, "floor/r%d-%d", i, j);
    add_box(h, name, vec3_make(x, y, -WALL), vec3_make(x1, y1, 0), err);
    snprintf(name, sizeof name, "ceiling/r%d-%d", i, j);
    if (!err->status) add_box(h, name, vec3_make(x, y, HEIGHT), vec3_make(x1, y1, HEIGHT + WALL), err);
    return err->status;
}

static enum status make_model(struct solid_mesh *mesh, struct house *h, struct err *err)
{
    for (int j = 0; !err->status && j <= h->rows; j++)
        for (int i = 0; !err->status && i <= h->columns; i++) add_cell(h, i, j, err);
    if (!err->status) unite_solids(mesh, &h->solids, NULL, err);
    return err->status;
}

/* Camera k of the house: in room k / VIEWS, on the ring, looking across the room. */
static struct view camera_of(const struct house *h, int k)
{
    const int room = k / VIEWS;
    const double angle = 2 * M_PI * (k % VIEWS + 0.3) / VIEWS, c = cos(angle), s = sin(angle);
    const double x = (room % h->columns + 0.5) * ROOM_X + WALL / 2, y = (room / h->columns + 0.5) * ROOM_Y + WALL / 2;
    struct view v = {.width = h->size, .height = h->size, .fx = 0.5 * h->size, .fy = 0.5 * h->size};
    v.cx = v.cy = 0.5 * h->size;
    v.center = vec3_make(x - RING * c, y - RING * s, EYE);
    v.cam_from_world = (struct mat3){{{s, -c, 0}, {0, 0, -1}, {c, s, 0}}};
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, v.center), -1);
    return v;
}

/* Point k of a room: on its walls, from the south-west corner around. */
static struct vec3 point_of(const struct house *h, int room, int k)
{
    const double x0 = room % h->columns * ROOM_X + WALL, y0 = room / h->columns * ROOM_Y + WALL;
    const double wide = ROOM_X - WALL, deep = ROOM_Y - WALL, at = (k / 4 + 0.5) / (POINTS / 4.0);
    const double z = 0.3 + 2.0 * (k % 7) / 6.0;
    switch (k % 4) {
    case 0:
        return vec3_make(x0 + at * wide, y0, z);
    case 1:
        return vec3_make(x0 + wide, y0 + at * deep, z);
    case 2:
        return vec3_make(x0 + at * wide, y0 + deep, z);
    default:
        return vec3_make(x0, y0 + at * deep, z);
    }
}

static bool sees(double *u, double *v, const struct view *view, struct vec3 p)
{
    const double z = view_project(view, p, u, v);
    return z > 0.05 && *u > 0 && *v > 0 && *u < view->width && *v < view->height;
}

static void write_images(const struct house *h, FILE *to)
{
    for (int k = 0; k < h->views; k++) {
        const struct view view = camera_of(h, k);
        const struct quat q = quat_from_mat3(view.cam_from_world);
        double u, v;
        fprintf(to, "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g 1 v%06d.exr\n", k + 1, q.w, q.x, q.y, q.z,
                view.translation.x, view.translation.y, view.translation.z, k);
        for (int p = 0; p < POINTS; p++)
            if (sees(&u, &v, &view, point_of(h, k / VIEWS, p)))
                fprintf(to, "%.6f %.6f %d ", u, v, k / VIEWS * POINTS + p + 1);
        fputc('\n', to);
    }
}

/* A track names an observation by its place in the view's line. */
static void write_points(const struct house *h, FILE *to)
{
    for (int room = 0; room * VIEWS < h->views; room++) {
        int seen[VIEWS] = {0};
        for (int p = 0; p < POINTS; p++) {
            const struct vec3 at = point_of(h, room, p);
            double u, v;
            fprintf(to, "%d %.17g %.17g %.17g 128 128 128 0.5", room * POINTS + p + 1, at.x, at.y, at.z);
            for (int k = 0; k < VIEWS && room * VIEWS + k < h->views; k++) {
                const struct view view = camera_of(h, room * VIEWS + k);
                if (sees(&u, &v, &view, at)) fprintf(to, " %d %d", room * VIEWS + k + 1, seen[k]++);
            }
            fputc('\n', to);
        }
    }
}

static void write_camera(const struct house *h, FILE *to)
{
    fprintf(to, "1 PINHOLE %d %d %.17g %.17g %.17g %.17g\n", h->size, h->size, 0.5 * h->size, 0.5 * h->size,
            0.5 * h->size, 0.5 * h->size);
}

static enum status write_text(const struct house *h, const char *name, void (*write)(const struct house *, FILE *),
                              struct err *err)
{
    struct outfile file;
    char path[PATH];
    snprintf(path, sizeof path, "%s/views/%s.txt", h->out, name);
    if (outfile_open(&file, path, err)) return err->status;
    write(h, file.fp);
    return outfile_commit(&file, err);
}

static enum status write_lenses(const struct house *h, const char *path, struct err *err)
{
    struct lens_list list = {calloc((size_t)h->views, sizeof(struct lens)), h->views};
    char(*names)[16] = calloc((size_t)h->views, sizeof *names);
    if (!list.lenses || !names) err_nomem(err, "lenses", (size_t)h->views * sizeof(struct lens));
    for (int k = 0; !err->status && k < h->views; k++) {
        snprintf(names[k], sizeof names[k], "v%06d", k);
        list.lenses[k] = (struct lens){names[k], names[k], {.model = CAMERA_PINHOLE}, {1, 0, 0, 0}};
        list.lenses[k].camera.width = list.lenses[k].camera.height = h->size;
        for (int i = 0; i < 4; i++) list.lenses[k].camera.params[i] = 0.5 * h->size;
    }
    if (!err->status) lens_list_write(&list, path, h->prov, err);
    free(list.lenses);
    free(names);
    return err->status;
}

/* Radiance of a point on a face: stripes along a direction of the face's own. */
static void stripes(float rgb[3], struct vec3 p, int face)
{
    const double turn = 2.4 * face, wave = 9 + face % 5;
    const double t = cos(turn) * p.x + sin(turn) * p.y + 0.7 * p.z;
    for (int c = 0; c < 3; c++) {
        const double base = 0.25 + 0.2 * ((face >> c) % 4);
        rgb[c] = (float)(base * (1 + 0.3 * sin(wave * t + c)));
    }
}

/* The picture and the depth of a view; faces: 1 + index of the face at each pixel. The segment of a face has its index
 * + 1 as id. */
static enum status fill_view(struct image *im, struct layered_depth *d, const struct view *view,
                             const struct model_rays *model, const uint32_t *faces, struct err *err)
{
    const size_t width = (size_t)view->width, pixels = width * (size_t)view->height;
    const int all = model->mesh.face_count;
    int *segment = calloc((size_t)all + 1, sizeof *segment);
    d->segments = calloc((size_t)all, sizeof *d->segments);
    if (!segment || !d->segments) {
        free(segment);
        return err_nomem(err, "segments", (size_t)all * sizeof *d->segments);
    }
    for (size_t i = 0; i < pixels; i++) segment[faces[i]]++;
    for (int f = 1; f <= all; f++) {
        if (!segment[f]) continue;
        struct depth_segment *s = &d->segments[d->segment_count];
        *s = (struct depth_segment){
            .id = (uint32_t)d->segment_count + 1, .pixels = segment[f], .sigma = 0.002, .confidence = 1};
        model_face_inverse_depth(s->plane, &model->mesh.faces[f - 1], view);
        segment[f] = d->segment_count++;
    }
    for (size_t i = 0; i < pixels; i++) {
        if (!faces[i]) continue;
        const struct depth_segment *s = &d->segments[segment[faces[i]]];
        const double u = (double)(i % width) + 0.5, v = (double)(i / width) + 0.5;
        const double z = 1 / (s->plane[0] * u + s->plane[1] * v + s->plane[2]);
        stripes(im->data + 4 * i, view_unproject(view, u, v, z), (int)faces[i]);
        im->data[4 * i + 3] = 1;
        memcpy(d->interior.rgba + 4 * i, im->data + 4 * i, 4 * sizeof(float));
        d->interior.z[i] = (float)z;
        d->interior.id[i] = s->id;
    }
    free(segment);
    return ST_OK;
}

#define NOISE 0.01f /* of the radiance */

static enum status write_view(const struct house *h, const struct model_rays *model, int k, struct err *err)
{
    struct view view = camera_of(h, k);
    struct layered_depth d = {0};
    struct image im = {0};
    struct photo_quality quality = {0};
    char name[16], path[PATH];
    uint32_t *faces = calloc((size_t)h->size * (size_t)h->size, sizeof *faces);
    if (!faces) err_nomem(err, "a view", (size_t)h->size * (size_t)h->size * 4);
    snprintf(name, sizeof name, "v%06d", k);
    view.name = name;
    if (!err->status) model_rays_view(faces, model, &view);
    if (!err->status && !image_init(&im, h->size, h->size, 4, err) && !layered_depth_init(&d, h->size, h->size, err))
        fill_view(&im, &d, &view, model, faces, err);
    snprintf(path, sizeof path, "%s/views/%s.exr", h->out, name);
    if (!err->status) photo_quality_init(&quality, h->size, h->size, err);
    for (int i = 0; !err->status && i < h->size * h->size; i++) {
        const float sigma = NOISE * luminance_of(im.data + 4 * i);
        quality.variance[i] = sigma * sigma;
    }
    if (!err->status) view_image_write(&im, &quality, path, &view, h->prov, "relative", err);
    photo_quality_release(&quality);
    snprintf(path, sizeof path, "%s/depth/%s.exr", h->out, name);
    if (!err->status) layered_depth_write(&d, &view, path, h->prov, err);
    layered_depth_release(&d);
    image_release(&im);
    free(faces);
    return err->status;
}

/* A grid whose sides differ by at most one. */
static enum status plan_grid(struct house *h, struct err *err)
{
    const int rooms = (h->views + VIEWS - 1) / VIEWS;
    if (h->views < 1 || h->views > 100000 || h->size < 8 || h->size > 8192 || h->first < 0 || h->count < 0 ||
        h->first + h->count > h->views)
        return err_set(
            err, ST_USAGE,
            "--views %d --size %d --first %d --count %d: wanted 1 to 100000 views, sides of 8 to 8192 px, and "
            "pictures of views that there are.",
            h->views, h->size, h->first, h->count);
    h->columns = (int)ceil(sqrt(rooms));
    h->rows = (rooms + h->columns - 1) / h->columns;
    return ST_OK;
}

static enum status make(struct house *h, struct err *err)
{
    struct model_axes axes = {.rotation = {1, 0, 0, 0}, .scale = 1, .metric = true, .ceiling = HEIGHT};
    struct model_rays model = {0};
    char path[PATH];
    if (!plan_grid(h, err)) make_model(&model.mesh, h, err);
    snprintf(path, sizeof path, "%s/model/model.txt", h->out);
    if (!err->status) solid_mesh_write(&model.mesh, path, h->prov, err);
    snprintf(path, sizeof path, "%s/model/axes.txt", h->out);
    if (!err->status && !model_axes_write(&axes, path, h->prov, err) && !write_text(h, "cameras", write_camera, err) &&
        !write_text(h, "images", write_images, err))
        write_text(h, "points3D", write_points, err);
    snprintf(path, sizeof path, "%s/views/lenses.txt", h->out);
    if (!err->status) write_lenses(h, path, err);
    if (!err->status && h->count) model_rays_build(&model, MODEL_WITH_GLASS, err);
    for (int k = h->first; !err->status && k < h->first + h->count; k++) write_view(h, &model, k, err);
    if (!err->status) printf("views %d\nrooms %d\nfaces %d\n", h->views, h->columns * h->rows, model.mesh.face_count);
    model_rays_release(&model);
    solid_list_release(&h->solids);
    return err->status;
}

int main(int argc, char **argv)
{
    struct house h = {.views = 100, .size = 256};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Makes a house of any number of rooms and views."),
        CLI_STR("out", &h.out, CLI_REQUIRED, "folder to write"),
        CLI_INT("views", &h.views, CLI_OPTIONAL, "number of views, twelve a room"),
        CLI_INT("size", &h.size, CLI_OPTIONAL, "side of a view, px"),
        CLI_INT("first", &h.first, CLI_OPTIONAL, "first view that gets a picture and depth"),
        CLI_INT("count", &h.count, CLI_OPTIONAL, "number of views that get them"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    h.prov = &prov;
    if (cli_parse(argc, argv, "scaling_house", opts, &prov, &err) == CLI_RUN) make(&h, &err);
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
