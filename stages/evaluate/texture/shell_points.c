/* shell_points.c - see shell_points.h.
 *
 * The true radiance of a point P with normal n. A picture of the shell shows it if P projects into the picture, the
 * camera is in front of the surface, and the point Q that the shell's depth gives at the pixel lies in the plane of P:
 * abs(n . (Q - P)) <= tolerance. Q may be far from P along a slanted surface, but not off its plane, so that no limit
 * depends on slant. Pixels beside a jump of depth fail when one of their neighbours is on the other side.
 *
 * How a photo sees P. The face of the model that a ray through the pixel meets must be that of P. Clutter stands in
 * front of it if furniture does, or if Q lies off that face's plane. */
#include "stages/evaluate/texture/shell_points.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/capture/photo_match.h"
#include "common/image/exr.h"
#include "stages/evaluate/truth/true_depth.h"

enum status shell_view_make(struct shell_view *v, const struct true_photo *shell, struct err *err)
{
    const size_t pixels = (size_t)shell->lens.width * (size_t)shell->lens.height;
    struct vec3 *seen = malloc(pixels * sizeof *seen);
    *v = (struct shell_view){.photo = -1, .lens = shell->lens, .pose = shell->pose};
    v->points = malloc(pixels * sizeof *v->points);
    v->known = malloc(pixels);
    if (!seen || !v->points || !v->known) {
        free(seen);
        shell_view_release(v);
        return err_nomem(err, "true points", pixels * sizeof *seen);
    }
    v->world_to_camera = mat3_from_quat(shell->pose.rotation);
    v->centre = pose_center(&shell->pose);
    const struct mat3 back = mat3_transpose(v->world_to_camera);
    true_points(seen, shell);
    for (size_t i = 0; i < pixels; i++) {
        const struct vec3 p = mat3_apply(back, vec3_sub(seen[i], shell->pose.translation));
        v->known[i] = vec3_length(seen[i]) > 0;
        v->points[i][0] = (float)p.x;
        v->points[i][1] = (float)p.y;
        v->points[i][2] = (float)p.z;
    }
    free(seen);
    return ST_OK;
}

/* Clutter at a pixel, and around it. */
static void mark_around(uint8_t *clutter, int x, int y, int width, int height)
{
    for (int v = y - CLUTTER_MARGIN; v <= y + CLUTTER_MARGIN; v++)
        for (int u = x - CLUTTER_MARGIN; u <= x + CLUTTER_MARGIN; u++)
            if (u >= 0 && v >= 0 && u < width && v < height) clutter[(size_t)v * (size_t)width + (size_t)u] = 1;
}

enum status shell_view_mark(struct shell_view *v, const struct shell_pixel_ids *ids, double tolerance, struct err *err)
{
    const int width = v->lens.width, height = v->lens.height;
    const size_t pixels = (size_t)width * (size_t)height;
    v->faces = malloc(pixels * sizeof *v->faces);
    v->clutter = calloc(pixels, 1);
    if (!v->faces || !v->clutter) return err_nomem(err, "ids", pixels * sizeof *v->faces);
    memcpy(v->faces, ids->faces, pixels * sizeof *v->faces);
    for (size_t i = 0; i < pixels; i++)
        if (ids->shell[i] != ids->whole[i] || ids->distance[i] > tolerance)
            mark_around(v->clutter, (int)(i % (size_t)width), (int)(i / (size_t)width), width, height);
    return ST_OK;
}

void shell_view_release(struct shell_view *v)
{
    free(v->points);
    free(v->known);
    free(v->faces);
    free(v->clutter);
    image_release(&v->rgb);
    *v = (struct shell_view){0};
}

/* ---------------------------------------------------------------------------------------------------- single points */

static bool same_surface(const struct shell_view *v, int x, int y, const struct surface_point *p, double tolerance)
{
    const size_t i = (size_t)y * (size_t)v->lens.width + (size_t)x;
    const struct vec3 q = vec3_make(v->points[i][0], v->points[i][1], v->points[i][2]);
    return v->known[i] && fabs(vec3_dot(p->normal, vec3_sub(q, p->point))) <= tolerance;
}

/* Where the camera would see the point. */
static bool project(const struct shell_view *v, const struct surface_point *p, double *x, double *y)
{
    if (!(vec3_dot(p->normal, vec3_sub(v->centre, p->point)) > 0)) return false;
    const struct vec3 in_camera = vec3_add(mat3_apply(v->world_to_camera, p->point), v->pose.translation);
    if (!camera_project(&v->lens, in_camera, x, y)) return false;
    return *x >= 0 && *y >= 0 && *x < v->lens.width && *y < v->lens.height;
}

enum shell_sight shell_view_sight(const struct shell_view *v, const struct surface_point *p)
{
    double x, y;
    if (!v->clutter || !project(v, p, &x, &y)) return SHELL_HIDDEN_POINT;
    const size_t i = (size_t)y * (size_t)v->lens.width + (size_t)x;
    if (v->faces[i] != (uint32_t)p->face) return SHELL_HIDDEN_POINT;
    return v->clutter[i] ? SHELL_CLUTTER : SHELL_CLEAN;
}

bool shell_view_radiance(float rgb[3], const struct shell_view *v, const struct image *picture,
                         const struct surface_point *p, double tolerance, bool shell)
{
    double x, y;
    if (!picture->data || !project(v, p, &x, &y)) return false;
    if (shell && !same_surface(v, (int)x, (int)y, p, tolerance)) return false;
    const int x0 = (int)floor(x - 0.5), y0 = (int)floor(y - 0.5), margin = RADIANCE_MARGIN;
    if (x0 < margin || y0 < margin || x0 + 1 + margin >= v->lens.width || y0 + 1 + margin >= v->lens.height)
        return false;
    for (int j = y0 - margin; shell && j <= y0 + 1 + margin; j++)
        for (int i = x0 - margin; i <= x0 + 1 + margin; i++)
            if (!same_surface(v, i, j, p, tolerance)) return false;
    const double a = x - 0.5 - x0, b = y - 0.5 - y0;
    for (int c = 0; c < 3; c++) {
        const double top = (1 - a) * image_at(picture, x0, y0)[c] + a * image_at(picture, x0 + 1, y0)[c];
        const double low = (1 - a) * image_at(picture, x0, y0 + 1)[c] + a * image_at(picture, x0 + 1, y0 + 1)[c];
        rgb[c] = (float)((1 - b) * top + b * low);
    }
    return true;
}

static double pixels_per_area(const struct shell_view *v, const struct surface_point *p)
{
    const struct vec3 to = vec3_sub(v->centre, p->point);
    double fx, fy, cx, cy;
    const double distance = vec3_length(to), cosine = vec3_dot(p->normal, to) / distance;
    camera_focal(&v->lens, &fx, &fy, &cx, &cy);
    return cosine * fx * fy / (distance * distance);
}

bool shell_radiance(float rgb[3], const struct shell_points *s, const struct surface_point *p, int first)
{
    if (first >= 0 && shell_view_radiance(rgb, &s->views[first], &s->views[first].rgb, p, s->tolerance, true))
        return true;
    double best = 0;
    for (int i = 0; i < s->count; i++) {
        const struct shell_view *v = &s->views[i];
        float found[3];
        if (!v->rgb.data) continue;
        const double size = pixels_per_area(v, p);
        if (!(size > best) || !shell_view_radiance(found, v, &v->rgb, p, s->tolerance, true)) continue;
        best = size;
        memcpy(rgb, found, sizeof found);
    }
    return best > 0;
}

/* ---------------------------------------------------------------------------------------------------------- reading */

struct model_trace {
    const struct model_rays *model;
    const struct model_frame *frame;
};

static enum status add_input(struct evaluation *e, const char *path, struct err *err)
{
    char name[FILE_PATH];
    snprintf(name, sizeof name, "truth%s", path + strlen(e->truth_folder));
    return provenance_add_file(e->prov, name, path, err);
}

static enum status check_size(const char *path, int width, int height, const struct camera *lens, struct err *err)
{
    if (width == lens->width && height == lens->height) return ST_OK;
    return err_set(err, ST_DATA, "%s is %d x %d px, but the truth's camera is %d x %d px.", path, width, height,
                   lens->width, lens->height);
}

/* The ids of a picture; im stays empty if there is no file. */
static enum status read_ids(struct exr_image *im, struct evaluation *e, const char *path, const struct camera *lens,
                            struct err *err)
{
    static const char *const names[] = {"id"};
    if (!path_is_file(path)) return ST_OK;
    if (!add_input(e, path, err)) exr_read(im, path, names, 1, err);
    if (!err->status && !im->planes[0].u) err_set(err, ST_DATA, "%s: channel id holds no integers, wanted uint.", path);
    if (!err->status) check_size(path, im->width, im->height, lens, err);
    return err->status;
}

/* The ids of a camera with furniture: those of the photo, or of a view that nobody photographed. */
static enum status read_whole_ids(struct exr_image *im, struct evaluation *e, const struct true_picture *p,
                                  struct err *err)
{
    static const char *const folders[] = {"ids", "novel/ids"};
    for (int k = 0; !err->status && !im->count && k < 2; k++) {
        char path[FILE_PATH], folder[FILE_PATH];
        if (!file_path(folder, e->truth_folder, folders[k], "", err) && !file_path(path, folder, p->name, ".exr", err))
            read_ids(im, e, path, &p->lens, err);
    }
    return err->status;
}

static enum status read_radiance(struct shell_view *v, struct evaluation *e, const struct shell_points *s,
                                 struct err *err)
{
    struct linear_picture picture = {0};
    char path[FILE_PATH];
    if (!true_set_file(path, &s->set, "hdr", v->name)) return ST_OK;
    if (!add_input(e, path, err) && !linear_picture_read(&picture, path, err))
        check_size(path, picture.rgb.width, picture.rgb.height, &v->lens, err);
    if (!err->status) {
        v->rgb = picture.rgb;
        picture.rgb = (struct image){0};
    }
    linear_picture_release(&picture);
    return err->status;
}

/* What the photos of a view and the model show at its pixels, if the truth has ids without and with furniture. */
static enum status read_clutter(struct shell_view *v, struct evaluation *e, const struct shell_points *s,
                                const struct true_picture *p, const struct true_photo *photo,
                                const struct model_trace *trace, struct err *err)
{
    const size_t pixels = (size_t)p->lens.width * (size_t)p->lens.height;
    struct exr_image shell = {0}, whole = {0};
    char path[FILE_PATH];
    if (!true_set_file(path, &s->set, "ids", p->name)) return ST_OK;
    struct vec3 *points = malloc(pixels * sizeof *points);
    uint32_t *faces = malloc(pixels * sizeof *faces);
    float *distance = malloc(pixels * sizeof *distance);
    if (!points || !faces || !distance) err_nomem(err, "faces", pixels * sizeof *points);
    if (!err->status) read_whole_ids(&whole, e, p, err);
    if (!err->status && whole.count && !read_ids(&shell, e, path, &p->lens, err)) {
        true_points(points, photo);
        traced_model_faces(faces, distance, trace->model, trace->frame, p, points);
        const struct shell_pixel_ids ids = {shell.planes[0].u, whole.planes[0].u, faces, distance};
        shell_view_mark(v, &ids, s->tolerance, err);
    }
    exr_image_release(&whole);
    exr_image_release(&shell);
    free(points);
    free(faces);
    free(distance);
    return err->status;
}

static enum status add_view(struct shell_points *s, struct evaluation *e, const struct true_picture *p,
                            const char *depth_path, const struct model_trace *trace, struct err *err)
{
    struct true_photo photo = {.lens = p->lens, .pose = p->pose};
    struct shell_view *v = &s->views[s->count];
    if (!add_input(e, depth_path, err) && !truth_photo_read_depth(&photo, depth_path, e->params->far, err))
        shell_view_make(v, &photo, err);
    if (!err->status) {
        s->count++;
        v->name = p->name;
        v->photo = photo_list_match(&e->photos, p->name);
        read_clutter(v, e, s, p, &photo, trace, err);
    }
    if (!err->status) read_radiance(v, e, s, err);
    free(photo.depth);
    return err->status;
}

enum status shell_points_read(struct shell_points *s, struct evaluation *e, const struct model_rays *model,
                              const struct model_frame *frame, struct err *err)
{
    const struct model_trace trace = {model, frame};
    *s = (struct shell_points){.tolerance = e->params->surface_distance};
    true_set_read(&s->set, e->truth_folder, "shell", e->prov, err);
    if (!err->status && s->set.count && !(s->views = calloc((size_t)s->set.count, sizeof *s->views)))
        err_nomem(err, "true pictures", (size_t)s->set.count * sizeof *s->views);
    for (int i = 0; !err->status && i < s->set.count; i++) {
        char path[FILE_PATH];
        if (true_set_file(path, &s->set, "depth", s->set.pictures[i].name))
            add_view(s, e, &s->set.pictures[i], path, &trace, err);
    }
    return err->status;
}

void shell_points_release(struct shell_points *s)
{
    for (int i = 0; i < s->count; i++) shell_view_release(&s->views[i]);
    free(s->views);
    true_set_release(&s->set);
    *s = (struct shell_points){0};
}
