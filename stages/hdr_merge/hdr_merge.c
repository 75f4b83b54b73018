/* hdr_merge.c - merges the bracketed exposures of one view into linear radiance.
 *
 * reads   RECORDS/ID.txt    which photos are the view's exposures, and how they were exposed
 *         PHOTOS/FILE       the photos: JPEG, PNG, TIFF, EXR, raw files
 *         MODEL/cameras.txt, images.txt   the view's lens and pose, if it is there
 *         RESPONSE          how their samples follow light; the sRGB curve if none is given
 * writes  OUT/ID.jpg        the radiance, tone-mapped: what structure from motion sees
 *         OUT/ID.exr        R G B (half): 1 is white at the exposure remodel:white, which all views of a scene share;
 *                           clipped (uint): 1 a colour saturates in every exposure, 2 a colour is dark in every
 *                           exposure that does not saturate, 3 both;
 *                           variance (float): of the luminance, over its square; 1 where nothing sure is known;
 *                           with MODEL worldToCamera and remodel:lens
 *
 * Each file appears whole or not at all, ID.exr last. */
#include <math.h>

#include "common/base/cli.h"
#include "common/base/log.h"
#include "stages/hdr_merge/bracketed_view.h"

static void warn_of_disagreement(const struct bracketed_view *v)
{
    const struct exposure_agreement *a = &v->agreement;
    const struct photo_record *r = &v->record;
    if (a->pair && !v->agree)
        log_warn(
            "view %s: %s should have %.3g times the light of %s, but shows %.3g times as much; either the exposures "
            "are wrong (exposures.txt corrects them), or the photos follow another curve (docs/formats.md, "
            "response.txt). Its radiance is not exact.",
            r->id, r->brackets[a->pair].file, a->stated, r->brackets[a->pair - 1].file, a->seen);
}

static void tell_shifts(const struct bracketed_view *v, const struct merge_params *params)
{
    const struct photo_record *r = &v->record;
    for (int i = 0; i < r->bracket_count; i++) {
        const struct shift *s = &v->alignment.shifts[i];
        if (s->dx || s->dy)
            log_note("%s: %s is shifted by %d, %d px against %s%s", r->id, r->brackets[i].file, s->dx, s->dy,
                     r->brackets[r->middle].file, v->brackets.shifts ? "; corrected" : "");
        if (v->alignment.at_limit[i])
            log_warn("view %s: %s seems to be shifted by as much as is looked for ([hdr_merge] most_shift = %d), or "
                     "more; look at it, and leave it out (EXCLUDE) if it is of another view.",
                     r->id, r->brackets[i].file, params->most_shift);
    }
}

static void tell(const struct bracketed_view *v, const struct merge_params *params)
{
    size_t pixels = (size_t)v->merged.radiance.width * (size_t)v->merged.radiance.height, bright = 0, dark = 0;
    for (size_t i = 0; i < pixels; i++) {
        bright += (v->merged.marks[i] & MERGE_BRIGHT) != 0;
        dark += (v->merged.marks[i] & MERGE_DARK) != 0;
    }
    log_note("%s: %d exposure%s; %.2f %% of the pixels saturate in all of them, %.2f %% are dark in all of them",
             v->record.id, v->record.bracket_count, v->record.bracket_count == 1 ? "" : "s",
             100.0 * (double)bright / (double)pixels, 100.0 * (double)dark / (double)pixels);
    if (v->noise_measured)
        log_note("%s: noise of %.2f %% of white at white, %.3f %% in the dark", v->record.id,
                 100 * sqrt(v->noise[0].photon + v->noise[0].read2), 100 * sqrt(v->noise[0].read2));
    tell_shifts(v, params);
    warn_of_disagreement(v);
}

static enum status hdr_merge(const char *id, const char *photos, const char *records, const char *response,
                             const char *model, const char *out, const struct merge_params *params,
                             struct provenance *prov, struct err *err)
{
    struct bracketed_view v = {0};
    size_t beyond = 0;
    bool placed = false;
    enum status st = bracketed_view_read(&v, id, photos, records, response, prov, err);
    if (!st && model) st = bracketed_view_place(&v, &placed, model, prov, err);
    if (!st && model && !placed)
        log_warn("view %s: %s/images.txt has no image of it; its radiance is written without lens and pose.", id,
                 model);
    if (!st) st = bracketed_view_merge(&v, params, err);
    if (!st) st = bracketed_view_write_picture(&v, photos, out, params, err);
    if (!st) st = bracketed_view_write_radiance(&v, out, prov, &beyond, err);
    if (!st && beyond)
        log_warn("view %s: %zu samples are brighter than a half number holds times white, and cut there.", id, beyond);
    if (!st) tell(&v, params);
    bracketed_view_release(&v);
    return st;
}

int main(int argc, char **argv)
{
    const char *id = NULL, *photos = NULL, *records = NULL, *response = NULL, *model = NULL, *out = NULL;
    struct merge_params params = MERGE_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Merges the bracketed exposures of one view into linear radiance."),
        CLI_STR("id", &id, CLI_REQUIRED, "view to merge, by its record's id"),
        CLI_STR("photos", &photos, CLI_REQUIRED, "folder of photographs"),
        CLI_STR("records", &records, CLI_REQUIRED, "folder of records"),
        CLI_STR("response", &response, CLI_OPTIONAL, "response.txt; without it the sRGB curve"),
        CLI_STR("model", &model, CLI_OPTIONAL,
                "COLMAP text model that may know the view's camera, which ID.exr then tells"),
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
