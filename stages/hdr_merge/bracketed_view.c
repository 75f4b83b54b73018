/* bracketed_view.c - see bracketed_view.h. */
#include "stages/hdr_merge/bracketed_view.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/exr.h"
#include "common/outfile.h"

#define LARGEST_HALF 65504.0f

/* The caller frees it. */
static enum status join(char **path, const char *folder, const char *name, const char *ending, struct err *err)
{
    if (asprintf(path, "%s/%s%s", folder, name, ending) >= 0) return ST_OK;
    *path = NULL;
    return err_nomem(err, "a file name", strlen(folder) + strlen(name));
}

static enum status read_photos(struct bracketed_view *v, const char *photos, struct provenance *prov, struct err *err)
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

enum status bracketed_view_read(struct bracketed_view *v, const char *id, const char *photos, const char *records,
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
    enum status st = photo_write_jpeg(path, rgb, p->info.width, p->info.height, QUALITY, &p->info, err);
    free(rgb);
    return st;
}

enum status bracketed_view_write_middle(const struct bracketed_view *v, const char *photos, const char *out,
                                        struct err *err)
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
    char name[64];
    enum status st = exr_set_attribute(im, "remodel:radiometry", r->bracket_count > 1 ? "exact" : "one exposure", err);
    if (!st) st = exr_set_number(im, "remodel:white", r->white, err);
    for (int i = 0; !st && i < r->bracket_count; i++) {
        snprintf(name, sizeof name, "remodel:exposure.%d", i + 1);
        st = exr_set_number(im, name, r->brackets[i].exposure, err);
    }
    return st;
}

enum status bracketed_view_write_radiance(const struct bracketed_view *v, const char *out,
                                          const struct provenance *prov, size_t *beyond, struct err *err)
{
    static const char *const names[] = {"R", "G", "B"};
    struct exr_image im = {0};
    char *path = NULL;
    size_t pixels = (size_t)v->radiance.width * (size_t)v->radiance.height;
    *beyond = 0;
    enum status st = join(&path, out, v->record.id, ".exr", err);
    if (!st) st = exr_image_init(&im, v->radiance.width, v->radiance.height, err);
    for (size_t c = 0; !st && c < 3; c++) {
        struct exr_plane *plane = NULL;
        st = exr_add_plane(&im, names[c], EXR_HALF, &plane, err);
        for (size_t i = 0; !st && i < pixels; i++)
            *beyond += (plane->f[i] = v->radiance.data[3 * i + c]) > LARGEST_HALF;
    }
    struct exr_plane *clipped = NULL;
    if (!st) st = exr_add_plane(&im, "clipped", EXR_UINT, &clipped, err);
    for (size_t i = 0; !st && i < pixels; i++) clipped->u[i] = v->marks[i];
    if (!st) st = set_attributes(&im, &v->record, err);
    if (!st) st = exr_write(&im, path, prov, err);
    exr_image_release(&im);
    free(path);
    return st;
}

void bracketed_view_release(struct bracketed_view *v)
{
    if (!v) return;
    for (int i = 0; i < MERGE_MOST; i++) photo_release(&v->photos[i]);
    photo_record_release(&v->record);
    image_release(&v->radiance);
    free(v->marks);
    *v = (struct bracketed_view){0};
}
