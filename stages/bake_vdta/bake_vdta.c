/* bake_vdta.c - view-dependent texture atlases: the faces of the model as one viewpoint sees them, without what hides
 * them.
 *
 * reads   MODEL                                         the unedited model
 *         AXES                                          its frame in the scene
 *         VIEWS/cameras.txt, images.txt                 the cameras
 *         VIEWS/lenses.txt                              which views are of one photo: a viewpoint
 *         VIEWS/VIEW.exr, IDS/VIEW.exr                  the viewpoint's views and those that show hidden texels
 *         THINGS/masks/VIEW.exr                         things that stand before the model
 *         FILL/atlas.txt, page0.exr, ...                texture of what no photo shows
 *         IDS/index.txt                                 which views show a face
 *         REVEAL/VIEW.exr                               what the edits reveal to the viewpoint's views
 * writes  OUT/PHOTO/page0.exr, ..., atlas.txt           an atlas for each photo
 *         DEPS                                          make dependencies: the views that were read
 *
 * With several --photo, what they share is read once. --estimate prints what viewpoints will take instead. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "stages/bake_vdta/bake_estimate.h"

_Static_assert(offsetof(struct vdta_params, texture) == 0, "the table below has offsets into struct texture_params");
static const struct param vdta_param_table[] = {
#define PARAM_STRUCT struct texture_params
    TEXTURE_PARAMS(PARAM_ROW)
#undef PARAM_STRUCT
#define PARAM_STRUCT struct vdta_params
        VDTA_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

static enum status check_params(const void *values, struct err *err)
{
    return texture_params_check(&((const struct vdta_params *)values)->texture, err);
}

struct files {
    const char *model, *axes, *estimate;
    struct cli_list photos, deps;
};

static enum status read_scene(struct bake_scene *s, const struct files *f, struct provenance *prov, struct err *err)
{
    const struct scene_files files = {.views = s->from.views, .axes = f->axes, .mesh = f->model};
    return scene_inputs_read(&s->in, SCENE_CAMERAS | SCENE_LENSES | SCENE_AXES | SCENE_MODEL_VIEWS | SCENE_MESH, &files,
                             prov, err) ||
                   surfaces_make(&s->surfaces, &s->in.mesh, 1, err)
               ? err->status
               : ST_OK;
}

static void release_scene(struct bake_scene *s)
{
    filled_atlas_release(&s->filled);
    surfaces_release(&s->surfaces);
    scene_inputs_release(&s->in);
}

struct job {
    struct bake_scene *scene;
    const struct files *files;
    struct provenance *prov;
};

static enum status bake_one(void *ctx, int i, struct err *err)
{
    const struct job *j = ctx;
    const struct files *f = j->files;
    return viewpoint_bake(j->scene, f->photos.items[i], f->deps.count ? f->deps.items[i] : NULL, j->prov, err);
}

static enum status run(struct job *j, struct err *err)
{
    if (!read_scene(j->scene, j->files, j->prov, err) && j->scene->fill && !j->files->estimate)
        filled_atlas_open(&j->scene->filled, j->scene->fill, j->prov, err);
    if (!err->status && j->files->estimate)
        estimate_print(stdout, j->files->estimate, j->scene, err);
    else if (!err->status)
        cli_make_each(&j->files->photos, bake_one, j, err);
    release_scene(j->scene);
    return err->status;
}

int main(int argc, char **argv)
{
    struct vdta_params params = VDTA_PARAMS_DEFAULT;
    struct bake_scene scene = {.params = &params};
    struct files f = {0};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Bakes view-dependent texture atlases: the model's faces as a viewpoint sees them."),
        CLI_STR("model", &f.model, CLI_REQUIRED, "the unedited model, model.txt"),
        CLI_STR("axes", &f.axes, CLI_REQUIRED, "the model's frame, axes.txt"),
        CLI_STR("views", &scene.from.views, CLI_REQUIRED, "folder of cameras and rectified views"),
        CLI_STR("ids", &scene.from.ids, CLI_REQUIRED, "folder of the faces that each view shows, and of their index"),
        CLI_STR("things", &scene.from.things, CLI_OPTIONAL, "folder of the scene's things: textures leave them out"),
        CLI_STR("fill", &scene.fill, CLI_OPTIONAL,
                "folder of a view-independent atlas of the unedited model: texture of what no photo shows is taken "
                "from it"),
        CLI_STR("reveal", &scene.reveal, CLI_REQUIRED, "folder of what the edits reveal to each view"),
        CLI_LIST("photo", &f.photos, CLI_OPTIONAL, "viewpoint to bake, as a photo's id; repeat for several"),
        CLI_STR("out", &scene.out, CLI_REQUIRED, "folder in which each viewpoint gets a folder"),
        CLI_LIST("deps", &f.deps, CLI_OPTIONAL,
                 "make dependencies to write, one for each --photo or none: the views that were read"),
        CLI_STR("estimate", &f.estimate, CLI_OPTIONAL,
                "file with a photo on each line: bakes nothing, but prints the time and memory that these will take"),
        CLI_PARAMS(vdta_param_table, &params, check_params),
        CLI_END,
    };
    struct provenance prov = {0};
    struct job job = {&scene, &f, &prov};
    struct err err = ERR_INIT;
    const enum cli_verdict verdict = cli_parse(argc, argv, "bake_vdta", opts, &prov, &err);
    if (verdict == CLI_RUN && !f.estimate == !f.photos.count)
        err_set(&err, ST_USAGE, "give --photo, or else --estimate.");
    else if (verdict == CLI_RUN && f.deps.count && f.deps.count != f.photos.count)
        err_set(&err, ST_USAGE, "found %d --photo and %d --deps; give one for each photo, or none.", f.photos.count,
                f.deps.count);
    else if (verdict == CLI_RUN)
        run(&job, &err);
    err_report(&err);
    cli_list_release(&f.deps);
    cli_list_release(&f.photos);
    provenance_release(&prov);
    return err_exit_code(&err);
}
