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
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/cli.h"
#include "common/exr.h"
#include "common/log.h"
#include "common/outfile.h"
#include "common/photo_list.h"
#include "stages/hdr_merge/merge.h"

#define LARGEST_HALF 65504.0f

struct view {
    struct photo_record record;
    struct photo photos[MERGE_MOST];
    double exposures[MERGE_MOST]; /* relative to white's */
    struct image radiance;
    uint8_t *marks;
};

/* The caller frees it. */
static enum status join(char **path, const char *folder, const char *name, const char *ending, struct err *err)
{
    if (asprintf(path, "%s/%s%s", folder, name, ending) >= 0) return ST_OK;
    *path = NULL;
    return err_nomem(err, "a file name", strlen(folder) + strlen(name));
}

static enum status read_photos(struct view *v, const char *photos, struct provenance *prov, struct err *err)
{
    enum status st = ST_OK;
    for (int i = 0; !st && i < v->record.bracket_count; i++) {
        const struct bracket *b = &v->record.brackets[i];
        char *path = NULL, *input = NULL;
        st = join(&path, photos, b->file, "", err) || join(&input, "photos", b->file, "", err) ? err->status : ST_OK;
        if (!st) st = photo_read(&v->photos[i], path, err);
        if (!st) st = provenance_add_file(prov, input, path, err);
        v->exposures[i] = b->exposure / v->record.white;
        free(path);
        free(input);
    }
    return st;
}

static enum status read_view(struct view *v, const char *id, const char *photos, const char *records,
                             struct provenance *prov, struct err *err)
{
    char *path = NULL, *input = NULL;
    enum status st = photo_record_read(&v->record, records, id, err);
    if (!st && !v->record.bracket_count)
        st =
            err_set(err, ST_DATA, "%s/%s.txt is the record of a single photo; there is nothing to merge.", records, id);
    if (!st && v->record.bracket_count > MERGE_MOST)
        st = err_set(err, ST_DATA, "view %s has %d exposures, wanted at most %d; leave some out (EXCLUDE).", id,
                     v->record.bracket_count, (int)MERGE_MOST);
    if (!st)
        st = join(&path, records, id, ".txt", err) || join(&input, "photos", id, ".txt", err) ? err->status : ST_OK;
    if (!st) st = provenance_add_file(prov, input, path, err);
    if (!st) st = read_photos(v, photos, prov, err);
    free(path);
    free(input);
    return st;
}

static enum status merge_view(struct view *v, const struct merge_params *params, struct err *err)
{
    size_t pixels = (size_t)v->photos[0].info.width * (size_t)v->photos[0].info.height;
    v->marks = malloc(pixels);
    if (!v->marks) return err_nomem(err, "marks of a view", pixels);
    if (merge_brackets(&v->radiance, v->marks, v->photos, v->exposures, v->record.bracket_count, params, err))
        return err_context(err, "view %s", v->record.id);
    return ST_OK;
}

static bool is_jpeg(const char *path)
{
    unsigned char begin[3] = {0};
    FILE *f = fopen(path, "rb");
    bool jpeg = f && fread(begin, 1, sizeof begin, f) == sizeof begin && begin[0] == 0xff && begin[1] == 0xd8;
    if (f) fclose(f);
    return jpeg;
}

static enum status copy_file(const char *from, const char *to, struct err *err)
{
    struct outfile out = {0};
    char bytes[1 << 14];
    size_t n;
    FILE *in = fopen(from, "rb");
    enum status st = in ? outfile_open(&out, to, err) : err_errno(err, "open", from);
    while (!st && (n = fread(bytes, 1, sizeof bytes, in)) > 0)
        if (fwrite(bytes, 1, n, out.fp) != n) st = err_errno(err, "write", to);
    if (!st && ferror(in)) st = err_errno(err, "read", from);
    if (!st) st = outfile_commit(&out, err);
    outfile_discard(&out);
    if (in) fclose(in);
    return st;
}

static enum status encode_photo(const struct photo *p, const char *path, struct err *err)
{
    enum { QUALITY = 95 };
    size_t samples = (size_t)p->info.width * (size_t)p->info.height * 3;
    unsigned char *rgb = malloc(samples);
    if (!rgb) return err_nomem(err, "a photo", samples);
    for (size_t i = 0; i < samples; i++)
        rgb[i] = (unsigned char)(p->info.bits == 16 ? p->samples[i] >> 8 : p->samples[i]);
    enum status st = jpeg_write(path, rgb, p->info.width, p->info.height, QUALITY, err);
    free(rgb);
    return st;
}

static enum status write_middle(const struct view *v, const char *photos, const char *out, struct err *err)
{
    const struct photo_record *r = &v->record;
    char *from = NULL, *to = NULL;
    enum status st = join(&from, photos, r->brackets[r->middle].file, "", err) || join(&to, out, r->id, ".jpg", err)
                         ? err->status
                         : ST_OK;
    if (!st) st = is_jpeg(from) ? copy_file(from, to, err) : encode_photo(&v->photos[r->middle], to, err);
    free(from);
    free(to);
    return st;
}

static enum status set_attributes(struct exr_image *im, const struct photo_record *r, struct err *err)
{
    char name[64], value[64];
    enum status st = exr_set_attribute(im, "remodel:radiometry", r->bracket_count > 1 ? "exact" : "one exposure", err);
    snprintf(value, sizeof value, "%.9g", r->white);
    if (!st) st = exr_set_attribute(im, "remodel:white", value, err);
    for (int i = 0; !st && i < r->bracket_count; i++) {
        snprintf(name, sizeof name, "remodel:exposure.%d", i + 1);
        snprintf(value, sizeof value, "%.9g", r->brackets[i].exposure);
        st = exr_set_attribute(im, name, value, err);
    }
    return st;
}

static enum status write_radiance(const struct view *v, const char *out, const struct provenance *prov, struct err *err)
{
    static const char *const names[] = {"R", "G", "B"};
    struct exr_image im = {0};
    char *path = NULL;
    size_t pixels = (size_t)v->radiance.width * (size_t)v->radiance.height, beyond = 0;
    enum status st = join(&path, out, v->record.id, ".exr", err);
    if (!st) st = exr_image_init(&im, v->radiance.width, v->radiance.height, err);
    for (size_t c = 0; !st && c < 3; c++) {
        struct exr_plane *plane = NULL;
        st = exr_add_plane(&im, names[c], EXR_HALF, &plane, err);
        for (size_t i = 0; !st && i < pixels; i++) beyond += (plane->f[i] = v->radiance.data[3 * i + c]) > LARGEST_HALF;
    }
    struct exr_plane *clipped = NULL;
    if (!st) st = exr_add_plane(&im, "clipped", EXR_UINT, &clipped, err);
    for (size_t i = 0; !st && i < pixels; i++) clipped->u[i] = v->marks[i];
    if (!st) st = set_attributes(&im, &v->record, err);
    if (!st) st = exr_write(&im, path, prov, err);
    if (!st && beyond)
        log_warn("%s: %zu samples are brighter than %g times white, the most that half numbers hold, and cut there.",
                 path, beyond, (double)LARGEST_HALF);
    exr_image_release(&im);
    free(path);
    return st;
}

/* Linear light needs exposures and a curve that are true; photos tell whether they are. */
static void warn_if_exposures_disagree(const struct view *v)
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

static void tell(const struct view *v)
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
    struct view v = {0};
    enum status st = read_view(&v, id, photos, records, prov, err);
    if (!st) st = merge_view(&v, params, err);
    if (!st) st = write_middle(&v, photos, out, err);
    if (!st) st = write_radiance(&v, out, prov, err);
    if (!st) tell(&v);
    if (!st) warn_if_exposures_disagree(&v);
    for (int i = 0; i < MERGE_MOST; i++) photo_release(&v.photos[i]);
    photo_record_release(&v.record);
    image_release(&v.radiance);
    free(v.marks);
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
