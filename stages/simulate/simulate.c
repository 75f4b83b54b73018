/* simulate.c - photographs of a described scene, with their ground truth.
 *
 * reads   SCENE/scene.txt (or scene-EDIT.txt), its meshes, SCENE/cameras.txt      docs/scenes.md
 * writes  --photo NAME: OUT/photos/NAME_eK.jpg, or OUT/lri/NAME_eK.jpg for a reference image;
 *         OUT/truth/{depth,ids,hdr}/NAME.exr; for an edited scene OUT/truth/edited-EDIT/hdr/NAME.exr
 *         --common: OUT/truth/{scene,faces,cameras,images,points3D,irradiance}.txt, OUT/lri/exposures.txt, and last
 *         OUT/photos.mk; for an edited scene OUT/truth/edited-EDIT/{scene,faces}.txt
 *
 * One process makes one photo, or all with `--photo all`. Each file appears whole or not at all. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "stages/simulate/photos.h"
#include "stages/simulate/truth.h"

struct request {
    const char *scene, *out, *edit, *photo;
    bool common;
};

static enum status make_photos(const struct request *r, const struct world *w, const struct shoot *s,
                               const struct simulate_params *params, const struct provenance *prov, struct err *err)
{
    const bool all = !strcmp(r->photo, "all");
    if (!all && shoot_find(s, r->photo) < 0)
        return err_set(err, ST_USAGE,
                       "there is no photo or reference image %s in %s/cameras.txt; give the name of one, or all.",
                       r->photo, r->scene);
    enum status st = ST_OK;
    for (int i = 0; !st && i < s->photo_count; i++) {
        const struct shoot_photo *photo = &s->photos[i];
        if (!all && strcmp(photo->name, r->photo)) continue;
        if (!r->edit)
            st = photo_make(w, s, photo, r->out, params, prov, err);
        else if (!photo->reference || !all)
            st = photo_make_edited(w, s, photo, r->out, r->edit, params, prov, err);
    }
    return st;
}

static enum status simulate(const struct request *r, const struct simulate_params *params, struct provenance *prov,
                            struct err *err)
{
    struct world world = {0};
    struct shoot shoot = {0};
    char *file = NULL;
    if (!r->common && !r->photo)
        return err_set(err, ST_USAGE, "nothing to do; give --photo NAME, --photo all or --common.");
    if (r->edit && strchr(r->edit, '/'))
        return err_set(err, ST_USAGE, "--edit %s is not the name of an edit; give the E of a file scene-E.txt in %s.",
                       r->edit, r->scene);
    if (asprintf(&file, r->edit ? "scene-%s.txt" : "scene.txt", r->edit) < 0) return err_nomem(err, "a file name", 0);
    enum status st = world_read(&world, r->scene, file, prov, err);
    world.max_bounces = params->max_bounces;
    if (!st) st = shoot_read(&shoot, r->scene, params->scale, prov, err);
    if (!st && r->common)
        st = r->edit ? truth_write_edited(&world, r->scene, r->out, r->edit, prov, err)
                     : truth_write(&world, &shoot, r->scene, r->out, params, prov, err);
    if (!st && r->photo) st = make_photos(r, &world, &shoot, params, prov, err);
    shoot_release(&shoot);
    world_release(&world);
    free(file);
    return st;
}

int main(int argc, char **argv)
{
    struct request r = {0};
    struct simulate_params params = SIMULATE_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Renders photographs of a described scene, and their ground truth."),
        CLI_STR("scene", &r.scene, CLI_REQUIRED, "folder of scene.txt and cameras.txt"),
        CLI_STR("out", &r.out, CLI_REQUIRED, "folder to write to"),
        CLI_STR("photo", &r.photo, CLI_OPTIONAL, "name of the photo or reference image to make, or all"),
        CLI_FLAG("common", &r.common, "write the files that all photos share: cameras, faces, irradiance, lists"),
        CLI_STR("edit", &r.edit, CLI_OPTIONAL,
                "E: use the edited scene scene-E.txt in place of scene.txt, with the same cameras"),
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
