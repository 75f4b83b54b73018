/* bake_outdoors.c - what lies outside of the model, by direction: what its openings let the pictures see.
 *
 * reads   MODEL, AXES                                   the unedited model and its frame
 *         VIEWS/cameras.txt, images.txt                 the cameras
 *         VIEWS/lenses.txt                              which views are of one photo
 *         VIEWS/VIEW.exr, IDS/VIEW.exr                  the views of which some ray leaves the model
 *         VITA                                          the textures of the unedited model: patches of sun
 *         THINGS/things.txt, volume.exr                 the furniture, which throws shadows into them; optional
 *         REFERENCE...                                  lighting reference images
 * writes  SKY                                           the sky and the sun that were found
 *         OUT                                           an equirectangular picture; last */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/capture/photo_camera.h"
#include "common/math/numbers.h"
#include "common/model/scene_inputs.h"
#include "common/product/product.h"
#include "stages/bake_outdoors/outdoors_gather.h"
#include "stages/bake_outdoors/outdoors_guess.h"
#include "stages/bake_outdoors/outdoors_sun.h"

#define PARAM_STRUCT struct outdoors_params
static const struct param outdoors_param_table[] = {OUTDOORS_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

static enum status check_params(const void *values, struct err *err)
{
    const struct outdoors_params *p = values;
    if (p->height % CELL == 0) return ST_OK;
    return err_set(err, ST_USAGE, "height = %d is no multiple of %d; give %d.", p->height, CELL,
                   p->height / CELL * CELL + CELL);
}

struct job {
    const char *model_path, *axes_path, *views, *ids, *vita, *things, *sky, *out;
    struct cli_list references;
    struct outdoors_params params;
    struct provenance prov;
    struct outdoors_model model;
    struct scene_inputs in;
    struct outdoors_picture *pictures;
    int count, photos;
};

static enum status read_inputs(struct job *j, struct err *err)
{
    const struct scene_files files = {.views = j->views, .axes = j->axes_path};
    if (outdoors_model_read(&j->model, j->model_path, &j->prov, err) ||
        scene_inputs_read(&j->in, SCENE_CAMERAS | SCENE_LENSES | SCENE_AXES, &files, &j->prov, err))
        return err->status;
    return ST_OK;
}

static enum status add_references(struct job *j, struct err *err)
{
    for (int i = 0; i < j->references.count; i++) {
        struct outdoors_picture *p = &j->pictures[j->count++];
        bool placed;
        if (outdoors_picture_of_reference(p, j->references.items[i], &j->in.axes, &placed, err)) return err->status;
        if (!placed) {
            log_warn(
                "lighting reference image %s is left out, because its pose in the scene is unknown; give it one by "
                "LRI_SFM or scenes/NAME/lri.txt.",
                p->name);
            outdoors_picture_release(p);
            j->count--;
            continue;
        }
        p->photo = j->photos++;
        p->order = !strcmp(j->params.prefer, "references");
    }
    return ST_OK;
}

static enum status list_pictures(struct job *j, struct err *err)
{
    const size_t most = (size_t)j->references.count + (size_t)j->in.set.view_count + 1;
    char picture[FILE_PATH], ids[FILE_PATH];
    j->pictures = calloc(most, sizeof *j->pictures);
    if (!j->pictures) return err_nomem(err, "pictures", most * sizeof *j->pictures);
    j->photos = j->in.set.view_count;
    add_references(j, err);
    for (int i = 0; !err->status && i < j->in.set.view_count; i++) {
        const struct view view = model_from_world_view(&j->in.axes, &j->in.set.views[i]);
        const struct product_key key = {.view = view.name};
        if (!product_path_in(picture, j->views, PRODUCT_VIEW, &key, err) &&
            !product_path_in(ids, j->ids, PRODUCT_IDS, &key, err))
            outdoors_picture_of_view(&j->pictures[j->count++], &view, picture, ids, err);
        if (err->status) break;
        j->pictures[j->count - 1].photo = photo_of_view(&j->in.set, &j->in.lenses, i);
        j->pictures[j->count - 1].order = !strcmp(j->params.prefer, "photos");
    }
    return err->status;
}

static void report(const struct outdoors_totals *t)
{
    if (!t->references && !t->photos) {
        log_note("no picture looks out of the model, so the outdoors are black; cut openings into the model if there "
                 "are any.");
        return;
    }
    log_note(
        "%.1f %% of all directions from %d lighting reference images, %.1f %% from %d views with gains from %.3f to "
        "%.3f; the rest is guessed",
        100 * t->by_references, t->references, 100 * t->by_photos, t->photos, t->min_gain, t->max_gain);
}

static void report_sun(const struct outdoors_sun *s)
{
    const double azimuth = atan2(s->direction.y, s->direction.x) / DEGREE, elevation = asin(s->direction.z) / DEGREE;
    switch (s->source) {
    case SUN_SEEN:
        log_note("a lighting reference image shows the sun, at azimuth %.1f and elevation %.1f degrees", azimuth,
                 elevation);
        break;
    case SUN_HIDDEN:
        log_warn("patches of sun come from azimuth %.1f and elevation %.1f degrees, but a lighting reference image "
                 "shows no sun there; no sun is added. Check the image's pose, or take it at the time of the photos.",
                 azimuth, elevation);
        break;
    case SUN_PATCHES:
        if (!s->light.places)
            log_warn("patches of sun come from azimuth %.1f and elevation %.1f degrees, but their edges do not tell "
                     "how bright the sun is; none is added.",
                     azimuth, elevation);
        else
            log_note("patches of sun come from azimuth %.1f and elevation %.1f degrees (+- %.2f); the sun's irradiance "
                     "is %.3g (+- %.0f %%), from %d places",
                     azimuth, elevation, s->search.fit.error, rgb_luminance(s->light.irradiance), 100 * s->light.error,
                     s->light.places);
        break;
    case SUN_UNKNOWN:
        log_note("no picture shows the sun, and no patches of sun are found indoors; none is added");
        break;
    }
}

/* looked: patches of sun were looked for */
static enum status write_sky(const struct job *j, const struct sky_fit *sky, const struct outdoors_sun *s, bool looked,
                             struct err *err)
{
    static const char *const sources[] = {"unknown", "seen", "hidden", "patches"};
    struct outfile f = {0};
    if (product_begin(&f, PRODUCT_SKY, j->sky, &j->prov, err)) return err->status;
    if (sky->type)
        fprintf(f.fp, "sky %d brightest %.6g misfit %.4g\n", sky->type, sky->brightest, sky->misfit);
    else
        fprintf(f.fp, "sky unknown\n");
    fprintf(f.fp, "sun %s", sources[s->source]);
    if (s->source != SUN_UNKNOWN)
        fprintf(f.fp, " azimuth %.6g elevation %.6g", atan2(s->direction.y, s->direction.x) / DEGREE,
                asin(s->direction.z) / DEGREE);
    if (s->source == SUN_PATCHES)
        fprintf(f.fp, " error %.4g radius %.4g painted %.4g irradiance %.6g %.6g %.6g error %.4g places %d lamps %.4g",
                s->search.fit.error, s->search.fit.radius, s->radius, s->light.irradiance.r, s->light.irradiance.g,
                s->light.irradiance.b, s->light.places ? s->light.error : 0, s->light.places, s->light.lamps);
    fputc('\n', f.fp);
    if (looked)
        fprintf(f.fp, "patches gain %.4g next %.4g contrast %.4g agree %.4g border %d sure %.4g\n", s->search.fit.gain,
                s->search.next, s->search.evidence.contrast, s->search.evidence.agree, s->search.evidence.border,
                s->search.evidence.sure);
    outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

/* What no picture shows: the sky, the ground and the sun. */
static enum status complete(const struct job *j, struct outdoors *outdoors, bool known, struct provenance *prov,
                            struct err *err)
{
    struct outdoors_sun sun = {0};
    struct sky_fit sky = {0};
    const bool look = known && !strcmp(j->params.sun, "find");
    const struct outdoors_sun_files files = {j->model_path, j->vita, j->things};
    if (look) outdoors_sun_find(&sun, outdoors, &j->model, &files, prov, err);
    if (!err->status) outdoors_guess(outdoors, sun.source != SUN_UNKNOWN ? &sun.direction : NULL, &sky, err);
    if (!err->status) outdoors_sun_add(&sun, outdoors, &j->model, err);
    if (!err->status && look && (j->vita || sun.source == SUN_SEEN)) report_sun(&sun);
    if (!err->status && j->sky) write_sky(j, &sky, &sun, look && j->vita && sun.source != SUN_SEEN, err);
    outdoors_sun_release(&sun);
    return err->status;
}

static enum status bake(struct job *j, struct err *err)
{
    struct outdoors outdoors = {0};
    struct outdoors_totals totals;
    if (!read_inputs(j, err) && !list_pictures(j, err) &&
        !outdoors_gather(&outdoors, &totals, j->pictures, j->count, j->photos, &j->model, &j->params, &j->prov, err)) {
        report(&totals);
        if (!complete(j, &outdoors, totals.photos + totals.references > 0, &j->prov, err))
            outdoors_write(&outdoors, j->out, &j->prov, err);
    }
    outdoors_release(&outdoors);
    return err->status;
}

static void release(struct job *j)
{
    for (int i = 0; i < j->count; i++) outdoors_picture_release(&j->pictures[i]);
    free(j->pictures);
    scene_inputs_release(&j->in);
    outdoors_model_release(&j->model);
    cli_list_release(&j->references);
    provenance_release(&j->prov);
}

int main(int argc, char **argv)
{
    struct job j = {.params = OUTDOORS_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("What lies outside of the model, by direction, from the pictures that look out of its openings."),
        CLI_STR("model", &j.model_path, CLI_REQUIRED, "the unedited model, model.txt"),
        CLI_STR("axes", &j.axes_path, CLI_REQUIRED, "the model's frame, axes.txt"),
        CLI_STR("views", &j.views, CLI_REQUIRED, "folder of cameras and rectified views"),
        CLI_STR("ids", &j.ids, CLI_REQUIRED, "folder of the faces that each view shows"),
        CLI_LIST("reference", &j.references, CLI_OPTIONAL,
                 "lighting reference image with lens and pose; comes before the views; repeat for several"),
        CLI_STR("vita", &j.vita, CLI_OPTIONAL,
                "folder of the textures of the unedited model, in which patches of sun are looked for"),
        CLI_STR("things", &j.things, CLI_OPTIONAL, "folder of the things, furniture that throws shadows into them"),
        CLI_STR("sky", &j.sky, CLI_OPTIONAL, "text to write: the sky and the sun that were found"),
        CLI_STR("out", &j.out, CLI_REQUIRED, "EXR to write"),
        CLI_PARAMS(outdoors_param_table, &j.params, check_params),
        CLI_END,
    };
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "bake_outdoors", opts, &j.prov, &err) == CLI_RUN) bake(&j, &err);
    err_report(&err);
    release(&j);
    return err_exit_code(&err);
}
