/* transforms_file.c - cameras in transforms.json.
 *
 * The form is that of NeRF's first data sets, extended by instant-ngp [Müller 2022] and nerfstudio [Tancik 2023]:
 *   w, h                                 size of the pictures, px; without it that of the photos
 *   fl_x, fl_y or camera_angle_x, _y     focal lengths, px, or fields of view, radians
 *   cx, cy                               principal point, px; without it the middle
 *   camera_model                         PINHOLE, OPENCV, OPENCV_FISHEYE, ...; is_fisheye: true is the last;
 *                                        EQUIRECTANGULAR: a panorama
 *   k1 to k4, p1, p2                     OpenCV's coefficients
 *   frames: file_path, transform_matrix  and any of the above, where they differ
 *   depth_file_path or depth_path        the depth of a frame, z along the axis; of whole numbers
 *                                        integer_depth_scale or depth_unit_scale_factor is a step, 0.001 without
 * The matrix maps the camera's axes, x right, y up, z backward, to the world. Paths are those of the program that wrote
 * the file, so only the names of files count; names may lack the extension. */
#include "common/capture/transforms_file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "common/base/file_bytes.h"
#include "common/base/scan.h"

void transforms_file_close(struct transforms_file *t)
{
    json_decref(t->root);
    *t = (struct transforms_file){0};
}

enum status transforms_file_open(struct transforms_file *t, const char *path, struct err *err)
{
    struct file_bytes file = {0};
    json_error_t why;
    *t = (struct transforms_file){0};
    if (strlen(path) >= sizeof t->path) return err_set(err, ST_IO, "the path %.200s... is too long.", path);
    strcpy(t->path, path);
    if (file_bytes_read(&file, path, err)) return err->status;
    const size_t mark = file.size >= 3 && !memcmp(file.bytes, "\xEF\xBB\xBF", 3) ? 3 : 0;
    t->root = json_loadb(file.bytes + mark, file.size - mark, 0, &why);
    file_bytes_release(&file);
    if (!t->root) return err_set(err, ST_DATA, "%s:%d: this is not JSON: %s.", path, why.line, why.text);
    t->frames = json_object_get(t->root, "frames");
    if (json_array_size(t->frames)) return ST_OK;
    err_set(err, ST_DATA, "%s has no list \"frames\" of cameras.", path);
    transforms_file_close(t);
    return err->status;
}

void transforms_file_frame(struct transforms_frame *f, const char **name, const struct transforms_file *t, size_t i)
{
    char shown[SCAN_QUOTED];
    f->own = json_array_get(t->frames, i);
    f->all = t->root;
    *name = json_string_value(json_object_get(f->own, "file_path"));
    if (*name && !**name) *name = NULL;
    if (*name)
        snprintf(f->where, sizeof f->where, "%s: frame %zu (%s)", t->path, i + 1, scan_quote(shown, *name));
    else
        snprintf(f->where, sizeof f->where, "%s: frame %zu", t->path, i + 1);
}

static const json_t *find_value(const struct transforms_frame *f, const char *key)
{
    const json_t *v = json_object_get(f->own, key);
    return v ? v : json_object_get(f->all, key);
}

enum status transforms_file_number(const struct transforms_frame *f, const char *key, double *value, struct err *err)
{
    const json_t *v = find_value(f, key);
    if (!v || json_is_null(v)) return ST_OK;
    if (!json_is_number(v) || !isfinite(json_number_value(v)))
        return err_set(err, ST_DATA, "%s: \"%s\" is not a number.", f->where, key);
    *value = json_number_value(v);
    return ST_OK;
}

bool transforms_file_is_panorama(const struct transforms_frame *f)
{
    const json_t *v = find_value(f, "camera_model");
    const char *name = json_is_string(v) ? json_string_value(v) : "";
    return !strcasecmp(name, "EQUIRECTANGULAR") || !strcasecmp(name, "spherical");
}

/* *fisheye: whether the frame's lens is a fisheye. ST_DATA: a model that is none of OpenCV's. */
static enum status read_model(const struct transforms_frame *f, bool *fisheye, struct err *err)
{
    static const char *const plain[] = {"OPENCV", "PINHOLE",     "SIMPLE_PINHOLE", "SIMPLE_RADIAL",
                                        "RADIAL", "FULL_OPENCV", "perspective"};
    const json_t *v = find_value(f, "camera_model"), *flag = find_value(f, "is_fisheye");
    *fisheye = json_is_true(flag);
    if (!v || json_is_null(v)) return ST_OK;
    const char *name = json_is_string(v) ? json_string_value(v) : "";
    *fisheye = !strcmp(name, "OPENCV_FISHEYE") || !strcmp(name, "fisheye");
    bool known = *fisheye;
    for (size_t i = 0; i < sizeof plain / sizeof *plain; i++) known = known || !strcmp(name, plain[i]);
    return known ? ST_OK
                 : err_set(err, ST_DATA,
                           "%s: its camera_model is %s, which is not supported; wanted OPENCV, OPENCV_FISHEYE, "
                           "PINHOLE or EQUIRECTANGULAR.",
                           f->where, *name ? name : "no name");
}

enum status transforms_file_lens(struct given_lens *lens, bool *known, const struct transforms_frame *f, double width,
                                 double height, struct err *err)
{
    static const char *const coefficients[] = {"k1", "k2", "k3", "k4", "p1", "p2"};
    double w = width, h = height, wide = 0, high = 0;
    double *const values[] = {&lens->k[0], &lens->k[1], &lens->k[2], &lens->k[3], &lens->p[0], &lens->p[1]};
    *lens = (struct given_lens){.width = 0};
    if (transforms_file_number(f, "w", &w, err) || transforms_file_number(f, "h", &h, err) ||
        read_model(f, &lens->fisheye, err))
        return err->status;
    *known = w >= 1 && h >= 1 && w < 1e6 && h < 1e6;
    if (!*known) return ST_OK;
    lens->width = (int)lround(w);
    lens->height = (int)lround(h);
    lens->cx = w / 2;
    lens->cy = h / 2;
    if (transforms_file_number(f, "fl_x", &lens->fx, err) || transforms_file_number(f, "fl_y", &lens->fy, err) ||
        transforms_file_number(f, "camera_angle_x", &wide, err) ||
        transforms_file_number(f, "camera_angle_y", &high, err) || transforms_file_number(f, "cx", &lens->cx, err) ||
        transforms_file_number(f, "cy", &lens->cy, err))
        return err->status;
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        if (transforms_file_number(f, coefficients[i], values[i], err)) return err->status;
    if (!(lens->fx > 0) && wide > 0 && wide < 3.1) lens->fx = w / (2 * tan(wide / 2));
    if (!(lens->fy > 0) && high > 0 && high < 3.1) lens->fy = h / (2 * tan(high / 2));
    if (!(lens->fx > 0)) lens->fx = lens->fy;
    if (!(lens->fy > 0)) lens->fy = lens->fx;
    if (lens->fx > 0) return ST_OK;
    return err_set(err, ST_DATA, "%s has no focal length; wanted fl_x in pixels, or camera_angle_x in radians.",
                   f->where);
}

enum status transforms_file_pose(struct vec3 axes[3], struct vec3 *center, const struct transforms_frame *f,
                                 struct err *err)
{
    const json_t *m = json_object_get(f->own, "transform_matrix");
    double v[3][4];
    bool good = json_array_size(m) == 4 || json_array_size(m) == 3;
    for (size_t i = 0; good && i < 3; i++) {
        const json_t *row = json_array_get(m, i);
        good = json_array_size(row) == 4;
        for (size_t k = 0; good && k < 4; k++) {
            const json_t *x = json_array_get(row, k);
            good = json_is_number(x) && isfinite(json_number_value(x));
            v[i][k] = good ? json_number_value(x) : 0;
        }
    }
    if (!good)
        return err_set(err, ST_DATA, "%s: its transform_matrix is missing or broken; wanted 4 rows of 4 numbers.",
                       f->where);
    for (int k = 0; k < 3; k++) {
        const double sign = k ? -1 : 1;
        axes[k] = vec3_make(sign * v[0][k], sign * v[1][k], sign * v[2][k]);
    }
    *center = vec3_make(v[0][3], v[1][3], v[2][3]);
    return ST_OK;
}
