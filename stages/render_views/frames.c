/* frames.c - rendering and writing of frames; see frames.h. */
#include "stages/render_views/frames.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/file_path.h"
#include "common/base/progress.h"
#include "common/capture/view_image.h"
#include "common/image/exr.h"
#include "common/layers/hole_measure.h"
#include "common/product/product.h"

enum status frame_part_read(struct frame_part *part, const char *crop, const char *scale, struct err *err)
{
    int used = 0;
    char *end = NULL;

    *part = (struct frame_part){.scale = 1};
    if (crop && (sscanf(crop, "%9d,%9d,%9d,%9d%n", &part->x, &part->y, &part->width, &part->height, &used) != 4 ||
                 crop[used] || part->x < 0 || part->y < 0 || part->width < 1 || part->height < 1))
        return err_set(err, ST_USAGE, "--crop %s: wanted X,Y,WIDTH,HEIGHT in pixels, like 100,50,640,480.", crop);
    if (scale) part->scale = strtod(scale, &end);
    if (scale && (end == scale || *end || !(part->scale > 0 && part->scale <= 16)))
        return err_set(err, ST_USAGE, "--scale %s: wanted a number above 0, at most 16.", scale);
    return ST_OK;
}

enum status frame_part_camera(struct view *camera, const struct frame_part *part, struct err *err)
{
    if (part->width) {
        if (part->x > camera->width - part->width || part->y > camera->height - part->height)
            return err_set(err, ST_USAGE,
                           "--crop %d,%d,%d,%d is not inside the picture of %s, which has %d x %d pixels.", part->x,
                           part->y, part->width, part->height, camera->name, camera->width, camera->height);
        camera->cx -= part->x;
        camera->cy -= part->y;
        camera->width = part->width;
        camera->height = part->height;
    }
    if (part->scale == 1) return ST_OK;
    const int width = (int)lround(camera->width * part->scale), height = (int)lround(camera->height * part->scale);
    if (width < 1 || height < 1 || width > 65536 || height > 65536)
        return err_set(
            err, ST_USAGE,
            "--scale %g gives a picture of %d x %d pixels for %s, from %d x %d: wanted 1 to 65536 on a side.",
            part->scale, width, height, camera->name, camera->width, camera->height);
    view_resize(camera, width, height);
    return ST_OK;
}

static enum status measure_holes(double *h, const struct rendered_frame *f, struct err *err)
{
    const size_t pixels = (size_t)f->width * (size_t)f->height;
    float *scratch = malloc(pixels * sizeof *scratch);
    if (scratch)
        hole_measure(h, f->hole, f->width, f->height, scratch, err);
    else
        err_nomem(err, "distances in holes", pixels * sizeof *scratch);
    free(scratch);
    return err->status;
}

static enum status frame_write(const struct rendered_frame *f, const struct view *camera, bool with_holes,
                               const char *file, const struct provenance *prov, struct err *err)
{
    const size_t pixels = (size_t)f->width * (size_t)f->height;
    struct exr_image im = {0};
    struct exr_plane *plane;
    double h = 0;

    if (!measure_holes(&h, f, err) && !exr_init_rgba(&im, f->rgba, f->width, f->height, err) &&
        !exr_add_plane(&im, "Z", EXR_FLOAT, &plane, err))
        memcpy(plane->f, f->z, pixels * sizeof *f->z);
    if (!err->status && with_holes && !exr_add_plane(&im, "hole", EXR_HALF, &plane, err))
        for (size_t p = 0; p < pixels; p++) plane->f[p] = f->hole[p];
    view_image_set_camera(&im, camera);
    if (!err->status && !exr_set_number(&im, "remodel:holes", f->hole_fraction, err))
        exr_set_number(&im, "remodel:unfilled", f->unfilled_fraction, err);
    if (!err->status && isfinite(h)) exr_set_number(&im, "remodel:h", h, err);
    if (!err->status) exr_write(&im, file, prov, err);
    exr_image_release(&im);
    return err->status;
}

enum status frames_render(const struct camera_path *path, const bool *wanted, struct renderer *renderer,
                          const char *folder, const struct provenance *prov, struct err *err)
{
    struct rendered_frame frame = {0};
    struct progress progress;
    char file[FILE_PATH];
    int count = 0;

    for (int i = 0; i < path->frame_count; i++) count += wanted[i];
    progress_start(&progress, "rendering", count, "frames");
    for (int i = 0; !err->status && i < path->frame_count; i++) {
        const struct view *camera = &path->frames[i].camera;
        if (!wanted[i]) continue;
        if (!product_path_in(file, folder, PRODUCT_FRAME, &(struct product_key){.frame = camera->name}, err))
            renderer_frame(renderer, i, &frame, err);
        if (!err->status && frame.hole_fraction >= 1)
            err_set(err, ST_DATA,
                    "frame %d of the path sees nothing of the scene: no view covers any of its pixels. "
                    "Check its pose in the path, or plan the path again.",
                    i + 1);
        if (!err->status) frame_write(&frame, camera, false, file, prov, err);
        progress_add(&progress, 1);
    }
    progress_end(&progress);
    rendered_frame_release(&frame);
    return err->status;
}

enum status frame_select_cameras(bool *wanted, const struct camera_set *cameras, const char *const *names, int count,
                                 struct err *err)
{
    for (int i = 0; i < cameras->view_count; i++) wanted[i] = count == 0;
    for (int i = 0; i < count; i++) {
        int at = camera_set_find(cameras, names[i]);
        if (at < 0)
            return err_set(err, ST_USAGE,
                           "--camera %s: the folder of --cameras has no camera of this name; its first camera is %s.",
                           names[i], cameras->views[0].name);
        wanted[at] = true;
    }
    return ST_OK;
}

enum status frame_render_cameras(const struct camera_set *cameras, const bool *wanted, struct renderer *renderer,
                                 const char *folder, const struct provenance *prov, struct err *err)
{
    struct progress progress;
    int count = 0;

    for (int i = 0; i < cameras->view_count; i++) count += wanted[i];
    progress_start(&progress, "rendering", count, "frames");
    for (int i = 0; !err->status && i < cameras->view_count; i++) {
        const struct view *camera = &cameras->views[i];
        struct rendered_frame frame = {0};
        char file[FILE_PATH];
        if (!wanted[i]) continue;
        if (!product_path_in(file, folder, PRODUCT_HELD_FRAME, &(struct product_key){.view = camera->name}, err))
            renderer_camera(renderer, camera, &frame, err);
        if (!err->status && frame.hole_fraction >= 1)
            log_warn("camera %s sees nothing of the scene: its frame is empty", camera->name);
        if (!err->status) frame_write(&frame, camera, true, file, prov, err);
        rendered_frame_release(&frame);
        progress_add(&progress, 1);
    }
    progress_end(&progress);
    return err->status;
}
