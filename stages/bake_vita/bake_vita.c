/* bake_vita.c - the view-independent texture atlas: every face of the model, seen orthogonally.
 *
 * reads   MODEL, EDIT...                                the unedited model, those of the edits
 *         AXES                                          their frame in the scene
 *         VIEWS/cameras.txt, images.txt                 the cameras
 *         VIEWS/lenses.txt                              which views are of one photo
 *         VIEWS/VIEW.exr, IDS/VIEW.exr                  the views that show faces best
 *         THINGS/masks/VIEW.exr                         things that stand before the model
 *         IDS/index.txt                                 which views show a face
 * writes  OUT/page0.exr, ..., atlas.txt */
#include <stdlib.h>

#include "common/base/cli.h"
#include "common/base/file_path.h"
#include "common/base/work_estimate.h"
#include "common/light/model_rays.h"
#include "common/product/product.h"
#include "stages/bake_vita/vita.h"

_Static_assert(offsetof(struct vita_params, texture) == 0, "the table below has offsets into struct texture_params");
static const struct param vita_param_table[] = {
#define PARAM_STRUCT struct texture_params
    TEXTURE_PARAMS(PARAM_ROW)
#undef PARAM_STRUCT
#define PARAM_STRUCT struct vita_params
        VITA_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

static enum status check_params(const void *values, struct err *err)
{
    return texture_params_check(&((const struct vita_params *)values)->texture, err);
}

struct files {
    const char *model, *axes;
    struct cli_list edits;
};

static enum status read_models(struct vita_scene *s, const struct files *f, struct provenance *prov, struct err *err)
{
    s->models = calloc((size_t)f->edits.count + 1, sizeof *s->models);
    if (!s->models) return err_nomem(err, "models", (size_t)f->edits.count * sizeof *s->models);
    s->model_count = 1 + f->edits.count;
    solid_mesh_read(&s->models[0], f->model, prov, err);
    for (int i = 0; !err->status && i < f->edits.count; i++)
        solid_mesh_read(&s->models[1 + i], f->edits.items[i], prov, err);
    if (!err->status) surfaces_make(&s->surfaces, s->models, s->model_count, err);
    return err->status;
}

static enum status read_index(struct vita_scene *s, struct provenance *prov, struct err *err)
{
    char path[FILE_PATH];
    struct face_index index = {0};
    s->shown_by = calloc((size_t)s->surfaces.count + 1, sizeof *s->shown_by);
    if (!s->shown_by) return err_nomem(err, "faces", (size_t)s->surfaces.count * sizeof *s->shown_by);
    if (!product_path_in(path, s->from.ids, PRODUCT_FACE_INDEX, NULL, err)) face_index_open(&index, path, prov, err);
    for (int i = 0; !err->status && i < s->surfaces.count; i++)
        face_index_load(&s->shown_by[i], &index, s->surfaces.list[i].id, err);
    face_index_close(&index);
    return err->status;
}

static enum status read_scene(struct vita_scene *s, const struct files *f, struct provenance *prov, struct err *err)
{
    const struct scene_files files = {.views = s->from.views, .axes = f->axes};
    if (!scene_inputs_read(&s->in, SCENE_CAMERAS | SCENE_LENSES | SCENE_AXES | SCENE_MODEL_VIEWS, &files, prov, err) &&
        !read_models(s, f, prov, err))
        read_index(s, prov, err);
    return err->status;
}

static void release_scene(struct vita_scene *s)
{
    scene_inputs_release(&s->in);
    for (int i = 0; s->shown_by && i < s->surfaces.count; i++) face_views_release(&s->shown_by[i]);
    free(s->shown_by);
    surfaces_release(&s->surfaces);
    for (int i = 0; s->models && i < s->model_count; i++) solid_mesh_release(&s->models[i]);
    free(s->models);
}

/* Prints what atlases of this model will take. The costs are those of loft and of a real room at draft, on one core of
 * a server of 2023. */
static enum status estimate(int atlases, const char *model, const struct vita_params *params, struct err *err)
{
    struct work_estimate work = {0};
    struct model_rays m = {0};
    if (!solid_mesh_read(&m.mesh, model, NULL, err)) {
        const double side = model_rays_height(&m) / params->texels;
        const double megatexels = side > 0 ? 1e-6 * model_rays_area(&m) / (side * side) : 0;
        for (int i = 0; i < atlases; i++)
            work_estimate_add(&work, 1.5 + 1.5 * megatexels, 150 + 50 * megatexels, 2e6 * megatexels);
        work_estimate_print(stdout, &work);
    }
    solid_mesh_release(&m.mesh);
    return err->status;
}

int main(int argc, char **argv)
{
    int to_estimate = 0;
    struct vita_params params = VITA_PARAMS_DEFAULT;
    struct vita_scene scene = {.params = &params};
    struct files f = {0};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Bakes the view-independent texture atlas: every face of the model, seen orthogonally."),
        CLI_STR("model", &f.model, CLI_REQUIRED, "the unedited model, model.txt"),
        CLI_LIST("edit", &f.edits, CLI_OPTIONAL,
                 "model.txt of an edit, whose part of the faces is baked too; repeat for several"),
        CLI_STR("axes", &f.axes, CLI_REQUIRED, "the models' frame, axes.txt"),
        CLI_STR("views", &scene.from.views, CLI_REQUIRED, "folder of cameras and rectified views"),
        CLI_STR("ids", &scene.from.ids, CLI_REQUIRED, "folder of the faces that each view shows, and of their index"),
        CLI_STR("things", &scene.from.things, CLI_OPTIONAL, "folder of the scene's things: textures leave them out"),
        CLI_INT("estimate", &to_estimate, CLI_OPTIONAL, "instead: print what this many atlases of --model will take"),
        CLI_STR("out", &scene.out, CLI_REQUIRED, "folder to write to"),
        CLI_PARAMS(vita_param_table, &params, check_params),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "bake_vita", opts, &prov, &err) == CLI_RUN) {
        if (to_estimate > 0)
            estimate(to_estimate, f.model, &params, &err);
        else if (!read_scene(&scene, &f, &prov, &err))
            vita_bake(&scene, &prov, &err);
    }
    err_report(&err);
    release_scene(&scene);
    cli_list_release(&f.edits);
    provenance_release(&prov);
    return err_exit_code(&err);
}
