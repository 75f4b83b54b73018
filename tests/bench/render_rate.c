/* render_rate.c - rendering time of a frame, without files: of a camera move, or of given cameras, whose frames it
 * can write.
 *
 *   render_rate --views DIR --depth DIR --path DIR [--frames N] [--width W --height H] [--coverage]
 *   render_rate --views DIR --depth DIR --cameras DIR [--scale S] [--out DIR]
 *   render_rate --views DIR --cameras DIR --photo [--out DIR]
 *
 * and the parameters of render_views. Of a move, N frames are spread over it, each W x H, rendered separately
 * without aperture and effects. Each of the given cameras makes one frame of its own size times S; the written frame
 * (CAMERA.exr: R, G, B, hole) is resized to the camera's own size by bilinear interpolation, which shows the quality
 * of a reduced picture at full size. --photo is the baseline without rendering: the photo of the view with the
 * nearest centre.
 *
 * All frames are rendered repeatedly until half a second is measured; the first round counts only if it took that
 * long. Prints "seconds S" (per frame), "frames_per_s F", "core_ms M" (CPU time per frame), "core_s_per_mp C" (CPU
 * time per megapixel of the frame at full size, before --scale), "holes H" (% of all pixels) and "peak_mib P" (of
 * the process, reading included). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "common/base/cli.h"
#include "common/base/clock.h"
#include "common/capture/view_image.h"
#include "common/image/exr.h"
#include "stages/render_views/frames.h"

#define SECONDS_MIN 0.5

struct job { /* the command line */
    const char *views, *depth, *path, *cameras, *scale, *out;
    int frames, width, height;
    bool coverage, photo;
    struct render_params params;
};

struct bench {
    struct camera_set set, set_of_cameras;
    struct camera_path path;
    struct layer_scene scene;
    struct renderer renderer;
    const struct view **cameras; /* owned list; the cameras belong to the set or the path */
    struct view *reduced;        /* at the rendered size */
    int count;
};

/* Keeps the field of view of the width and cuts or extends the height: unlike with view_resize(), pixels stay
 * square. */
static void reframe(struct view *v, int width, int height)
{
    const double scale = (double)width / v->width;
    v->cx = 0.5 * width + (v->cx - 0.5 * v->width) * scale;
    v->cy = 0.5 * height + (v->cy - 0.5 * v->height) * scale;
    v->fx *= scale;
    v->fy *= scale;
    v->width = width;
    v->height = height;
}

/* ---------------------------------------------------------------------------------------------- the written frames */

/* Resizes `in` of w x h to `out`: bilinear between pixel centres, constant beyond the outer ones; a copy at equal
 * size. */
static void enlarge(float *out, int out_width, int out_height, const float *in, int w, int h, int channels)
{
    if (out_width == w && out_height == h) {
        memcpy(out, in, (size_t)w * (size_t)h * (size_t)channels * sizeof *out);
        return;
    }
    for (int y = 0; y < out_height; y++) {
        const double v = fmin(fmax((y + 0.5) * h / out_height - 0.5, 0), h - 1);
        const int y0 = (int)v, y1 = y0 + 1 < h ? y0 + 1 : y0;
        for (int x = 0; x < out_width; x++) {
            const double u = fmin(fmax((x + 0.5) * w / out_width - 0.5, 0), w - 1);
            const int x0 = (int)u, x1 = x0 + 1 < w ? x0 + 1 : x0;
            const double a = u - x0, b = v - y0;
            for (int c = 0; c < channels; c++) {
                const double top = (1 - a) * in[((size_t)y0 * (size_t)w + (size_t)x0) * (size_t)channels + (size_t)c] +
                                   a * in[((size_t)y0 * (size_t)w + (size_t)x1) * (size_t)channels + (size_t)c];
                const double low = (1 - a) * in[((size_t)y1 * (size_t)w + (size_t)x0) * (size_t)channels + (size_t)c] +
                                   a * in[((size_t)y1 * (size_t)w + (size_t)x1) * (size_t)channels + (size_t)c];
                out[((size_t)y * (size_t)out_width + (size_t)x) * (size_t)channels + (size_t)c] =
                    (float)((1 - b) * top + b * low);
            }
        }
    }
}

/* rgba and hole: w x h; the file has the camera's size. */
static enum status write_frame(const char *folder, const struct view *camera, const float *rgba, const float *hole,
                               int w, int h, struct err *err)
{
    static const char *const names[] = {"R", "G", "B", "hole"};
    const size_t pixels = (size_t)camera->width * (size_t)camera->height;
    const size_t size = strlen(folder) + strlen(camera->name) + 8;
    struct exr_image im = {0};
    struct exr_plane *plane;
    float *full = malloc(4 * pixels * sizeof *full);
    char *file = malloc(size);

    if (!full || !file)
        err_nomem(err, "a frame", 4 * pixels * sizeof *full);
    else if (!exr_image_init(&im, camera->width, camera->height, err))
        enlarge(full, camera->width, camera->height, rgba, w, h, 4);
    for (size_t k = 0; !err->status && k < 4; k++) {
        if (exr_add_plane(&im, names[k], EXR_HALF, &plane, err)) break;
        if (k == 3) enlarge(plane->f, camera->width, camera->height, hole, w, h, 1);
        for (size_t i = 0; k < 3 && i < pixels; i++) plane->f[i] = full[4 * i + k];
    }
    if (!err->status) {
        snprintf(file, size, "%s/%s.exr", folder, camera->name);
        exr_write(&im, file, NULL, err);
    }
    exr_image_release(&im);
    free(full);
    free(file);
    return err->status;
}

static enum status write_rendered(const char *folder, const struct view *camera, const struct rendered_frame *f,
                                  struct err *err)
{
    const size_t pixels = (size_t)f->width * (size_t)f->height;
    float *hole = malloc(pixels * sizeof *hole);

    if (!hole) return err_nomem(err, "a frame's holes", pixels * sizeof *hole);
    for (size_t i = 0; i < pixels; i++) hole[i] = f->hole[i];
    write_frame(folder, camera, f->rgba, hole, f->width, f->height, err);
    free(hole);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------- measuring */

static void say(int frames, double megapixels, double wall, double cpu, double holes)
{
    struct rusage use;
    getrusage(RUSAGE_SELF, &use);
    printf("seconds %.9g\nframes_per_s %.9g\ncore_ms %.9g\ncore_s_per_mp %.9g\nholes %.4g\npeak_mib %.1f\n",
           wall / frames, frames / wall, 1e3 * cpu / frames, cpu / megapixels, 1e2 * holes / frames,
           (double)use.ru_maxrss / 1024);
}

static enum status measure(struct bench *b, const struct job *job, struct err *err)
{
    struct rendered_frame frame = {0};
    double wall = 0, cpu = 0, holes = 0, megapixels = 0;
    int done = 0;

    for (int round = 0; !err->status && (round == 0 || wall < SECONDS_MIN); round++) {
        if (round == 1) wall = cpu = holes = megapixels = done = 0;
        for (int i = 0; !err->status && i < b->count; i++) {
            const struct view *camera = &b->reduced[i], *shown = job->path ? camera : b->cameras[i];
            const double wall_begin = clock_seconds(), cpu_begin = clock_cpu_seconds();
            if (job->coverage)
                layer_coverage(&frame, &b->scene, camera, 1, err);
            else
                renderer_camera(&b->renderer, camera, &frame, err);
            wall += clock_seconds() - wall_begin;
            cpu += clock_cpu_seconds() - cpu_begin;
            holes += frame.hole_fraction;
            megapixels += 1e-6 * shown->width * shown->height;
            done++;
            if (!err->status && round == 0 && job->out) write_rendered(job->out, b->cameras[i], &frame, err);
        }
    }
    rendered_frame_release(&frame);
    if (!err->status) say(done, megapixels, wall, cpu, holes);
    return err->status;
}

static int nearest_view(const struct camera_set *set, const struct view *camera)
{
    int nearest = 0;
    for (int i = 1; i < set->view_count; i++)
        if (vec3_length(vec3_sub(set->views[i].center, camera->center)) <
            vec3_length(vec3_sub(set->views[nearest].center, camera->center)))
            nearest = i;
    return nearest;
}

/* The photos are in memory: this measures finding and copying one. */
static enum status measure_photos(struct bench *b, const struct job *job, struct err *err)
{
    double wall = 0, cpu = 0, holes = 0, megapixels = 0;

    for (int i = 0; !err->status && i < b->count; i++) {
        const int nearest = nearest_view(&b->set, b->cameras[i]);
        struct image photo = {0}, copy = {0};
        float *hole = NULL;
        view_image_read(&photo, job->views, &b->set.views[nearest], NULL, err);
        const size_t pixels = err->status ? 0 : (size_t)photo.width * (size_t)photo.height;
        if (!err->status) image_init(&copy, photo.width, photo.height, 4, err);
        if (!err->status && !(hole = malloc(pixels * sizeof *hole))) err_nomem(err, "holes", pixels * sizeof *hole);
        if (!err->status) {
            const double wall_begin = clock_seconds(), cpu_begin = clock_cpu_seconds();
            memcpy(copy.data, photo.data, 4 * pixels * sizeof *copy.data);
            wall += clock_seconds() - wall_begin;
            cpu += clock_cpu_seconds() - cpu_begin;
            megapixels += 1e-6 * (double)pixels;
            double missing = 0;
            for (size_t p = 0; p < pixels; p++) missing += hole[p] = !(copy.data[4 * p + 3] > 0);
            holes += missing / (double)pixels;
            if (job->out) write_frame(job->out, b->cameras[i], copy.data, hole, copy.width, copy.height, err);
        }
        image_release(&photo);
        image_release(&copy);
        free(hole);
    }
    if (!err->status) say(b->count, megapixels, wall, cpu, holes);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------ the command line */

static enum status choose_cameras(struct bench *b, const struct job *job, struct err *err)
{
    struct frame_part part;
    frame_part_read(&part, NULL, job->scale, err);

    if (!err->status) {
        if (job->path)
            camera_path_read(&b->path, job->path, NULL, err);
        else
            camera_set_read(&b->set_of_cameras, job->cameras, NULL, err);
    }
    if (err->status) return err->status;
    b->count = job->path ? job->frames : b->set_of_cameras.view_count;
    b->cameras = calloc((size_t)b->count + 1, sizeof *b->cameras);
    b->reduced = calloc((size_t)b->count + 1, sizeof *b->reduced);
    if (!b->cameras || !b->reduced) return err_nomem(err, "cameras", (size_t)b->count);
    for (int i = 0; !err->status && i < b->count; i++) {
        const int last = b->path.frame_count - 1;
        b->cameras[i] = job->path ? &b->path.frames[(long)i * last / (b->count > 1 ? b->count - 1 : 1)].camera
                                  : &b->set_of_cameras.views[i];
        b->reduced[i] = *b->cameras[i];
        if (job->path)
            reframe(&b->reduced[i], job->width, job->height);
        else
            frame_part_camera(&b->reduced[i], &part, err);
    }
    return err->status;
}

static enum status run(struct bench *b, const struct job *job, struct err *err)
{
    static const struct effects none = {0};

    if (!job->path == !job->cameras || !job->depth != job->photo || (job->path && (job->out || job->photo)) ||
        (job->out && job->coverage))
        return err_set(err, ST_USAGE,
                       "wanted --depth with either --path or --cameras, or --photo with --cameras; "
                       "--out goes with --cameras, without --coverage.");
    if (job->frames < 1 || job->width < 1 || job->height < 1 || job->width > 65536 || job->height > 65536)
        return err_set(err, ST_USAGE, "--frames %d --width %d --height %d: wanted numbers from 1, sizes up to 65536.",
                       job->frames, job->width, job->height);
    if (camera_set_read(&b->set, job->views, NULL, err) || choose_cameras(b, job, err)) return err->status;
    if (job->photo) return measure_photos(b, job, err);
    if (layer_scene_read(&b->scene, &b->set, job->depth, NULL, err)) return err->status;
    if (renderer_match_exposures(&b->scene, &job->params, err)) return err->status;
    renderer_init(&b->renderer, &b->scene, NULL, &none, &job->params);
    return measure(b, job, err);
}

int main(int argc, char **argv)
{
    struct job job = {.frames = 20, .width = 1200, .height = 800, .params = RENDER_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Measures the rendering time of frames of a camera move or of given cameras."),
        CLI_STR("views", &job.views, CLI_REQUIRED, "folder of cameras"),
        CLI_STR("depth", &job.depth, CLI_OPTIONAL, "folder of layered depth maps"),
        CLI_STR("path", &job.path, CLI_OPTIONAL, "folder of the move: path.txt and path/"),
        CLI_INT("frames", &job.frames, CLI_OPTIONAL, "number of frames, spread over the move"),
        CLI_INT("width", &job.width, CLI_OPTIONAL, "width of a frame of the move, px"),
        CLI_INT("height", &job.height, CLI_OPTIONAL, "height of a frame of the move, px"),
        CLI_STR("cameras", &job.cameras, CLI_OPTIONAL, "instead of a move: folder of cameras, one frame each"),
        CLI_STR("scale", &job.scale, CLI_OPTIONAL, "factor of the rendered size of the cameras' frames"),
        CLI_FLAG("coverage", &job.coverage, "only find the pixels that a view covers"),
        CLI_FLAG("photo", &job.photo, "instead of rendering: the photo of the nearest view"),
        CLI_STR("out", &job.out, CLI_OPTIONAL, "folder for the cameras' frames, CAMERA.exr"),
        CLI_PARAMS(render_param_table, &job.params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct bench b = {0};
    struct err err = ERR_INIT;

    if (cli_parse(argc, argv, "render_rate", opts, &prov, &err) == CLI_RUN) run(&b, &job, &err);
    err_report(&err);
    renderer_release(&b.renderer);
    layer_scene_release(&b.scene);
    camera_path_release(&b.path);
    camera_set_release(&b.set_of_cameras);
    camera_set_release(&b.set);
    free(b.cameras);
    free(b.reduced);
    provenance_release(&prov);
    return err_exit_code(&err);
}
