/* atlas_squares.c - see atlas_squares.h.
 *
 * Squares are cut from each tile of the atlas, whole texels wide. A square counts if photographs show at least half of
 * it: texels that were synthesised continue whatever light was beside them, across the edge of a patch of sun. Two
 * squares are a pair if they are `gap` squares apart along one side of their tile. */
#include "common/gather/atlas_squares.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DARKEST 1e-6 /* radiance: darker squares count as that dark */

void atlas_squares_release(struct atlas_squares *s)
{
    free(s->list);
    free(s->pairs);
    *s = (struct atlas_squares){0};
}

/* Texels a unit of length. */
static double scale_of(const struct atlas_tile *t)
{
    const double *m = t->matrix[0];
    return sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
}

/* A texel's radiance; false: no photograph shows it. */
static bool read_texel(struct rgb *radiance, const struct atlas_scene *s, const struct atlas_tile *t, int x, int y)
{
    if (!field_atlas_has(s->atlas, t, x, y)) return false;
    const struct vec3 at = field_atlas_place(t, s->planes[t->face], x, y);
    const struct field_texel texel = field_atlas_look(s->atlas, t->face, at);
    *radiance = texel.radiance;
    return texel.source == LIGHT_TEXTURE;
}

double atlas_squares_side(const struct atlas_scene *scene, int wanted)
{
    const struct atlas *a = &scene->atlas->atlas;
    struct rgb radiance;
    double area = 0;
    for (int k = 0; k < a->tile_count; k++) {
        const struct atlas_tile *t = &a->tiles[k];
        const double scale = scale_of(t);
        int64_t count = 0;
        for (int y = 0; y < t->height; y++)
            for (int x = 0; x < t->width; x++) count += read_texel(&radiance, scene, t, x, y);
        area += scale > 0 ? (double)count / (scale * scale) : 0;
    }
    return sqrt(area / wanted);
}

/* --------------------------------------------------------------------------------------------------------- squares */

struct cutting {
    const struct atlas_scene *scene;
    const struct atlas_filter *filter;
    int tile, stride;
};

/* The mean radiance of a square's photographed texels; false: too few are. */
static bool average(double rgb[3], const struct cutting *c, int left, int top)
{
    const struct atlas_tile *t = &c->scene->atlas->atlas.tiles[c->tile];
    int count = 0;
    rgb[0] = rgb[1] = rgb[2] = 0;
    for (int y = top; y < top + c->stride; y++)
        for (int x = left; x < left + c->stride; x++) {
            struct rgb radiance;
            if (!read_texel(&radiance, c->scene, t, x, y)) continue;
            rgb[0] += radiance.r;
            rgb[1] += radiance.g;
            rgb[2] += radiance.b;
            count++;
        }
    for (int k = 0; count && k < 3; k++) rgb[k] /= count;
    return 2 * count >= c->stride * c->stride;
}

/* The middle of a square. */
static struct vec3 middle_of(const struct cutting *c, int left, int top)
{
    const struct atlas_tile *t = &c->scene->atlas->atlas.tiles[c->tile];
    const int last = c->stride - 1;
    return vec3_scale(vec3_add(field_atlas_place(t, c->scene->planes[t->face], left, top),
                               field_atlas_place(t, c->scene->planes[t->face], left + last, top + last)),
                      0.5);
}

static bool cut(struct atlas_square *s, const struct cutting *c, int column, int row)
{
    double rgb[3];
    const int left = column * c->stride, top = row * c->stride;
    *s = (struct atlas_square){.tile = c->tile, .column = column, .row = row, .at = middle_of(c, left, top)};
    s->normal = c->scene->planes[c->scene->atlas->atlas.tiles[c->tile].face].normal;
    if (c->filter && !c->filter->keep(c->filter->ctx, c->tile, s->at)) return false;
    if (!average(rgb, c, left, top)) return false;
    for (int k = 0; k < 3; k++) s->level[k] = (float)log(fmax(rgb[k], DARKEST));
    return true;
}

/* Pairs of the squares from `first` on, which are those of one tile; grid: their indices by row and column. */
static void pair_up(struct atlas_squares *s, int first, const int *grid, int columns, int rows, int gap)
{
    for (int i = first; i < s->count; i++) {
        const struct atlas_square *t = &s->list[i];
        const int right = t->column + gap < columns ? grid[t->row * columns + t->column + gap] : -1;
        const int below = t->row + gap < rows ? grid[(t->row + gap) * columns + t->column] : -1;
        if (right >= 0) s->pairs[s->pair_count++] = (struct atlas_pair){i, right};
        if (below >= 0) s->pairs[s->pair_count++] = (struct atlas_pair){i, below};
    }
}

static enum status cut_tile(struct atlas_squares *s, const struct cutting *c, int gap, struct err *err)
{
    const struct atlas_tile *t = &c->scene->atlas->atlas.tiles[c->tile];
    const int columns = t->width / c->stride, rows = t->height / c->stride, first = s->count;
    const size_t squares = (size_t)columns * (size_t)rows, most = (size_t)s->count + squares;
    if (!squares) return ST_OK;
    int *grid = malloc(squares * sizeof *grid);
    struct atlas_square *list = realloc(s->list, most * sizeof *list);
    if (list) s->list = list;
    struct atlas_pair *pairs = realloc(s->pairs, ((size_t)s->pair_count + 2 * squares) * sizeof *pairs);
    if (pairs) s->pairs = pairs;
    if (!grid || !list || !pairs) err_nomem(err, "texels of a face", most * sizeof *list);
    for (int row = 0; !err->status && row < rows; row++)
        for (int column = 0; column < columns; column++) {
            const bool counts = cut(&s->list[s->count], c, column, row);
            grid[row * columns + column] = counts ? s->count : -1;
            s->count += counts;
        }
    if (!err->status) pair_up(s, first, grid, columns, rows, gap);
    free(grid);
    return err->status;
}

enum status atlas_squares_list(struct atlas_squares *s, const struct atlas_scene *scene, double side, int gap,
                               const struct atlas_filter *filter, struct err *err)
{
    const struct atlas *a = &scene->atlas->atlas;
    *s = (struct atlas_squares){.side = side};
    for (int k = 0; !err->status && k < a->tile_count; k++) {
        const int stride = (int)lround(side * scale_of(&a->tiles[k]));
        const struct cutting c = {scene, filter, k, stride > 1 ? stride : 1};
        cut_tile(s, &c, gap, err);
    }
    return err->status;
}

enum status atlas_places_list(struct atlas_places *p, const struct atlas_squares *squares, const bool *marked,
                              int tiles, struct err *err)
{
    int count = 0;
    *p = (struct atlas_places){malloc(((size_t)squares->count + 1) * sizeof *p->at),
                               calloc((size_t)tiles + 1, sizeof *p->first)};
    if (!p->at || !p->first) return err_nomem(err, "squares", (size_t)squares->count * sizeof *p->at);
    for (int i = 0, tile = 0; i <= squares->count; i++) {
        const int next = i < squares->count ? squares->list[i].tile : tiles;
        while (tile < next) p->first[++tile] = count;
        if (i < squares->count && (!marked || marked[i])) p->at[count++] = squares->list[i].at;
    }
    return ST_OK;
}

bool atlas_places_near(const struct atlas_places *p, int tile, struct vec3 at, double reach)
{
    for (int i = p->first[tile]; i < p->first[tile + 1]; i++) {
        const struct vec3 d = vec3_sub(at, p->at[i]);
        if (fabs(d.x) < reach && fabs(d.y) < reach && fabs(d.z) < reach) return true;
    }
    return false;
}

void atlas_places_release(struct atlas_places *p)
{
    free(p->at);
    free(p->first);
    *p = (struct atlas_places){0};
}
