/* source_view.c - a rectified view as a source of texels: its colours at several sizes, and what each pixel may be
 * used for.
 *
 * Overview. A pixel is a source if the view has one there (alpha), if it is some pixels away from depth jumps, where
 * a small error of the camera would take the colour of another surface, and if nothing that the model does not hold
 * stands in front of the surface. The last is a matter of degree (view_ids.h, clutter): clean, likely, unsure, or
 * hidden. Things that all views together know of (thing_mask.h) hide what is behind them, and their rims do.
 * Clipped and noisy pixels are poor: they are used only where there is nothing better.
 *
 * Pyramid [Williams 1983]. A texel that covers many pixels needs their mean, or a fine photograph aliases in a
 * coarse texture. Level k has pixels of 2^k; each is the mean of four of the level below, with premultiplied alpha.
 * A pixel that may not be used counts as transparent in the first halving, so that it does not leak into its
 * neighbours; a poor one counts only where none of the four is better. A sample uses the level whose pixels are
 * nearest in size to the texel's footprint, on a scale of logarithms, and is bilinear within it: aliasing and blur
 * stay within a factor of sqrt(2).
 *
 * Differs from the source: no blend between two levels. Textures are baked once, so there is no motion in which a
 * change of levels would show.
 *
 * project[] holds the camera as a 3x4 matrix, pixel = project (point, 1), for the loops over texels.
 *
 * Memory: 16 bytes a pixel and a third more for the levels, and 6 bytes a pixel of ids and states. */
#include "common/texture/source_view.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "common/capture/view_image.h"
#include "common/math/distance.h"
#include "common/model/thing_mask.h"

static void add_size(uint64_t *bytes, const char *path)
{
    struct stat file;
    if (!stat(path, &file)) *bytes += (uint64_t)file.st_size;
}

static enum status read_picture(struct view_planes *picture, const char *folder, const struct view *camera,
                                uint64_t *bytes, struct provenance *prov, struct err *err)
{
    char path[FILE_PATH];
    if (!product_path_in(path, folder, PRODUCT_VIEW, &(struct product_key){.view = camera->name}, err) &&
        !view_planes_read(picture, folder, camera, VIEW_CHANNELS, prov, err))
        add_size(bytes, path);
    return err->status;
}

static enum status read_ids(struct view_ids *ids, const char *folder, const struct view *camera, uint64_t *bytes,
                            struct provenance *prov, struct err *err)
{
    char path[FILE_PATH];
    if (!product_path_in(path, folder, PRODUCT_IDS, &(struct product_key){.view = camera->name}, err) &&
        !view_ids_read(ids, camera, path, prov, err))
        add_size(bytes, path);
    return err->status;
}

#define SIDES 4    /* times thing_margin, where depth is not sure */
#define SURE  0.1f /* clutter of a pixel up to which the depth itself says that the surface is there */

/* Whether a pixel shows the surface that the model has there. */
static uint8_t state_of(float alpha, float jump, float clutter, const struct texture_params *p)
{
    if (!(alpha > 0.999f) || jump < (float)p->edge) return SOURCE_NONE;
    if (!(p->max_clutter < 1)) return SOURCE_CLEAN;
    if (clutter >= (float)p->max_clutter) return SOURCE_HIDDEN;
    return clutter >= (float)p->min_clutter ? SOURCE_UNSURE : clutter > SURE ? SOURCE_LIKELY : SOURCE_CLEAN;
}

static enum status level_init(struct source_level *l, int width, int height, struct err *err)
{
    *l = (struct source_level){width, height, calloc((size_t)width * (size_t)height, 4 * sizeof(float))};
    return l->rgba ? ST_OK : err_nomem(err, "a picture", (size_t)width * (size_t)height * 4 * sizeof(float));
}

static uint8_t best_of_four(const struct source_level *from, const uint8_t *state, int x, int y)
{
    uint8_t best = 0;
    for (int k = 0; k < 4; k++) {
        const int sx = 2 * x + (k & 1), sy = 2 * y + (k >> 1);
        if (sx >= from->width || sy >= from->height) continue;
        const uint8_t here = state[(size_t)sy * (size_t)from->width + (size_t)sx];
        if (here > best) best = here;
    }
    return best;
}

/* Half the size: each pixel is the sum of four over 4, a missing one counting as transparent. state: of the finer
 * level's pixels, NULL: all are used; poor ones only where there is nothing better. */
static void halve(struct source_level *to, const struct source_level *from, const uint8_t *state)
{
    for (int y = 0; y < to->height; y++)
        for (int x = 0; x < to->width; x++) {
            float *out = to->rgba + 4 * ((size_t)y * (size_t)to->width + (size_t)x);
            const uint8_t least = state && best_of_four(from, state, x, y) > SOURCE_POOR ? SOURCE_UNSURE : SOURCE_POOR;
            for (int k = 0; k < 4; k++) {
                const int sx = 2 * x + (k & 1), sy = 2 * y + (k >> 1);
                if (sx >= from->width || sy >= from->height) continue;
                const size_t at = (size_t)sy * (size_t)from->width + (size_t)sx;
                if (state && state[at] < least) continue;
                for (int c = 0; c < 4; c++) out[c] += 0.25f * from->rgba[4 * at + (size_t)c];
            }
        }
}

static enum status make_levels(struct source_view *v, struct err *err)
{
    while (!err->status && v->level_count < SOURCE_LEVELS) {
        const struct source_level *finer = &v->levels[v->level_count - 1];
        if (finer->width < 2 || finer->height < 2) break;
        if (!level_init(&v->levels[v->level_count], (finer->width + 1) / 2, (finer->height + 1) / 2, err))
            halve(&v->levels[v->level_count], finer, v->level_count == 1 ? v->state : NULL);
        v->level_count++;
    }
    return err->status;
}

static void set_projection(struct source_view *v)
{
    const struct view *c = &v->camera;
    const double t[3] = {c->translation.x, c->translation.y, c->translation.z};
    for (int i = 0; i < 4; i++) {
        const double x = i < 3 ? c->cam_from_world.m[0][i] : t[0], y = i < 3 ? c->cam_from_world.m[1][i] : t[1];
        const double z = i < 3 ? c->cam_from_world.m[2][i] : t[2];
        v->project[0][i] = c->fx * x + c->cx * z;
        v->project[1][i] = c->fy * y + c->cy * z;
        v->project[2][i] = z;
    }
}

static void take_pixels(struct source_view *v, const float *const channel[VIEW_CHANNELS], const struct view_ids *ids,
                        const struct texture_params *params)
{
    const size_t pixels = (size_t)v->camera.width * (size_t)v->camera.height;
    for (size_t i = 0; i < pixels; i++) {
        v->own[i] = state_of(channel[VIEW_A][i], ids->jump[i], ids->clutter[i], params);
        const bool poor = channel[VIEW_CLIPPED][i] > 0 || channel[VIEW_SIGMA][i] > (float)params->max_noise;
        v->state[i] = !poor ? v->own[i] : v->own[i] >= SOURCE_LIKELY ? SOURCE_POOR : SOURCE_NONE;
        const float alpha = channel[VIEW_A][i] > 0.999f;
        for (int c = 0; c < 3; c++) v->levels[0].rgba[4 * i + (size_t)c] = alpha * fmaxf(channel[c][i], 0);
        v->levels[0].rgba[4 * i + 3] = alpha;
    }
}

static enum status list_faces(struct source_view *v, struct err *err)
{
    const size_t pixels = (size_t)v->camera.width * (size_t)v->camera.height;
    for (size_t i = 0; i < pixels; i++)
        if (v->id[i] >= v->ids) v->ids = v->id[i] + 1;
    v->shows = calloc((size_t)v->ids + 1, 1);
    if (!v->shows) return err_nomem(err, "the faces of a view", v->ids);
    for (size_t i = 0; i < pixels; i++)
        if (v->state[i] > SOURCE_NONE) v->shows[v->id[i]] = 1;
    return ST_OK;
}

/* Pixels that show a thing, or whose ray meets one, and those around them are hidden; where depth is not sure, those in
 * a wider rim: plain sides of furniture get the depth of the wall. What else stands in front is this view's word. */
static enum status hide_things(struct source_view *v, const char *folder, const struct view *camera,
                               const struct texture_params *params, struct provenance *prov, struct err *err)
{
    const size_t pixels = (size_t)camera->width * (size_t)camera->height;
    const float margin = (float)params->thing_margin, wide = SIDES * margin;
    char path[FILE_PATH];
    struct thing_mask mask = {0};
    uint8_t *free_of = malloc(pixels + 1);
    float *squared = malloc((pixels + 1) * sizeof *squared);
    if (!free_of || !squared) err_nomem(err, "the things of a view", pixels * 5);
    if (!err->status &&
        !product_path_in(path, folder, PRODUCT_THING_MASK, &(struct product_key){.view = camera->name}, err) &&
        !thing_mask_read(&mask, camera, path, UINT32_MAX, prov, err)) {
        add_size(&v->bytes, path);
        for (size_t i = 0; i < pixels; i++) free_of[i] = !mask.shows[i] && !mask.meets[i];
        distance_squared(squared, free_of, camera->width, camera->height, err);
    }
    for (size_t i = 0; !err->status && i < pixels; i++) {
        uint8_t *const states[] = {&v->own[i], &v->state[i]};
        for (int k = 0; k < 2; k++) {
            const float reach = *states[k] == SOURCE_CLEAN ? margin : wide;
            if (*states[k] == SOURCE_NONE) continue;
            if (squared[i] <= reach * reach)
                *states[k] = SOURCE_HIDDEN;
            else if (*states[k] == SOURCE_HIDDEN)
                *states[k] = SOURCE_ALLEGED;
        }
    }
    thing_mask_release(&mask);
    free(free_of);
    free(squared);
    return err->status;
}

enum status source_view_read(struct source_view *v, struct view_ids *ids, const struct source_files *files,
                             const struct view *camera, const struct texture_params *params, struct provenance *prov,
                             struct err *err)
{
    const size_t pixels = (size_t)camera->width * (size_t)camera->height;
    struct view_planes picture = {0};
    struct view_ids faces = {0};
    *v = (struct source_view){.camera = *camera, .level_count = 1};
    set_projection(v);
    if (!read_picture(&picture, files->views, camera, &v->bytes, prov, err))
        read_ids(&faces, files->ids, camera, &v->bytes, prov, err);
    v->state = malloc(pixels);
    v->own = malloc(pixels);
    if (!err->status && (!v->state || !v->own)) err_nomem(err, "a view's surfaces", pixels);
    if (!err->status && !level_init(&v->levels[0], camera->width, camera->height, err)) {
        take_pixels(v, picture.channel, &faces, params);
        v->id = faces.id;
        faces.id = NULL;
        if (!files->things || !hide_things(v, files->things, camera, params, prov, err)) make_levels(v, err);
    }
    if (!err->status) list_faces(v, err);
    if (!err->status && ids) {
        *ids = faces;
        faces = (struct view_ids){0};
    }
    view_planes_release(&picture);
    view_ids_release(&faces);
    return err->status;
}

void source_view_release(struct source_view *v)
{
    free(v->id);
    free(v->state);
    free(v->own);
    free(v->shows);
    for (int k = 0; k < SOURCE_LEVELS; k++) free(v->levels[k].rgba);
    *v = (struct source_view){0};
}

bool source_view_sample(float rgb[3], const struct source_view *v, double x, double y, double footprint)
{
    int level = footprint > 1.5 ? (int)lround(log2(footprint)) : 0;
    if (level >= v->level_count) level = v->level_count - 1;
    const struct source_level *l = &v->levels[level];
    const double size = 1 << level;
    const double u = x / size - 0.5, w = y / size - 0.5;
    const int x0 = (int)floor(u), y0 = (int)floor(w);
    const float fx = (float)(u - x0), fy = (float)(w - y0);
    float sum[4] = {0};
    for (int k = 0; k < 4; k++) {
        const int px = x0 + (k & 1), py = y0 + (k >> 1);
        if (px < 0 || py < 0 || px >= l->width || py >= l->height) continue;
        const float weight = (k & 1 ? fx : 1 - fx) * (k >> 1 ? fy : 1 - fy);
        const float *p = l->rgba + 4 * ((size_t)py * (size_t)l->width + (size_t)px);
        for (int c = 0; c < 4; c++) sum[c] += weight * p[c];
    }
    if (!(sum[3] > 0)) return false;
    for (int c = 0; c < 3; c++) rgb[c] = sum[c] / sum[3];
    return true;
}
