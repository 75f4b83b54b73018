/* fit_materials.c - the reflectance of materials whose regions a person marked: Lambert, Phong or Ward.
 *
 * reads   MARKS                                       scenes/NAME/materials.txt: regions of materials
 *         MODEL, AXES                                 the unedited model and its frame
 *         VIEWS/cameras.txt, images.txt, lenses.txt   the cameras
 *         VIEWS/VIEW.exr, IDS/VIEW.exr                the views that face a marked region
 *         VITA/atlas.txt, page0.exr, ...; OUTDOORS; LIGHTS   the light that arrives there
 * writes  OUT/materials/NAME.jpg                      the residuals of a material in the view that shows most of it
 *         OUT/materials/samples.txt                   all samples with what the models say
 *         then OUT/materials.txt                      the materials */
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/log.h"
#include "common/gather/model_field.h"
#include "common/model/scene_inputs.h"
#include "common/product/product.h"
#include "stages/fit_materials/fit_region.h"
#include "stages/fit_materials/marked_materials.h"

#define PARAM_STRUCT struct materials_params
static const struct param materials_param_table[] = {MATERIALS_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

struct job {
    struct model_field_files files;
    const char *marks_path, *axes_path, *views, *ids, *out;
    struct materials_params params;
    struct provenance prov;
    struct marked_materials marks;
    struct scene_inputs in;
    struct model_field field;
    struct observations seen;
};

static void job_release(struct job *j)
{
    observe_release(&j->seen);
    model_field_release(&j->field);
    scene_inputs_release(&j->in);
    marked_materials_release(&j->marks);
    provenance_release(&j->prov);
}

static enum status read_inputs(struct job *j, struct err *err)
{
    const struct scene_files files = {.views = j->views, .axes = j->axes_path};
    if (marked_materials_read(&j->marks, j->marks_path, &j->prov, err) ||
        scene_inputs_read(&j->in, SCENE_CAMERAS | SCENE_LENSES | SCENE_AXES, &files, &j->prov, err))
        return err->status;
    return model_field_read(&j->field, &j->files, &j->prov, err);
}

static void report(const struct material *m, const struct region_fit *f)
{
    const double guessed = f->shares[LIGHT_NONE] + f->shares[LIGHT_SYNTHESISED] + f->shares[LIGHT_SKY_GUESSED];
    log_note("material %s: %s, k_d %.4g %.4g %.4g, k_s %.4g, shape %.4g, from %d samples of %d points in %d views: %s; "
             "residuals %.3g times the noise, %.0f %% of the light is guessed",
             m->name, material_kind_name(m->kind), m->k_d[0], m->k_d[1], m->k_d[2], m->ks, m->shape, m->samples,
             m->points, m->views, m->why, m->scale, 100 * guessed);
}

/* One material, its picture, its samples. */
static enum status fit_one(struct job *j, const struct observed_scene *scene, int index, FILE *samples, struct err *err)
{
    struct material *m = &j->marks.list.items[index];
    struct region_fit f;
    char path[FILE_PATH];
    if (!region_fit_make(&f, m, index, j->marks.declared[index], &j->seen, scene, &j->field.field, err)) {
        report(m, &f);
        region_fit_print(samples, &f, m, &j->seen, scene);
        if (!product_path_in(path, j->out, PRODUCT_MATERIAL_PICTURE, &(struct product_key){.name = m->name}, err))
            region_fit_picture(&f, &j->seen, scene, path, err);
    }
    region_fit_release(&f);
    return err->status;
}

static enum status fit_all(struct job *j, const struct observed_scene *scene, struct err *err)
{
    char path[FILE_PATH];
    struct outfile samples = {0};
    if (product_path_in(path, j->out, PRODUCT_MATERIAL_SAMPLES, NULL, err) ||
        product_begin(&samples, PRODUCT_MATERIAL_SAMPLES, path, &j->prov, err))
        return err->status;
    fprintf(samples.fp, "# material view x y, radiance R G B in the view, and by the fitted model\n");
    for (int i = 0; !err->status && i < j->marks.list.count; i++) fit_one(j, scene, i, samples.fp, err);
    if (!err->status) outfile_commit(&samples, err);
    outfile_discard(&samples);
    if (err->status || product_path_in(path, j->out, PRODUCT_MATERIALS, NULL, err)) return err->status;
    return material_list_write(&j->marks.list, path, &j->prov, err);
}

/* Points are on the surface that shows in the views; the light's model may have it a little off. */
static void lift_points(struct job *j)
{
    for (int i = 0; i < j->seen.point_count; i++) {
        struct gather_point p = {j->seen.points[i].at, j->seen.points[i].normal};
        if (model_field_lift(&j->field, &p, j->field.reach)) j->seen.points[i].at = p.at;
    }
}

static enum status run(struct job *j, struct err *err)
{
    if (read_inputs(j, err)) return err->status;
    const struct observed_scene scene = {&j->field.model, &j->in.axes, &j->in.set, &j->in.lenses,
                                         j->marks_path,   j->views,    j->ids,     &j->params};
    if (observe_points(&j->seen, &scene, &j->marks.list, err) || observe_views(&j->seen, &scene, &j->prov, err))
        return err->status;
    lift_points(j);
    return fit_all(j, &scene, err);
}

int main(int argc, char **argv)
{
    struct job j = {.params = MATERIALS_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Fits the reflectance of materials whose regions a person marked: Lambert, Phong or Ward."),
        CLI_STR("marks", &j.marks_path, CLI_REQUIRED, "marked regions of materials, scenes/NAME/materials.txt"),
        CLI_STR("model", &j.files.model, CLI_REQUIRED, "the unedited model, model.txt"),
        CLI_STR("axes", &j.axes_path, CLI_REQUIRED, "the model's frame, axes.txt"),
        CLI_STR("views", &j.views, CLI_REQUIRED, "folder of cameras and rectified views"),
        CLI_STR("ids", &j.ids, CLI_REQUIRED, "folder of the faces that each view shows"),
        CLI_STR("vita", &j.files.vita, CLI_REQUIRED, "folder of the view-independent atlas"),
        CLI_STR("outdoors", &j.files.outdoors, CLI_OPTIONAL, "what lies outside, by direction; without it, it is dark"),
        CLI_STR("lights", &j.files.lights, CLI_OPTIONAL, "lamps and openings, lights.txt"),
        CLI_STR("out", &j.out, CLI_REQUIRED, "folder to write to"),
        CLI_PARAMS(materials_param_table, &j.params, NULL),
        CLI_END,
    };
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "fit_materials", opts, &j.prov, &err) == CLI_RUN) run(&j, &err);
    err_report(&err);
    job_release(&j);
    return err_exit_code(&err);
}
