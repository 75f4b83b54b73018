/* plan_path.c - plans a camera move that shows depth but not holes, or computes a film of keys or of given cameras.
 *
 * reads   VIEWS/cameras.txt, images.txt, points3D.txt   the cameras
 *         for a move:
 *         FILM_VIEWS                                    with --film-views: the views that are used
 *         DEPTH/VIEW.exr, VIEW.txt                      the layers of these views
 *         VALIDITY, SUBJECTS                            the move's valid viewpoints; the scene's subjects
 *         for a keyframed film:
 *         FILE                                          with --keyframes: the film
 *         MOVES/EFFECT/path.txt, path/NAME.txt,         with --moves: the moves that it uses and their effect layers
 *         effects.txt
 *         VIEWS/lenses.txt, RECORDS/ID.txt              with --records: the orientation of the photos
 *         for a film of given cameras:
 *         CAMERAS                                       with --cameras: transforms.json, or a folder of COLMAP text
 * writes  OUT/path/{cameras,images,points3D}.txt        the frames' cameras
 *         OUT/effects.txt                               the film's effect layers, even if there are none
 *         OUT/path.txt                                  scores and times
 *         OUT/blender.py, transforms.json               the same path for other programs
 *         OUT/frames.mk                                 FRAMES := 0001 0002 ..., written last: if it is new, so is the
 * rest */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/capture/central_views.h"
#include "common/capture/upright.h"
#include "common/film/film_lens.h"
#include "common/film/film_views.h"
#include "common/product/product.h"
#include "stages/plan_path/given_path.h"
#include "stages/plan_path/keyframed_film.h"
#include "stages/plan_path/path_export.h"
#include "stages/plan_path/plan_move.h"

static enum status write_frames(const struct camera_path *path, const char *out, struct err *err)
{
    struct outfile f = {0};
    char name[FILE_PATH];
    if (!product_path_in(name, out, PRODUCT_FRAMES_MK, NULL, err)) outfile_open(&f, name, err);
    if (!err->status) {
        fputs("FRAMES :=", f.fp);
        for (int i = 0; i < path->frame_count; i++) fprintf(f.fp, " %s", path->frames[i].camera.name);
        fputc('\n', f.fp);
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
}

/* Writes the path and the effect layers, which may be none, for render_views and for other programs. */
static enum status write_film(const struct camera_path *path, const struct effects *layers, const char *out,
                              const struct provenance *prov, struct err *err)
{
    char name[FILE_PATH];
    return product_path_in(name, out, PRODUCT_EFFECTS, NULL, err) || effects_write(layers, name, prov, err) ||
                   camera_path_write(path, out, prov, err) || path_export_write(path, out, prov, err) ||
                   write_frames(path, out, err)
               ? err->status
               : ST_OK;
}

#define STILL_ANGLE    1.0  /* degrees; a film that moves through less */
#define STILL_PARALLAX 0.02 /* of the frame area, and shows less, seems to stand still; stages/plan_path/run.sh */

static void log_summary(const struct camera_path *path, const struct move_notes *n, const struct validity *v)
{
    const struct move_ends *e = &n->ends, *d = &n->chosen.discrete;
    log_note("%d frames of %d x %d: %.1f degrees at the scene's centroid, %.3g median depths long", path->frame_count,
             path->frames[0].camera.width, path->frames[0].camera.height, e->angle, e->length / v->shot.median_depth);
    log_note(
        "parallax %.2f %% of the frame area (best of the %d longest pairs: %.2f %%), worst H %.2g at %.0f %% of the "
        "path (%.2g)",
        100 * e->parallax, n->chosen.longest, 100 * d->parallax, e->worst_h, 100 * e->worst_at, d->worst_h);
    if (n->is_static)
        log_warn("no move is valid on its whole path: the camera does not move");
    else if (e->angle < STILL_ANGLE && e->parallax < STILL_PARALLAX)
        log_warn("the camera moves through only %.2g degrees and shows hardly any parallax", e->angle);
    if (!n->is_static && n->chosen.chosen < 0)
        log_note("the ends were drawn in towards the origin: no pair of cells with a valid path gave as much parallax");
    if (!e->valid)
        log_warn("a part of the path is not valid: H is up to %.3g, the limit is %.3g", e->worst_h, v->limits.max_h);
    if (v->effect.focus && !(n->aperture > 0))
        log_warn("the aperture cannot open without showing holes: all frames are pinhole");
    else if (v->effect.focus)
        log_note("the aperture opens to %.3g scene units: distant points are blurred by %.1f px%s", n->aperture,
                 n->blur, n->blur < 1 ? ", which is hardly visible" : "");
}

/* Reads the views and, given records, their upright directions. The caller frees *ups. */
static enum status read_views(struct camera_set *set, struct vec3 **ups, const char *views, const char *records,
                              struct provenance *prov, struct err *err)
{
    if (camera_set_read(set, views, prov, err) || !records) return err->status;
    *ups = calloc((size_t)set->view_count + 1, sizeof **ups);
    return *ups ? upright_read(*ups, set, views, records, prov, err)
                : err_nomem(err, "upright directions", (size_t)set->view_count * sizeof **ups);
}

struct job { /* the command line */
    const char *views, *film_views, *records, *depth, *validity, *subjects, *keyframes, *moves, *cameras, *effect, *out;
    struct plan_params params;
};

static enum status make_film(const struct job *job, struct provenance *prov, struct err *err)
{
    struct camera_set set = {0};
    struct camera_path path = {0};
    struct effects layers = {0};
    struct vec3 *ups = NULL;
    int *order = NULL;
    struct film_settings film = {.name = job->effect, .fps = job->params.fps, .moves = job->moves};
    read_views(&set, &ups, job->views, job->records, prov, err);
    if (!err->status && !set.view_count)
        err_set(err, ST_DATA, "%s has no views, so no film can be planned; check that SfM placed the photographs.",
                job->views);
    if (!err->status && !(order = malloc((size_t)set.view_count * sizeof *order)))
        err_nomem(err, "views", (size_t)set.view_count * sizeof *order);
    if (!err->status && !central_views(order, &set, err)) {
        film.set = &set;
        film.ups = ups;
        film.rest = !strcmp(job->params.ease, "smooth");
        const struct film_size size = {job->params.width, job->params.height, job->params.max_side};
        film_lens(&film.lens, &film.up, &set, order[0], ups, &size);
        keyframed_path(&path, &layers, job->keyframes, &film, prov, err);
    }
    if (!err->status) write_film(&path, &layers, job->out, prov, err);
    if (!err->status)
        log_note("%d frames of %d x %d in %d shots, %d effect layers", path.frame_count, film.lens.width,
                 film.lens.height, path.score_count, layers.layer_count);
    camera_path_release(&path);
    effects_release(&layers);
    camera_set_release(&set);
    free(order);
    free(ups);
    return err->status;
}

static enum status make_given(const struct job *job, struct provenance *prov, struct err *err)
{
    struct camera_set set = {0};
    struct camera_path path = {0};
    struct effects none = {0};
    if (!camera_set_read(&set, job->views, prov, err) &&
        !given_path_read(&path, job->cameras, job->effect, job->params.fps, &set, prov, err) &&
        !write_film(&path, &none, job->out, prov, err))
        log_note("%d frames of %d x %d, as given", path.frame_count, path.frames[0].camera.width,
                 path.frames[0].camera.height);
    camera_path_release(&path);
    camera_set_release(&set);
    return err->status;
}

static enum status make_move(const struct job *job, struct provenance *prov, struct err *err)
{
    struct camera_set set = {0};
    struct layer_scene scene = {0};
    struct validity v = {0};
    struct subject_list subjects = {0};
    struct camera_path path = {0};
    struct effects layers = {0};
    struct move_notes notes = {0};
    struct film_effect effect;
    if (!film_effect_parse(&effect, job->effect, err) && !read_views(&set, NULL, job->views, NULL, prov, err) &&
        !film_views_keep(&set, job->film_views, prov, err))
        validity_read(&v, job->validity, prov, err);
    if (!err->status && v.effect.move != effect.move)
        err_set(err, ST_USAGE, "--effect %s: %s is of another move; run sample_validity for this one.", job->effect,
                job->validity);
    v.effect = effect;
    if (!err->status && job->subjects) subject_list_read(&subjects, job->subjects, prov, err);
    if (!err->status && !layer_scene_read(&scene, &set, job->depth, prov, err) &&
        !plan_move(&path, &layers, &notes, &scene, &v, &subjects, &job->params, err) &&
        !write_film(&path, &layers, job->out, prov, err))
        log_summary(&path, &notes, &v);
    camera_path_release(&path);
    effects_release(&layers);
    subject_list_release(&subjects);
    validity_release(&v);
    layer_scene_release(&scene);
    camera_set_release(&set);
    return err->status;
}

static enum status run(const struct job *job, struct provenance *prov, struct err *err)
{
    const bool move = job->depth && job->validity && !job->keyframes && !job->moves;
    const bool keys = job->keyframes && !job->depth && !job->validity && !job->subjects && !job->film_views;
    const bool given = job->cameras && !job->depth && !job->validity && !job->subjects && !job->film_views &&
                       !job->keyframes && !job->moves && !job->records;
    if (job->cameras ? !given : !move && !keys)
        return err_set(err, ST_USAGE,
                       "wanted --depth with --validity (and --subjects, --film-views) for a move, --keyframes (and "
                       "--moves, --records) for a keyframed film, or --cameras for a film of given cameras.");
    if (given) return make_given(job, prov, err);
    return job->keyframes ? make_film(job, prov, err) : make_move(job, prov, err);
}

int main(int argc, char **argv)
{
    struct job job = {.params = PLAN_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Plans a camera move that shows a scene's depth but not its holes, or computes a film of keys or of "
                  "given cameras."),
        CLI_STR("views", &job.views, CLI_REQUIRED, "folder of cameras"),
        CLI_STR("effect", &job.effect, CLI_REQUIRED,
                "effect of the taxonomy, such as dolly_in+dim, or name of the keyframed film"),
        CLI_STR("film-views", &job.film_views, CLI_OPTIONAL,
                "views that moves are made from (choose_views); default: all"),
        CLI_STR("depth", &job.depth, CLI_OPTIONAL, "folder of the views' layers, for a move"),
        CLI_STR("validity", &job.validity, CLI_OPTIONAL, "file of the move's valid viewpoints"),
        CLI_STR("subjects", &job.subjects, CLI_OPTIONAL, "file of the scene's subjects, for a move that needs any"),
        CLI_STR("keyframes", &job.keyframes, CLI_OPTIONAL, "file of a keyframed film"),
        CLI_STR("moves", &job.moves, CLI_OPTIONAL, "folder of the planned moves that a keyframed film may use"),
        CLI_STR("cameras", &job.cameras, CLI_OPTIONAL,
                "cameras of the frames: transforms.json, or a folder of cameras.txt and images.txt"),
        CLI_STR("records", &job.records, CLI_OPTIONAL,
                "folder of the photos' records, which make a keyframed film upright"),
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
