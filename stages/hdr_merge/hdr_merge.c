/* hdr_merge.c - merges the bracketed exposures of one view into linear radiance.
 *
 * reads   RECORDS/ID.txt    the photos of the view, with their exposures
 *         PHOTOS/FILE       the photos: JPEG, PNG, TIFF, EXR, raw files
 *         MODEL/cameras.txt, images.txt   the view's lens and pose, if the model has them
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
    warn_of_disagreement(v);
}

static enum status hdr_merge(const char *id, const char *photos, const char *records, const char *response,
                             const char *model, const char *out, const struct merge_params *params,
                             struct provenance *prov, struct err *err)
{
    struct bracketed_view v = {0};
    size_t clamped = 0;
    bool placed = false;
    enum status st = bracketed_view_read(&v, id, photos, records, response, prov, err);
    if (!st && model) st = bracketed_view_place(&v, &placed, model, prov, err);
    if (!st && model && !placed)
        log_warn("view %s: %s/images.txt has no image of it; its radiance is written without lens and pose.", id,
                 model);
    if (!st) st = bracketed_view_merge(&v, params, err);
    if (!st) st = bracketed_view_write_picture(&v, photos, out, params, err);
    if (!st) st = bracketed_view_write_radiance(&v, out, prov, &clamped, err);
    if (!st && clamped)
        log_warn("view %s: %zu samples exceed 65504 times white, the largest half value, and are clamped to it.", id,
                 clamped);
    if (!st) report(&v, params);
    bracketed_view_release(&v);
    return st;
}

int main(int argc, char **argv)
{
    const char *id = NULL, *photos = NULL, *records = NULL, *response = NULL, *model = NULL, *out = NULL;
    struct merge_params params = MERGE_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Merges the bracketed exposures of one view into linear radiance."),
        CLI_STR("id", &id, CLI_REQUIRED, "id of the view to merge"),
        CLI_STR("photos", &photos, CLI_REQUIRED, "folder of photographs"),
        CLI_STR("records", &records, CLI_REQUIRED, "folder of the photos' records"),
        CLI_STR("response", &response, CLI_OPTIONAL, "response.txt, the response curve; default: the sRGB curve"),
        CLI_STR("model", &model, CLI_OPTIONAL, "COLMAP text model with the view's camera, to be written to ID.exr"),
        CLI_STR("out", &out, CLI_REQUIRED, "folder to write ID.jpg and ID.exr into"),
        CLI_PARAMS(merge_param_table, &params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "hdr_merge", opts, &prov, &err) != CLI_RUN ||
        hdr_merge(id, photos, records, response, model, out, &params, &prov, &err))
        err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
