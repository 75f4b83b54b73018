/* simulate.c - photographs of a described scene, with their ground truth.
 *
 * reads   SCENE/scene.txt (or scene-EDIT.txt), its meshes, SCENE/cameras.txt      docs/scenes.md
 * writes  --photo NAME: OUT/photos/NAME_eK.jpg, or OUT/lri/NAME_eK.jpg for a reference image;
 *         OUT/truth/{depth,ids,hdr}/NAME.exr, of a witness OUT/truth/novel/{depth,ids,hdr}/NAME.exr;
 *         for an edited scene only OUT/truth/edited-EDIT/{depth,ids,hdr}/NAME.exr;
 *         with --kind shell OUT/truth/shell/{depth,ids,hdr}/NAME.exr, and with --kind irradiance
 *         OUT/truth/irradiance/NAME.exr or OUT/truth/edited-EDIT/irradiance/NAME.exr, in place of these
 *         --common: OUT/truth/{scene,faces,cameras,images,points3D,irradiance}.txt, the cameras of witnesses and
 *         reference images in OUT/truth/{novel,lri}, OUT/lri/exposures.txt, and last OUT/photos.mk; for an edited
 *         scene OUT/truth/edited-EDIT/{scene,faces,cameras,images,points3D}.txt
 *         --estimate: to the standard output, how long each kind of picture takes
 *         --points FILE: OUT/truth/irradiance-points.txt or OUT/truth/edited-EDIT/irradiance-points.txt
 *
 * One process makes one photo, or all with `--photo all`. Each file appears whole or not at all. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "stages/simulate/render_estimate.h"
#include "stages/simulate/scene_truth.h"
#include "stages/simulate/true_irradiance.h"

struct request {
    const char *scene, *out, *edit, *photo, *kind, *points;
    bool common, estimate;
};

/* The scenes of a run: `plain` is scene.txt, `shown` the edited scene, or the same. */
struct worlds {
    struct world plain, edited;
    struct world *shown;
    char folder[200]; /* of the truth of `shown`, under OUT */
};

static bool is_kind(const struct request *r, const char *kind) { return !strcmp(r->kind, kind); }

static enum status make_picture(const struct request *r, struct worlds *w, const struct picture_job *job,
                                const struct shoot_photo *photo, struct err *err)
{
    if (is_kind(r, "irradiance"))
        return irradiance_picture(job, &w->plain, r->edit ? &w->edited : NULL, photo, w->folder, err);
    w->shown->shell = is_kind(r, "shell");
    if (w->shown->shell) return photo_make_truth(job, w->shown, photo, "truth/shell", err);
    return r->edit ? photo_make_truth(job, w->shown, photo, w->folder, err) : photo_make(job, w->shown, photo, err);
}

/* Moves the sun for a photo that has one of its own, and back after it (`photo` NULL). */
static enum status move_sun(struct worlds *w, const struct shoot_photo *photo, const struct sun sun[2], struct err *err)
{
    struct world *const all[2] = {&w->plain, &w->edited};
    for (int i = 0; !err->status && i < 2; i++) {
        if (!all[i]->scene.item_count) continue; /* not needed in this run */
        if (photo && !all[i]->scene.sky.has_sun)
            return err_set(err, ST_DATA, "photo %s moves the sun, but its scene has none; add a sun to the scene.",
                           photo->name);
        if (all[i]->scene.sky.has_sun)
            path_world_move_sun(all[i], photo ? photo->sun_azimuth : sun[i].azimuth,
                                photo ? photo->sun_elevation : sun[i].elevation, err);
    }
    return err->status;
}

static enum status make_photos(const struct request *r, struct worlds *w, const struct picture_job *job,
                               struct err *err)
{
    const struct shoot *s = job->shoot;
    const struct sun sun[2] = {w->plain.scene.sky.sun, w->edited.scene.sky.sun};
    const bool all = !strcmp(r->photo, "all"), photos_only = r->edit || !is_kind(r, "photo");
    if (!all && shoot_find(s, r->photo) < 0)
        return err_set(err, ST_USAGE,
                       "there is no photo, witness or reference image %s in %s/cameras.txt; give the name of one, or "
                       "all.",
                       r->photo, r->scene);
    for (int i = 0; !err->status && i < s->photo_count; i++) {
        const struct shoot_photo *photo = &s->photos[i];
        if (all ? photos_only && photo->kind == SHOOT_REFERENCE : strcmp(photo->name, r->photo)) continue;
        if (photo->own_sun) move_sun(w, photo, sun, err);
        if (!err->status) make_picture(r, w, job, photo, err);
        if (!err->status && photo->own_sun) move_sun(w, NULL, sun, err);
    }
    return err->status;
}

static enum status check_request(const struct request *r, struct err *err)
{
    if (!r->common && !r->photo && !r->points && !r->estimate)
        return err_set(err, ST_USAGE,
                       "nothing to do; give --photo NAME, --photo all, --common, --points FILE or --estimate.");
    if (r->edit && strchr(r->edit, '/'))
        return err_set(err, ST_USAGE, "--edit %s is not the name of an edit; give the E of a file scene-E.txt in %s.",
                       r->edit, r->scene);
    if (r->edit && strlen(r->edit) > 100)
        return err_set(err, ST_USAGE, "--edit has a name of %zu characters; give at most 100.", strlen(r->edit));
    if (!is_kind(r, "photo") && !is_kind(r, "shell") && !is_kind(r, "irradiance"))
        return err_set(err, ST_USAGE, "--kind %s is unknown; give photo, shell or irradiance.", r->kind);
    if (r->edit && is_kind(r, "shell"))
        return err_set(err, ST_USAGE, "--kind shell shows the unedited scene; leave out --edit, or --kind.");
    return ST_OK;
}

static enum status read_worlds(struct worlds *w, const struct request *r, const struct simulate_params *params,
                               struct provenance *prov, struct err *err)
{
    char *file = NULL;
    const bool both = r->edit && r->photo && is_kind(r, "irradiance");
    w->shown = r->edit ? &w->edited : &w->plain;
    snprintf(w->folder, sizeof w->folder, r->edit ? "truth/edited-%s" : "truth", r->edit);
    if (asprintf(&file, "scene-%s.txt", r->edit ? r->edit : "") < 0) return err_nomem(err, "a file name", 0);
    if (r->edit) path_world_read(&w->edited, r->scene, file, prov, err);
    if (!err->status && (!r->edit || both)) path_world_read(&w->plain, r->scene, "scene.txt", prov, err);
    w->plain.max_bounces = w->edited.max_bounces = params->max_bounces;
    free(file);
    return err->status;
}

static enum status simulate(const struct request *r, const struct simulate_params *params, struct provenance *prov,
                            struct err *err)
{
    struct worlds w = {0};
    struct shoot shoot = {0};
    const struct picture_job job = {&shoot, r->out, params, prov};
    if (!check_request(r, err) && !read_worlds(&w, r, params, prov, err))
        shoot_read(&shoot, r->scene, params->scale, prov, err);
    if (!err->status && r->estimate) estimate_print(stdout, &job, w.shown, err);
    if (!err->status && r->points) irradiance_points(&job, w.shown, r->points, w.folder, err);
    if (!err->status && r->common) {
        if (r->edit)
            truth_write_edited(w.shown, &shoot, r->scene, r->out, r->edit, prov, err);
        else
            truth_write(w.shown, &shoot, r->scene, r->out, params, prov, err);
    }
    if (!err->status && r->photo) make_photos(r, &w, &job, err);
    shoot_release(&shoot);
    path_world_release(&w.plain);
    path_world_release(&w.edited);
    return err->status;
}

int main(int argc, char **argv)
{
    struct request r = {.kind = "photo"};
    struct simulate_params params = SIMULATE_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Renders photographs of a described scene, and their ground truth."),
        CLI_STR("scene", &r.scene, CLI_REQUIRED, "folder of scene.txt and cameras.txt"),
        CLI_STR("out", &r.out, CLI_REQUIRED, "folder to write to"),
        CLI_STR("photo", &r.photo, CLI_OPTIONAL, "name of the photo, witness or reference image to make, or all"),
        CLI_STR("kind", &r.kind, CLI_OPTIONAL,
                "photo (default): photos and their truth; shell: truth without furniture; irradiance: a picture of it"),
        CLI_FLAG("common", &r.common, "write the files that all photos share: cameras, faces, irradiance, lists"),
        CLI_STR("edit", &r.edit, CLI_OPTIONAL,
                "E: use the edited scene scene-E.txt in place of scene.txt, with the same cameras"),
        CLI_STR("points", &r.points, CLI_OPTIONAL, "file of X Y Z NX NY NZ: points at which to compute the irradiance"),
        CLI_FLAG("estimate", &r.estimate, "print how long each kind of picture takes on this machine"),
        CLI_PARAMS(simulate_param_table, &params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "simulate", opts, &prov, &err) != CLI_RUN || simulate(&r, &params, &prov, &err))
        err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
