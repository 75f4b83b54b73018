/* calibrate_light.c - how many cd/m2 a radiance of 1 of a scene is, from exposures or from measurements.
 *
 * reads   RECORDS/PHOTO.txt                              the exposures of the photos
 *         VIEWS/cameras.txt, images.txt, lenses.txt      the cameras
 *         MARKS                                          scenes/NAME/lux.txt: what somebody measured; optional. Then
 *         VIEWS/VIEW.exr                                 the views of photos in which a luminance was measured
 *         MODEL, AXES, VITA/atlas.txt, page0.exr, ...,   the textured model, which gives the irradiance where an
 *         OUTDOORS, LIGHTS, REFERENCES/ID.exr, THINGS    illuminance was measured
 * writes  OUT                                            lux/scale.txt */
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/log.h"
#include "common/relight/light_things.h"
#include "stages/calibrate_light/mark_light.h"
#include "stages/calibrate_light/scale_fit.h"

#define PARAM_STRUCT struct calibrate_params
static const struct param calibrate_param_table[] = {CALIBRATE_PARAMS(PARAM_ROW) GATHER_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

struct job {
    const char *records, *views, *marks_path, *axes, *references, *things_path, *out;
    struct model_field_files files;
    struct calibrate_params params;
    struct provenance prov;
    struct scene_inputs in;
    struct lux_marks marks;
    struct thing_surfaces things;
    struct field_surfaces furniture; /* of things, which must outlive the field */
    struct model_field field;
    struct gatherer *gatherer;
    struct lux_scale scale;
};

#define COPY_FIELD(name, ...) memcpy(&g.name, &p->name, sizeof g.name);
static struct gather_params gather_params_of(const struct calibrate_params *p)
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

/* The exposures of the photos that have views. */
static enum status by_exposure(struct job *j, struct err *err)
{
    const struct lens_list *lenses = &j->in.lenses;
    double *exposures = calloc((size_t)lenses->count + 1, sizeof *exposures);
    int known = 0, unknown = 0;
    if (!exposures) return err_nomem(err, "exposures", (size_t)lenses->count * sizeof *exposures);
    for (int i = 0; !err->status && i < lenses->count; i++) {
        struct photo_record record = {0};
        if (i && !strcmp(lenses->lenses[i].photo, lenses->lenses[i - 1].photo)) continue;
        if (!photo_record_read(&record, j->records, lenses->lenses[i].photo, &j->prov, err)) {
            const double exposure = scale_exposure(&record);
            if (exposure > 0)
                exposures[known++] = exposure;
            else
                unknown++;
        }
        photo_record_release(&record);
    }
    if (!err->status) {
        j->scale.photos = known;
        j->scale.by_exposure = scale_of_exposures(exposures, known, &j->params);
        if (known && unknown) log_note("%d of %d photos do not state their exposure", unknown, known + unknown);
    }
    free(exposures);
    return err->status;
}

static bool has_illuminance(const struct lux_marks *marks)
{
    for (int i = 0; i < marks->count; i++)
        if (marks->items[i].kind == LUX_ILLUMINANCE) return true;
    return false;
}

static enum status read_field(struct job *j, struct err *err)
{
    const struct gather_params params = gather_params_of(&j->params);
    if (j->things_path) {
        if (thing_surfaces_read(&j->things, j->things_path, &j->prov, err)) return err->status;
        j->furniture = thing_surfaces_of_field(&j->things);
        if (j->things.count) j->files.surfaces = &j->furniture;
    }
    if (model_field_read(&j->field, &j->files, &j->prov, err)) return err->status;
    if (j->references && model_field_read_references(&j->field, j->references, &j->in.axes, &j->prov, err))
        return err->status;
    return gatherer_make(&j->gatherer, &params, err);
}

static enum status by_measurement(struct job *j, struct err *err)
{
    const bool needs_field = j->files.vita && has_illuminance(&j->marks);
    const struct mark_inputs in = {.views = j->views,
                                   .in = &j->in,
                                   .field = needs_field ? &j->field : NULL,
                                   .gatherer = j->gatherer,
                                   .params = &j->params,
                                   .prov = &j->prov};
    struct lux_scale *s = &j->scale;
    if (!(s->measurements = calloc((size_t)j->marks.count, sizeof *s->measurements)))
        return err_nomem(err, "measurements", (size_t)j->marks.count * sizeof *s->measurements);
    s->count = j->marks.count;
    if (mark_light_find(s->measurements, &j->marks, &in, err)) return err->status;
    s->is = scale_of_measurements(s->measurements, s->count, &j->params);
    s->from = LUX_MEASUREMENTS;
    return ST_OK;
}

static void say(const struct job *j)
{
    const struct lux_scale *s = &j->scale;
    const struct lux_interval *e = &s->by_exposure;
    if (s->from == LUX_UNKNOWN) {
        log_warn(
            "no photo states exposure time, f-number and ISO speed, so that light has no absolute unit; write what is "
            "missing to scenes/NAME/exposures.txt, such as `* 0 0 100` for ISO 100, or measure some illuminances and "
            "write them to scenes/NAME/lux.txt.");
        return;
    }
    log_note("a radiance of 1 is %.4g cd/m2 (%.4g to %.4g), from %s", s->is.scale, s->is.low, s->is.high,
             s->from == LUX_MEASUREMENTS ? "measurements" : "exposures");
    for (int i = 0; i < s->count; i++)
        if (s->measurements[i].off)
            log_warn("%s:%d: the measurement %s is %.0f %% %s than the others say; check its value and its place.",
                     j->marks.path, j->marks.items[i].line, s->measurements[i].name,
                     100 * fabs(expm1(s->measurements[i].deviation)),
                     s->measurements[i].deviation > 0 ? "more" : "less");
    if (s->from == LUX_MEASUREMENTS && s->photos)
        log_note("exposures alone would give %.4g (%.4g to %.4g); they agree if the constant is %.4g", e->scale, e->low,
                 e->high, j->params.constant * s->is.scale / e->scale);
    if (s->from == LUX_MEASUREMENTS && s->photos && (s->is.high < e->low || s->is.low > e->high))
        log_warn(
            "measurements and exposures disagree: %.4g to %.4g and %.4g to %.4g cd/m2. Check the units in lux.txt and "
            "exposures.txt.",
            s->is.low, s->is.high, e->low, e->high);
}

static enum status calibrate(struct job *j, struct err *err)
{
    const bool wants_field = j->files.vita != NULL;
    const struct scene_files files = {.views = j->views, .axes = j->axes};
    if (wants_field && (!j->files.model || !j->axes))
        return err_set(err, ST_USAGE, "--vita needs --model and --axes, the model that it is of.");
    if (scene_inputs_read(&j->in, SCENE_CAMERAS | SCENE_LENSES | (j->axes ? SCENE_AXES : 0u), &files, &j->prov, err) ||
        by_exposure(j, err))
        return err->status;
    if (j->scale.photos) {
        j->scale.is = j->scale.by_exposure;
        j->scale.from = LUX_EXPOSURE;
    }
    if (j->marks_path) {
        if (lux_marks_read(&j->marks, j->marks_path, &j->prov, err) ||
            (wants_field && has_illuminance(&j->marks) && read_field(j, err)) || by_measurement(j, err))
            return err->status;
    }
    say(j);
    return lux_scale_write(&j->scale, j->out, &j->prov, err);
}

static void job_release(struct job *j)
{
    lux_scale_release(&j->scale);
    gatherer_free(j->gatherer);
    model_field_release(&j->field);
    thing_surfaces_release(&j->things);
    lux_marks_release(&j->marks);
    scene_inputs_release(&j->in);
    provenance_release(&j->prov);
}

int main(int argc, char **argv)
{
    struct job j = {.params = CALIBRATE_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("How many cd/m2 a radiance of 1 of a scene is, from exposures or from measurements."),
        CLI_STR("records", &j.records, CLI_REQUIRED, "folder of the photos' records, with their exposures"),
        CLI_STR("views", &j.views, CLI_REQUIRED, "folder of cameras and rectified views"),
        CLI_STR("marks", &j.marks_path, CLI_OPTIONAL, "what somebody measured, lux.txt; without it, exposures count"),
        CLI_STR("model", &j.files.model, CLI_OPTIONAL, "the unedited model, model.txt; for illuminances of lux.txt"),
        CLI_STR("axes", &j.axes, CLI_OPTIONAL, "the model's frame, axes.txt"),
        CLI_STR("vita", &j.files.vita, CLI_OPTIONAL, "folder of the view-independent atlas"),
        CLI_STR("outdoors", &j.files.outdoors, CLI_OPTIONAL, "what lies outside, by direction; without it, it is dark"),
        CLI_STR("lights", &j.files.lights, CLI_OPTIONAL, "lamps and openings, lights.txt"),
        CLI_STR("references", &j.references, CLI_OPTIONAL, "folder of the reference images that openings name"),
        CLI_STR("things", &j.things_path, CLI_OPTIONAL,
                "folder of the things, furniture that throws shadows and reflects"),
        CLI_STR("out", &j.out, CLI_REQUIRED, "scale to write, scale.txt"),
        CLI_PARAMS(calibrate_param_table, &j.params, check_params),
        CLI_END,
    };
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "calibrate_light", opts, &j.prov, &err) == CLI_RUN) calibrate(&j, &err);
    err_report(&err);
    job_release(&j);
    return err_exit_code(&err);
}
