/* transforms_model.c - cameras in transforms.json.
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
#include "stages/sfm/transforms_model.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include <jansson.h>

#include "common/base/file_bytes.h"
#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/base/scan.h"
#include "common/capture/photo_match.h"
#include "stages/sfm/given_cameras.h"
#include "stages/sfm/sfm_folder.h"

#define DEPTH_STEP 0.001 /* of whole numbers: millimetres, where the file does not say */

/* A frame, and what holds for all frames. */
struct frame {
    const json_t *own, *all;
    char where[FILE_PATH + 64]; /* for messages: "PATH: frame 3 (NAME)" */
};

static const json_t *find_value(const struct frame *f, const char *key)
{
    const json_t *v = json_object_get(f->own, key);
    return v ? v : json_object_get(f->all, key);
}

/* The number of a frame, or of all frames; *value is unchanged if neither has it. */
static enum status read_number(const struct frame *f, const char *key, double *value, struct err *err)
{
    const json_t *v = find_value(f, key);
    if (!v || json_is_null(v)) return ST_OK;
    if (!json_is_number(v) || !isfinite(json_number_value(v)))
        return err_set(err, ST_DATA, "%s: \"%s\" is not a number.", f->where, key);
    *value = json_number_value(v);
    return ST_OK;
}

static bool is_panorama(const struct frame *f)
{
    const json_t *v = find_value(f, "camera_model");
    const char *name = json_is_string(v) ? json_string_value(v) : "";
    return !strcasecmp(name, "EQUIRECTANGULAR") || !strcasecmp(name, "spherical");
}

/* *has: whether the frame's lens is a fisheye. ST_DATA: a model that is none of OpenCV's. */
static enum status read_model(const struct frame *f, bool *fisheye, struct err *err)
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

/* photo: NULL: the image is no photo of the scene. *known: false if the size of its pictures is unknown. */
static enum status read_lens(struct camera *c, bool *known, const struct frame *f, const struct photo_record *photo,
                             struct err *err)
{
    static const char *const coefficients[] = {"k1", "k2", "k3", "k4", "p1", "p2"};
    struct given_lens lens = {0};
    double w = photo ? photo->info.width : 0, h = photo ? photo->info.height : 0, wide = 0, high = 0;
    double *const values[] = {&lens.k[0], &lens.k[1], &lens.k[2], &lens.k[3], &lens.p[0], &lens.p[1]};
    if (read_number(f, "w", &w, err) || read_number(f, "h", &h, err) || read_model(f, &lens.fisheye, err))
        return err->status;
    *known = w >= 1 && h >= 1 && w < 1e6 && h < 1e6;
    if (!*known) return ST_OK;
    lens.width = (int)lround(w);
    lens.height = (int)lround(h);
    lens.cx = w / 2;
    lens.cy = h / 2;
    if (read_number(f, "fl_x", &lens.fx, err) || read_number(f, "fl_y", &lens.fy, err) ||
        read_number(f, "camera_angle_x", &wide, err) || read_number(f, "camera_angle_y", &high, err) ||
        read_number(f, "cx", &lens.cx, err) || read_number(f, "cy", &lens.cy, err))
        return err->status;
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        if (read_number(f, coefficients[i], values[i], err)) return err->status;
    if (!(lens.fx > 0) && wide > 0 && wide < 3.1) lens.fx = w / (2 * tan(wide / 2));
    if (!(lens.fy > 0) && high > 0 && high < 3.1) lens.fy = h / (2 * tan(high / 2));
    if (!(lens.fx > 0)) lens.fx = lens.fy;
    if (!(lens.fy > 0)) lens.fy = lens.fx;
    if (!(lens.fx > 0))
        return err_set(err, ST_DATA, "%s has no focal length; wanted fl_x in pixels, or camera_angle_x in radians.",
                       f->where);
    return given_lens_camera(c, &lens, f->where, err);
}

static enum status read_matrix(const struct frame *f, struct vec3 axes[3], struct vec3 *center, struct err *err)
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

struct transforms {
    char path[FILE_PATH];
    json_t *root;
    const json_t *frames;
};

static void transforms_close(struct transforms *t)
{
    json_decref(t->root);
    *t = (struct transforms){0};
}

/* t->root stays NULL if there is no such file. */
static enum status transforms_open(struct transforms *t, const char *folder, struct err *err)
{
    static const char *const names[] = {"transforms.json", "transforms_train.json"};
    struct file_bytes file = {0};
    json_error_t why;
    *t = (struct transforms){0};
    for (int i = 0; i < 2; i++) {
        if (file_path(t->path, folder, names[i], "", err)) return err->status;
        if (path_is_file(t->path)) break;
        if (i == 1) return ST_OK;
    }
    if (file_bytes_read(&file, t->path, err)) return err->status;
    const size_t mark = file.size >= 3 && !memcmp(file.bytes, "\xEF\xBB\xBF", 3) ? 3 : 0;
    t->root = json_loadb(file.bytes + mark, file.size - mark, 0, &why);
    file_bytes_release(&file);
    if (!t->root) return err_set(err, ST_DATA, "%s:%d: this is not JSON: %s.", t->path, why.line, why.text);
    t->frames = json_object_get(t->root, "frames");
    if (json_array_size(t->frames)) return ST_OK;
    err_set(err, ST_DATA, "%s has no list \"frames\" of cameras.", t->path);
    transforms_close(t);
    return err->status;
}

/* *name: of the file of frame i; it lasts as long as t. */
static enum status frame_at(struct frame *f, const char **name, const struct transforms *t, size_t i, struct err *err)
{
    char shown[SCAN_QUOTED];
    f->own = json_array_get(t->frames, i);
    f->all = t->root;
    snprintf(f->where, sizeof f->where, "%s: frame %zu", t->path, i + 1);
    *name = json_string_value(json_object_get(f->own, "file_path"));
    if (!*name || !**name) return err_set(err, ST_DATA, "%s has no \"file_path\", the name of its picture.", f->where);
    snprintf(f->where, sizeof f->where, "%s: frame %zu (%s)", t->path, i + 1, scan_quote(shown, *name));
    return ST_OK;
}

enum status transforms_model_read(struct sfm_model *m, bool *found, const char *folder, const struct photo_list *photos,
                                  struct provenance *prov, struct err *err)
{
    struct transforms t = {0};
    int unsized = 0;
    *m = (struct sfm_model){0};
    *found = !transforms_open(&t, folder, err) && t.root;
    if (!*found) return err->status;
    if (prov) provenance_add_file(prov, "model/transforms.json", t.path, err);
    for (size_t i = 0; !err->status && i < json_array_size(t.frames); i++) {
        struct frame f;
        struct camera c;
        struct vec3 axes[3], center;
        const char *name = NULL;
        bool sized = false;
        if (frame_at(&f, &name, &t, i, err)) break;
        const int photo = photo_list_match(photos, name);
        if (is_panorama(&f)) {
            sized = true;
            if (given_panorama_lens(&c, name, photos, f.where, err)) break;
        } else if (read_lens(&c, &sized, &f, photo < 0 ? NULL : &photos->photos[photo], err)) {
            break;
        }
        unsized += !sized;
        if (sized && !read_matrix(&f, axes, &center, err)) given_cameras_add(m, name, &c, axes, center, f.where, err);
    }
    if (!err->status && unsized)
        log_note("%d frames of %s are not photos of the scene and are left out", unsized, t.path);
    if (!err->status) given_cameras_end(m, t.path, err);
    transforms_close(&t);
    if (err->status) sfm_model_release(m);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- depth */

static const char *depth_name(const struct frame *f)
{
    const char *name = json_string_value(json_object_get(f->own, "depth_file_path"));
    return name ? name : json_string_value(json_object_get(f->own, "depth_path"));
}

/* Links to/ID.EXT to the depth of a photo; the path is relative to the folder of transforms.json. *linked: whether the
 * file exists. */
static enum status link_map(bool *linked, const char *to, const char *folder, const char *name, const char *id,
                            struct err *err)
{
    char from[FILE_PATH], file[FILE_PATH], ending[16] = "";
    const char *dot = strrchr(path_file_name(name), '.');
    *linked = false;
    if (*name == '/' ? file_path(from, "", name + 1, "", err) : file_path(from, folder, name, "", err))
        return err->status;
    for (char *p = from; *p; p++)
        if (*p == '\\') *p = '/';
    if (!dot || strlen(dot) >= sizeof ending || !path_is_file(from)) return ST_OK;
    for (size_t i = 0; dot[i]; i++) ending[i] = (char)(dot[i] >= 'A' && dot[i] <= 'Z' ? dot[i] + 32 : dot[i]);
    char *whole = realpath(from, NULL);
    if (!whole) return err_errno(err, "open", from);
    if (!file_path(file, to, id, ending, err)) {
        unlink(file);
        if (symlink(whole, file)) err_errno(err, "make", file);
        *linked = !err->status;
    }
    free(whole);
    return err->status;
}

/* depth.txt: the maps show the photos with their lens; step: the scale, 0: none is needed. */
static enum status write_units(const char *to, double step, struct err *err)
{
    struct outfile f = {0};
    char path[FILE_PATH];
    if (!file_path(path, to, "depth.txt", "", err) && !outfile_open(&f, path, err)) {
        if (step > 0) fprintf(f.fp, "scale %.9g\n", step);
        fputs("pixels photo\n", f.fp);
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
}

enum status transforms_link_depth(int *count, const char *to, const char *folder, const struct photo_list *photos,
                                  struct err *err)
{
    struct transforms t = {0};
    double step = 0;
    bool whole_numbers = false; /* of any map */
    *count = 0;
    if (sfm_remove_tree(to, err) || transforms_open(&t, folder, err) || !t.root) return err->status;
    for (size_t i = 0; !err->status && i < json_array_size(t.frames); i++) {
        struct frame f;
        const char *name = NULL;
        bool linked = false;
        if (frame_at(&f, &name, &t, i, err)) break;
        const char *depth = depth_name(&f);
        const int photo = depth ? photo_list_match(photos, name) : -1;
        if (photo < 0) continue;
        if (!*count && outfile_make_folders(to, err)) break;
        if (read_number(&f, "depth_unit_scale_factor", &step, err) ||
            read_number(&f, "integer_depth_scale", &step, err))
            break;
        link_map(&linked, to, folder, depth, photos->photos[photo].id, err);
        *count += linked;
        whole_numbers = whole_numbers || !strcasecmp(depth + strlen(depth) - (strlen(depth) < 4 ? 0 : 4), ".png");
    }
    if (!err->status && *count) write_units(to, step > 0 || !whole_numbers ? step : DEPTH_STEP, err);
    if (!*count || err->status) sfm_remove_tree(to, &(struct err)ERR_INIT);
    transforms_close(&t);
    return err->status;
}
