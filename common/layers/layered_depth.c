/* layered_depth.c - reading and writing layered depth maps; formats in docs/formats.md.
 *
 * VIEW.txt, written before the picture because a picture without its segments is useless:
 *   remodel-segments 1
 *   size WIDTH HEIGHT
 *   segments COUNT
 *   ID PIXELS A B C SIGMA CONFIDENCE [DEVIATION]      one line per segment, ids 1 .. COUNT in order
 * Readers check both files against each other, so that callers may index segments by id without checks. */
#include "common/layers/layered_depth.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/outfile.h"
#include "common/base/textfile.h"
#include "common/capture/view_image.h"
#include "common/image/exr.h"

#define PLANES_A_LAYER 6
static const char *const plane_names[2 * PLANES_A_LAYER] = {
    "interior.R", "interior.G", "interior.B", "interior.A", "interior.Z", "interior.id",
    "boundary.R", "boundary.G", "boundary.B", "boundary.A", "boundary.Z", "boundary.id",
};
static const enum exr_type plane_types[PLANES_A_LAYER] = {EXR_HALF, EXR_HALF, EXR_HALF, EXR_HALF, EXR_FLOAT, EXR_UINT};

static enum status layer_init(struct layer *l, size_t pixels, struct err *err)
{
    l->rgba = calloc(pixels, 4 * sizeof *l->rgba);
    l->z = calloc(pixels, sizeof *l->z);
    l->id = calloc(pixels, sizeof *l->id);
    return l->rgba && l->z && l->id ? ST_OK : err_nomem(err, "a layer of a depth map", pixels * 24);
}

static void layer_release(struct layer *l)
{
    free(l->rgba);
    free(l->z);
    free(l->id);
}

enum status layered_depth_init(struct layered_depth *d, int width, int height, struct err *err)
{
    *d = (struct layered_depth){0};
    if (width < 1 || height < 1 || (int64_t)width * height > INT_MAX)
        return err_set(err, ST_DATA, "a depth map cannot have %d x %d pixels.", width, height);
    d->width = width;
    d->height = height;
    size_t pixels = (size_t)width * (size_t)height;
    if (layer_init(&d->interior, pixels, err) || layer_init(&d->boundary, pixels, err)) {
        layered_depth_release(d);
        return ST_NOMEM;
    }
    return ST_OK;
}

void layered_depth_release(struct layered_depth *d)
{
    if (!d) return;
    layer_release(&d->interior);
    layer_release(&d->boundary);
    free(d->segments);
    *d = (struct layered_depth){0};
}

struct depth_shares layered_depth_shares(const struct layered_depth *d)
{
    const size_t pixels = (size_t)d->width * (size_t)d->height;
    size_t unknown = 0, inherited = 0;
    for (size_t i = 0; i < pixels; i++) {
        const uint32_t id = d->interior.id[i];
        if (!id || id > (uint32_t)d->segment_count)
            unknown++;
        else
            inherited += d->segments[id - 1].confidence < DEPTH_INHERITED;
    }
    return (struct depth_shares){(double)unknown / (double)pixels, (double)inherited / (double)pixels};
}

/* PATH.exr -> PATH.txt; the caller frees *text. */
static enum status text_path(char **text, const char *path, struct err *err)
{
    size_t n = strlen(path);
    if (n < 5 || strcmp(path + n - 4, ".exr"))
        return err_set(err, ST_USAGE, "%s: the name of a depth map must end in .exr.", path);
    *text = strdup(path);
    if (!*text) return err_nomem(err, "a file name", n + 1);
    memcpy(*text + n - 4, ".txt", 4);
    return ST_OK;
}

/* Refuses segments that could not be read back. */
static enum status check_segments(const struct layered_depth *d, const char *path, struct err *err)
{
    for (int i = 0; i < d->segment_count; i++) {
        const struct depth_segment *s = &d->segments[i];
        bool finite = isfinite(s->plane[0]) && isfinite(s->plane[1]) && isfinite(s->plane[2]);
        if (s->id == (uint32_t)i + 1 && s->pixels >= 0 && s->pixels <= (int64_t)d->width * d->height && finite &&
            isfinite(s->sigma) && s->sigma >= 0 && s->confidence >= 0 && s->confidence <= 1 && isfinite(s->deviation) &&
            s->deviation >= 0)
            continue;
        return err_set(err, ST_INTERNAL,
                       "cannot write %s: segment %d has id %u, %d pixels, plane %g %g %g, sigma %g, confidence %g, "
                       "deviation %g.",
                       path, i + 1, s->id, s->pixels, s->plane[0], s->plane[1], s->plane[2], s->sigma, s->confidence,
                       s->deviation);
    }
    return ST_OK;
}

static enum status write_segments(const struct layered_depth *d, const char *path, const struct provenance *prov,
                                  struct err *err)
{
    struct outfile file = {0};
    if (!product_begin(&file, PRODUCT_SEGMENTS, path, prov, err)) {
        fprintf(file.fp, "size %d %d\nsegments %d\n", d->width, d->height, d->segment_count);
        for (int i = 0; i < d->segment_count; i++) {
            const struct depth_segment *s = &d->segments[i];
            fprintf(file.fp, "%u %d %.17g %.17g %.17g %.17g %.17g", s->id, s->pixels, s->plane[0], s->plane[1],
                    s->plane[2], s->sigma, s->confidence);
            if (s->deviation > 0) fprintf(file.fp, " %.9g", s->deviation);
            fputc('\n', file.fp);
        }
        outfile_commit(&file, err);
    }
    outfile_discard(&file);
    return err->status;
}

static enum status add_layer(struct exr_image *im, const struct layer *l, const char *const *names, struct err *err)
{
    size_t pixels = (size_t)im->width * (size_t)im->height;
    for (int k = 0; k < PLANES_A_LAYER; k++) {
        struct exr_plane *plane;
        if (exr_add_plane(im, names[k], plane_types[k], &plane, err)) return err->status;
        if (k < 4)
            for (size_t i = 0; i < pixels; i++) plane->f[i] = l->rgba[4 * i + (size_t)k];
        else if (k == 4)
            memcpy(plane->f, l->z, pixels * sizeof *l->z);
        else
            memcpy(plane->u, l->id, pixels * sizeof *l->id);
    }
    return ST_OK;
}

static enum status add_shares(struct exr_image *im, const struct layered_depth *d, struct err *err)
{
    const struct depth_shares shares = layered_depth_shares(d);
    char text[32];
    snprintf(text, sizeof text, "%.6g", shares.unknown);
    if (exr_set_attribute(im, "remodel:unknown", text, err)) return err->status;
    snprintf(text, sizeof text, "%.6g", shares.inherited);
    return exr_set_attribute(im, "remodel:inherited", text, err);
}

enum status layered_depth_write(const struct layered_depth *d, const struct view *view, const char *path,
                                const struct provenance *prov, struct err *err)
{
    struct exr_image im = {0};
    char *text = NULL;
    if (!text_path(&text, path, err) && !check_segments(d, path, err) &&
        !exr_image_init(&im, d->width, d->height, err) && !add_layer(&im, &d->interior, plane_names, err) &&
        !add_layer(&im, &d->boundary, plane_names + PLANES_A_LAYER, err))
        add_shares(&im, d, err);
    if (!err->status) {
        if (view) view_image_set_camera(&im, view);
        write_segments(d, text, prov, err);
    }
    if (!err->status) exr_write(&im, path, prov, err);
    exr_image_release(&im);
    free(text);
    return err->status;
}

static enum status expect_word(struct textfile *t, const char *wanted, struct err *err)
{
    char *word;
    if (!textfile_next(t)) return textfile_error(t, err, NULL, "a line '%s ...'", wanted);
    if (textfile_word(t, wanted, &word, err)) return err->status;
    return strcmp(word, wanted) ? textfile_error(t, err, word, "'%s'", wanted) : ST_OK;
}

static enum status read_segment(struct depth_segment *s, struct textfile *t, int id, int64_t max_pixels,
                                struct err *err)
{
    int64_t id_read, pixels;
    char found[32];
    if (!textfile_next(t)) return textfile_error(t, err, NULL, "a line of segment %d", id);
    if (textfile_int(t, "segment id", id, id, &id_read, err) ||
        textfile_int(t, "pixels", 0, max_pixels, &pixels, err) || textfile_double(t, "plane a", &s->plane[0], err) ||
        textfile_double(t, "plane b", &s->plane[1], err) || textfile_double(t, "plane c", &s->plane[2], err) ||
        textfile_double(t, "sigma", &s->sigma, err) || textfile_double(t, "confidence", &s->confidence, err))
        return err->status;
    if (textfile_more(t) && textfile_number(t, "deviation", 0, INFINITY, &s->deviation, err)) return err->status;
    if (textfile_end(t, err)) return err->status;
    if (s->sigma < 0 || s->confidence < 0 || s->confidence > 1) {
        snprintf(found, sizeof found, "%.9g", s->sigma < 0 ? s->sigma : s->confidence);
        return textfile_error(t, err, found, s->sigma < 0 ? "sigma, 0 or more" : "confidence, from 0 to 1");
    }
    s->id = (uint32_t)id;
    s->pixels = (int)pixels;
    return ST_OK;
}

enum status layered_depth_read_segments(struct layered_depth *d, const char *path, struct provenance *prov,
                                        struct err *err)
{
    struct textfile t = {0};
    int64_t width = 0, height = 0, count = 0;
    *d = (struct layered_depth){0};
    if (!product_open(&t, NULL, PRODUCT_SEGMENTS, path, prov, err) && !expect_word(&t, "size", err) &&
        !textfile_int(&t, "width", 1, 1 << 20, &width, err) &&
        !textfile_int(&t, "height", 1, INT_MAX / width, &height, err) && !textfile_end(&t, err))
        expect_word(&t, "segments", err);
    /* a line has at least 14 bytes: rejects counts that the file cannot hold, before memory is allocated */
    if (!err->status && !textfile_int(&t, "number of segments", 0, (int64_t)(t.size / 14 + 1), &count, err))
        textfile_end(&t, err);
    if (!err->status) {
        d->width = (int)width;
        d->height = (int)height;
        d->segments = calloc((size_t)count + 1, sizeof *d->segments);
        if (!d->segments) err_nomem(err, "segments", (size_t)count * sizeof *d->segments);
    }
    for (int i = 0; !err->status && i < count; i++) {
        read_segment(&d->segments[i], &t, i + 1, width * height, err);
        d->segment_count = i + 1;
    }
    if (!err->status) textfile_end_of_file(&t, err);
    textfile_release(&t);
    if (err->status) layered_depth_release(d);
    return err->status;
}

static enum status take_layer(struct layer *l, const struct exr_image *im, const char *const *names, int segments,
                              const char *path, struct err *err)
{
    size_t pixels = (size_t)im->width * (size_t)im->height;
    const struct exr_plane *planes[PLANES_A_LAYER];
    for (int k = 0; k < PLANES_A_LAYER; k++) {
        planes[k] = exr_find(im, names[k]);
        if (!planes[k] || (k == 5 ? !planes[k]->u : !planes[k]->f))
            return err_set(err, ST_DATA, "%s: channel %s has the wrong type; make the depth map again.", path,
                           names[k]);
    }
    for (size_t i = 0; i < pixels; i++) {
        for (int k = 0; k < 4; k++) l->rgba[4 * i + (size_t)k] = planes[k]->f[i];
        l->z[i] = planes[4]->f[i];
        l->id[i] = planes[5]->u[i];
        if (l->id[i] > (uint32_t)segments || !(l->z[i] >= 0) || !(l->rgba[4 * i + 3] >= 0 && l->rgba[4 * i + 3] <= 1))
            return err_set(err, ST_DATA,
                           "%s: pixel (%zu, %zu) of %.8s has segment %u, alpha %g, z %g; wanted a segment up to %d, an "
                           "alpha from 0 to 1 and a depth of 0 or more. Make the depth map again.",
                           path, i % (size_t)im->width, i / (size_t)im->width, names[0], l->id[i],
                           (double)l->rgba[4 * i + 3], (double)l->z[i], segments);
    }
    return ST_OK;
}

/* layers: 1 (interior only) or 2. */
static enum status read_layers(struct layered_depth *d, const char *path, int layers, struct provenance *prov,
                               struct err *err)
{
    struct exr_image im = {0};
    char *text = NULL;
    if (!text_path(&text, path, err) && !layered_depth_read_segments(d, text, prov, err))
        exr_read_product(&im, PRODUCT_DEPTH, path, plane_names, layers * PLANES_A_LAYER, prov, err);
    if (!err->status && (im.width != d->width || im.height != d->height))
        err_set(err, ST_DATA, "%s has %d x %d pixels, but %s says %d x %d; make the depth map again.", path, im.width,
                im.height, text, d->width, d->height);
    for (int i = 0; !err->status && i < layers; i++) {
        struct layer *l = i ? &d->boundary : &d->interior;
        if (!layer_init(l, (size_t)im.width * (size_t)im.height, err))
            take_layer(l, &im, plane_names + i * PLANES_A_LAYER, d->segment_count, path, err);
    }
    if (err->status) layered_depth_release(d);
    exr_image_release(&im);
    free(text);
    return err->status;
}

enum status layered_depth_read(struct layered_depth *d, const char *path, struct provenance *prov, struct err *err)
{
    *d = (struct layered_depth){0};
    return read_layers(d, path, 2, prov, err);
}

enum status layered_depth_read_interior(struct layered_depth *d, const char *path, struct provenance *prov,
                                        struct err *err)
{
    *d = (struct layered_depth){0};
    return read_layers(d, path, 1, prov, err);
}

enum status layered_depth_read_ids(struct layered_depth *d, const char *path, struct provenance *prov, struct err *err)
{
    static const char *const name[] = {"interior.id"};
    struct exr_image im = {0};
    char *text = NULL;
    if (!text_path(&text, path, err) && !layered_depth_read_segments(d, text, prov, err))
        exr_read_product(&im, PRODUCT_DEPTH, path, name, 1, prov, err);
    struct exr_plane *ids = err->status ? NULL : exr_find(&im, name[0]);
    if (!err->status && (im.width != d->width || im.height != d->height || !ids->u))
        err_set(err, ST_DATA,
                "%s: interior.id is not the plane of %d x %d integers that %s announces; make the depth map again.",
                path, d->width, d->height, text);
    for (size_t i = 0; !err->status && i < (size_t)im.width * (size_t)im.height; i++)
        if (ids->u[i] > (uint32_t)d->segment_count)
            err_set(err, ST_DATA, "%s: pixel (%zu, %zu) has segment %u, wanted one up to %d; make the depth map again.",
                    path, i % (size_t)im.width, i / (size_t)im.width, ids->u[i], d->segment_count);
    if (!err->status) {
        d->interior.id = ids->u;
        ids->u = NULL;
    } else {
        layered_depth_release(d);
    }
    exr_image_release(&im);
    free(text);
    return err->status;
}
