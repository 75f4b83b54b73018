/* outdoors_picture.c - which pixels of a picture show the outdoors.
 *
 * A ray through a pixel leaves the model if it meets nothing but panes of glass; the model is traced without them. Such
 * a pixel shows the outdoors unless
 *   - it is within `edge` px of one that does not: the model's frames and the cameras are not that exact;
 *   - something stands before the pane, by the view's clutter;
 *   - the photograph has no pixel there, or, in a reference image, it is black but for noise: beyond the circle of a
 *     fisheye.
 * Where a colour saturates or drowns in noise the pixel counts as clipped: it is used where no other picture helps.
 *
 * How squarely a ray passes an opening is |direction . normal| of the pane. An opening without a pane lies in a wall
 * along the model's axes, so the largest component of the direction stands for it. A reference image is taken in the
 * opening or outside; there the angle to the lens's axis counts, because fisheyes are sharpest at their centre. */
#include "common/gather/outdoors_picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/textfile.h"
#include "common/capture/photo_quality.h"
#include "common/image/exr.h"
#include "common/image/luminance.h"
#include "common/light/model_clearance.h"
#include "common/math/distance.h"
#include "common/texture/view_ids.h"

#define MAX_SIGMA 0.5f /* relative noise of a pixel from which it counts as dark */

/* ---------------------------------------------------------------------------------------------------- lens and pose */

static void set_pose(struct outdoors_picture *p, const struct view *view)
{
    p->cam_from_model = view->cam_from_world;
    p->center = view->center;
}

enum status outdoors_picture_of_view(struct outdoors_picture *p, const struct view *view, const char *path,
                                     const char *ids, struct err *err)
{
    *p = (struct outdoors_picture){.name = strdup(view->name), .path = strdup(path), .ids = strdup(ids)};
    p->lens = (struct camera){CAMERA_PINHOLE, view->width, view->height, {view->fx, view->fy, view->cx, view->cy}};
    set_pose(p, view);
    return p->name && p->path && p->ids ? ST_OK : err_nomem(err, "names", strlen(path));
}

/* The name of a file without folder and ending. */
static char *name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
    return strndup(name, dot && dot > name ? (size_t)(dot - name) : strlen(name));
}

/* remodel:lens is a line MODEL WIDTH HEIGHT PARAMS... */
static enum status read_lens(struct camera *lens, const struct exr_image *im, const char *path, struct err *err)
{
    struct textfile line = {.path = (char *)path, .line = 1};
    char *text = strdup(exr_attribute(im, "remodel:lens")), *model;
    if (!text) return err_nomem(err, "a lens", 256);
    line.cursor = text;
    if (!textfile_word(&line, "camera model", &model, err)) lens_read_camera(lens, model, &line, err);
    if (!err->status && (lens->width != im->width || lens->height != im->height))
        err_set(err, ST_DATA, "%s is %d x %d px, but remodel:lens says %d x %d; run `make lri` again.", path, im->width,
                im->height, lens->width, lens->height);
    free(text);
    return err->status;
}

/* The inverse of view_image_set_camera(). */
static struct view view_of_exr(const struct exr_image *im)
{
    static const double flip[3] = {1, -1, 1};
    struct view v = {0};
    double t[3];
    for (int column = 0; column < 3; column++) {
        for (int row = 0; row < 3; row++)
            v.cam_from_world.m[column][row] = flip[column] * (double)im->world_to_camera[4 * row + column];
        t[column] = flip[column] * (double)im->world_to_camera[12 + column];
    }
    v.translation = vec3_make(t[0], t[1], t[2]);
    v.center = vec3_scale(mat3_apply(mat3_transpose(v.cam_from_world), v.translation), -1);
    return v;
}

enum status outdoors_picture_of_reference(struct outdoors_picture *p, const char *path, const struct model_axes *axes,
                                          bool *placed, struct err *err)
{
    static const char *const none[] = {NULL};
    struct exr_image im = {0};
    *placed = false;
    *p = (struct outdoors_picture){.name = name_of(path), .path = strdup(path), .reference = true};
    if (!p->name || !p->path) return err_nomem(err, "names", strlen(path));
    exr_read(&im, path, none, 0, err); /* no channel, but all attributes */
    *placed = !err->status && im.has_world_to_camera && exr_attribute(&im, "remodel:lens");
    if (*placed) read_lens(&p->lens, &im, path, err);
    if (!err->status && *placed) {
        const struct view world = view_of_exr(&im), view = model_from_world_view(axes, &world);
        set_pose(p, &view);
    }
    exr_image_release(&im);
    return err->status;
}

/* ------------------------------------------------------------------------------------------- what the picture shows */

struct rays {
    const struct outdoors_picture *picture;
    struct mat3 model_from_cam;
};

static bool ray_of(const void *ctx, int x, int y, struct vec3 *direction)
{
    const struct rays *r = ctx;
    struct vec3 ray;
    if (!camera_unproject(&r->picture->lens, x + 0.5, y + 0.5, &ray)) return false;
    *direction = mat3_apply(r->model_from_cam, ray);
    return true;
}

/* Marks the pixels whose rays leave the model. Returns their number. */
static size_t trace(uint8_t *leaves, uint32_t *faces, const struct outdoors_picture *p, const struct model_rays *m)
{
    const struct rays rays = {p, mat3_transpose(p->cam_from_model)};
    const int width = p->lens.width, height = p->lens.height;
    size_t count = 0;
    model_rays_picture(faces, m, p->center, width, height, ray_of, &rays);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const size_t at = (size_t)y * (size_t)width + (size_t)x;
            struct vec3 direction;
            leaves[at] = !faces[at] && ray_of(&rays, x, y, &direction);
            count += leaves[at];
        }
    return count;
}

/* What one pixel is good for; of the channels' values, in the order of the files below. */
static uint8_t judge(bool reference, const float rgb[3], unsigned marks, float fourth, float fifth)
{
    if (!reference && !(fourth > 0.999f)) return SHOWS_NOTHING;
    const float sigma = reference ? photo_relative_sigma(fourth, luminance_of(rgb)) : fifth;
    const bool dark = marks & PHOTO_DARK || sigma > MAX_SIGMA;
    if (reference && dark) return SHOWS_NOTHING;
    return dark || marks ? SHOWS_CLIPPED : SHOWS_OUTDOORS;
}

/* Reads the colours, and judges the pixels whose rays leave the model. */
static enum status read_pixels(struct outdoors_picture *p, struct provenance *prov, struct err *err)
{
    static const char *const of_view[] = {"R", "G", "B", "clipped", "A", "sigma"};
    static const char *const of_reference[] = {"R", "G", "B", "clipped", "variance"};
    const int count = p->reference ? 5 : 6;
    const char *const *names = p->reference ? of_reference : of_view;
    const size_t pixels = (size_t)p->lens.width * (size_t)p->lens.height;
    struct exr_image im = {0};
    const struct exr_plane *plane[6] = {0};
    exr_read_product(&im, p->reference ? PRODUCT_LRI : PRODUCT_VIEW, p->path, names, count, prov, err);
    if (!err->status && (im.width != p->lens.width || im.height != p->lens.height))
        err_set(err, ST_DATA, "%s has %d x %d pixels, but its camera %d x %d; make the views again.", p->path, im.width,
                im.height, p->lens.width, p->lens.height);
    for (int k = 0; !err->status && k < count; k++) {
        plane[k] = exr_find(&im, names[k]);
        if (!plane[k]->f && k != 3)
            err_set(err, ST_DATA, "%s: channel %s contains integers, wanted half or float.", p->path, names[k]);
    }
    for (size_t i = 0; !err->status && i < pixels; i++) {
        const unsigned marks = plane[3]->u ? plane[3]->u[i] : (unsigned)plane[3]->f[i];
        for (size_t c = 0; c < 3; c++) p->rgb[3 * i + c] = fmaxf(plane[c]->f[i], 0);
        if (p->state[i])
            p->state[i] = judge(p->reference, p->rgb + 3 * i, marks, plane[4]->f[i], p->reference ? 0 : plane[5]->f[i]);
    }
    exr_image_release(&im);
    return err->status;
}

/* Leaves out clutter, and finds the panes that the rays pass. */
static enum status use_ids(struct outdoors_picture *p, const struct model_rays *m, const struct vec3 *normals,
                           double max_clutter, struct provenance *prov, struct err *err)
{
    const struct rays rays = {p, mat3_transpose(p->cam_from_model)};
    const struct view size = {.width = p->lens.width, .height = p->lens.height};
    struct view_ids ids = {0};
    view_ids_read(&ids, &size, p->ids, prov, err);
    for (size_t i = 0; !err->status && i < (size_t)size.width * (size_t)size.height; i++) {
        struct vec3 d = {0, 0, 0};
        if (!p->state[i]) continue;
        if (ids.clutter[i] >= (float)max_clutter && max_clutter < 1) {
            p->state[i] = SHOWS_NOTHING;
            continue;
        }
        ray_of(&rays, (int)(i % (size_t)size.width), (int)(i / (size_t)size.width), &d);
        const bool pane = ids.id[i] && ids.id[i] < (uint32_t)m->ids;
        p->facing[i] =
            (float)(pane ? fabs(vec3_dot(d, normals[ids.id[i]])) : fmax(fabs(d.x), fmax(fabs(d.y), fabs(d.z))));
    }
    view_ids_release(&ids);
    return err->status;
}

static void face_lens(struct outdoors_picture *p)
{
    for (int y = 0; y < p->lens.height; y++)
        for (int x = 0; x < p->lens.width; x++) {
            const size_t i = (size_t)y * (size_t)p->lens.width + (size_t)x;
            struct vec3 ray = {0, 0, 0};
            if (p->state[i]) camera_unproject(&p->lens, x + 0.5, y + 0.5, &ray);
            p->facing[i] = (float)fmax(ray.z, 0.01);
        }
}

/* Leaves out pixels within `edge` of one that shows something else; a clipped pixel is outdoors too. The circle of a
 * fisheye may touch the ends of its picture, so they count as dark. */
static enum status erode(struct outdoors_picture *p, double edge, struct err *err)
{
    const int width = p->lens.width, height = p->lens.height;
    const size_t pixels = (size_t)width * (size_t)height;
    float *squared = malloc(pixels * sizeof *squared);
    if (squared)
        distance_squared(squared, p->state, width, height, err);
    else
        err_nomem(err, "distances", pixels * sizeof *squared);
    for (int y = 0; !err->status && y < height; y++)
        for (int x = 0; x < width; x++) {
            const size_t i = (size_t)y * (size_t)width + (size_t)x;
            const double end = fmin(fmin(x + 1, width - x), fmin(y + 1, height - y));
            if ((double)squared[i] <= edge * edge || (p->reference && end <= edge)) p->state[i] = SHOWS_NOTHING;
        }
    free(squared);
    return err->status;
}

/* The cone around all rays that show the outdoors, and their solid angle. Returns the number of pixels. */
static size_t measure(struct outdoors_picture *p)
{
    const struct rays rays = {p, mat3_transpose(p->cam_from_model)};
    const int width = p->lens.width, height = p->lens.height;
    size_t count = 0;
    struct vec3 sum = {0, 0, 0}, d;
    double fx, fy, cx, cy;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            if (p->state[(size_t)y * (size_t)width + (size_t)x] && ray_of(&rays, x, y, &d)) {
                sum = vec3_add(sum, d);
                count++;
            }
    camera_focal(&p->lens, &fx, &fy, &cx, &cy);
    p->coverage = (double)count / (fx * fy);
    p->axis = vec3_normalize(sum);
    p->cone = 1;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            if (p->state[(size_t)y * (size_t)width + (size_t)x] && ray_of(&rays, x, y, &d))
                p->cone = fmin(p->cone, vec3_dot(p->axis, d));
    p->cone -= 1 / fmin(fx, fy); /* half a pixel and more */
    return count;
}

static enum status load(struct outdoors_picture *p, bool *shows, uint32_t *faces, const struct model_rays *model,
                        const struct vec3 *normals, const struct outdoors_limits *limits, struct provenance *prov,
                        struct err *err)
{
    if (!trace(p->state, faces, p, model)) return ST_OK;
    if (read_pixels(p, prov, err)) return err->status;
    if (p->ids && use_ids(p, model, normals, limits->max_clutter, prov, err)) return err->status;
    if (erode(p, limits->edge, err)) return err->status;
    if (!p->ids) face_lens(p);
    *shows = measure(p) > 0;
    return ST_OK;
}

enum status outdoors_picture_load(struct outdoors_picture *p, bool *shows, const struct model_rays *model,
                                  const struct vec3 *normals, const struct outdoors_limits *limits,
                                  struct provenance *prov, struct err *err)
{
    const size_t pixels = (size_t)p->lens.width * (size_t)p->lens.height;
    uint32_t *faces = NULL;
    *shows = false;
    if (model_rays_enclose(model, p->center)) {
        if (p->reference)
            log_warn("lighting reference image %s is inside a solid of the model, and is left out; check its pose.",
                     p->name);
        return ST_OK;
    }
    p->rgb = malloc(pixels * 3 * sizeof *p->rgb);
    p->facing = malloc(pixels * sizeof *p->facing);
    p->state = malloc(pixels);
    faces = malloc(pixels * sizeof *faces);
    if (p->rgb && p->facing && p->state && faces)
        load(p, shows, faces, model, normals, limits, prov, err);
    else
        err_nomem(err, "a picture", pixels * 21);
    free(faces);
    if (err->status || !*shows) outdoors_picture_unload(p);
    return err->status;
}

void outdoors_picture_unload(struct outdoors_picture *p)
{
    free(p->rgb);
    free(p->facing);
    free(p->state);
    p->rgb = p->facing = NULL;
    p->state = NULL;
}

void outdoors_picture_release(struct outdoors_picture *p)
{
    if (!p) return;
    outdoors_picture_unload(p);
    free(p->name);
    free(p->path);
    free(p->ids);
    *p = (struct outdoors_picture){0};
}

/* ---------------------------------------------------------------------------------------------------------- look-up */

enum outdoors_state outdoors_picture_sample(float rgb[3], float *facing, const struct outdoors_picture *p,
                                            struct vec3 direction)
{
    double u, v;
    if (vec3_dot(direction, p->axis) < p->cone) return SHOWS_NOTHING;
    if (!camera_project(&p->lens, mat3_apply(p->cam_from_model, direction), &u, &v)) return SHOWS_NOTHING;
    const double left = floor(u - 0.5), top = floor(v - 0.5);
    if (!(left >= 0 && top >= 0 && left + 1 < p->lens.width && top + 1 < p->lens.height)) return SHOWS_NOTHING;
    const size_t width = (size_t)p->lens.width, first = (size_t)top * width + (size_t)left;
    const float fx = (float)(u - 0.5 - left), fy = (float)(v - 0.5 - top);
    enum outdoors_state state = SHOWS_OUTDOORS;
    float sum[3] = {0};
    for (size_t k = 0; k < 4; k++) {
        const size_t at = first + (k & 1) + (k >> 1) * width;
        const float weight = (k & 1 ? fx : 1 - fx) * (k >> 1 ? fy : 1 - fy);
        if (p->state[at] < state) state = p->state[at];
        for (int c = 0; c < 3; c++) sum[c] += weight * p->rgb[3 * at + (size_t)c];
    }
    memcpy(rgb, sum, sizeof sum);
    if (facing) *facing = p->facing[first];
    return state;
}
