/* render_model.c - rendering time of a frame of the shell between two viewpoints, without files.
 *
 *   render_model --folder O --vdta DIR --vita DIR --from VIEW --to VIEW [--texture pair|single|vita] [--frames N]
 *                [--width W --height H] [--threads N] [--model FILE]
 *
 * The camera goes from one view to the other in N frames, each with its own pose and its own share of the second
 * viewpoint, from 0 to 1. `pair` blends the textures of both viewpoints, `single` takes the first one's alone, `vita`
 * none. All pages are in memory before anything is measured; then the way is drawn repeatedly until two seconds have
 * passed. Prints "seconds S" (per frame), "frames_per_s F", "core_ms M" (CPU time per frame), "visible_ms M" (time per
 * frame of finding what is visible, measured alone), "shade_ms M" (the rest of the frame) and "bytes_mib M" (of texels
 * in memory). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/clock.h"
#include "common/base/file_path.h"
#include "common/base/parallel.h"
#include "common/model/model_axes.h"
#include "stages/render_model/shell_scene.h"

#define SECONDS_MIN 2.0

struct job { /* the command line */
    const char *folder, *vdta, *vita, *model, *from, *to, *texture;
    int frames, width, height;
};

struct bench {
    struct shell_scene *scene;
    struct view *cameras; /* of each frame */
    char names[2][256];   /* of the viewpoints */
    const char *photos[2];
};

/* A view's photo is its name up to @. */
static void set_photo(char name[256], const char *view) { snprintf(name, 256, "%.*s", (int)strcspn(view, "@"), view); }

static struct view between(const struct view *a, const struct view *b, double t, int width, int height)
{
    const struct quat p = quat_from_mat3(a->cam_from_world), q = quat_from_mat3(b->cam_from_world);
    const double sign = p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z < 0 ? -t : t, rest = 1 - t;
    struct quat r = {rest * p.w + sign * q.w, rest * p.x + sign * q.x, rest * p.y + sign * q.y,
                     rest * p.z + sign * q.z};
    const double length = sqrt(r.w * r.w + r.x * r.x + r.y * r.y + r.z * r.z);
    r = (struct quat){r.w / length, r.x / length, r.y / length, r.z / length};
    const double focal = a->fx * width / a->width;
    struct view v = {.name = "frame",
                     .width = width,
                     .height = height,
                     .fx = focal,
                     .fy = focal,
                     .cx = 0.5 * width,
                     .cy = 0.5 * height};
    v.cam_from_world = mat3_from_quat(r);
    v.center = vec3_add(vec3_scale(a->center, rest), vec3_scale(b->center, t));
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, v.center), -1);
    return v;
}

static enum status find_view(struct view *view, const struct camera_set *set, const char *name,
                             const struct model_axes *axes, struct err *err)
{
    const int at = camera_set_find(set, name);
    if (at < 0) return err_set(err, ST_DATA, "there is no view %s.", name);
    *view = model_from_world_view(axes, &set->views[at]);
    return ST_OK;
}

static enum status set_cameras(struct bench *b, const struct job *j, struct err *err)
{
    struct camera_set set = {0};
    struct model_axes axes;
    struct view from, to;
    char views[FILE_PATH], path[FILE_PATH];
    if (!file_path(views, j->folder, "views", "", err) && !file_path(path, j->folder, "model/axes", ".txt", err) &&
        !camera_set_read_cameras(&set, views, NULL, err) && !model_axes_read(&axes, path, NULL, err) &&
        !find_view(&from, &set, j->from, &axes, err))
        find_view(&to, &set, j->to, &axes, err);
    b->cameras = calloc((size_t)j->frames, sizeof *b->cameras);
    if (!err->status && !b->cameras) err_nomem(err, "cameras", (size_t)j->frames * sizeof *b->cameras);
    for (int i = 0; !err->status && i < j->frames; i++)
        b->cameras[i] = between(&from, &to, i / fmax(j->frames - 1, 1), j->width, j->height);
    camera_set_release(&set);
    return err->status;
}

static enum status open_bench(struct bench *b, const struct job *j, struct err *err)
{
    char model[FILE_PATH];
    if (file_path(model, j->folder, "model/model", ".txt", err)) return err->status;
    const struct shell_files files = {j->model ? j->model : model, NULL, j->vdta, j->vita, 4096};
    set_photo(b->names[0], j->from);
    set_photo(b->names[1], j->to);
    if (strcmp(j->texture, "vita")) b->photos[0] = b->names[0];
    if (!strcmp(j->texture, "pair")) b->photos[1] = b->names[1];
    if (shell_open(&b->scene, &files, NULL, err) || set_cameras(b, j, err)) return err->status;
    return ST_OK;
}

/* All frames once. */
static enum status draw_all(const struct bench *b, const struct job *j, struct model_picture *out, struct err *err)
{
    for (int i = 0; i < j->frames; i++) {
        const double t = i / fmax(j->frames - 1, 1);
        if (shell_draw(out, b->scene, &b->cameras[i], b->photos, t, NULL, err)) return err->status;
    }
    return ST_OK;
}

static enum status find_visible(const struct bench *b, const struct job *j, struct model_picture *out, struct err *err)
{
    (void)out;
    for (int i = 0; i < j->frames; i++)
        if (visible_draw(&b->scene->seen, &b->scene->model, &b->cameras[i], err)) return err->status;
    return ST_OK;
}

struct rate { /* of a frame */
    double seconds, core_seconds;
};

/* The first round, which reads pages and makes room, is not measured. */
static enum status measure(struct rate *r, const struct bench *b, const struct job *j,
                           enum status (*round)(const struct bench *, const struct job *, struct model_picture *,
                                                struct err *),
                           struct err *err)
{
    struct model_picture out = {0};
    round(b, j, &out, err);
    const double begin = clock_seconds(), core_begin = clock_cpu_seconds();
    int rounds = 0;
    while (!err->status && clock_seconds() - begin < SECONDS_MIN) {
        round(b, j, &out, err);
        rounds++;
    }
    const double frames = (double)rounds * j->frames;
    *r = (struct rate){(clock_seconds() - begin) / frames, (clock_cpu_seconds() - core_begin) / frames};
    model_picture_release(&out);
    return err->status;
}

static enum status run(const struct job *j, struct err *err)
{
    struct bench b = {0};
    struct rate frame, visible;
    if (!open_bench(&b, j, err) && !measure(&frame, &b, j, draw_all, err) &&
        !measure(&visible, &b, j, find_visible, err)) {
        printf("seconds %.5g\nframes_per_s %.4g\ncore_ms %.4g\n", frame.seconds, 1 / frame.seconds,
               1e3 * frame.core_seconds);
        printf("visible_ms %.4g\nshade_ms %.4g\n", 1e3 * visible.seconds, 1e3 * (frame.seconds - visible.seconds));
        printf("bytes_mib %.4g\n", (double)page_cache_stats(b.scene->pages).bytes / (1 << 20));
    }
    shell_close(b.scene);
    free(b.cameras);
    return err->status;
}

int main(int argc, char **argv)
{
    struct job j = {.texture = "pair", .frames = 25, .width = 1024, .height = 768};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Measures the rendering of the shell between two viewpoints."),
        CLI_STR("folder", &j.folder, CLI_REQUIRED, "folder of a scene, with views and model"),
        CLI_STR("vdta", &j.vdta, CLI_REQUIRED, "folder of the viewpoints' atlases"),
        CLI_STR("vita", &j.vita, CLI_REQUIRED, "folder of the view-independent atlas"),
        CLI_STR("model", &j.model, CLI_OPTIONAL, "another model than that of the folder"),
        CLI_STR("from", &j.from, CLI_REQUIRED, "view where the camera begins"),
        CLI_STR("to", &j.to, CLI_REQUIRED, "view where it ends"),
        CLI_STR("texture", &j.texture, CLI_OPTIONAL, "pair, single or vita"),
        CLI_INT("frames", &j.frames, CLI_OPTIONAL, "frames on the way"),
        CLI_INT("width", &j.width, CLI_OPTIONAL, "px"),
        CLI_INT("height", &j.height, CLI_OPTIONAL, "px"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "render_model", opts, &prov, &err) == CLI_RUN) run(&j, &err);
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
