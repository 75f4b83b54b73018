/* hole_pieces.c - see hole_pieces.h.
 *
 * Overview. The masks of furniture end a little before or behind its outline, and small parts of it have the depth of
 * what is behind. So a strip of a shelf, or a spot below a desk, counts as wall, and a hole beside it takes its colour.
 * Texels are joined to those beside them where no edge lies between. What is joined so and lies near a hole as a
 * whole, and touches it, is a piece if its colour is rare farther from holes: a wall or a print beside the hole reaches
 * beyond, and of bricks the wall is full. Pieces behind pieces are found by further rounds, as near to the hole as the
 * first. */
#include "common/texture/hole_pieces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BINS = 64, FINE = 4 };      /* of each channel; of an edge */
static const double COMMON = 0.02; /* part of the texels farther from holes that have a colour which is not rare */
enum { REACH = 8 };                /* texels: how far from a hole a piece may reach */

struct search {
    const struct hole_picture *p;
    float edge;
    int32_t *steps; /* from the nearest texel of a hole; -1: more than REACH */
    int32_t *queue;
    uint8_t *met, *piece;
    uint32_t *colours, far; /* how many texels farther from holes have a colour; all of them */
};

static int around(int32_t beside[4], const struct hole_picture *p, int32_t at)
{
    const int x = at % p->width, y = at / p->width;
    int count = 0;
    if (x > 0) beside[count++] = at - 1;
    if (x + 1 < p->width) beside[count++] = at + 1;
    if (y > 0) beside[count++] = at - p->width;
    if (y + 1 < p->height) beside[count++] = at + p->width;
    return count;
}

static void find_steps(struct search *s, size_t texels)
{
    size_t head = 0, tail = 0;
    for (size_t i = 0; i < texels; i++) {
        s->steps[i] = s->p->hole[i] ? 0 : -1;
        if (s->p->hole[i]) s->queue[tail++] = (int32_t)i;
    }
    while (head < tail) {
        const int32_t at = s->queue[head++];
        int32_t beside[4];
        const int count = around(beside, s->p, at);
        for (int k = 0; k < count; k++) {
            if (s->steps[beside[k]] >= 0 || s->steps[at] == REACH) continue;
            s->steps[beside[k]] = s->steps[at] + 1;
            s->queue[tail++] = beside[k];
        }
    }
}

static int bin_of(const struct search *s, float value)
{
    const float bin = value * FINE / s->edge;
    return bin < 1 ? 1 : bin > BINS - 2 ? BINS - 2 : (int)bin;
}

static void count_colours(struct search *s, size_t texels)
{
    for (size_t i = 0; i < texels; i++) {
        const float *v = s->p->value + 3 * i;
        if (!s->p->seen[i] || s->steps[i] >= 0) continue;
        s->colours[(bin_of(s, v[0]) * BINS + bin_of(s, v[1])) * BINS + bin_of(s, v[2])]++;
        s->far++;
    }
}

static bool is_common(const struct search *s, const float colour[3])
{
    const int r = bin_of(s, colour[0]), g = bin_of(s, colour[1]), b = bin_of(s, colour[2]);
    uint32_t count = 0;
    for (int i = r - 1; i <= r + 1; i++)
        for (int j = g - 1; j <= g + 1; j++)
            for (int k = b - 1; k <= b + 1; k++) count += s->colours[(i * BINS + j) * BINS + k];
    return count >= COMMON * s->far;
}

static bool are_joined(const struct search *s, int32_t a, int32_t b)
{
    for (int k = 0; k < 3; k++)
        if (fabsf(s->p->value[3 * a + k] - s->p->value[3 * b + k]) > s->edge) return false;
    return true;
}

/* The texels that are joined to `from`, into the queue; *is_piece: they touch a hole, or another piece, end near it,
 * and have a rare colour. */
static size_t join(struct search *s, int32_t from, bool *is_piece)
{
    size_t head = 0, tail = 0;
    bool touches = false, ends = true;
    float sum[3] = {0};
    s->met[from] = 1;
    s->queue[tail++] = from;
    while (head < tail) {
        const int32_t at = s->queue[head++];
        int32_t beside[4];
        const int count = around(beside, s->p, at);
        ends = ends && s->steps[at] >= 0;
        for (int k = 0; k < 3; k++) sum[k] += s->p->value[3 * at + k];
        for (int k = 0; k < count; k++) {
            touches = touches || s->p->hole[beside[k]] || s->piece[beside[k]];
            if (!s->p->seen[beside[k]] || s->met[beside[k]] || s->piece[beside[k]]) continue;
            if (!are_joined(s, at, beside[k])) continue;
            s->met[beside[k]] = 1;
            s->queue[tail++] = beside[k];
        }
    }
    for (int k = 0; k < 3; k++) sum[k] /= (float)tail;
    *is_piece = touches && ends && !is_common(s, sum);
    return tail;
}

static bool find_some(struct search *s, size_t texels)
{
    bool any = false;
    memset(s->met, 0, texels);
    for (size_t i = 0; i < texels; i++) {
        bool is_piece;
        if (!s->p->seen[i] || s->met[i] || s->piece[i] || s->steps[i] < 0) continue;
        const size_t count = join(s, (int32_t)i, &is_piece);
        for (size_t k = 0; is_piece && k < count; k++) s->piece[s->queue[k]] = 1;
        any = any || is_piece;
    }
    return any;
}

enum status hole_pieces_find(uint8_t *piece, const struct hole_picture *picture, float edge, struct err *err)
{
    const size_t texels = (size_t)picture->width * (size_t)picture->height;
    struct search s = {.p = picture, .edge = edge, .piece = piece};
    memset(piece, 0, texels);
    if (!memchr(picture->hole, 1, texels)) return ST_OK;
    s.steps = malloc(texels * sizeof *s.steps);
    s.queue = malloc(texels * sizeof *s.queue);
    s.met = malloc(texels);
    s.colours = calloc(BINS * BINS * BINS, sizeof *s.colours);
    if (s.steps && s.queue && s.met && s.colours) {
        find_steps(&s, texels);
        count_colours(&s, texels);
        while (find_some(&s, texels)) continue;
    } else
        err_nomem(err, "the holes of a tile", texels * 2 * sizeof *s.queue);
    free(s.steps);
    free(s.queue);
    free(s.met);
    free(s.colours);
    return err->status;
}
