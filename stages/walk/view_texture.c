/* view_texture.c - see view_texture.h.
 *
 * The furniture of a view is drawn as a mesh over a grid of its pixels. A point of the grid has the depth of the
 * nearest pixel of furniture within a cell of it, so that all cells that hold such a pixel have four corners; how much
 * of a pixel is furniture, its alpha, cuts the outline.
 *
 * A second grid holds what the view sees, furniture or not, by which it confirms or denies the furniture of other
 * views, as in render_model (clutter_blend.c): of the pixels around a point the nearest depth, the least confidence and
 * the largest part that is furniture. A view must not deny what another one shows because outlines are off by a
 * pixel. */
#include "stages/walk/view_texture.h"

#include <libdeflate.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/base64.h"
#include "common/capture/view_image.h"
#include "common/clutter/clutter_view.h"
#include "common/image/photo.h"
#include "common/layers/depth_sigma.h"
#include "common/product/product.h"
#include "common/texture/picture_made.h"
#include "stages/walk/atlas_texture.h"
#include "stages/walk/data_file.h"

enum { DEPTH_LEVELS = 65535, THINGS = 255, LEVEL = 9 };
enum { SIGHT_STEPS = 256 };           /* levels of 1 / z for each factor of e: 0.4 % */
static const double SIGHT_LOG = 8;    /* factors of e below the largest 1 / z: the level 1 */
static const double MAX_SLACK = 0.03; /* relative uncertainty of a depth that is 255 */
static const float LEAST = 0.25f;     /* of a pixel, from which it is furniture with a depth of its own */

static enum status read_clutter(struct clutter_view *clutter, const struct walk_scene *s, int at,
                                const struct pane_fronts *panes, struct err *err)
{
    const struct view *view = &s->in.set.views[at];
    const struct product_key key = {.view = view->name};
    struct layered_depth depth = {0};
    struct view_ids ids = {0};
    struct thing_mask things = {0};
    char path[FILE_PATH];
    if (!product_path_in(path, s->files->depth, PRODUCT_DEPTH, &key, err) &&
        !layered_depth_read(&depth, path, NULL, err) && !product_path_in(path, s->files->ids, PRODUCT_IDS, &key, err))
        view_ids_read(&ids, view, path, NULL, err);
    if (!err->status && s->files->things && !product_path_in(path, s->files->things, PRODUCT_THING_MASK, &key, err))
        thing_mask_read(&things, view, path, UINT32_MAX, NULL, err);
    if (!err->status) {
        pane_fronts_apply(&ids, panes, &s->cameras[at], s->in.axes.scale);
        clutter_view_make(clutter, &depth, &ids, s->files->things ? &things : NULL, view->name, err);
    }
    view_ids_release(&ids);
    thing_mask_release(&things);
    layered_depth_release(&depth);
    return err->status;
}

/* 1 / z of the furniture at a pixel, scene units; 0: there is none. *slack: its relative uncertainty. */
static double inverse_depth(const struct clutter_view *c, int x, int y, float *cover, float *slack)
{
    float rgba[4];
    layer_view_photo(&c->layers, x, y, rgba);
    *cover = rgba[3];
    *slack = 0;
    if (rgba[3] < LEAST) return 0;
    const struct texel *t = &c->layers.texels[(size_t)(y + 1) * (size_t)c->layers.stride + (size_t)(x + 1)];
    const uint32_t first = t->id[0] & ~TEXEL_JOINED, id = first ? first : t->id[1] & ~TEXEL_JOINED;
    if (!id) return 0;
    const double *plane = c->depth.segments[id - 1].plane;
    *slack = (float)fmin(MAX_SLACK, depth_width(&c->depth.segments[id - 1]));
    return fmax(0, plane[0] * (x + 0.5) + plane[1] * (y + 0.5) + plane[2]);
}

/* The depths of a view's pixels, and how much of each is furniture. */
struct pixels {
    double *inverse;
    float *slack;
    unsigned char *cover;
    struct clutter_view clutter; /* {0}: there are no depth maps */
};

static void pixels_release(struct pixels *p)
{
    free(p->inverse);
    free(p->slack);
    free(p->cover);
    clutter_view_release(&p->clutter);
}

struct grid {
    int columns, rows, step;
    double *inverse;
    float *slack;
};

static void find_point(struct grid *g, const struct pixels *p, const struct view *view, int i, int j)
{
    const int x = i * g->step, y = j * g->step;
    double nearest = INFINITY;
    for (int v = y - g->step; v < y + g->step; v++)
        for (int u = x - g->step; u < x + g->step; u++) {
            if (u < 0 || v < 0 || u >= view->width || v >= view->height) continue;
            const size_t at = (size_t)v * (size_t)view->width + (size_t)u;
            const double away = hypot(u + 0.5 - x, v + 0.5 - y);
            if (!(p->inverse[at] > 0) || away >= nearest) continue;
            nearest = away;
            g->inverse[(size_t)j * (size_t)g->columns + (size_t)i] = p->inverse[at];
            g->slack[(size_t)j * (size_t)g->columns + (size_t)i] = p->slack[at];
        }
}

static enum status write_packed(FILE *to, const unsigned char *bytes, size_t size, struct err *err)
{
    struct libdeflate_compressor *c = libdeflate_alloc_compressor(LEVEL);
    const size_t room = c ? libdeflate_zlib_compress_bound(c, size) : 0;
    unsigned char *packed = malloc(room + 1);
    putc('"', to);
    if (c && packed)
        base64_write(to, packed, libdeflate_zlib_compress(c, bytes, size, packed, room));
    else
        err_nomem(err, "a grid of depths", room);
    putc('"', to);
    free(packed);
    if (c) libdeflate_free_compressor(c);
    return err->status;
}

static enum status write_grid(FILE *to, const struct walk_scene *s, int at, const struct pixels *p, struct err *err)
{
    const struct view *view = &s->cameras[at];
    const struct thing_volume *volume = &s->models[0].things.volume;
    struct grid g = {.step = s->params->grid};
    g.columns = (view->width + g.step - 1) / g.step + 1;
    g.rows = (view->height + g.step - 1) / g.step + 1;
    const size_t points = (size_t)g.columns * (size_t)g.rows;
    unsigned char *bytes = calloc(4, points);
    g.inverse = calloc(points, sizeof *g.inverse);
    g.slack = calloc(points, sizeof *g.slack);
    if (!bytes || !g.inverse || !g.slack) err_nomem(err, "a grid of depths", points * (4 + sizeof *g.inverse));
    double most = 0;
    for (int j = 0; !err->status && j < g.rows; j++)
        for (int i = 0; i < g.columns; i++) {
            find_point(&g, p, view, i, j);
            most = fmax(most, g.inverse[(size_t)j * (size_t)g.columns + (size_t)i]);
        }
    for (size_t k = 0; !err->status && k < points; k++) {
        if (!(g.inverse[k] > 0)) continue;
        const int level = (int)fmax(1, DEPTH_LEVELS * g.inverse[k] / most + 0.5);
        const double u = (double)(k % (size_t)g.columns) * g.step, v = (double)(k / (size_t)g.columns) * g.step;
        const uint32_t thing = thing_volume_at(volume, view_unproject(view, u, v, s->in.axes.scale / g.inverse[k]));
        bytes[k] = (unsigned char)(level & 255); /* planes of low bytes, high bytes, things, slack: they pack better */
        bytes[points + k] = (unsigned char)(level >> 8);
        bytes[2 * points + k] = thing <= THINGS ? (unsigned char)thing : 0;
        bytes[3 * points + k] = (unsigned char)((double)g.slack[k] / MAX_SLACK * 255 + 0.5);
    }
    fprintf(to, ",\"columns\":%d,\"rows\":%d,\"most\":", g.columns, g.rows);
    data_write_number(to, most / s->in.axes.scale);
    fputs(",\"depth\":", to);
    if (!err->status) write_packed(to, bytes, 4 * points, err);
    free(g.inverse);
    free(g.slack);
    free(bytes);
    return err->status;
}

/* What the view sees around a point of the grid. */
static struct clutter_sight find_sight(const struct clutter_view *c, const struct view *view, int x, int y, int reach)
{
    struct clutter_sight sight = {.sure = UINT8_MAX};
    for (int v = y - reach; v < y + reach; v++)
        for (int u = x - reach; u < x + reach; u++) {
            if (u < 0 || v < 0 || u >= view->width || v >= view->height) continue;
            const struct clutter_sight *s = &c->sight[(size_t)v * (size_t)view->width + (size_t)u];
            if (!(s->nearest > 0)) continue;
            sight.nearest = fmaxf(sight.nearest, s->nearest);
            if (s->sure < sight.sure) sight.sure = s->sure;
            if (s->shows > sight.shows) sight.shows = s->shows;
        }
    return sight;
}

/* Planes of bytes: low and high ones of the differences of levels along a row, confidence, share of furniture. */
static enum status write_sight(FILE *to, const struct walk_scene *s, int at, const struct clutter_view *c,
                               struct err *err)
{
    const struct view *view = &s->cameras[at];
    const int step = s->params->grid, columns = (view->width + step - 1) / step + 1,
              rows = (view->height + step - 1) / step + 1, reach = step / 2 > 1 ? step / 2 : 1;
    const size_t points = (size_t)columns * (size_t)rows, pixels = (size_t)view->width * (size_t)view->height;
    unsigned char *bytes = calloc(4, points);
    double most = 0;
    for (size_t i = 0; i < pixels; i++) most = fmax(most, (double)c->sight[i].nearest);
    if (!bytes) err_nomem(err, "a grid of depths", 4 * points);
    for (int j = 0; !err->status && j < rows; j++) {
        unsigned before = 0;
        for (int i = 0; i < columns; i++) {
            const size_t k = (size_t)j * (size_t)columns + (size_t)i;
            const struct clutter_sight sight = find_sight(c, view, i * step, j * step, reach);
            const double log_inverse = sight.nearest > 0 ? log((double)sight.nearest / most) + SIGHT_LOG : 0;
            const unsigned level = sight.nearest > 0 ? 1 + (unsigned)(fmax(0, log_inverse) * SIGHT_STEPS + 0.5) : 0;
            bytes[k] = (unsigned char)((level - before) & 255);
            bytes[points + k] = (unsigned char)((level - before) >> 8 & 255);
            bytes[2 * points + k] = sight.nearest > 0 ? sight.sure : 0;
            bytes[3 * points + k] = sight.shows;
            before = level;
        }
    }
    fputs(",\"seen\":", to);
    data_write_number(to, most / s->in.axes.scale);
    fputs(",\"sight\":", to);
    if (!err->status) write_packed(to, bytes, 4 * points, err);
    free(bytes);
    return err->status;
}

static enum status find_pixels(struct pixels *p, const struct walk_scene *s, int at, const struct pane_fronts *panes,
                               struct err *err)
{
    const struct view *view = &s->cameras[at];
    const size_t pixels = (size_t)view->width * (size_t)view->height;
    p->inverse = calloc(pixels, sizeof *p->inverse);
    p->slack = calloc(pixels, sizeof *p->slack);
    p->cover = calloc(pixels, 1);
    if (!p->inverse || !p->slack || !p->cover) return err_nomem(err, "depths", pixels * (5 + sizeof *p->inverse));
    if (!s->files->depth || read_clutter(&p->clutter, s, at, panes, err)) return err->status;
    for (int y = 0; y < view->height; y++)
        for (int x = 0; x < view->width; x++) {
            const size_t i = (size_t)y * (size_t)view->width + (size_t)x;
            float cover;
            p->inverse[i] = inverse_depth(&p->clutter, x, y, &cover, &p->slack[i]);
            p->cover[i] = (unsigned char)(fminf(1, fmaxf(0, cover)) * (255 - VIEW_ALPHA_SEEN));
        }
    return ST_OK;
}

enum status view_texture_write(FILE *to, const struct walk_scene *s, int at, const struct pane_fronts *panes,
                               struct err *err)
{
    const struct view *view = &s->cameras[at];
    const size_t pixels = (size_t)view->width * (size_t)view->height;
    struct image photo = {0}, im = {0};
    struct pixels p = {0};
    unsigned char *alpha = malloc(pixels + 1), *rgba = NULL;
    if (!alpha) err_nomem(err, "a view", pixels);
    if (!err->status && !view_image_read(&photo, s->files->views, &s->in.set.views[at], NULL, err) &&
        !image_init(&im, view->width, view->height, 3, err))
        find_pixels(&p, s, at, panes, err);
    for (size_t i = 0; !err->status && i < pixels; i++) {
        alpha[i] = photo.data[4 * i + 3] > 0 ? (unsigned char)(VIEW_ALPHA_SEEN + p.cover[i]) : 0;
        for (size_t c = 0; c < 3; c++) im.data[3 * i + c] = (float)(s->exposure * (double)photo.data[4 * i + c]);
    }
    fputs("{\"picture\":", to);
    if (!err->status && !atlas_texture_bytes(&rgba, &im, alpha, err))
        atlas_texture_encode(to, rgba, view->width, view->height, s->params->photo_quality, s->params->effort, err);
    if (!err->status && s->files->depth && !write_grid(to, s, at, &p, err)) write_sight(to, s, at, &p.clutter, err);
    putc('}', to);
    image_release(&photo);
    image_release(&im);
    pixels_release(&p);
    free(alpha);
    free(rgba);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- changes */

/* What a pixel comes from, by its colour in a picture of sources. */
static enum picture_made made_of(const uint16_t *rgb)
{
    for (int k = 0; k < MADE_COUNT; k++) {
        const uint8_t *of = picture_made_kind((enum picture_made)k)->rgb;
        if (rgb[0] == of[0] && rgb[1] == of[1] && rgb[2] == of[2]) return (enum picture_made)k;
    }
    return MADE_NOTHING;
}

enum status view_texture_write_change(FILE *to, const struct walk_scene *s, int at, const char *jpeg,
                                      const char *sources, struct err *err)
{
    const struct view *view = &s->in.set.views[at];
    struct photo picture = {0}, made = {0};
    struct image seen = {0};
    unsigned char *rgba = NULL;
    const size_t pixels = (size_t)view->width * (size_t)view->height;
    if (photo_read(&picture, jpeg, err) || (sources && photo_read(&made, sources, err)) ||
        (!sources && view_image_read(&seen, s->files->views, view, NULL, err)))
        goto done;
    if (picture.info.width != view->width || picture.info.height != view->height ||
        (sources && (made.info.width != view->width || made.info.height != view->height))) {
        const struct photo *wrong = sources && picture.info.width == view->width ? &made : &picture;
        err_set(err, ST_DATA, "%s has %d x %d pixels, but view %s has %d x %d. Run make %s again.",
                wrong == &made ? sources : jpeg, wrong->info.width, wrong->info.height, view->name, view->width,
                view->height, sources ? "remodel" : "relight");
        goto done;
    }
    if (!(rgba = malloc(4 * pixels))) err_nomem(err, "a picture", 4 * pixels);
    for (size_t i = 0; !err->status && i < pixels; i++) {
        const enum picture_made kind = sources ? made_of(made.samples + 3 * i) : MADE_PHOTO;
        const bool shown = sources ? kind != MADE_NOTHING && kind != MADE_PHOTO : seen.data[4 * i + 3] > 0;
        for (size_t c = 0; c < 3; c++) rgba[4 * i + c] = (unsigned char)picture.samples[3 * i + c];
        rgba[4 * i + 3] = shown ? (unsigned char)(VIEW_ALPHA_MADE + VIEW_ALPHA_STEP * (int)kind) : 0;
    }
    if (!err->status)
        atlas_texture_encode(to, rgba, view->width, view->height, s->params->photo_quality, s->params->effort, err);
done:
    free(rgba);
    photo_release(&picture);
    photo_release(&made);
    image_release(&seen);
    return err->status;
}
