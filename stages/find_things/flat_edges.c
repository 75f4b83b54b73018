/* flat_edges.c - see flat_edges.h.
 *
 * Overview. A rug has another colour than its floor, but nobody knows how much of another: light falls off along both.
 * So regions are grown around the pixel, of all pixels whose colour differs by at most T from that there, for a series
 * of T, as in [Matas 2002]. Chairs on a rug leave gaps in them, but rugs and posters are convex: what counts is the
 * convex hull. Inside of the rug little changes across it, at the rug's edge much, and where the region has leaked,
 * such as into a reflection of a lamp on the floor, little again. The hull across which colours change most is the rug.
 *
 * Colours are compared by their logarithms, after a blur of 3 x 3 pixels, since noise must stop no walk.
 *
 * Source: extremal regions [Matas 2002]; what differs: one seed, distance of colours, and which region counts. */
#include "stages/find_things/flat_edges.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DARK     0.02f  /* of the picture's mean radiance: differences of darker colours count less */
#define LEAST    0.04   /* T */
#define RATIO    1.15   /* of successive T */
#define CLEAR    0.1    /* least change across the outline, in the mean */
#define ACROSS   3.0    /* px on either side of it */
#define SMALLEST 0.0005 /* part of the picture that it fills at least */
#define LARGEST  0.5
#define FILLED   0.6 /* part of its convex hull, without what stands on it, that it fills at least */

enum { CORNERS = 40 };
enum { STEPS = 24, SEED = 2 }; /* SEED: pixels beside the first one whose mean colour counts */

struct region {
    const struct image *photo;
    const uint8_t *open;
    float *log;   /* three a pixel */
    float *apart; /* difference from the colour of the seed */
    uint8_t *in;
    int *list; /* of its pixels */
    int count;
    bool cut; /* it reaches the border */
};

static bool take_logs(struct region *r)
{
    const int w = r->photo->width, h = r->photo->height;
    double sum = 0, count = 0;
    for (int i = 0; i < w * h; i++) {
        const float *p = r->photo->data + 4 * (size_t)i;
        if (!(p[3] > 0)) continue;
        sum += (double)(p[0] + p[1] + p[2]) / 3;
        count++;
    }
    if (!(sum > 0)) return false;
    const float dark = DARK * (float)(sum / count);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            float mean[3] = {0}, n = 0;
            for (int k = 0; k < 9; k++) {
                const int a = x + k % 3 - 1, b = y + k / 3 - 1;
                if (a < 0 || b < 0 || a >= w || b >= h) continue;
                const float *p = r->photo->data + 4 * ((size_t)b * (size_t)w + (size_t)a);
                if (!(p[3] > 0)) continue;
                for (int c = 0; c < 3; c++) mean[c] += fmaxf(0, p[c]);
                n++;
            }
            for (int c = 0; c < 3; c++)
                r->log[3 * ((size_t)y * (size_t)w + (size_t)x) + (size_t)c] = logf(mean[c] / fmaxf(1, n) + dark);
        }
    return true;
}

static void compare(struct region *r, int x, int y)
{
    const int w = r->photo->width, h = r->photo->height;
    float seed[3] = {0}, n = 0;
    for (int b = y - SEED; b <= y + SEED; b++)
        for (int a = x - SEED; a <= x + SEED; a++) {
            if (a < 0 || b < 0 || a >= w || b >= h || !r->open[(size_t)b * (size_t)w + (size_t)a]) continue;
            for (int c = 0; c < 3; c++) seed[c] += r->log[3 * ((size_t)b * (size_t)w + (size_t)a) + (size_t)c];
            n++;
        }
    for (int i = 0; i < w * h; i++) {
        const float *p = r->log + 3 * (size_t)i;
        r->apart[i] = 0;
        for (int c = 0; c < 3; c++) r->apart[i] = fmaxf(r->apart[i], fabsf(p[c] - seed[c] / fmaxf(1, n)));
    }
}

/* Grows the region from its list on, over pixels that differ by at most `most`. */
static void grow(struct region *r, float most)
{
    const int w = r->photo->width, h = r->photo->height;
    for (int n = 0; n < r->count; n++) {
        const int x = r->list[n] % w, y = r->list[n] / w;
        r->cut = r->cut || x == 0 || y == 0 || x == w - 1 || y == h - 1;
        for (int k = 0; k < 4; k++) {
            const int a = x + (k == 0) - (k == 1), b = y + (k == 2) - (k == 3), i = b * w + a;
            if (a < 0 || b < 0 || a >= w || b >= h || r->in[i] || !r->open[i] || !(r->apart[i] <= most)) continue;
            r->in[i] = 1;
            r->list[r->count++] = i;
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------- hull */

static int by_place(const void *a, const void *b)
{
    const struct flat_corner *p = a, *q = b;
    if (p->u < q->u || p->u > q->u) return p->u < q->u ? -1 : 1;
    return (p->v > q->v) - (p->v < q->v);
}

static double turn(struct flat_corner o, struct flat_corner a, struct flat_corner b)
{
    return (a.u - o.u) * (b.v - o.v) - (a.v - o.v) * (b.u - o.u);
}

/* The convex hull of sorted points [Andrew 1979]; hull: room for twice as many. Returns its corners. */
static int hull_of(struct flat_corner *hull, const struct flat_corner *points, int count)
{
    int n = 0;
    for (int pass = 0; pass < 2; pass++) {
        const int first = n;
        for (int i = 0; i < count; i++) {
            const struct flat_corner p = points[pass ? count - 1 - i : i];
            while (n - first >= 2 && turn(hull[n - 2], hull[n - 1], p) <= 0) n--;
            hull[n++] = p;
        }
        n--; /* the last one begins the other half */
    }
    return n;
}

static double area_of(const struct flat_corner *hull, int count)
{
    double sum = 0;
    for (int i = 2; i < count; i++) sum += turn(hull[0], hull[i - 1], hull[i]) / 2;
    return sum;
}

/* Leaves out the corner that holds least area until there are at most CORNERS [Visvalingam 1993]; returns how many. */
static int simplify(struct flat_corner *hull, int count)
{
    while (count > CORNERS) {
        int least = 0;
        double smallest = INFINITY;
        for (int i = 0; i < count; i++) {
            const double area = turn(hull[(i + count - 1) % count], hull[i], hull[(i + 1) % count]);
            if (!(area < smallest)) continue;
            smallest = area;
            least = i;
        }
        count--;
        for (int i = least; i < count; i++) hull[i] = hull[i + 1];
    }
    return count;
}

/* The corners of the region's pixels; points: room for two a line. */
static int list_ends(struct flat_corner *points, const struct region *r)
{
    const int w = r->photo->width;
    int count = 0;
    for (int y = 0; y < r->photo->height; y++) {
        int first = -1, last = -1;
        for (int x = 0; x < w; x++) {
            if (!r->in[(size_t)y * (size_t)w + (size_t)x]) continue;
            if (first < 0) first = x;
            last = x;
        }
        for (int k = 0; k < 4 && first >= 0; k++)
            points[count++] = (struct flat_corner){k & 1 ? last + 1 : first, y + (k >> 1)};
    }
    qsort(points, (size_t)count, sizeof *points, by_place);
    return count;
}

/* How much colours change from inside to outside at a place of the outline, whose way out is (du, dv); -1: unknown. */
static float change_at(const struct region *r, double u, double v, double du, double dv)
{
    size_t at[2];
    for (int k = 0; k < 2; k++) {
        const double far = k ? ACROSS : -ACROSS;
        const int x = (int)floor(u + far * du), y = (int)floor(v + far * dv);
        if (x < 0 || y < 0 || x >= r->photo->width || y >= r->photo->height) return -1;
        at[k] = (size_t)y * (size_t)r->photo->width + (size_t)x;
        if (!r->open[at[k]]) return -1;
    }
    float most = 0;
    for (size_t c = 0; c < 3; c++) most = fmaxf(most, fabsf(r->log[3 * at[0] + c] - r->log[3 * at[1] + c]));
    return fminf(1, most);
}

/* The mean change across an outline, at every pixel of it that shows the face on both sides. */
static double change_across(const struct region *r, const struct flat_corner *hull, int count)
{
    double sum = 0, places = 0;
    for (int i = 0; i < count; i++) {
        const struct flat_corner p = hull[i], q = hull[(i + 1) % count];
        const double length = hypot(q.u - p.u, q.v - p.v);
        for (double t = 0.5; t < length; t++) {
            const double u = p.u + t / length * (q.u - p.u), v = p.v + t / length * (q.v - p.v);
            const float change = change_at(r, u, v, (q.v - p.v) / length, -(q.u - p.u) / length);
            if (change < 0) continue;
            sum += (double)change;
            places++;
        }
    }
    return places > 0 ? sum / places : 0;
}

/* Keeps the outline with the largest change across it, of regions that grow. */
static enum status try_outlines(struct flat_corner **best, int *count, struct region *r, struct err *err)
{
    const size_t most = 4 * (size_t)r->photo->height + 1;
    const double pixels = (double)r->photo->width * r->photo->height;
    struct flat_corner *points = malloc(most * sizeof *points), *hull = malloc(2 * most * sizeof *hull);
    double clearest = CLEAR;
    *best = malloc(2 * most * sizeof **best);
    if (!points || !hull || !*best) err_nomem(err, "an outline", 5 * most * sizeof *points);
    for (int k = 0; !err->status && k < STEPS; k++) {
        grow(r, (float)(LEAST * pow(RATIO, k)));
        if (r->cut || r->count > LARGEST * pixels) break;
        if (r->count < SMALLEST * pixels) continue;
        const int corners = hull_of(hull, points, list_ends(points, r));
        if (corners < 3 || r->count < FILLED * area_of(hull, corners)) continue;
        const double change = change_across(r, hull, corners);
        if (!(change > clearest)) continue;
        clearest = change;
        memcpy(*best, hull, (size_t)corners * sizeof *hull);
        *count = corners;
    }
    free(points);
    free(hull);
    if (!err->status && *count) *count = simplify(*best, *count);
    if (err->status || !*count) {
        free(*best);
        *best = NULL;
    }
    return err->status;
}

enum status flat_edges_find(struct flat_corner **corners, int *count, const struct image *photo, const uint8_t *open,
                            int x, int y, struct err *err)
{
    const size_t pixels = (size_t)photo->width * (size_t)photo->height;
    struct region r = {.photo = photo, .open = open};
    *corners = NULL;
    *count = 0;
    r.log = malloc(pixels * 3 * sizeof *r.log);
    r.apart = malloc(pixels * sizeof *r.apart);
    r.in = calloc(pixels, 1);
    r.list = malloc(pixels * sizeof *r.list);
    if (!r.log || !r.apart || !r.in || !r.list) err_nomem(err, "a picture's colours", pixels * 21);
    const int seed = y * photo->width + x;
    if (!err->status && open[seed] && take_logs(&r)) {
        compare(&r, x, y);
        r.in[r.list[r.count++] = seed] = 1;
        try_outlines(corners, count, &r, err);
    }
    free(r.log);
    free(r.apart);
    free(r.in);
    free(r.list);
    return err->status;
}
