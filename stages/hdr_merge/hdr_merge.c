/* hdr_merge.c - merges the bracketed exposures of one view into linear radiance.
 *
 * reads   RECORDS/ID.txt    the photos of the view, with their exposures
 *         PHOTOS/FILE       the photos: JPEG, PNG, TIFF, EXR, raw files
 *         MODEL/cameras.txt, images.txt   the view's lens and pose, if the model has them
 *         VIEWS/cameras.txt, images.txt, lenses.txt, RECORDS-OF-THE-SCENE/ID.txt, or AXES   the frame of that pose
 *         RESPONSE          the response curve; without it the sRGB curve
 * writes  OUT/ID.jpg        the picture for structure from motion: by default the tone-mapped radiance
 *         OUT/ID.exr        R G B (half): 1 is white at the exposure remodel:white, the same for all views of a scene;
 *                           clipped (uint): 1 a colour saturates in every exposure, 2 a colour is dark in every
 *                           exposure that does not saturate, 3 both;
 *                           variance (float): of the luminance, divided by its square; 1 if unknown;
 *                           with MODEL: worldToCamera and remodel:lens
 *
 * Each file appears complete or not at all, ID.exr last. */
#include <math.h>

#include "common/base/cli.h"
#include "common/base/log.h"
#include "stages/hdr_merge/bracketed_view.h"

static void warn_of_disagreement(const struct bracketed_view *v)
{
    const struct exposure_agreement *a = &v->agreement;
    const struct photo_record *r = &v->record;
    if (a->pair && !v->agree)
        log_warn("view %s: %s should have %.3g times the light of %s, but shows %.3g times as much; its radiance is "
                 "not exact. "
                 "Correct the exposures (exposures.txt) or the response curve (response.txt, docs/formats.md).",
                 r->id, r->brackets[a->pair].file, a->stated, r->brackets[a->pair - 1].file, a->measured);
}

static void report_shifts(const struct bracketed_view *v, const struct merge_params *params)
{
    const struct photo_record *r = &v->record;
    for (int i = 0; i < r->bracket_count; i++) {
        const struct shift *s = &v->alignment.shifts[i];
        if (s->dx || s->dy)
            log_note("%s: %s is shifted by %d, %d px against %s%s", r->id, r->brackets[i].file, s->dx, s->dy,
                     r->brackets[r->middle].file, v->brackets.shifts ? "; corrected" : "");
        if (v->alignment.at_limit[i])
            log_warn("view %s: %s is shifted by at least [hdr_merge] max_shift = %d px; check it, and exclude it "
                     "(EXCLUDE) if it is of another view.",
                     r->id, r->brackets[i].file, params->max_shift);
    }
}

static void report_frame(const struct bracketed_view *v)
{
    const struct frame_agreement *f = &v->frame;
    if (f->photos)
        log_note("%s: placed in the scene by %d photographs; their places agree to %.2g %% of their extent (median; at "
                 "most %.2g %%), their axes to %.2g degrees (at most %.2g)",
                 v->record.id, f->photos, 100 * f->errors.center_median, 100 * f->errors.center_max,
                 f->errors.rotation_median, f->errors.rotation_max);
}

static void report(const struct bracketed_view *v, const struct merge_params *params)
{
    size_t pixels = (size_t)v->merged.radiance.width * (size_t)v->merged.radiance.height, bright = 0, dark = 0;
    for (size_t i = 0; i < pixels; i++) {
        bright += (v->merged.marks[i] & PHOTO_BRIGHT) != 0;
        dark += (v->merged.marks[i] & PHOTO_DARK) != 0;
    }
    log_note("%s: %d exposure%s; %.2f %% of the pixels saturate in all of them, %.2f %% are dark in all of them",
             v->record.id, v->record.bracket_count, v->record.bracket_count == 1 ? "" : "s",
             100.0 * (double)bright / (double)pixels, 100.0 * (double)dark / (double)pixels);
    if (v->noise_measured)
        log_note("%s: noise is %.2f %% of white at white, %.3f %% in the dark", v->record.id,
                 100 * sqrt(v->noise[0].photon + v->noise[0].read2), 100 * sqrt(v->noise[0].read2));
    report_shifts(v, params);
    report_frame(v);
    warn_of_disagreement(v);
}

struct request { /* the options of these names */
    const char *id, *photos, *records, *response, *model, *out;
    struct reference_frame frame;
};

static enum status check_request(const struct request *r, struct err *err)
{
    const struct reference_frame *f = &r->frame;
    if (!f->views == !f->records && !(f->views && f->axes) && (r->model || (!f->views && !f->axes))) return ST_OK;
    return err_set(err, ST_USAGE,
                   "--views wants --scene-records, and either these two or --axes state the frame of --model; give "
                   "one of them.");
}

static enum status hdr_merge(const struct request *r, const struct merge_params *params, struct provenance *prov,
                             struct err *err)
{
    struct bracketed_view v = {0};
    size_t clamped = 0;
    bool placed = false;
    enum status st = check_request(r, err);
    if (!st) st = bracketed_view_read(&v, r->id, r->photos, r->records, r->response, prov, err);
    if (!st && r->model) st = bracketed_view_place(&v, &placed, r->model, &r->frame, params, prov, err);
    if (!st && r->model && !placed)
        log_warn("view %s: %s/images.txt has no image of it; its radiance is written without lens and pose.", r->id,
                 r->model);
    if (!st) st = bracketed_view_merge(&v, params, err);
    if (!st) st = bracketed_view_write_picture(&v, r->photos, r->out, params, err);
    if (!st) st = bracketed_view_write_radiance(&v, r->out, prov, &clamped, err);
    if (!st && clamped)
        log_warn("view %s: %zu samples exceed 65504 times white, the largest half value, and are clamped to it.", r->id,
                 clamped);
    if (!st) report(&v, params);
    bracketed_view_release(&v);
    return st;
}

int main(int argc, char **argv)
{
    struct request r = {0};
    struct merge_params params = MERGE_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Merges the bracketed exposures of one view into linear radiance."),
        CLI_STR("id", &r.id, CLI_REQUIRED, "id of the view to merge"),
        CLI_STR("photos", &r.photos, CLI_REQUIRED, "folder of photographs"),
        CLI_STR("records", &r.records, CLI_REQUIRED, "folder of the photos' records"),
        CLI_STR("response", &r.response, CLI_OPTIONAL, "response.txt, the response curve; default: the sRGB curve"),
        CLI_STR("model", &r.model, CLI_OPTIONAL, "COLMAP text model with the view's camera, to be written to ID.exr"),
        CLI_STR("views", &r.frame.views, CLI_OPTIONAL,
                "folder of the scene's cameras.txt, images.txt and lenses.txt: the pose in the model is moved to the "
                "scene's frame by the photographs that both have; default: it is in that frame"),
        CLI_STR("scene-records", &r.frame.records, CLI_OPTIONAL, "folder of the records of the scene's photographs"),
        CLI_STR("axes", &r.frame.axes, CLI_OPTIONAL, "axes.txt: the pose is in the frame of the room's model"),
        CLI_STR("out", &r.out, CLI_REQUIRED, "folder to write ID.jpg and ID.exr into"),
        CLI_PARAMS(merge_param_table, &params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "hdr_merge", opts, &prov, &err) != CLI_RUN || hdr_merge(&r, &params, &prov, &err))
        err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
