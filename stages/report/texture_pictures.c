/* texture_pictures.c - pictures of atlases: pages, and the room from a view with its textures or their sources.
 *
 * Overview. A page of an atlas shows pieces of walls in no order, so the report also shows what a photograph would
 * see if the model with its textures stood in for the room. Nothing is rendered: the view's ids and depths
 * (trace_ids) give the face and the point of each pixel, and the tile that shows this point gives its texel, as a
 * renderer would look it up at the photograph's own place.
 *
 * A pixel of the thumbnail has SIGHT_SIDE x SIGHT_SIDE samples, which are looked up once, in parallel, before any
 * page is read. Pages are then read one at a time and fill in the samples that lie on them, so memory holds one
 * page.
 *
 * Colours. The picture is the mean of the samples in linear light, encoded as sRGB; hatched grey where most samples
 * have no texel. In the picture of sources each source has its hue, darkened by the luminance of the texel, so that
 * the room stays recognisable; originals are grey, synthesised texels hatched, default ones magenta. */
#include "stages/report/texture_pictures.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"

enum { SAMPLES = SIGHT_SIDE * SIGHT_SIDE, NO_TILE = -1, NO_FACE = -2 };

struct look_up {
    struct sight *sight;
    const struct atlas *atlas;
    const struct view *view;
    const struct model_axes *axes;
    const uint32_t *id;
    const float *z;
    int width, height, orientation; /* the thumbnail before it is turned */
};

static struct sight_sample look_up_pixel(const struct look_up *l, int x, int y)
{
    const size_t at = (size_t)y * (size_t)l->view->width + (size_t)x;
    struct sight_sample s = {.tile = NO_FACE};
    if (!l->id[at] || !(l->z[at] > 0)) return s;
    double px = 0, py = 0;
    const struct vec3 world = view_unproject(l->view, x + 0.5, y + 0.5, (double)l->z[at]);
    const struct atlas_tile *t =
        l->id[at] <= INT32_MAX ? atlas_find(l->atlas, (int)l->id[at], model_from_world_point(l->axes, world), &px, &py)
                               : NULL;
    s.tile = t ? (int)(t - l->atlas->tiles) : NO_TILE;
    s.x = (float)px;
    s.y = (float)py;
    return s;
}

static void look_up_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct look_up *l = ctx;
    (void)thread;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < l->sight->width; x++) {
            struct sight_sample *to = l->sight->samples + SAMPLES * ((size_t)y * (size_t)l->sight->width + (size_t)x);
            int tx, ty;
            page_upright_source(l->orientation, l->width, l->height, x, y, &tx, &ty);
            for (int k = 0; k < SAMPLES; k++) {
                const double u = (tx + (k % SIGHT_SIDE + 0.5) / SIGHT_SIDE) * l->view->width / l->width;
                const double v = (ty + (k / SIGHT_SIDE + 0.5) / SIGHT_SIDE) * l->view->height / l->height;
                to[k] = look_up_pixel(l, (int)u, (int)v);
            }
        }
}

enum status texture_sight_make(struct sight *s, const struct atlas *a, const struct view *view,
                               const struct model_axes *axes, const char *ids, int orientation, int height,
                               struct err *err)
{
    static const char *const NAMES[] = {"id", "Z"};
    struct exr_image im = {0};
    struct look_up l = {.sight = s, .atlas = a, .view = view, .axes = axes, .orientation = orientation};
    *s = (struct sight){0};
    exr_read(&im, ids, NAMES, 2, err);
    if (!err->status && (im.width != view->width || im.height != view->height))
        err_set(err, ST_DATA, "%s has %d x %d pixels, but its view %d x %d; trace it again.", ids, im.width, im.height,
                view->width, view->height);
    if (!err->status && (!exr_find(&im, "id")->u || !exr_find(&im, "Z")->f))
        err_set(err, ST_DATA, "%s: wanted a channel id of integers and Z of floats; trace it again.", ids);
    if (!err->status) {
        l.id = exr_find(&im, "id")->u;
        l.z = exr_find(&im, "Z")->f;
        page_thumb_size(im.width, im.height, orientation, height, &l.width, &l.height);
        s->width = orientation >= 5 ? l.height : l.width;
        s->height = orientation >= 5 ? l.width : l.height;
        const size_t pixels = (size_t)s->width * (size_t)s->height;
        s->samples = malloc(SAMPLES * pixels * sizeof *s->samples);
        if (!s->samples) err_nomem(err, "samples of a view", SAMPLES * pixels * sizeof *s->samples);
    }
    if (!err->status) parallel_for((size_t)s->height, 8, look_up_rows, &l);
    exr_image_release(&im);
    return err->status;
}

void texture_sight_release(struct sight *s)
{
    if (!s) return;
    free(s->samples);
    *s = (struct sight){0};
}

void texture_sight_add_page(struct sight *s, const struct atlas *a, const struct atlas_page *page, int number)
{
    const size_t count = SAMPLES * (size_t)s->width * (size_t)s->height;
    for (size_t i = 0; i < count; i++) {
        struct sight_sample *sample = &s->samples[i];
        if (sample->tile < 0 || a->tiles[sample->tile].page != number) continue;
        if (!atlas_sample(sample->rgb, &sample->source, page, &a->tiles[sample->tile], (double)sample->x,
                          (double)sample->y))
            sample->source = ATLAS_NONE;
    }
}

/* Stripes of the two levels of grey. */
static void put_hatched(unsigned char rgb[3], int x, int y, int dark, int light)
{
    memset(rgb, (x + y) % 8 < 4 ? dark : light, 3);
}

static void put_colour(unsigned char rgb[3], const double linear[3])
{
    for (int c = 0; c < 3; c++) rgb[c] = (unsigned char)(255 * srgb_from_linear((float)linear[c]) + 0.5f);
}

/* The mean over a pixel's samples that have a texel; false: most have none. */
static bool mean_of(const struct sight_sample *s, unsigned char rgb[3])
{
    double sum[3] = {0};
    int count = 0;
    for (int k = 0; k < SAMPLES; k++) {
        if (s[k].source == ATLAS_NONE) continue;
        for (int c = 0; c < 3; c++) sum[c] += (double)s[k].rgb[c];
        count++;
    }
    if (2 * count < SAMPLES) return false;
    for (int c = 0; c < 3; c++) sum[c] /= count;
    put_colour(rgb, sum);
    return true;
}

enum status picture_from_sight(struct picture *p, const struct sight *s, struct err *err)
{
    if (picture_init(p, s->width, s->height, err)) return err->status;
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++) {
            const size_t at = (size_t)y * (size_t)s->width + (size_t)x;
            if (!mean_of(s->samples + SAMPLES * at, p->rgb + 3 * at)) put_hatched(p->rgb + 3 * at, x, y, 120, 165);
        }
    return ST_OK;
}

static void put_source(unsigned char rgb[3], const struct sight_sample *samples, int x, int y,
                       const struct source_colour *colours)
{
    static const unsigned char MAGENTA[3] = {255, 0, 255};
    const uint32_t source = samples[SAMPLES / 2].source;
    unsigned char mean[3] = {0};
    if (source == ATLAS_NONE) return; /* black */
    if (source == ATLAS_SYNTHESISED) {
        put_hatched(rgb, x, y, 70, 205);
        return;
    }
    if (source == ATLAS_DEFAULT) {
        memcpy(rgb, MAGENTA, 3);
        return;
    }
    mean_of(samples, mean);
    const struct source_colour *colour = &colours[source - ATLAS_VIEWS];
    const double light = (0.25 * mean[0] + 0.65 * mean[1] + 0.1 * mean[2]) / 255;
    for (int c = 0; c < 3; c++)
        rgb[c] = (unsigned char)(colour->original ? 70 + 160 * light : colour->rgb[c] * (0.55 + 0.45 * light));
}

enum status picture_from_sources(struct picture *p, const struct sight *s, const struct source_colour *colours,
                                 long long *counts, struct err *err)
{
    if (picture_init(p, s->width, s->height, err)) return err->status;
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++) {
            const size_t at = (size_t)y * (size_t)s->width + (size_t)x;
            const struct sight_sample *samples = s->samples + SAMPLES * at;
            put_source(p->rgb + 3 * at, samples, x, y, colours);
            if (samples[SAMPLES / 2].tile != NO_FACE) counts[samples[SAMPLES / 2].source]++;
        }
    return ST_OK;
}

/* Means of boxes, over the texels that exist. */
enum status picture_from_atlas_page(struct picture *p, const struct atlas_page *page, int height, struct err *err)
{
    int w, h;
    page_thumb_size(page->width, page->height, 1, height, &w, &h);
    if (picture_init(p, w, h, err)) return err->status;
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            const int x0 = (int)((int64_t)x * page->width / w), x1 = (int)(((int64_t)x + 1) * page->width / w);
            const int y0 = (int)((int64_t)y * page->height / h), y1 = (int)(((int64_t)y + 1) * page->height / h);
            unsigned char *to = p->rgb + 3 * ((size_t)y * (size_t)w + (size_t)x);
            double sum[3] = {0};
            int count = 0;
            for (int j = y0; j < y1; j++)
                for (int i = x0; i < x1; i++) {
                    const size_t at = (size_t)j * (size_t)page->width + (size_t)i;
                    if (page->source[at] == ATLAS_NONE) continue;
                    for (int c = 0; c < 3; c++) sum[c] += (double)page->rgb[3 * at + (size_t)c];
                    count++;
                }
            for (int c = 0; c < 3 && count; c++) sum[c] /= count;
            if (2 * count >= (x1 - x0) * (y1 - y0))
                put_colour(to, sum);
            else
                put_hatched(to, x, y, 120, 165);
        }
    return ST_OK;
}
