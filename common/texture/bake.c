/* bake.c - see bake.h: tiles, their texels, and which of these need candidates. */
#include "common/texture/bake.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"

static const double BLACK = 0.05; /* of white: where display turns from linear to logarithmic */

float bake_display(float radiance, double white)
{
    return (float)(log1p(radiance / (BLACK * white)) / log1p(1 / BLACK));
}

float bake_radiance(float display, double white)
{
    return display > 0 ? (float)(BLACK * white * expm1(display * log1p(1 / BLACK))) : 0;
}

bool bake_tile_point(struct vec3 *p, const struct bake_tile *t, double x, double y)
{
    double h[4];
    for (int i = 0; i < 4; i++) {
        const double *m = t->raster.point[i];
        h[i] = m[0] * x + m[1] * y + m[2];
    }
    if (!(h[3] > 0)) return false;
    *p = vec3_make(h[0] / h[3], h[1] / h[3], h[2] / h[3]);
    return true;
}

void bake_release(struct bake *b)
{
    for (int i = 0; i < b->source_count; i++) free(b->sources[i].name);
    free(b->sources);
    free(b->tiles);
    free(b->role);
    free(b->rgb);
    free(b->made);
    free(b->list);
    free(b->lists);
    free(b->counts);
    free(b->hidden);
    free(b->surely);
    *b = (struct bake){0};
}

static enum status make_room(struct bake *b, size_t texels, struct err *err)
{
    size_t room[4];
    for (int k = 0; k < 4; k++) room[k] = b->texel_room;
    if (!array_reserve(&b->role, &room[0], texels, sizeof *b->role, "texels", err) &&
        !array_reserve(&b->rgb, &room[1], texels, 3 * sizeof *b->rgb, "texels", err) &&
        !array_reserve(&b->made, &room[2], texels, sizeof *b->made, "texels", err) &&
        !array_reserve(&b->list, &room[3], texels, sizeof *b->list, "texels", err))
        b->texel_room = room[0];
    return err->status;
}

enum status bake_add_tile(struct bake *b, struct bake_tile tile, struct err *err)
{
    const size_t texels = (size_t)tile.raster.width * (size_t)tile.raster.height, first = b->texel_count;
    if (array_append(&b->tiles, (size_t)b->tile_count, sizeof *b->tiles, "tiles", err) ||
        make_room(b, first + texels, err))
        return err->status;
    memset(b->role + first, TEXEL_NONE, texels);
    memset(b->rgb + 3 * first, 0, 3 * texels * sizeof *b->rgb);
    memset(b->made + first, 0, texels * sizeof *b->made);
    memset(b->list + first, -1, texels * sizeof *b->list);
    tile.first = first;
    b->tiles[b->tile_count++] = tile;
    b->texel_count += texels;
    return ST_OK;
}

enum status bake_set_sources(struct bake *b, const char *const *names, const int *groups, const bool *own, int count,
                             struct err *err)
{
    b->sources = calloc((size_t)count + 1, sizeof *b->sources);
    if (!b->sources) return err_nomem(err, "sources", (size_t)count * sizeof *b->sources);
    for (int i = 0; i < count; i++) {
        b->sources[i] = (struct bake_source){strdup(names[i]), groups[i], {1, 1, 1}, own[i]};
        b->source_count = i + 1;
        if (!b->sources[i].name) return err_nomem(err, "a name", strlen(names[i]));
    }
    return ST_OK;
}

/* Whether an original texel has a neighbour that is not: the composite needs to know how sources differ across. */
static bool is_rim(const uint8_t *role, int x, int y, int width, int height)
{
    const size_t at = (size_t)y * (size_t)width + (size_t)x;
    const uint8_t around[4] = {
        x > 0 ? role[at - 1] : TEXEL_NONE,
        x + 1 < width ? role[at + 1] : TEXEL_NONE,
        y > 0 ? role[at - (size_t)width] : TEXEL_NONE,
        y + 1 < height ? role[at + (size_t)width] : TEXEL_NONE,
    };
    for (int k = 0; k < 4; k++)
        if (around[k] == TEXEL_WANTED || around[k] == TEXEL_DOUBTED) return true;
    return false;
}

static bool needs_list(const struct bake_tile *t, const uint8_t *role, int x, int y)
{
    const size_t at = (size_t)y * (size_t)t->raster.width + (size_t)x;
    if (role[at] != TEXEL_ORIGINAL) return role[at] != TEXEL_NONE;
    return ((t->x + x) % PROBE == 0 && (t->y + y) % PROBE == 0) ||
           is_rim(role, x, y, t->raster.width, t->raster.height);
}

enum status bake_list_texels(struct bake *b, struct err *err)
{
    b->list_count = 0;
    for (int i = 0; i < b->tile_count; i++) {
        const struct bake_tile *t = &b->tiles[i];
        for (int y = 0; y < t->raster.height; y++)
            for (int x = 0; x < t->raster.width; x++)
                if (needs_list(t, b->role + t->first, x, y))
                    b->list[t->first + (size_t)y * (size_t)t->raster.width + (size_t)x] = (int32_t)b->list_count++;
    }
    b->lists = malloc((b->list_count + 1) * sizeof *b->lists);
    b->counts = calloc(b->list_count + 1, 1);
    b->hidden = calloc(b->list_count + 1, 1);
    b->surely = calloc(b->list_count + 1, 1);
    return b->lists && b->counts && b->hidden && b->surely
               ? ST_OK
               : err_nomem(err, "candidates", b->list_count * sizeof *b->lists);
}
