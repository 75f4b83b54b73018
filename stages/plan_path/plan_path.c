/* plan_path.c - plans a camera move that shows a scene's depth without showing its holes, or the film of a file of keys.
 *
 * reads   VIEWS/cameras.txt, images.txt, points3D.txt   the cameras
 *         VIEWS/lenses.txt, RECORDS/ID.txt              with --records: which way up the photos are
 *         DEPTH/VIEW.exr, VIEW.txt                      every view's layers; or
 *         FILE, MOVES/EFFECT/path.txt, path/NAME.txt,   with --keyframes: the film, the moves that it chains
 *         effects.txt                                   and their effect layers
 * writes  OUT/path/{cameras,images,points3D}.txt        the frames' cameras
 *         OUT/effects.txt                               with --keyframes: the film's effect layers
 *         OUT/path.txt                                  scores and times
 *         OUT/blender.py, transforms.json               the same move for other programs
 *         OUT/frames.mk                                 FRAMES := 0001 0002 ..., last: if it is new, so is the rest */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/cli.h"
#include "common/log.h"
#include "common/outfile.h"
#include "common/upright.h"
#include "stages/plan_path/establishing_dolly.h"
#include "stages/plan_path/film.h"
#include "stages/plan_path/film_lens.h"
#include "stages/plan_path/path_export.h"

enum { PATH_SIZE = 4096 };

static enum status join(char out[PATH_SIZE], const char *folder, const char *file, const char *suffix, struct err *err)
{
    if (snprintf(out, PATH_SIZE, "%s/%s%s", folder, file, suffix) < PATH_SIZE) return ST_OK;
    return err_set(err, ST_IO, "the path %s/%s%s is too long.", folder, file, suffix);
}

static enum status add_input(struct provenance *prov, const char *name, const char *folder, const char *file,
                             struct err *err)
{
    char path[PATH_SIZE];
    if (join(path, folder, file, "", err) || provenance_add_file(prov, name, path, err)) return err->status;
    return ST_OK;
}

static enum status write_frames(const struct camera_path *path, const char *out, struct err *err)
{
    struct outfile f = {0};
    char name[PATH_SIZE];
    enum status st = join(name, out, "frames.mk", "", err) || outfile_open(&f, name, err) ? err->status : ST_OK;
    if (!st) {
        fputs("FRAMES :=", f.fp);
        for (int i = 0; i < path->frame_count; i++) fprintf(f.fp, " %s", path->frames[i].camera.name);
        fputc('\n', f.fp);
        st = outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return st;
}

static void tell(const struct camera_path *path, const struct dolly_notes *notes, const struct plan_params *params)
{
    double parallax = 0, angle = 0;
    for (int i = 0; i < path->score_count; i++) {
        if (!strcmp(path->scores[i].name, "parallax")) parallax = path->scores[i].value;
        if (!strcmp(path->scores[i].name, "angle")) angle = path->scores[i].value;
    }
    log_note("%d frames of %d x %d around view %s: %.1f degrees at the scene's centroid, %.0f px of parallax",
             path->frame_count, path->frames[0].camera.width, path->frames[0].camera.height, notes->center_view, angle,
             parallax);
    if (notes->zoom > 1)
        log_note("zoomed in by %.0f %% to keep holes and the photos' borders out of the frames",
                 100 * (notes->zoom - 1));
    if (notes->hole_limit > params->max_holes)
        log_warn("even view %s leaves more than %.3g %% of the frame uncovered; allowing %.3g %%", notes->center_view,
                 100 * params->max_holes, 100 * notes->hole_limit);
    if (notes->outside_limit > params->max_outside)
        log_warn("even at view %s more than %.3g %% of the frame lies beyond the views' borders; allowing %.3g %%",
                 notes->center_view, 100 * params->max_outside, 100 * notes->outside_limit);
    if (notes->stands_still) log_warn("no move keeps holes and borders out of the frames: the camera stands still");
}

/* The views and, with records, their upright directions; the caller frees *ups. */
static enum status read_views(struct camera_set *set, struct vec3 **ups, const char *views, const char *records,
                              struct provenance *prov, struct err *err)
{
    enum status st = camera_set_read(set, views, err);
    if (!st) st = add_input(prov, "views/cameras.txt", views, "cameras.txt", err);
    if (!st) st = add_input(prov, "views/images.txt", views, "images.txt", err);
    if (!st) st = add_input(prov, "views/points3D.txt", views, "points3D.txt", err);
    if (st || !records) return st;
    *ups = calloc((size_t)set->view_count + 1, sizeof **ups);
    return *ups ? upright_read(*ups, set, views, records, prov, err)
                : err_nomem(err, "a direction a view", (size_t)set->view_count * sizeof **ups);
}

struct job { /* what the command line says */
    const char *views, *records, *depth, *keyframes, *moves, *effect, *out;
    struct plan_params params;
};

/* The film of a file of keys; its layers, none too, stand beside its path. */
static enum status plan_film(const struct job *job, struct provenance *prov, struct err *err)
{
    struct camera_set set = {0};
    struct camera_path path = {0};
    struct effects layers = {0};
    struct vec3 *ups = NULL;
    struct film film = {.name = job->effect, .fps = job->params.fps, .moves = job->moves};
    char name[PATH_SIZE];
    enum status st = read_views(&set, &ups, job->views, job->records, prov, err);
    if (!st && !set.view_count) st = err_set(err, ST_DATA, "%s has no view: there is no scene to film.", job->views);
    if (!st) {
        film.set = &set;
        film.ups = ups;
        film.rest = !strcmp(job->params.ease, "smooth");
        film_lens(&film.lens, &film.up, &set, ups, &job->params);
        st = keyframed_path(&path, &layers, job->keyframes, &film, prov, err);
    }
    if (!st) st = join(name, job->out, "effects.txt", "", err);
    if (!st) st = effects_write(&layers, name, prov, err);
    if (!st) st = camera_path_write(&path, job->out, prov, err);
    if (!st) st = write_frames(&path, job->out, err);
    if (!st)
        log_note("%d frames of %d x %d in %d shots, %d effect layers", path.frame_count, film.lens.width,
                 film.lens.height, path.score_count, layers.layer_count);
    camera_path_release(&path);
    effects_release(&layers);
    camera_set_release(&set);
    free(ups);
    return st;
}

static enum status plan(const char *views, const char *records, const char *depth, const char *out,
                        const struct plan_params *params, struct provenance *prov, struct err *err)
{
    struct camera_set set = {0};
    struct layer_scene scene = {0};
    struct camera_path path = {0};
    struct dolly_notes notes = {0};
    struct vec3 *ups = NULL;
    enum status st = read_views(&set, &ups, views, records, prov, err);
    if (!st) st = layer_scene_read(&scene, &set, depth, prov, err);
    if (!st) st = plan_establishing_dolly(&path, &notes, &scene, ups, params, err);
    if (!st) st = camera_path_write(&path, out, prov, err);
    if (!st) st = path_export_write(&path, out, prov, err);
    if (!st) st = write_frames(&path, out, err);
    if (!st) tell(&path, &notes, params);
    camera_path_release(&path);
    layer_scene_release(&scene);
    camera_set_release(&set);
    free(ups);
    return st;
}

static enum status run(const struct job *job, struct provenance *prov, struct err *err)
{
    if (job->keyframes) return plan_film(job, prov, err);
    if (!job->depth)
        return err_set(err, ST_USAGE,
                       "--depth is missing, the folder of the views' layers; only a film of keys does without.");
    if (strcmp(job->effect, "establishing_dolly"))
        return err_set(err, ST_USAGE, "there is no effect \"%s\"; the one known is establishing_dolly.", job->effect);
    return plan(job->views, job->records, job->depth, job->out, &job->params, prov, err);
}

int main(int argc, char **argv)
{
    struct job job = {.params = PLAN_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Plans a camera move that shows a scene's depth without showing its holes, or a film of keys."),
        CLI_STR("views", &job.views, CLI_REQUIRED, "folder of cameras"),
        CLI_STR("depth", &job.depth, CLI_OPTIONAL, "folder of the views' layers"),
        CLI_STR("records", &job.records, CLI_OPTIONAL, "folder of the photos' records: makes the film upright"),
        CLI_STR("effect", &job.effect, CLI_REQUIRED, "establishing_dolly; of a film of keys, its name"),
        CLI_STR("keyframes", &job.keyframes, CLI_OPTIONAL, "file of keys and moves to make a film from"),
        CLI_STR("moves", &job.moves, CLI_OPTIONAL, "folder of the planned moves that the film may chain"),
        CLI_STR("out", &job.out, CLI_REQUIRED, "folder to write the path into"),
        CLI_PARAMS(plan_param_table, &job.params, plan_params_check),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "plan_path", opts, &prov, &err) == CLI_RUN) run(&job, &prov, &err);
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
