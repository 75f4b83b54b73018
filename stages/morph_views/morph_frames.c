/* morph_frames.c - rendering and writing of a morph's frames; see morph_frames.h. */
#include "stages/morph_views/morph_frames.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/file_path.h"
#include "common/base/frame_list.h"
#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "common/capture/camera_path.h"
#include "common/capture/view_image.h"
#include "common/image/exr.h"
#include "common/product/product.h"
#include "stages/morph_views/morph.h"
#include "stages/morph_views/prepare.h"

struct morph_frames_job {
    const struct morph *morph;
    const struct camera_path *path;
    const struct morph_params *params;
    const struct provenance *prov;
    const char *out;
    const int *frames;  /* to render */
    bool posed;         /* the photos' cameras are known */
    struct err *errors; /* one per frame; the first error is reported */
    struct progress progress;
};

static enum status write_frame(const struct morph_frames_job *job, const struct rendered_frame *f,
                               const struct view *camera, double t, struct err *err)
{
    struct exr_image im = {0};
    char path[FILE_PATH];
    if (!product_path_in(path, job->out, PRODUCT_FRAME, &(struct product_key){.frame = camera->name}, err))
        exr_init_rgba(&im, f->rgba, f->width, f->height, err);
    if (job->posed) view_image_set_camera(&im, camera);
    if (!err->status && !exr_set_number(&im, "remodel:holes", f->hole_fraction, err) &&
        !exr_set_number(&im, "remodel:unfilled", f->unfilled_fraction, err) &&
        !exr_set_number(&im, "remodel:t", t, err) &&
        !exr_set_attribute(&im, "remodel:radiometry", job->morph->radiometry, err))
        exr_write(&im, path, job->prov, err);
    exr_image_release(&im);
    return err->status;
}

static void make_frames(void *ctx, size_t begin, size_t end, int thread)
{
    struct morph_frames_job *job = ctx;
    struct rendered_frame frame = {0};
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct err *err = &job->errors[i];
        double t = morph_time(job->frames[i], job->path->frame_count, job->params);
        if (!morph_frame(&frame, job->morph, t, err))
            write_frame(job, &frame, &job->path->frames[job->frames[i]].camera, t, err);
        progress_add(&job->progress, 1);
    }
    rendered_frame_release(&frame);
}

enum status morph_frames(const char *folder, const char *list, const char *out, const struct morph_params *params,
                         struct provenance *prov, struct err *err)
{
    struct morph morph = {0};
    struct camera_path path = {0};
    struct morph_frames_job job = {.morph = &morph, .path = &path, .params = params, .prov = prov, .out = out};
    bool *wanted = NULL;
    int *frames = NULL, count = 0;
    if (!camera_path_read(&path, folder, prov, err)) {
        const size_t n = (size_t)path.frame_count;
        wanted = calloc(n, sizeof *wanted);
        frames = calloc(n, sizeof *frames);
        job.errors = calloc(n, sizeof *job.errors);
        if (!wanted || !frames || !job.errors) err_nomem(err, "a list of frames", n * sizeof *job.errors);
    }
    if (!err->status && !frame_list_read(wanted, path.frame_count, list, err)) morph_read(&morph, folder, prov, err);
    if (!err->status && (morph.pictures[0].width != path.frames[0].camera.width ||
                         morph.pictures[0].height != path.frames[0].camera.height))
        err_set(err, ST_DATA,
                "%s/first.exr has %d x %d pixels, but the frames of path.txt have %d x %d; make the morph again.",
                folder, morph.pictures[0].width, morph.pictures[0].height, path.frames[0].camera.width,
                path.frames[0].camera.height);
    job.posed = morph.posed;
    if (!err->status) {
        for (int i = 0; i < path.frame_count; i++)
            if (wanted[i]) frames[count++] = i;
        job.frames = frames;
        progress_start(&job.progress, "morphing", count, "frames");
        parallel_for((size_t)count, 1, make_frames, &job);
        progress_end(&job.progress);
        for (int i = 0; !err->status && i < count; i++)
            if (job.errors[i].status) err_set(err, job.errors[i].status, "%s", job.errors[i].text);
    }
    morph_release(&morph);
    camera_path_release(&path);
    free(job.errors);
    free(wanted);
    free(frames);
    return err->status;
}
