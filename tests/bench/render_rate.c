/* render_rate.c - how fast frames of a camera move are rendered, files apart.
 *
 *   render_rate --views DIR --depth DIR --path DIR [--renderer fast|coverage] [--frames N] [--width W --height H]
 *
 * The frames are N that are spread over the move, each as large as said. Prints "frames_per_s F", "core_ms M" (processor
 * time of a frame), "holes H" (% of all pixels) and "peak_mib P". */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

#include "common/camera_path.h"
#include "common/cli.h"
#include "common/layer_render.h"

static double now(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void resize(struct view *v, int width, int height)
{
    const double scale = (double)width / v->width;
    v->cx = 0.5 * width + (v->cx - 0.5 * v->width) * scale;
    v->cy = 0.5 * height + (v->cy - 0.5 * v->height) * scale;
    v->fx *= scale;
    v->fy *= scale;
    v->width = width;
    v->height = height;
}

static enum status measure(const struct layer_scene *scene, const struct camera_path *path, const char *renderer,
                           int frames, int width, int height, struct err *err)
{
    const struct layer_render_options options = {.soft_z = SOFT_Z_WIDTHS, .fill_diameter = 6};
    struct rendered_frame frame = {0};
    double wall = 0, cpu = 0, holes = 0;
    enum status st = ST_OK;

    for (int i = -1; !st && i < frames; i++) { /* the first is a warm-up */
        const int n = i < 0 ? 0 : (int)((long)i * (path->frame_count - 1) / (frames > 1 ? frames - 1 : 1));
        struct view camera = path->frames[n].camera;
        resize(&camera, width, height);
        const double wall_begin = now(CLOCK_MONOTONIC), cpu_begin = now(CLOCK_PROCESS_CPUTIME_ID);
        st = strcmp(renderer, "coverage") == 0 ? layer_coverage(&frame, scene, &camera, 1, err)
                                               : layer_render(&frame, scene, &camera, &options, err);
        if (i < 0) continue;
        wall += now(CLOCK_MONOTONIC) - wall_begin;
        cpu += now(CLOCK_PROCESS_CPUTIME_ID) - cpu_begin;
        holes += frame.hole_fraction;
    }
    rendered_frame_release(&frame);
    if (st) return st;
    struct rusage use;
    getrusage(RUSAGE_SELF, &use);
    printf("frames_per_s %.4g\ncore_ms %.4g\nholes %.4g\npeak_mib %.1f\n", frames / wall, 1e3 * cpu / frames,
           1e2 * holes / frames, (double)use.ru_maxrss / 1024);
    return ST_OK;
}

int main(int argc, char **argv)
{
    const char *views = NULL, *depth = NULL, *folder = NULL, *renderer = "fast", *frames = "20", *width = "1200",
               *height = "800";
    const struct cli_opt opts[] = {
        CLI_ABOUT("How fast frames of a camera move are rendered, files apart."),
        CLI_STR("views", &views, CLI_REQUIRED, "folder of cameras"),
        CLI_STR("depth", &depth, CLI_REQUIRED, "folder of layered depth maps"),
        CLI_STR("path", &folder, CLI_REQUIRED, "folder of the move: path.txt and path/"),
        CLI_STR("renderer", &renderer, CLI_OPTIONAL, "fast or coverage"),
        CLI_STR("frames", &frames, CLI_OPTIONAL, "how many, spread over the move"),
        CLI_STR("width", &width, CLI_OPTIONAL, "of a frame, px"),
        CLI_STR("height", &height, CLI_OPTIONAL, "of a frame, px"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct camera_set set = {0};
    struct camera_path path = {0};
    struct layer_scene scene = {0};
    struct err err = ERR_INIT;

    if (cli_parse(argc, argv, "render_rate", opts, &prov, &err) == CLI_RUN && !camera_set_read(&set, views, &err) &&
        !camera_path_read(&path, folder, &err) && !layer_scene_read(&scene, &set, depth, NULL, &err))
        measure(&scene, &path, renderer, atoi(frames), atoi(width), atoi(height), &err);
    err_report(&err);
    layer_scene_release(&scene);
    camera_path_release(&path);
    camera_set_release(&set);
    provenance_release(&prov);
    return err_exit_code(&err);
}
