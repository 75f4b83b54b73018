/* fit_lights.c - the lamps of a scene and the openings that let daylight in: where they are, how bright, how wide.
 *
 * reads   LAMPS                                         scenes/NAME/lights.txt: what a person marked; optional
 *         MODEL, PLAN, AXES                             the unedited model, its openings, its frame
 *         VIEWS/cameras.txt, images.txt, lenses.txt     the cameras
 *         VIEWS/VIEW.exr, IDS/VIEW.exr                  the views that face a marked point or a lamp
 *         VITA/atlas.txt, page0.exr, ..., OUTDOORS,     what else lights the marked points; or
 *         REFERENCES/ID.exr
 *         THINGS/things.txt, volume.exr                 the furniture, which throws shadows and reflects; optional
 *         INDIRECT                                      their irradiance without the lamps
 * writes  OUT/declared.txt, candidates.txt, fit.txt, LAMP.jpg, then OUT/lights.txt
 * With --list instead:
 * writes  OUT                                           the points at which indirect light is needed */
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/log.h"
#include "common/base/work_estimate.h"
#include "common/gather/model_field.h"
#include "common/math/numbers.h"
#include "common/product/product.h"
#include "common/relight/light_things.h"
#include "stages/fit_lights/indirect.h"
#include "stages/fit_lights/lamp_picture.h"
#include "stages/fit_lights/lamps_on_faces.h"
#include "stages/fit_lights/mark_candidates.h"
#include "stages/fit_lights/solve.h"
#include "stages/fit_lights/unseen_lamps.h"

#define PARAM_STRUCT struct fit_lights_params
static const struct param fit_lights_param_table[] = {FIT_LIGHTS_PARAMS(PARAM_ROW) GATHER_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

struct job {
    const char *lamps, *model_path, *plan_path, *axes_path, *views, *ids, *vita, *outdoors, *references, *indirect_path,
        *list, *things_path, *out;
    struct fit_lights_params params;
    struct provenance prov;
    struct annotation_list notes;
    struct lit_model model;
    struct lit_scene scene;
    struct indirect indirect;
    struct thing_surfaces things;
    struct field_surfaces furniture; /* of things */
    struct model_rays furnished;     /* the model with them: what throws shadows */
    struct model_field field;        /* with its lamps off; empty without --vita */
    struct unseen_lamps unseen;
    struct face_lamp *faces; /* of each lamp */
};

static enum status read_things(struct job *j, struct err *err)
{
    if (j->things_path && thing_surfaces_read(&j->things, j->things_path, &j->prov, err)) return err->status;
    j->furniture = thing_surfaces_of_field(&j->things);
    return model_rays_read_with(&j->furnished, j->model_path, MODEL_WITHOUT_GLASS, &j->furniture.triangles, NULL, err);
}

static enum status read_inputs(struct job *j, struct err *err)
{
    const struct scene_files files = {.views = j->views, .axes = j->axes_path, .plan = j->plan_path};
    if (model_rays_read(&j->model.rays, j->model_path, MODEL_WITHOUT_GLASS, &j->prov, err) ||
        scene_inputs_read(&j->model.in, SCENE_CAMERAS | SCENE_LENSES | SCENE_AXES | SCENE_PLAN, &files, &j->prov,
                          err) ||
        (j->lamps && annotation_list_read(&j->notes, j->lamps, &j->prov, err)) || read_things(j, err))
        return err->status;
    return lit_scene_resolve(&j->scene, j->lamps ? &j->notes : NULL, &j->model, j->params.grid, j->params.places, err);
}

#define COPY_FIELD(name, ...) memcpy(&g.name, &p->name, sizeof g.name);
static struct gather_params gather_params_of(const struct fit_lights_params *p)
{
    struct gather_params g;
    GATHER_PARAMS(COPY_FIELD)
    return g;
}

static enum status check_params(const void *values, struct err *err)
{
    const struct gather_params g = gather_params_of(values);
    return gather_params_check(&g, err);
}

/* The field of the textured model, with its lamps, as declared, off. */
static enum status read_field(struct job *j, struct err *err)
{
    char declared[FILE_PATH];
    const struct model_field_files files = {.model = j->model_path,
                                            .vita = j->vita,
                                            .outdoors = j->outdoors,
                                            .lights = declared,
                                            .surfaces = j->things.count ? &j->furniture : NULL};
    if (!product_path_in(declared, j->out, PRODUCT_LIGHTS_DECLARED, NULL, err) &&
        !light_list_write(&j->scene.lights, declared, &j->prov, err))
        model_field_read(&j->field, &files, &j->prov, err);
    if (!err->status && j->references)
        model_field_read_references(&j->field, j->references, &j->model.in.axes, &j->prov, err);
    if (!err->status) model_field_switch_lamp(&j->field, -1, false);
    return err->status;
}

static enum status gather_indirect(struct job *j, struct err *err)
{
    struct gatherer *gatherer = NULL;
    const struct gather_params params = gather_params_of(&j->params);
    if (!gatherer_make(&gatherer, &params, err)) indirect_gather(&j->indirect, &j->scene, &j->field.field, gatherer);
    gatherer_free(gatherer);
    return err->status;
}

static bool looks_for_unseen(const struct job *j) { return j->vita && strcmp(j->params.unseen, "no") != 0; }

/* Whether the light of faces is gathered: it tells of lamps. */
static bool looks_at_faces(const struct job *j)
{
    return looks_for_unseen(j) || (j->vita && j->scene.lights.lamp_count > 0);
}

static enum status find_indirect(struct job *j, struct err *err)
{
    if (j->indirect.count && !j->indirect_path && !j->vita)
        return err_set(err, ST_USAGE,
                       "%s marks points, so --vita is needed, for the indirect light there, or --indirect.", j->lamps);
    const bool is_gathered = j->indirect.count && !j->indirect_path;
    if ((is_gathered || looks_at_faces(j)) && read_field(j, err)) return err->status;
    if (is_gathered) return gather_indirect(j, err);
    if (!j->indirect.count) return ST_OK;
    return indirect_read(&j->indirect, &j->scene, &j->model.in.axes, j->indirect_path, &j->prov, err);
}

static void report(const struct light_list *lights, const struct solved_lights *s)
{
    for (int i = 0; i < lights->lamp_count; i++) {
        const struct lamp *l = &lights->lamps[i];
        const struct lamp_result *r = &s->lamps[i];
        log_note("lamp %s: radiance %.4g %.4g %.4g +- %.2g, beta %.2f +- %.2f degrees, exponent %.3g", l->name,
                 l->radiance.r, l->radiance.g, l->radiance.b, 1.96 * r->radiance_error[1], l->beta / DEGREE,
                 1.96 * r->beta_error / DEGREE, l->exponent);
    }
    log_note("%d lamps, %d openings that let daylight in", lights->lamp_count, lights->opening_count);
}

static enum status write_lights(struct job *j, const struct solved_lights *s, const struct solve_inputs *in,
                                struct err *err)
{
    char path[FILE_PATH];
    if (product_path_in(path, j->out, PRODUCT_MARK_CANDIDATES, NULL, err) ||
        mark_candidates_write(&j->scene, &j->notes, &j->model, &j->furnished, j->views, j->ids, &j->params, path,
                              &j->prov, err) ||
        product_path_in(path, j->out, PRODUCT_LIGHT_FIT, NULL, err) ||
        solve_write(s, in, &j->unseen, &j->model, path, &j->prov, err) ||
        lamp_pictures_write(&j->scene, &j->model, j->views, j->out, err))
        return err->status;
    report(&j->scene.lights, s);
    unseen_lamps_report(&j->unseen, &j->model);
    if (!unseen_lamps_add(&j->unseen, &j->scene.lights, err) &&
        !product_path_in(path, j->out, PRODUCT_LIGHTS, NULL, err))
        light_list_write(&j->scene.lights, path, &j->prov, err);
    return err->status;
}

static enum status find_unseen(struct job *j, struct err *err)
{
    return unseen_lamps_find(&j->unseen, &j->field, &j->scene, &j->model, &j->furnished, j->views, &j->params, &j->prov,
                             err);
}

/* What faces tell of the lamps whose radiance nobody gave, and of those that nobody marked. known: the lamps shine as
 * they do now, and only the unmarked ones are fitted. */
static enum status fit_faces(struct job *j, bool known, struct err *err)
{
    const size_t count = (size_t)j->scene.lights.lamp_count;
    bool *is_free = calloc(count + 1, sizeof *is_free);
    struct face_lamp *faces = calloc(count + 1, sizeof *faces);
    if (!is_free || !faces) err_nomem(err, "lamps", count * sizeof *faces);
    for (size_t k = 0; !err->status && k < count; k++)
        is_free[k] = !known && !j->notes.items[j->scene.lamp_notes[k]].has_radiance;
    if (!err->status) lamps_on_faces_fit(faces, is_free, &j->unseen, &j->scene, &j->furnished, err);
    if (!known && !err->status) memcpy(j->faces, faces, count * sizeof *faces);
    free(is_free);
    free(faces);
    return err->status;
}

static void shine_as_faces_tell(struct job *j)
{
    for (int k = 0; k < j->scene.lights.lamp_count; k++) {
        const double *s = j->faces[k].radiance;
        if (j->faces[k].is_known) j->scene.lights.lamps[k].radiance = rgb_make(s[0], s[1], s[2]);
    }
}

/* Fits the lamps roughly to their marks, then to all faces; looks for lamps that nobody marked, and adds the light of
 * those that it finds. */
static enum status find_before(struct job *j, const struct solve_inputs *in, struct err *err)
{
    struct light_list *lights = &j->scene.lights;
    struct solved_lights rough = {0};
    struct solve_inputs first = *in;
    const size_t size = (size_t)lights->lamp_count * sizeof *lights->lamps;
    struct lamp *lamps = malloc(size + 1);
    if (!lamps) return err_nomem(err, "lamps", size);
    if (size) memcpy(lamps, lights->lamps, size);
    first.is_provisional = true;
    first.faces = NULL;
    if (!solve_lights(&rough, &first, err) && !unseen_lamps_gather(&j->unseen, &j->field, err) &&
        !fit_faces(j, false, err)) {
        shine_as_faces_tell(j);
        if (looks_for_unseen(j) && !find_unseen(j, err) && j->unseen.count) fit_faces(j, false, err);
        if (!err->status && j->unseen.are_used)
            unseen_lamps_light(&j->unseen, j->indirect.at, &j->scene, &j->furnished);
    }
    if (size) memcpy(lights->lamps, lamps, size);
    free(lamps);
    solve_release(&rough);
    return err->status;
}

static enum status solve(struct job *j, struct solved_lights *solved, const struct solve_inputs *in, struct err *err)
{
    if (looks_at_faces(j) && find_before(j, in, err)) return err->status;
    if (solve_lights(solved, in, err)) return err->status;
    return j->unseen.count && !find_unseen(j, err) ? fit_faces(j, true, err) : err->status;
}

static enum status fit(struct job *j, struct err *err)
{
    struct observations seen = {0};
    struct direct_light direct = {0};
    struct solved_lights solved = {0};
    find_indirect(j, err);
    if (!err->status && j->lamps)
        observe(&seen, &j->scene, &j->notes, &j->model, &j->furnished, j->views, j->ids, &j->params, &j->prov, err);
    if (!err->status) direct_light_make(&direct, &j->scene, &j->furnished, err);
    j->faces = calloc((size_t)j->scene.lights.lamp_count + 1, sizeof *j->faces);
    if (!err->status && !j->faces) err_nomem(err, "lamps", (size_t)j->scene.lights.lamp_count * sizeof *j->faces);
    const struct solve_inputs in = {.scene = &j->scene,
                                    .notes = &j->notes,
                                    .seen = &seen,
                                    .direct = &direct,
                                    .indirect = (const double(*)[3])j->indirect.at,
                                    .rays = &j->model.rays,
                                    .params = &j->params,
                                    .faces = j->faces};
    if (!err->status && !solve(j, &solved, &in, err)) write_lights(j, &solved, &in, err);
    solve_release(&solved);
    direct_light_release(&direct);
    observe_release(&seen);
    return err->status;
}

static enum status run(struct job *j, struct err *err)
{
    if (read_inputs(j, err) || indirect_init(&j->indirect, &j->scene, err)) return err->status;
    if (j->list) return indirect_list(&j->indirect, &j->scene, &j->model.in.axes, j->out, &j->prov, err);
    return fit(j, err);
}

/* Prints what the marks of the lamps will take: light is gathered at each point, and on faces, to find lamps without
 * marks. The costs are those of loft's lamps, on one core of a server of 2023. */
static enum status estimate(struct job *j, struct err *err)
{
    struct work_estimate work = {0};
    double points = 0;
    if (j->lamps && annotation_list_read(&j->notes, j->lamps, NULL, err)) return err->status;
    for (int i = 0; i < j->notes.count; i++) {
        const struct annotation *a = &j->notes.items[i];
        if (a->kind == NOTE_LIT || a->kind == NOTE_UNLIT)
            points += a->pixels == 2 ? j->params.grid * j->params.grid : 1;
        if (a->kind == NOTE_LINE) points += LINE_POINTS;
        if (a->kind == NOTE_DISK || a->kind == NOTE_AREA) points += j->params.places;
    }
    work_estimate_add(&work, (strcmp(j->params.unseen, "no") ? 3 : 1) + 0.0045 * points, 300, 4e5);
    work_estimate_print(stdout, &work);
    return ST_OK;
}

int main(int argc, char **argv)
{
    bool to_estimate = false;
    struct job j = {.params = FIT_LIGHTS_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Places the lamps and windows that a person marked, and fits the lamps' radiance and cones."),
        CLI_STR("lamps", &j.lamps, CLI_OPTIONAL, "marked lamps, windows and lit points, scenes/NAME/lights.txt"),
        CLI_STR("model", &j.model_path, CLI_REQUIRED, "the unedited model, model.txt"),
        CLI_STR("plan", &j.plan_path, CLI_REQUIRED, "its walls and openings, plan.txt"),
        CLI_STR("axes", &j.axes_path, CLI_REQUIRED, "the model's frame, axes.txt"),
        CLI_STR("views", &j.views, CLI_REQUIRED, "folder of cameras and rectified views"),
        CLI_STR("ids", &j.ids, CLI_REQUIRED, "folder of the faces that each view shows"),
        CLI_STR("vita", &j.vita, CLI_OPTIONAL, "folder of the view-independent atlas, for indirect light"),
        CLI_STR("outdoors", &j.outdoors, CLI_OPTIONAL, "what lies outside, by direction; without it, it is dark"),
        CLI_STR("references", &j.references, CLI_OPTIONAL,
                "folder of the lighting reference images that windows of --lamps name"),
        CLI_STR("things", &j.things_path, CLI_OPTIONAL,
                "folder of the things, furniture that throws shadows and reflects"),
        CLI_STR("indirect", &j.indirect_path, CLI_OPTIONAL,
                "irradiance without the lamps at the points that --list writes: X Y Z NX NY NZ R G B a line"),
        CLI_STR("list", &j.list, CLI_OPTIONAL,
                "\"points\": only write the points at which indirect light is needed, to --out"),
        CLI_FLAG("estimate", &to_estimate, "instead: print what fitting --lamps will take"),
        CLI_STR("out", &j.out, CLI_REQUIRED, "folder of lights.txt and fit.txt to write, or with --list the file"),
        CLI_PARAMS(fit_lights_param_table, &j.params, check_params),
        CLI_END,
    };
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "fit_lights", opts, &j.prov, &err) == CLI_RUN) {
        if (to_estimate)
            estimate(&j, &err);
        else
            run(&j, &err);
    }
    err_report(&err);
    free(j.faces);
    indirect_release(&j.indirect);
    unseen_lamps_release(&j.unseen);
    model_field_release(&j.field);
    lit_scene_release(&j.scene);
    lit_model_release(&j.model);
    model_rays_release(&j.furnished);
    thing_surfaces_release(&j.things);
    annotation_list_release(&j.notes);
    provenance_release(&j.prov);
    return err_exit_code(&err);
}
