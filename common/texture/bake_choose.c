/* bake_choose.c - bake_choose(): the best candidate of each texel.
 *
 * A candidate whose sure depth agrees with the model is trusted. One that agrees by a depth which is not sure has a
 * vote for itself, and two views that see something in front outvote it. Where the depth of a view says nothing,
 * something that the model does not hold may stand in front: then the views vote. Two photographs that show the surface
 * agree in colour (after their gains); one that shows furniture in front of it agrees with others only by chance, since
 * furniture moves against the surface from view to view [Waechter 2014]. The views of one photo have one vote. A view
 * in which something surely stands in front of the texel votes against those that are not sure, and if all are outvoted
 * the texel is left to be synthesised. But where all views together know of no thing before a surface, what single
 * views see in front of it may be an error of their depth, as it is in an open door that the model lacks: then the
 * best view that agrees with the model is the last resort, though colours outvote it. Clipped or noisy pixels are
 * taken where POOR_PHOTOS show nothing else and none sees something in front: that is a lamp, lit or not; glare
 * moves from photo to photo. The same decides whether the viewpoint's own pixel may be copied where its depth is
 * not sure. */
#include <math.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/texture/bake.h"

enum { CHUNK = 4096, POOR_PHOTOS = 4 };
static const double BARE = 0.02;    /* of a surface's texels may be hidden by things, and it is bare */
static const double DIM = 0.02;     /* of white: differences of darker colours count less */
static const float HIDDEN = 0.5f;   /* weight of a view in which something surely stands in front */
static const float LIKELY = 0.75f;  /* vote of a view for itself whose depth, not sure, has nothing in front */
static const float OUTVOTED = 1e6f; /* penalty: chosen only if nothing else is there */

struct vote {
    float log_rgb[3];
    int group;
    uint8_t state;
};

static void set_vote(struct vote *v, const float rgb[3], const float gain[3], double dim, int group, uint8_t state)
{
    for (int c = 0; c < 3; c++) v->log_rgb[c] = logf((float)(gain[c] * rgb[c] + dim));
    v->group = group;
    v->state = state;
}

static bool agree(const struct vote *a, const struct vote *b, float limit)
{
    for (int c = 0; c < 3; c++)
        if (fabsf(a->log_rgb[c] - b->log_rgb[c]) > limit) return false;
    return true;
}

/* For and against vote i: weights of the other photos. */
static void count_votes(float *in_favour, float *against, const struct vote *votes, int count, int i, float limit)
{
    *in_favour = *against = 0;
    for (int j = 0; j < count; j++) {
        if (j == i || votes[j].group == votes[i].group || votes[j].state == SOURCE_POOR) continue;
        const float weight = votes[j].state >= SOURCE_LIKELY ? 2 : 1;
        *(agree(&votes[i], &votes[j], limit) ? in_favour : against) += weight;
    }
}

/* The number of photos that candidates come from. */
static int photos_of(const struct bake *b, const struct candidate *in, int count)
{
    int photos = 0;
    for (int i = 0; i < count; i++) {
        int before = 0;
        while (before < i && b->sources[in[before].source].group != b->sources[in[i].source].group) before++;
        photos += before == i;
    }
    return photos;
}

/* Puts the best candidate of the texel first; the order of the others is kept. Drops the doubt of the viewpoint's own
 * pixel: the texel becomes original or wanted. bare: no thing stands before its surface. */
static void choose_texel(struct bake *b, size_t texel, bool bare)
{
    const int32_t list = b->list[texel];
    struct candidate *in = b->lists[list];
    const int count = b->counts[list];
    const double dim = DIM * b->white;
    const float one[3] = {1, 1, 1}, limit = (float)b->params->agree;
    struct vote votes[CANDIDATES + 1];
    float in_favour, against;
    for (int i = 0; i < count; i++)
        set_vote(&votes[i], in[i].around, b->sources[in[i].source].gain, dim, b->sources[in[i].source].group,
                 in[i].state);
    if (b->role[texel] == TEXEL_DOUBTED) {
        const float *own = b->rgb + 3 * texel;
        for (int i = 0; i < count; i++)
            if (b->sources[in[i].source].own) own = in[i].around;
        set_vote(&votes[count], own, one, dim, b->own_group, SOURCE_UNSURE);
        count_votes(&in_favour, &against, votes, count + 1, count, limit);
        against += HIDDEN * b->hidden[list];
        b->role[texel] = against > in_favour ? TEXEL_WANTED : TEXEL_ORIGINAL;
    }
    int best = 0;
    float least = INFINITY;
    for (int i = 0; i < count; i++) {
        float penalty = in[i].penalty;
        if (in[i].state == SOURCE_UNSURE || in[i].state == SOURCE_LIKELY) {
            count_votes(&in_favour, &against, votes, count, i, limit);
            against += HIDDEN * b->hidden[list];
            if (in[i].state == SOURCE_LIKELY) in_favour += LIKELY;
            if (against > in_favour) penalty += OUTVOTED;
        }
        if (penalty < least) least = penalty, best = i;
    }
    const bool last_resort = bare && count && in[best].state == SOURCE_LIKELY;
    if (least >= OUTVOTED && b->hidden[list] && !last_resort) b->counts[list] = 0;
    if (count && in[best].state == SOURCE_POOR && (photos_of(b, in, count) < POOR_PHOTOS || b->hidden[list]))
        b->counts[list] = 0;
    if (best == 0) return;
    const struct candidate first = in[best];
    memmove(in + 1, in, (size_t)best * sizeof *in);
    in[0] = first;
}

struct choice {
    struct bake *b;
    const struct bake_tile *tile;
    bool bare;
};

static void choose_range(void *ctx, size_t begin, size_t end, int thread)
{
    const struct choice *c = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++)
        if (c->b->list[c->tile->first + i] >= 0) choose_texel(c->b, c->tile->first + i, c->bare);
}

/* Whether no thing stands before a surface, but for rims that end on it. */
static bool is_bare(const struct bake *b, int surface)
{
    size_t hidden = 0, all = 0;
    for (int k = 0; k < b->tile_count; k++) {
        const struct bake_tile *t = &b->tiles[k];
        const size_t texels = (size_t)t->raster.width * (size_t)t->raster.height;
        for (size_t i = 0; t->surface == surface && i < texels; i++) {
            if (b->list[t->first + i] < 0) continue;
            all++;
            hidden += b->surely[b->list[t->first + i]];
        }
    }
    return (double)hidden <= BARE * (double)all;
}

void bake_choose(struct bake *b)
{
    struct choice c = {.b = b};
    for (int k = 0; k < b->tile_count; k++) {
        const bool is_next = k && b->tiles[k].surface == b->tiles[k - 1].surface;
        c.tile = &b->tiles[k];
        if (!is_next) c.bare = is_bare(b, c.tile->surface);
        parallel_for((size_t)c.tile->raster.width * (size_t)c.tile->raster.height, CHUNK, choose_range, &c);
    }
}
