/* export_model.c - writes a model, or an edited one, with its photographic texture for other programs.
 *
 * reads   MODEL/model.txt, plan.txt                     the model; of an edit also MAP, texture.txt
 *         OBJECTS, SCENE/FILE.obj                       of an edit: the synthetic objects and their meshes
 *         SCENE/FILE.ies                                of an edit: the photometry of lamps that it adds
 *         THINGS/things.txt, volume.exr                 furniture; of an edit that changes it also BASE, the old model
 *         AXES                                          whether its lengths are metres
 *         VITA/atlas.txt, page0.exr, ...                the view-independent texture atlas
 * writes  OUT/page0.png, ...                            its pages, sRGB
 *         OUT/model.ifc, ...                            the model in each format (docs/formats.md) */
#include "common/base/cli.h"
#include "common/model/scene_inputs.h"
#include "common/product/product.h"
#include "stages/export_model/export_pages.h"
#include "stages/export_model/writers.h"

struct job {
    const char *name, *model, *map, *base, *things, *objects, *scene, *axes, *vita, *out;
    struct scene_inputs in;
    struct texture_map texture;
    struct atlas atlas;
    struct export_faces faces;
    struct export_objects inserted;
    struct export_things furniture;
    struct export_lamps lamps;
};

static enum status read_inputs(struct job *j, struct provenance *prov, struct err *err)
{
    char model[FILE_PATH], plan[FILE_PATH];
    const struct scene_files files = {.axes = j->axes, .mesh = model, .plan = plan};
    if (product_path_in(model, j->model, PRODUCT_MODEL, NULL, err) ||
        product_path_in(plan, j->model, PRODUCT_PLAN, NULL, err) ||
        scene_inputs_read(&j->in, SCENE_AXES | SCENE_MESH | SCENE_PLAN, &files, prov, err) ||
        (j->map && texture_map_read(&j->texture, j->map, prov, err)) ||
        export_objects_read(&j->inserted, j->objects, j->scene, prov, err) ||
        (j->map && export_lamps_read(&j->lamps, &j->texture, j->scene, &j->in.axes, &j->in.plan, prov, err)))
        return err->status;
    const struct export_thing_files things = {j->things, model, j->base, j->map};
    if (export_things_read(&j->furniture, &things, j->map ? &j->texture : NULL, prov, err)) return err->status;
    return atlas_read(&j->atlas, j->vita, prov, err);
}

#define WRITE(format, file, name, write) write,
static enum status (*const writers[])(const struct export_scene *s, struct err *err) = {EXPORTS(WRITE)};

static enum status export_all(struct job *j, struct provenance *prov, struct err *err)
{
    double exposure = 1;
    if (!read_inputs(j, prov, err) &&
        !export_faces_make(&j->faces, &j->in.mesh, j->map ? &j->texture : NULL, &j->atlas, err) &&
        !export_exposure(&exposure, &j->atlas, j->vita, err))
        export_pages_write(&j->atlas, j->vita, exposure, j->out, prov, err);
    const struct export_scene scene = {.name = j->name,
                                       .mesh = &j->in.mesh,
                                       .faces = &j->faces,
                                       .plan = &j->in.plan,
                                       .objects = &j->inserted,
                                       .lamps = &j->lamps,
                                       .things = &j->furniture,
                                       .page_sizes = (const int(*)[2])j->atlas.page_sizes,
                                       .page_count = j->atlas.page_count,
                                       .exposure = exposure,
                                       .metric = j->in.axes.metric,
                                       .out = j->out,
                                       .prov = prov};
    for (int i = EXPORT_COUNT - 1; !err->status && i >= 0; i--) writers[i](&scene, err);
    return err->status;
}

int main(int argc, char **argv)
{
    struct job j = {0};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Writes a model with its photographic texture for other programs."),
        CLI_STR("name", &j.name, CLI_REQUIRED, "name of the model, for titles"),
        CLI_STR("model", &j.model, CLI_REQUIRED, "folder of the model: model.txt and plan.txt"),
        CLI_STR("map", &j.map, CLI_OPTIONAL, "of an edited model: its texture.txt"),
        CLI_STR("base", &j.base, CLI_OPTIONAL, "of an edited model: model.txt of the unedited one, for --things"),
        CLI_STR("things", &j.things, CLI_OPTIONAL, "folder of find_things, whose furniture is exported, too"),
        CLI_STR("objects", &j.objects, CLI_OPTIONAL, "of an edited model: its objects.txt"),
        CLI_STR("scene", &j.scene, CLI_OPTIONAL,
                "of an edited model: folder of the meshes and IES files that it names"),
        CLI_STR("axes", &j.axes, CLI_REQUIRED, "the model's frame, axes.txt"),
        CLI_STR("vita", &j.vita, CLI_REQUIRED, "folder of the view-independent texture atlas"),
        CLI_STR("out", &j.out, CLI_REQUIRED, "folder to write to"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "export_model", opts, &prov, &err) == CLI_RUN) export_all(&j, &prov, &err);
    err_report(&err);
    export_faces_release(&j.faces);
    export_objects_release(&j.inserted);
    export_things_release(&j.furniture);
    export_lamps_release(&j.lamps);
    atlas_release(&j.atlas);
    texture_map_release(&j.texture);
    scene_inputs_release(&j.in);
    provenance_release(&prov);
    return err_exit_code(&err);
}
