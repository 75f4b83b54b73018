/* photo_gain.c - HDR photos with a gain map: Ultra HDR JPEG [Google 2023] and JPEG of ISO 21496-1 [ISO 2025].
 *
 * The file begins with an ordinary JPEG, whose XMP or ISO data say that a gain map follows. Its place is found by the
 * index of multi-picture files (MPF [CIPA 2009], in APP2), or by the lengths in the XMP container directory, which
 * count from the end of the ordinary JPEG. A second JPEG there with gain map data of its own is the map. Some writers
 * fill only one of the two lists, or leave wrong offsets behind after an edit, so that all places are tried.
 *
 * The map covers the photo and may have any size: it is interpolated between the four nearest samples. It is applied
 * to linear light in the photo's own primaries, at full headroom. What 8 bits leave: half a level of the map is a
 * factor of 2^((high - low) / 510), 0.5 % for a range of 4 stops.
 *
 * A photo that is HDR itself and whose map leads to a darker picture stays as it is. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <turbojpeg.h>

#include "common/base/parallel.h"
#include "common/image/gain_map.h"
#include "common/image/image.h"
#include "common/image/jpeg_segment.h"
#include "common/image/photo_formats.h"

#define XMP_NAME "http://ns.adobe.com/xap/1.0/"
#define ISO_NAME "urn:iso:std:iso:ts:21496:-1"

enum { STEPS = 16, LEVELS = 255 * STEPS, ROWS = 8 }; /* of the table of gains, between two levels of the map */

/* ---------------------------------------------------------------------------------------------------------- finding */

struct block {
    const unsigned char *bytes; /* NULL: the file has none */
    size_t size;
};

struct headers {
    struct block xmp, iso, mpf;
};

static void take_block(struct block *to, const struct jpeg_segment *s, unsigned char marker, const char *name)
{
    if (to->bytes || !jpeg_segment_is(s, marker, name)) return;
    const size_t length = strlen(name) + 1;
    *to = (struct block){s->body + length, s->size - length};
}

static struct headers read_headers(const unsigned char *bytes, size_t size)
{
    struct headers h = {0};
    struct jpeg_segment s;
    for (size_t at = 2; jpeg_segment_next(&s, bytes, size, &at);) {
        take_block(&h.xmp, &s, 0xe1, XMP_NAME);
        take_block(&h.iso, &s, 0xe2, ISO_NAME);
        take_block(&h.mpf, &s, 0xe2, "MPF");
    }
    return h;
}

static bool has_data(const struct headers *h)
{
    return h->iso.bytes || (h->xmp.bytes && gain_map_in_xmp((const char *)h->xmp.bytes, h->xmp.size));
}

/* Where the second picture and those after it begin. */
struct places {
    size_t at[2 * GAIN_MAP_ITEMS];
    int count;
};

static void add_place(struct places *p, double at, size_t size)
{
    if (p->count < 2 * GAIN_MAP_ITEMS && at > 0 && at + 4 <= (double)size) p->at[p->count++] = (size_t)at;
}

static uint32_t number(const unsigned char *b, int bytes, bool little)
{
    uint32_t value = 0;
    for (int i = 0; i < bytes; i++) value = value << 8 | b[little ? bytes - 1 - i : i];
    return value;
}

/* The index is a TIFF directory whose entry 0xb002 lists 16 bytes for each picture: attributes, size, offset from the
 * index. */
static void add_mpf(struct places *p, const struct block *mpf, const struct photo_bytes *file)
{
    const unsigned char *b = mpf->bytes;
    const size_t size = mpf->size, origin = (size_t)(b - file->bytes);
    if (size < 8) return;
    const bool little = b[0] == 'I';
    const size_t directory = number(b + 4, 4, little);
    if (directory > size || size - directory < 2) return;
    const size_t entries = number(b + directory, 2, little);
    for (size_t i = 0; i < entries && directory + 2 + 12 * (i + 1) <= size; i++) {
        const unsigned char *entry = b + directory + 2 + 12 * i;
        if (number(entry, 2, little) != 0xb002) continue;
        const size_t bytes = number(entry + 4, 4, little), from = number(entry + 8, 4, little);
        for (size_t k = 1; 16 * (k + 1) <= bytes && from + 16 * (k + 1) <= size; k++) /* the first is the photo */
            add_place(p, (double)origin + number(b + from + 16 * k + 8, 4, little), file->size);
    }
}

static enum status add_container(struct places *p, const struct block *xmp, const struct photo_bytes *file,
                                 struct err *err)
{
    struct gain_map_items items = {0};
    if (gain_map_list_items(&items, (const char *)xmp->bytes, xmp->size, file->path, err)) return err->status;
    double at = (double)jpeg_segment_end(file->bytes, file->size);
    if (at <= 0) return ST_OK;
    for (int i = 0; i < items.count; i++) {
        if (i) {
            if (items.items[i].is_gain_map) add_place(p, at, file->size);
            at += items.items[i].length;
        }
        at += items.items[i].padding;
    }
    return ST_OK;
}

struct map_file {
    const unsigned char *bytes; /* of the map's JPEG; NULL: none */
    size_t size;
    struct headers headers;
};

/* ST_DATA: the photo says that it has a gain map, and none is found. */
static enum status find_map(struct map_file *map, const struct photo_bytes *file, struct err *err)
{
    const struct headers h = read_headers(file->bytes, file->size);
    struct places places = {0};
    *map = (struct map_file){0};
    if (!has_data(&h)) return ST_OK;
    if (h.mpf.bytes) add_mpf(&places, &h.mpf, file);
    if (h.xmp.bytes && gain_map_in_xmp((const char *)h.xmp.bytes, h.xmp.size))
        add_container(&places, &h.xmp, file, err);
    for (int i = 0; !err->status && !map->bytes && i < places.count; i++) {
        const unsigned char *b = file->bytes + places.at[i];
        const size_t size = file->size - places.at[i];
        if (b[0] != 0xff || b[1] != 0xd8 || b[2] != 0xff) continue;
        const struct headers own = read_headers(b, size);
        if (has_data(&own)) *map = (struct map_file){b, size, own};
    }
    if (err->status || map->bytes) return err->status;
    return err_set(err, ST_DATA,
                   "%s says that it has a gain map, but none of the %d places in the file that it names holds one "
                   "(programs that edit photos may cut it off); export the photo again, or set [import_photos] "
                   "gain_map = no.",
                   file->path, places.count);
}

static enum status read_data(struct gain_map_data *data, const struct map_file *map, const char *path, struct err *err)
{
    const struct headers *h = &map->headers;
    if (h->xmp.bytes && gain_map_in_xmp((const char *)h->xmp.bytes, h->xmp.size))
        return gain_map_from_xmp(data, (const char *)h->xmp.bytes, h->xmp.size, path, err);
    return gain_map_from_iso(data, h->iso.bytes, h->iso.size, path, err);
}

/* --------------------------------------------------------------------------------------------------------- applying */

struct gain_job {
    const struct photo *photo;
    const unsigned char *map; /* R G B */
    int width, height;        /* of the map */
    const float *light[3];    /* of the photo's levels */
    const float *gain[3];     /* at LEVELS + 1 values of the map */
    float base_offset[3], hdr_offset[3];
    float *out;
};

/* The samples before and behind the centre of pixel i of `of`, among `count`, and the share of the second. */
static float between(int i, int of, int count, size_t *first, size_t *second)
{
    const double at = fmin(fmax((i + 0.5) * count / of - 0.5, 0), count - 1);
    *first = (size_t)at;
    *second = *first + 1 < (size_t)count ? *first + 1 : *first;
    return (float)(at - (double)*first);
}

static void apply_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct gain_job *job = ctx;
    const int width = job->photo->info.width, height = job->photo->info.height;
    (void)thread;
    for (size_t y = begin; y < end; y++) {
        size_t above, below, left, right;
        const float down = between((int)y, height, job->height, &above, &below);
        const unsigned char *upper = job->map + 3 * above * (size_t)job->width,
                            *lower = job->map + 3 * below * (size_t)job->width;
        const uint16_t *samples = job->photo->samples + 3 * y * (size_t)width;
        float *out = job->out + 3 * y * (size_t)width;
        for (int x = 0; x < width; x++, samples += 3, out += 3) {
            const float across = between(x, width, job->width, &left, &right);
            for (size_t c = 0; c < 3; c++) {
                const float a = upper[3 * left + c], b = upper[3 * right + c], d = lower[3 * left + c],
                            e = lower[3 * right + c];
                const float top = a + across * (b - a), bottom = d + across * (e - d);
                const float level = STEPS * (top + down * (bottom - top));
                const size_t low = (size_t)level < LEVELS ? (size_t)level : LEVELS - 1;
                const float *g = job->gain[c] + low, gain = g[0] + (level - (float)low) * (g[1] - g[0]);
                const float light = (job->light[c][samples[c]] + job->base_offset[c]) * gain - job->hdr_offset[c];
                out[c] = light > 0 ? light : 0;
            }
        }
    }
}

static void make_gains(float *gains, const struct gain_map_data *d)
{
    for (int c = 0; c < 3; c++)
        for (int i = 0; i <= LEVELS; i++)
            gains[c * (LEVELS + 1) + i] =
                (float)exp2(d->low[c] + (d->high[c] - d->low[c]) * pow((double)i / LEVELS, 1 / d->gamma[c]));
}

/* Grey maps have three equal colours. The caller frees *rgb. */
static enum status decode_map(unsigned char **rgb, int *width, int *height, const struct map_file *map,
                              const char *path, struct err *err)
{
    int subsampling = 0, space = 0;
    *rgb = NULL;
    tjhandle handle = tjInitDecompress();
    if (!handle) return err_nomem(err, "a JPEG decoder", 0);
    bool good = !tjDecompressHeader3(handle, map->bytes, map->size, width, height, &subsampling, &space) &&
                *width > 0 && *height > 0 && space != TJCS_CMYK && space != TJCS_YCCK;
    if (good && !photo_check_size(path, (uint64_t)*width, (uint64_t)*height, err)) {
        const size_t bytes = (size_t)*width * (size_t)*height * 3;
        *rgb = malloc(bytes);
        if (!*rgb)
            err_nomem(err, "a gain map", bytes);
        else
            good = !tjDecompress2(handle, map->bytes, map->size, *rgb, *width, 0, *height, TJPF_RGB,
                                  TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS);
    }
    if (!err->status && !good)
        err_set(err, ST_DATA,
                "%s: its gain map is damaged or cut off (%s); copy or export the photo again, or set [import_photos] "
                "gain_map = no.",
                path, tjGetErrorStr2(handle));
    tjDestroy(handle);
    return err->status;
}

/* The photo's samples become values. */
static enum status apply(struct photo *p, const struct gain_map_data *data, const unsigned char *map, int width,
                         int height, struct err *err)
{
    const size_t levels = p->info.bits == 16 ? 65536 : 256, table = LEVELS + 1;
    struct gain_job job = {.photo = p, .map = map, .width = width, .height = height};
    float *curve = malloc(levels * sizeof *curve), *gains = malloc(3 * table * sizeof *gains);
    if (!curve || !gains) err_nomem(err, "a table of gains", (levels + 3 * table) * sizeof *gains);
    if (!err->status && !photo_init_values(p, err)) {
        for (size_t i = 0; i < levels; i++) curve[i] = linear_from_srgb((float)i / (float)(levels - 1));
        make_gains(gains, data);
        for (size_t c = 0; c < 3; c++) {
            job.light[c] = p->space ? p->space->light + c * levels : curve;
            job.gain[c] = gains + c * table;
            job.base_offset[c] = (float)data->base_offset[c];
            job.hdr_offset[c] = (float)data->hdr_offset[c];
        }
        job.out = p->values;
        parallel_for((size_t)p->info.height, ROWS, apply_rows, &job);
        if (p->space) colour_space_to_rec709(p->space, p->values, (size_t)p->info.width * (size_t)p->info.height);
    }
    free(curve);
    free(gains);
    return err->status;
}

enum status photo_apply_gain(struct photo *p, const struct photo_bytes *file, enum photo_want want, struct err *err)
{
    struct map_file map;
    struct gain_map_data data;
    unsigned char *rgb = NULL;
    int width = 0, height = 0;
    if (find_map(&map, file, err) || !map.bytes || read_data(&data, &map, file->path, err) || data.base_is_hdr)
        return err->status;
    if (want != PHOTO_HEADER) decode_map(&rgb, &width, &height, &map, file->path, err);
    if (!err->status && want == PHOTO_SAMPLES && !apply(p, &data, rgb, width, height, err))
        p->saturation = photo_find_saturation(p);
    free(rgb);
    if (err->status) return err->status;
    p->info.bits = 32;
    free(p->samples);
    p->samples = NULL;
    colour_space_release(p->space); /* the values are in Rec.709 */
    p->space = NULL;
    return ST_OK;
}
