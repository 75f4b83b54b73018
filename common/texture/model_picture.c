/* model_picture.c - pictures of a model in memory and on disk (docs/formats.md). */
#include "common/texture/model_picture.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/capture/view_image.h"
#include "common/image/exr.h"

enum { PLANES = 6, RGB = 3 };
static const char *const names[PLANES] = {"R", "G", "B", "Z", "id", "made"};
static const enum exr_type types[PLANES] = {EXR_HALF, EXR_HALF, EXR_HALF, EXR_FLOAT, EXR_UINT, EXR_UINT};

enum status model_picture_resize(struct model_picture *p, int width, int height, struct err *err)
{
    const size_t pixels = (size_t)width * (size_t)height;
    if (width < 1 || height < 1 || (int64_t)width * height > INT_MAX)
        return err_set(err, ST_DATA, "a picture of a model cannot have %d x %d pixels.", width, height);
    p->has_camera = false;
    if (p->width == width && p->height == height) {
        memset(p->rgb, 0, RGB * pixels * sizeof *p->rgb);
        memset(p->z, 0, pixels * sizeof *p->z);
        memset(p->id, 0, pixels * sizeof *p->id);
        memset(p->made, 0, pixels * sizeof *p->made);
        return ST_OK;
    }
    model_picture_release(p);
    *p = (struct model_picture){.width = width,
                                .height = height,
                                .rgb = calloc(pixels, RGB * sizeof *p->rgb),
                                .z = calloc(pixels, sizeof *p->z),
                                .id = calloc(pixels, sizeof *p->id),
                                .made = calloc(pixels, sizeof *p->made)};
    if (p->rgb && p->z && p->id && p->made) return ST_OK;
    model_picture_release(p);
    return err_nomem(err, "a picture of a model",
                     pixels * (RGB * sizeof *p->rgb + sizeof *p->z + sizeof *p->id + sizeof *p->made));
}

void model_picture_release(struct model_picture *p)
{
    if (!p) return;
    free(p->rgb);
    free(p->z);
    free(p->id);
    free(p->made);
    *p = (struct model_picture){0};
}

void model_picture_set_camera(struct model_picture *p, const struct camera *lens, const struct pose *cam_from_model)
{
    p->has_camera = true;
    p->lens = *lens;
    p->pose = *cam_from_model;
}

/* Numbers are printed so that reading gives the same bits. */
static enum status write_camera(struct exr_image *im, const struct model_picture *p, struct err *err)
{
    char text[256], name[32];
    const struct quat q = p->pose.rotation;
    const struct vec3 t = p->pose.translation;
    snprintf(text, sizeof text, "%s %d %d", camera_model_name(p->lens.model), p->lens.width, p->lens.height);
    exr_set_attribute(im, "remodel:lens", text, err);
    for (int k = 0; !err->status && k < camera_model_params(p->lens.model); k++) {
        snprintf(name, sizeof name, "remodel:lens%d", k);
        snprintf(text, sizeof text, "%.17g", p->lens.params[k]);
        exr_set_attribute(im, name, text, err);
    }
    snprintf(text, sizeof text, "%.17g %.17g %.17g %.17g %.17g %.17g %.17g", q.w, q.x, q.y, q.z, t.x, t.y, t.z);
    if (!err->status) exr_set_attribute(im, "remodel:pose", text, err);
    return err->status;
}

/* Whether the attributes hold a camera; *p is unchanged otherwise. */
static bool read_camera(struct model_picture *p, const struct exr_image *im)
{
    char word[32], name[32];
    struct camera lens = {.width = 0};
    struct pose pose;
    double *n[7] = {&pose.rotation.w,    &pose.rotation.x,    &pose.rotation.y,   &pose.rotation.z,
                    &pose.translation.x, &pose.translation.y, &pose.translation.z};
    const char *text = exr_attribute(im, "remodel:lens"), *at = exr_attribute(im, "remodel:pose");
    if (!text || !at || sscanf(text, "%31s %d %d", word, &lens.width, &lens.height) != 3) return false;
    if (!camera_model_from_name(word, &lens.model)) return false;
    for (int k = 0; k < camera_model_params(lens.model); k++) {
        snprintf(name, sizeof name, "remodel:lens%d", k);
        const char *value = exr_attribute(im, name);
        if (!value) return false;
        lens.params[k] = strtod(value, NULL);
    }
    for (int k = 0; k < 7; k++) {
        char *end;
        *n[k] = strtod(at, &end);
        if (end == at) return false;
        at = end;
    }
    if (lens.width != im->width || lens.height != im->height || camera_check(&lens, NULL)) return false;
    model_picture_set_camera(p, &lens, &pose);
    return true;
}

enum status model_picture_write(const struct model_picture *p, const struct view *camera, const char *path,
                                const struct provenance *prov, struct err *err)
{
    const size_t pixels = (size_t)p->width * (size_t)p->height;
    struct exr_image im = {0};
    exr_image_init(&im, p->width, p->height, err);
    for (int k = 0; !err->status && k < PLANES; k++) exr_add_plane(&im, names[k], types[k], NULL, err);
    if (!err->status) {
        for (size_t i = 0; i < pixels; i++) {
            for (size_t c = 0; c < RGB; c++) im.planes[c].f[i] = fmaxf(p->rgb[RGB * i + c], 0);
            im.planes[5].u[i] = p->made[i];
        }
        memcpy(im.planes[3].f, p->z, pixels * sizeof *p->z);
        memcpy(im.planes[4].u, p->id, pixels * sizeof *p->id);
        view_image_set_camera(&im, camera);
        if (p->has_camera) write_camera(&im, p, err);
    }
    if (!err->status) exr_write(&im, path, prov, err);
    exr_image_release(&im);
    return err->status;
}

/* Whether pixel i of the planes is what model_picture_write() may write. */
static bool pixel_is_valid(struct exr_plane *const planes[PLANES], size_t i)
{
    const uint32_t made = planes[5]->u[i], id = planes[4]->u[i];
    const float z = planes[3]->f[i];
    bool valid = made < MADE_COUNT && id <= INT_MAX && (id ? z > 0 : z == 0);
    for (int c = 0; c < RGB; c++) valid &= made == MADE_NOTHING ? planes[c]->f[i] == 0 : planes[c]->f[i] >= 0;
    return valid;
}

static enum status wrong_pixel(struct exr_plane *const planes[PLANES], size_t i, int width, const char *path,
                               struct err *err)
{
    return err_set(err, ST_DATA,
                   "%s: pixel (%zu, %zu) has R G B %g %g %g, Z %g, id %u and made %u; wanted colours of 0 or more, all "
                   "0 where made is 0, Z above 0 where there is an id and 0 elsewhere, made below %d. Render it again.",
                   path, i % (size_t)width, i / (size_t)width, (double)planes[0]->f[i], (double)planes[1]->f[i],
                   (double)planes[2]->f[i], (double)planes[3]->f[i], planes[4]->u[i], planes[5]->u[i], MADE_COUNT);
}

static enum status take_planes(struct model_picture *p, const struct exr_image *im, const char *path, struct err *err)
{
    const size_t pixels = (size_t)im->width * (size_t)im->height;
    struct exr_plane *planes[PLANES];
    for (int k = 0; k < PLANES; k++) {
        planes[k] = exr_find(im, names[k]);
        if (types[k] == EXR_UINT ? !planes[k]->u : !planes[k]->f)
            return err_set(err, ST_DATA, "%s: channel %s has the wrong type; render it again.", path, names[k]);
    }
    if (model_picture_resize(p, im->width, im->height, err)) return err->status;
    for (size_t i = 0; i < pixels; i++) {
        if (!pixel_is_valid(planes, i)) return wrong_pixel(planes, i, im->width, path, err);
        for (size_t c = 0; c < RGB; c++) p->rgb[RGB * i + c] = planes[c]->f[i];
        p->z[i] = planes[3]->f[i];
        p->id[i] = planes[4]->u[i];
        p->made[i] = (uint8_t)planes[5]->u[i];
    }
    return ST_OK;
}

enum status model_picture_read(struct model_picture *p, const char *path, struct provenance *prov, struct err *err)
{
    struct exr_image im = {0};
    const enum product_id id = product_at(path) == PRODUCT_RELIT ? PRODUCT_RELIT : PRODUCT_PICTURE;
    if (!exr_read_product(&im, id, path, names, PLANES, prov, err) && !take_planes(p, &im, path, err))
        read_camera(p, &im);
    exr_image_release(&im);
    if (err->status) model_picture_release(p);
    return err->status;
}
