/* still_matches.c - what stands still in the picture while the scene moves; still_matches.h states the rule.
 *
 * A match is still if its two pixels differ by at most one pixel (more in large photos, whose features are found in
 * smaller pictures). A text that is burnt in is found at the same place to a tenth of a pixel, scenes hardly ever: in
 * photos taken by hand, 1 match of 400 at most.
 *
 * Whether the rest of a pair moves cannot be taken from its median, since a watermark may have most of its matches. If
 * half of the matches move, it does. Otherwise the moving matches count that two of their three nearest ones move
 * alike; wrong matches, which a tripod's pair has, too, do not. */
#include "stages/sfm/still_matches.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/file_path.h"
#include "common/image/photo.h"
#include "common/product/product.h"

enum { COPY_MATCHES = 50, COPY_BLOCKS = 4, COPY_SPREAD = 8 }; /* of COPY_BLOCKS^2 blocks of a picture */
static const float COPY_SHARE = 0.9f;                         /* of the matches, which do not move */
enum { CELLS = 64, BLOCK = 4, MIN_PHOTOS = 3, MIN_ALIKE = 10, MAX_COMPARED = 400, NEAREST = 3, MAX_NAMED = 3 };
static const double PHOTO_SHARE = 0.2;
static const float STILL = 1, LARGE = 1600; /* px; the longer side above which STILL grows with it */
static const float NEARLY = 4;              /* still matches per match that moves by 1 to NEARLY times STILL */
static const float ALIKE = 0.2f;            /* difference of two motions, as a share of the longer one */

struct spot {
    float x, y;
};

/* What is counted of a group. */
struct tally {
    unsigned char *seen;       /* of each cell and photo: it has still matches there */
    int *still, *nearly, *any; /* matches of each cell */
};

struct search {
    struct still_places *to;
    const struct photo_list *photos;
    struct spot **spots; /* of each photo's features; owned */
    int *counts;
    struct tally *tallies; /* of each group; owned */
};

/* ----------------------------------------------------------------------------------------------------------- places */

static int cell_of(const struct still_group *g, float x, float y)
{
    const int column = (int)(x / g->cell), row = (int)(y / g->cell);
    return (row < 0          ? 0
            : row >= g->rows ? g->rows - 1
                             : row) *
               g->columns +
           (column < 0             ? 0
            : column >= g->columns ? g->columns - 1
                                   : column);
}

static float tolerance(const struct still_group *g)
{
    return STILL * fmaxf(1, (float)(g->width > g->height ? g->width : g->height) / LARGE);
}

static enum status add_group(struct still_places *s, const struct photo_info *info, int photo, struct err *err)
{
    if (array_append(&s->groups, (size_t)s->count, sizeof *s->groups, "sizes of photos", err)) return err->status;
    struct still_group *g = &s->groups[s->count++];
    *g = (struct still_group){.width = info->width, .height = info->height, .first = photo};
    g->cell = (float)(g->width > g->height ? g->width : g->height) / CELLS;
    g->columns = (int)ceilf((float)g->width / g->cell);
    g->rows = (int)ceilf((float)g->height / g->cell);
    g->still = calloc((size_t)g->columns * (size_t)g->rows, 1);
    return g->still ? ST_OK : err_nomem(err, "places of a picture", (size_t)g->columns * (size_t)g->rows);
}

static enum status find_groups(struct still_places *s, const struct photo_list *photos, struct err *err)
{
    s->photos = photos->count;
    s->group_of = calloc((size_t)photos->count + 1, sizeof *s->group_of);
    s->copy_of = calloc((size_t)photos->count + 1, sizeof *s->copy_of);
    s->features = calloc((size_t)photos->count + 1, sizeof *s->features);
    if (!s->group_of || !s->copy_of || !s->features)
        return err_nomem(err, "sizes of photos", (size_t)photos->count * sizeof *s->group_of);
    for (int i = 0; i < photos->count; i++) {
        const struct photo_info *info = &photos->photos[i].info;
        int k = 0;
        s->copy_of[i] = -1;
        while (k < s->count && (s->groups[k].width != info->width || s->groups[k].height != info->height)) k++;
        if (k == s->count && add_group(s, info, i, err)) return err->status;
        s->group_of[i] = k;
        s->groups[k].count++;
    }
    return ST_OK;
}

/* --------------------------------------------------------------------------------------------------------- counting */

static enum status start_search(struct search *w, struct err *err)
{
    const size_t photos = (size_t)w->photos->count + 1, groups = (size_t)w->to->count + 1;
    w->spots = calloc(photos, sizeof *w->spots);
    w->counts = calloc(photos, sizeof *w->counts);
    w->tallies = calloc(groups, sizeof *w->tallies);
    if (!w->spots || !w->counts || !w->tallies) return err_nomem(err, "places of features", photos * sizeof *w->spots);
    for (int k = 0; k < w->to->count; k++) {
        const struct still_group *g = &w->to->groups[k];
        const size_t cells = (size_t)g->columns * (size_t)g->rows;
        struct tally *t = &w->tallies[k];
        t->seen = calloc(cells, photos);
        t->still = calloc(3 * cells, sizeof *t->still);
        if (!t->seen || !t->still) return err_nomem(err, "places of a picture", cells * photos);
        t->nearly = t->still + cells;
        t->any = t->nearly + cells;
    }
    return ST_OK;
}

static enum status read_spots(struct search *w, int photo, const char *features, struct err *err)
{
    struct feature_list list = {0};
    char path[FILE_PATH];
    if (product_path_in(path, features, PRODUCT_FEATURES, &(struct product_key){.photo = w->photos->photos[photo].id},
                        err))
        return err->status;
    if (!path_is_file(path) || feature_list_read(&list, path, NULL, err)) return err->status;
    w->spots[photo] = malloc(((size_t)list.count + 1) * sizeof **w->spots);
    if (!w->spots[photo]) err_nomem(err, "places of features", (size_t)list.count * sizeof **w->spots);
    for (int i = 0; !err->status && i < list.count; i++)
        w->spots[photo][i] = (struct spot){list.features[i].x, list.features[i].y};
    w->counts[photo] = list.count;
    feature_list_release(&list);
    return err->status;
}

struct motion {
    float x, y, dx, dy;
};

static bool is_alike(const struct motion *a, const struct motion *b)
{
    const float longer = fmaxf(hypotf(a->dx, a->dy), hypotf(b->dx, b->dy));
    return hypotf(a->dx - b->dx, a->dy - b->dy) <= ALIKE * longer;
}

/* How many motions agree with two of their nearest ones. */
static int count_alike(const struct motion *m, int count)
{
    int alike = 0;
    for (int i = 0; i < count; i++) {
        float distance[NEAREST];
        int nearest[NEAREST], agree = 0;
        for (int k = 0; k < NEAREST; k++) distance[k] = INFINITY;
        for (int k = 0; k < count; k++) {
            const float d = k == i ? INFINITY : hypotf(m[k].x - m[i].x, m[k].y - m[i].y);
            int at = NEAREST;
            for (; at > 0 && d < distance[at - 1]; at--)
                if (at < NEAREST) distance[at] = distance[at - 1], nearest[at] = nearest[at - 1];
            if (at < NEAREST) distance[at] = d, nearest[at] = k;
        }
        for (int k = 0; k < NEAREST; k++) agree += distance[k] < INFINITY && is_alike(&m[i], &m[nearest[k]]);
        alike += agree >= 2;
    }
    return alike;
}

/* Whether the scene moves between the photos of a pair. */
static bool moves(const struct motion *m, int moving, int all)
{
    if (moving < MIN_ALIKE) return false;
    return 2 * moving >= all || count_alike(m, moving < MAX_COMPARED ? moving : MAX_COMPARED) >= MIN_ALIKE;
}

static void count_still(struct search *w, int a, int b, const struct matched_pair *pair, float still)
{
    const struct still_group *g = &w->to->groups[w->to->group_of[a]];
    struct tally *t = &w->tallies[w->to->group_of[a]];
    const size_t photos = (size_t)w->photos->count + 1;
    for (int i = 0; i < pair->count; i++) {
        const struct spot *p = &w->spots[a][pair->matches[i].first], *q = &w->spots[b][pair->matches[i].second];
        const float d = hypotf(p->x - q->x, p->y - q->y);
        const int from = cell_of(g, p->x, p->y), to = cell_of(g, q->x, q->y);
        if (d > NEARLY * still) continue;
        *(d <= still ? &t->still[from] : &t->nearly[from]) += 1;
        if (d > still) continue;
        t->seen[(size_t)from * photos + (size_t)a] = 1;
        t->seen[(size_t)to * photos + (size_t)b] = 1;
    }
}

/* A file of matches may be older than the features. */
static bool fits(const struct search *w, int a, int b, const struct matched_pair *pair)
{
    for (int i = 0; i < pair->count; i++)
        if (pair->matches[i].first >= w->counts[a] || pair->matches[i].second >= w->counts[b]) return false;
    return true;
}

static enum status count_pair(struct search *w, int a, int b, const struct matched_pair *pair, struct err *err)
{
    const struct still_group *g = &w->to->groups[w->to->group_of[a]];
    struct tally *t = &w->tallies[w->to->group_of[a]];
    const float still = tolerance(g);
    struct motion *moving = malloc(((size_t)pair->count + 1) * sizeof *moving);
    int count = 0;
    if (!moving) return err_nomem(err, "matches", (size_t)pair->count * sizeof *moving);
    for (int i = 0; i < pair->count; i++) {
        const struct index_match *m = &pair->matches[i];
        const struct spot *p = &w->spots[a][m->first], *q = &w->spots[b][m->second];
        t->any[cell_of(g, p->x, p->y)]++;
        if (hypotf(p->x - q->x, p->y - q->y) > NEARLY * still)
            moving[count++] = (struct motion){p->x, p->y, q->x - p->x, q->y - p->y};
    }
    if (moves(moving, count, pair->count)) count_still(w, a, b, pair, still);
    free(moving);
    return ST_OK;
}

/* Whether both photos show the same picture, of their sizes: nearly all matches stay, all over the picture. A text
 * that is burnt in has most of the matches at most. */
static bool is_copy(const struct search *w, int a, int b, const struct matched_pair *pair)
{
    const struct photo_info *from = &w->photos->photos[a].info, *to = &w->photos->photos[b].info;
    const float sx = (float)to->width / (float)from->width, sy = (float)to->height / (float)from->height;
    const float room = tolerance(&w->to->groups[w->to->group_of[b]]) * fmaxf(1, fmaxf(sx, sy));
    bool seen[COPY_BLOCKS * COPY_BLOCKS] = {false};
    int still = 0, spread = 0;
    if (pair->count < COPY_MATCHES || fabsf(sx / sy - 1) > 0.01f) return false;
    for (int i = 0; i < pair->count; i++) {
        const struct spot *p = &w->spots[a][pair->matches[i].first], *q = &w->spots[b][pair->matches[i].second];
        if (hypotf(sx * p->x - q->x, sy * p->y - q->y) > room) continue;
        const int u = (int)(COPY_BLOCKS * p->x / (float)from->width),
                  v = (int)(COPY_BLOCKS * p->y / (float)from->height);
        still++;
        if (u >= 0 && v >= 0 && u < COPY_BLOCKS && v < COPY_BLOCKS) seen[v * COPY_BLOCKS + u] = true;
    }
    for (int k = 0; k < COPY_BLOCKS * COPY_BLOCKS; k++) spread += seen[k];
    return (float)still >= COPY_SHARE * (float)pair->count && spread >= COPY_SPREAD;
}

static void mark_copy(struct search *w, int a, int b, const struct matched_pair *pair)
{
    int *copy_of = w->to->copy_of;
    const int first = a < b ? a : b, second = a < b ? b : a;
    if (copy_of[second] < 0 && is_copy(w, a, b, pair)) copy_of[second] = copy_of[first] < 0 ? first : copy_of[first];
}

static void count_if_alike(struct search *w, int a, int b, const struct matched_pair *pair, struct err *err)
{
    const struct still_places *s = w->to;
    if (s->group_of[a] == s->group_of[b] && s->copy_of[a] < 0 && s->copy_of[b] < 0) count_pair(w, a, b, pair, err);
}

/* Twice: copies are found first. */
static enum status visit_photo(struct search *w, int photo, const char *matches, bool counting, struct err *err)
{
    struct match_list list = {0};
    char path[FILE_PATH];
    if (product_path_in(path, matches, PRODUCT_MATCHES, &(struct product_key){.photo = w->photos->photos[photo].id},
                        err))
        return err->status;
    if (!path_is_file(path) || match_list_read(&list, path, NULL, err)) return err->status;
    for (int i = 0; !err->status && i < list.count; i++) {
        const int other = photo_list_find_id(w->photos, list.pairs[i].other);
        if (other < 0 || !w->spots[photo] || !w->spots[other] || !fits(w, photo, other, &list.pairs[i])) continue;
        if (counting)
            count_if_alike(w, photo, other, &list.pairs[i], err);
        else
            mark_copy(w, photo, other, &list.pairs[i]);
    }
    match_list_release(&list);
    return err->status;
}

/* --------------------------------------------------------------------------------------------------------- deciding */

/* Cells beside those that stand still do, too. */
static enum status widen(unsigned char *still, const struct still_group *g, struct err *err)
{
    const size_t cells = (size_t)g->columns * (size_t)g->rows;
    unsigned char *core = malloc(cells);
    if (!core) return err_nomem(err, "places of a picture", cells);
    memcpy(core, still, cells);
    for (int y = 0; y < g->rows; y++)
        for (int x = 0; x < g->columns; x++)
            for (int k = 0; core[y * g->columns + x] && k < 9; k++) {
                const int u = x + k % 3 - 1, v = y + k / 3 - 1;
                if (u >= 0 && v >= 0 && u < g->columns && v < g->rows) still[v * g->columns + u] = 1;
            }
    free(core);
    return ST_OK;
}

/* Share of the blocks of cells with matches that also have still places: features are sparse, and those that move visit
 * many cells. */
static double share_of_picture(const struct still_group *g, const struct tally *t)
{
    int used = 0, still = 0;
    for (int y = 0; y < g->rows; y += BLOCK)
        for (int x = 0; x < g->columns; x += BLOCK) {
            bool any = false, in = false;
            for (int k = 0; k < BLOCK * BLOCK; k++) {
                const int u = x + k % BLOCK, v = y + k / BLOCK;
                if (u >= g->columns || v >= g->rows) continue;
                any |= t->any[v * g->columns + u] > 0;
                in |= g->still[v * g->columns + u];
            }
            used += any;
            still += in;
        }
    return used ? (double)still / used : 0;
}

static enum status decide(struct still_group *g, const struct tally *t, int photos, struct err *err)
{
    const int cells = g->columns * g->rows;
    const int wanted = (int)fmax(MIN_PHOTOS, ceil(PHOTO_SHARE * g->count));
    unsigned char *seen = calloc((size_t)photos + 1, 1);
    if (!seen) return err_nomem(err, "photos", (size_t)photos);
    for (int c = 0; c < cells; c++) {
        const unsigned char *row = t->seen + (size_t)c * ((size_t)photos + 1);
        int in = 0;
        for (int i = 0; i < photos; i++) in += row[i];
        g->still[c] = in >= wanted && (float)t->still[c] >= NEARLY * (float)t->nearly[c];
        if (!g->still[c]) continue;
        g->places++;
        g->matches += t->still[c];
        for (int i = 0; i < photos; i++) seen[i] |= row[i];
    }
    for (int i = 0; i < photos; i++) g->photos += seen[i];
    free(seen);
    if (share_of_picture(g, t) > STILL_SHARE) {
        memset(g->still, 0, (size_t)cells);
        g->places = g->matches = g->photos = 0;
    }
    return widen(g->still, g, err); /* features reach beyond their places */
}

/* Marks the features in such places. */
static enum status mark_features(struct still_places *s, const struct search *w, struct err *err)
{
    for (int i = 0; i < w->photos->count; i++) {
        const struct still_group *g = &s->groups[s->group_of[i]];
        if (!g->places || !w->spots[i]) continue;
        s->features[i] = malloc((size_t)w->counts[i] + 1);
        if (!s->features[i]) return err_nomem(err, "features", (size_t)w->counts[i]);
        for (int k = 0; k < w->counts[i]; k++)
            s->features[i][k] = g->still[cell_of(g, w->spots[i][k].x, w->spots[i][k].y)];
    }
    return ST_OK;
}

static void end_search(struct search *w)
{
    for (int i = 0; w->spots && i < w->photos->count; i++) free(w->spots[i]);
    for (int k = 0; w->tallies && k < w->to->count; k++) {
        free(w->tallies[k].seen);
        free(w->tallies[k].still);
    }
    free(w->spots);
    free(w->counts);
    free(w->tallies);
}

enum status still_places_find(struct still_places *s, const struct photo_list *photos, const char *features,
                              const char *matches, struct err *err)
{
    struct search w = {.to = s, .photos = photos};
    *s = (struct still_places){0};
    if (!find_groups(s, photos, err)) start_search(&w, err);
    for (int i = 0; !err->status && i < photos->count; i++) read_spots(&w, i, features, err);
    for (int i = 0; !err->status && i < photos->count; i++) visit_photo(&w, i, matches, false, err);
    for (int i = 0; !err->status && i < photos->count; i++) visit_photo(&w, i, matches, true, err);
    for (int k = 0; !err->status && k < s->count; k++) decide(&s->groups[k], &w.tallies[k], photos->count, err);
    if (!err->status) mark_features(s, &w, err);
    end_search(&w);
    if (err->status) still_places_release(s);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------ using */

void still_places_drop(const struct still_places *s, struct matched_pair *pair, int first, int second)
{
    const unsigned char *a = s->features[first], *b = s->features[second];
    int kept = 0;
    for (int i = 0; i < pair->count; i++)
        if (!(a && a[pair->matches[i].first]) && !(b && b[pair->matches[i].second]))
            pair->matches[kept++] = pair->matches[i];
    pair->count = kept;
}

/* The cells that are connected with one, as a rectangle; they are cleared. */
static void take_part(unsigned char *left, const struct still_group *g, int x, int y, int box[4])
{
    if (x < 0 || y < 0 || x >= g->columns || y >= g->rows || !left[y * g->columns + x]) return;
    left[y * g->columns + x] = 0;
    if (x < box[0]) box[0] = x;
    if (y < box[1]) box[1] = y;
    if (x > box[2]) box[2] = x;
    if (y > box[3]) box[3] = y;
    for (int k = 0; k < 9; k++) take_part(left, g, x + k % 3 - 1, y + k / 3 - 1, box);
}

void still_places_describe(char *text, size_t size, const struct still_group *g)
{
    const size_t cells = (size_t)g->columns * (size_t)g->rows;
    unsigned char *left = malloc(cells);
    int parts = 0;
    *text = 0;
    if (!left) return;
    memcpy(left, g->still, cells);
    for (int c = 0; c < (int)cells; c++) {
        int box[4] = {g->columns, g->rows, -1, -1};
        if (!left[c]) continue;
        take_part(left, g, c % g->columns, c / g->columns, box);
        const size_t n = strlen(text);
        if (parts++ >= MAX_NAMED) continue;
        const int right = (int)fminf((float)g->width, (float)(box[2] + 1) * g->cell),
                  low = (int)fminf((float)g->height, (float)(box[3] + 1) * g->cell);
        snprintf(text + n, size - n, "%sx %d to %d, y %d to %d px", n ? "; " : "", (int)((float)box[0] * g->cell),
                 right, (int)((float)box[1] * g->cell), low);
    }
    const size_t n = strlen(text);
    if (parts > MAX_NAMED) snprintf(text + n, size - n, "; %d more places", parts - MAX_NAMED);
    free(left);
}

enum status still_places_write_mask(const struct still_group *g, const char *path, struct err *err)
{
    const size_t cells = (size_t)g->columns * (size_t)g->rows, pixels = (size_t)g->width * (size_t)g->height;
    unsigned char *mask = malloc(pixels), *still = malloc(cells);
    if (!mask || !still) err_nomem(err, "a mask", pixels);
    if (still) memcpy(still, g->still, cells);
    if (!err->status) widen(still, g, err); /* texts reach beyond their features */
    for (int y = 0; !err->status && y < g->height; y++)
        for (int x = 0; x < g->width; x++)
            mask[(size_t)y * (size_t)g->width + (size_t)x] =
                still[cell_of(g, (float)x + 0.5f, (float)y + 0.5f)] ? 0 : 255;
    if (!err->status) png_write(path, mask, g->width, g->height, 1, err);
    free(mask);
    free(still);
    return err->status;
}

void still_places_release(struct still_places *s)
{
    if (!s) return;
    for (int k = 0; k < s->count; k++) free(s->groups[k].still);
    for (int i = 0; s->features && i < s->photos; i++) free(s->features[i]);
    free(s->groups);
    free(s->group_of);
    free(s->copy_of);
    free(s->features);
    *s = (struct still_places){0};
}
