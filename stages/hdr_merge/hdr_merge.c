/* hdr_merge.c - merges the bracketed exposures of one view into linear radiance.
 *
 * reads   RECORDS/ID.txt    which photos are the view's exposures, and how they were exposed
 *         PHOTOS/FILE       the photos
 * writes  OUT/ID.jpg        the middle exposure, what structure from motion sees; a JPEG's own bytes
 *         OUT/ID.exr        R G B (half): 1 is white at the exposure remodel:white, which all views of a scene share;
 *                           clipped (uint): 1 a colour saturates in every exposure, 2 a colour is dark in every
 *                           exposure that does not saturate, 3 both
 *
 * Each file appears whole or not at all, ID.exr last. */
#include <stdlib.h>

#include "common/cli.h"
#include "common/log.h"
#include "stages/hdr_merge/bracketed_view.h"

static enum status merge_view(struct bracketed_view *v, const struct merge_params *params, struct err *err)
{
    size_t pixels = (size_t)v->photos[0].info.width * (size_t)v->photos[0].info.height;
    v->marks = malloc(pixels);
    if (!v->marks) return err_nomem(err, "marks of a view", pixels);
    if (merge_brackets(&v->radiance, v->marks, v->photos, v->exposures, v->record.bracket_count, params, err))
        return err_context(err, "view %s", v->record.id);
    return ST_OK;
}

/* Linear light needs exposures and a curve that are true; photos tell whether they are. */
static void warn_if_exposures_disagree(const struct bracketed_view *v)
{
    const double most = 1.15; /* JPEG, noise and clipped colours move it by a few percent */
    struct exposure_agreement a;
    const struct photo_record *r = &v->record;
    merge_agreement(&a, v->photos, v->exposures, r->bracket_count);
    if (a.pair && (a.seen > most * a.stated || a.stated > most * a.seen))
        log_warn(
            "view %s: %s should have %.3g times the light of %s, but shows %.3g times as much; either the exposures "
            "are wrong (exposures.txt corrects them), or the photos were not developed to the sRGB curve. Its "
            "radiance is not exact.",
            r->id, r->brackets[a.pair].file, a.stated, r->brackets[a.pair - 1].file, a.seen);
}

static void tell(const struct bracketed_view *v)
{
    size_t pixels = (size_t)v->radiance.width * (size_t)v->radiance.height, bright = 0, dark = 0;
    for (size_t i = 0; i < pixels; i++) {
        bright += (v->marks[i] & MERGE_BRIGHT) != 0;
        dark += (v->marks[i] & MERGE_DARK) != 0;
    }
    log_note("%s: %d exposures; %.2f %% of the pixels saturate in all of them, %.2f %% are dark in all of them",
             v->record.id, v->record.bracket_count, 100.0 * (double)bright / (double)pixels,
             100.0 * (double)dark / (double)pixels);
}

static enum status hdr_merge(const char *id, const char *photos, const char *records, const char *out,
                             const struct merge_params *params, struct provenance *prov, struct err *err)
{
    struct bracketed_view v = {0};
    size_t beyond = 0;
    enum status st = bracketed_view_read(&v, id, photos, records, prov, err);
    if (!st) st = merge_view(&v, params, err);
    if (!st) st = bracketed_view_write_middle(&v, photos, out, err);
    if (!st) st = bracketed_view_write_radiance(&v, out, prov, &beyond, err);
    if (!st && beyond)
        log_warn("view %s: %zu samples are brighter than a half number holds times white, and cut there.", id, beyond);
    if (!st) tell(&v);
    if (!st) warn_if_exposures_disagree(&v);
    bracketed_view_release(&v);
    return st;
}

int main(int argc, char **argv)
{
    const char *id = NULL, *photos = NULL, *records = NULL, *out = NULL;
    struct merge_params params = MERGE_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Merges the bracketed exposures of one view into linear radiance."),
        CLI_STR("id", &id, CLI_REQUIRED, "view to merge, by its record's id"),
        CLI_STR("photos", &photos, CLI_REQUIRED, "folder of photographs"),
        CLI_STR("records", &records, CLI_REQUIRED, "folder of records"),
        CLI_STR("out", &out, CLI_REQUIRED, "folder to write ID.jpg and ID.exr into"),
        CLI_PARAMS(merge_param_table, &params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "hdr_merge", opts, &prov, &err) != CLI_RUN ||
        hdr_merge(id, photos, records, out, &params, &prov, &err))
        err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
