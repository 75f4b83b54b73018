/* unseen_fit.c - see unseen_fit.h.
 *
 * Overview. A lamp that no photograph shows whole is marked by nobody, and its light is missing from every gather. But
 * the photographs show where it arrives: on the floor below it and on the walls around it. The textured faces are cut
 * into squares, and each place of a grid below the ceilings that no photograph shows is tried: a lamp there explains
 * what is missing well, or it does not.
 *
 * Mathematics. Square i of face f has radiance L_i and irradiance E_i from what is known; a lamp of intensity a adds
 * F_i a, with F_i = cos cos / r^2 where nothing lies between. The face reflects a share k_f. With
 *     e_i = log L_i - log(E_i + F_i a) - median over the face,
 * the loss is the sum of sqrt(1 + (e_i / NOISE)^2) - 1, so that rugs, pictures and patches of sun count little. For
 * each place it is minimised over a, the best place is moved by steps that halve, and the lamp is taken if the loss
 * falls by the share LEAST, and by half of that on two faces at least: a patch of sun lies on one. Each colour is
 * fitted at that place. The standard errors are a jackknife over blocks of space, since neighbours err alike.
 *
 * At a bright place of a ceiling (bright_ceilings.c) the photographs show the lamp: there its place and outline are
 * known, and it is taken if the loss falls by LEAST_BRIGHT.
 *
 * What lamps below ceilings leave may come from a lamp on a stand or a wall. Places in the air are tried as they are,
 * with light that goes evenly to all sides: good enough to say that there is one, not to use it.
 *
 * Limits. A lamp that is used stands close below a ceiling and shines down. */
#include "stages/fit_lights/unseen_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/light/ceiling_places.h"
#include "common/light/colour.h"
#include "common/light/point_lamp.h"
#include "common/math/weighted.h"

enum {
    MOST_PLACES = 400,
    SCAN = 9,
    NARROW = 12,
    FEW = 3,
    BLOCKS = 8,
    LUMINANCE = 3,
    FACES = 2,
    LEVELS = 3, /* of lamps that stand, between floor and ceiling */
    PARTS = 4   /* a side of a lamp */
};
static const double SPACING = 0.14;      /* of the model's height: of the grid, at least */
static const double WIDE = 0.25;         /* the same of lamps that stand or hang on walls */
static const double BELOW = 0.01;        /* of a room's height: distance of a lamp from the ceiling */
static const double NEAREST = 0.1;       /* of the model's height: nearer squares tell nothing */
static const double NOISE = 0.1;         /* of a texture, a logarithm */
static const double LEAST_BRIGHT = 0.02; /* the same of one that photographs show */
static const double LEAST = 0.2;         /* share of the loss that a lamp must explain */
static const double BLOCK = 0.3;         /* of the model's height: the side of a block */
static const double FINEST = 16;         /* steps of the place end at the spacing over this */

double unseen_lamp_factor(const struct model_rays *rays, const struct bright_place *lamp, struct vec3 at,
                          struct vec3 normal)
{
    const enum point_lamp_kind kind = lamp->is_round ? POINT_LAMP_ROUND : POINT_LAMP_DOWNWARDS;
    const int side = lamp->x > 0 ? PARTS : 1;
    double sum = 0;
    for (int k = 0; k < side * side; k++) {
        const double x = (2 * (k % side) + 1.0) / side - 1, y = (2 * (k / side) + 1.0) / side - 1;
        const struct vec3 part = vec3_add(lamp->at, vec3_make(x * lamp->x, y * lamp->y, 0));
        sum += point_lamp_factor(rays, kind, part, at, normal);
    }
    return sum / (side * side);
}

/* What a fit at one place works on. */
struct trial {
    const struct unseen_light *l;
    struct bright_place at;
    double a, loss;
    double *factors;          /* of each square; below 0: too near */
    struct weighted *scratch; /* of each square */
    const double (*logs)[4];  /* of each square's radiance: R, G, B, luminance */
    int left_out;             /* a block; -1: none */
};

static double pick(const double rgb[3], int colour)
{
    return colour < 3 ? rgb[colour] : rgb_luminance(rgb_make(rgb[0], rgb[1], rgb[2]));
}

static int block_of(const struct unseen_light *l, int i)
{
    const double side = BLOCK * model_rays_height(l->rays);
    const struct vec3 p = l->squares->list[i].at;
    const int x = (int)floor(p.x / side), y = (int)floor(p.y / side), z = (int)floor(p.z / side);
    return (int)(((unsigned)x * 73856093u ^ (unsigned)y * 19349663u ^ (unsigned)z * 83492791u) % BLOCKS);
}

static void find_factors(struct trial *t)
{
    const struct unseen_light *l = t->l;
    const double nearest = NEAREST * model_rays_height(l->rays);
    for (int i = 0; i < l->squares->count; i++) {
        const struct atlas_square *s = &l->squares->list[i];
        const bool near = vec3_length(vec3_sub(t->at.at, s->at)) < nearest + fmax(t->at.x, t->at.y);
        t->factors[i] = near ? -1 : unseen_lamp_factor(l->shadows, &t->at, s->at, s->normal);
    }
}

static int end_of_face(const struct atlas_squares *s, int first)
{
    int end = first;
    while (end < s->count && s->list[end].tile == s->list[first].tile) end++;
    return end;
}

static bool counts(const struct trial *t, int i, int colour)
{
    if (t->factors[i] < 0 || !(pick(t->l->known[i], colour) > 0)) return false;
    return t->left_out < 0 || block_of(t->l, i) != t->left_out;
}

/* Of one face. */
static double face_loss(const struct trial *t, int first, int end, int colour, double a)
{
    size_t count = 0;
    double sum = 0;
    for (int i = first; i < end; i++) {
        if (!counts(t, i, colour)) continue;
        const double e = t->logs[i][colour] - log(pick(t->l->known[i], colour) + t->factors[i] * a);
        t->scratch[count++] = (struct weighted){e, 1};
    }
    if (count < FEW) return 0;
    const double median = weighted_percentile(t->scratch, count, 0.5);
    for (size_t k = 0; k < count; k++) {
        const double e = (t->scratch[k].value - median) / NOISE;
        sum += sqrt(1 + e * e) - 1;
    }
    return sum;
}

static double loss(const struct trial *t, int colour, double a)
{
    const struct atlas_squares *s = t->l->squares;
    double sum = 0;
    for (int first = 0; first < s->count;) {
        const int end = end_of_face(s, first);
        sum += face_loss(t, first, end, colour, a);
        first = end;
    }
    return sum;
}

/* The intensity that gives as much light as all else, where the lamp shines most. */
static double usual_intensity(const struct trial *t, int colour)
{
    double most = 0;
    for (int i = 0; i < t->l->squares->count; i++)
        if (counts(t, i, colour)) most = fmax(most, t->factors[i] / pick(t->l->known[i], colour));
    return most > 0 ? 1 / most : 0;
}

/* Sets a and the loss: over powers of 2, then by a narrowing interval about the best [Kiefer 1953]. */
static void fit_intensity(struct trial *t, int colour)
{
    const double usual = usual_intensity(t, colour);
    t->a = 0;
    t->loss = loss(t, colour, 0);
    if (!(usual > 0)) return;
    double best = -1;
    for (int k = 0; k < SCAN; k++) {
        const double a = usual * ldexp(1, k - 4), value = loss(t, colour, a);
        if (value >= t->loss) continue;
        t->loss = value;
        best = t->a = a;
    }
    if (best < 0) return;
    double low = log(best / 2), high = log(best * 2);
    for (int k = 0; k < NARROW; k++) {
        const double one = low + 0.382 * (high - low), two = high - 0.382 * (high - low);
        if (loss(t, colour, exp(one)) < loss(t, colour, exp(two)))
            high = two;
        else
            low = one;
    }
    const double a = exp((low + high) / 2), value = loss(t, colour, a);
    if (value < t->loss) t->a = a, t->loss = value;
}

/* ----------------------------------------------------------------------------------------------------------- places */

static struct ceiling_grid grid_of(const struct unseen_light *l)
{
    return (struct ceiling_grid){l->rays, SPACING, BELOW, MOST_PLACES, l->may_be, l->ctx};
}

/* ----------------------------------------------------------------------------------------------------------- search */

struct search {
    struct unseen_light *l;
    double (*logs)[4];
    struct trial *trials;
    int count;
};

static enum status find_logs(struct search *s, struct err *err)
{
    const size_t count = (size_t)s->l->squares->count;
    s->logs = calloc(count + 1, sizeof *s->logs);
    if (!s->logs) return err_nomem(err, "squares", count * sizeof *s->logs);
    for (size_t i = 0; i < count; i++) {
        double rgb[3];
        for (int c = 0; c < 3; c++) {
            s->logs[i][c] = (double)s->l->squares->list[i].level[c];
            rgb[c] = exp(s->logs[i][c]);
        }
        s->logs[i][LUMINANCE] = log(pick(rgb, LUMINANCE));
    }
    return ST_OK;
}

static enum status trials_make(struct search *s, int count, struct err *err)
{
    const size_t squares = (size_t)s->l->squares->count + 1;
    s->trials = calloc((size_t)count + 1, sizeof *s->trials);
    if (!s->trials) return err_nomem(err, "places of lamps", (size_t)count * sizeof *s->trials);
    for (s->count = 0; s->count < count; s->count++) {
        struct trial *t = &s->trials[s->count];
        *t = (struct trial){.l = s->l, .logs = (const double(*)[4])s->logs, .left_out = -1};
        t->factors = calloc(squares, sizeof *t->factors);
        t->scratch = calloc(squares, sizeof *t->scratch);
        if (t->factors && t->scratch) continue;
        s->count++;
        return err_nomem(err, "squares", squares * sizeof *t->scratch);
    }
    return ST_OK;
}

static void trials_release(struct search *s)
{
    for (int i = 0; i < s->count; i++) {
        free(s->trials[i].factors);
        free(s->trials[i].scratch);
    }
    free(s->trials);
    free(s->logs);
}

static void try_range(void *ctx, size_t begin, size_t end, int thread)
{
    const struct search *s = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        find_factors(&s->trials[i]);
        fit_intensity(&s->trials[i], LUMINANCE);
    }
}

/* Moves the place by steps that halve, for as long as the loss falls. */
static void refine(struct trial *best, struct trial *other)
{
    const struct unseen_light *l = best->l;
    const struct ceiling_grid grid = grid_of(l);
    const double spacing = ceiling_places_spacing(&grid);
    for (double step = spacing / 2; step > spacing / FINEST; step /= 2)
        for (int k = 0; k < 4; k++) {
            other->at = best->at;
            *(k < 2 ? &other->at.at.x : &other->at.at.y) += k % 2 ? step : -step;
            if (!l->may_be(l->ctx, other->at.at)) continue;
            find_factors(other);
            fit_intensity(other, LUMINANCE);
            if (other->loss >= best->loss) continue;
            const struct trial was = *best;
            *best = *other;
            *other = was;
        }
}

/* How much of the loss a lamp explains, and on how many faces. */
static double gain_of(const struct trial *t, int *faces)
{
    const struct atlas_squares *s = t->l->squares;
    double was = 0, is = 0;
    *faces = 0;
    for (int first = 0; first < s->count;) {
        const int end = end_of_face(s, first);
        const double without = face_loss(t, first, end, LUMINANCE, 0), with = face_loss(t, first, end, LUMINANCE, t->a);
        *faces += without - with > 0.5 * LEAST * without && without > FEW;
        was += without;
        is += with;
        first = end;
    }
    return was > 0 ? 1 - is / was : 0;
}

/* Each colour, with a jackknife over blocks. */
static void fit_colours(struct unseen_lamp *lamp, struct trial *t)
{
    for (int c = 0; c < 3; c++) {
        double logs[BLOCKS], mean = 0, sum = 0;
        int n = 0;
        for (int b = 0; b < BLOCKS; b++) {
            t->left_out = b;
            fit_intensity(t, c);
            if (!(t->a > 0)) continue;
            logs[n] = log(t->a);
            mean += logs[n++];
        }
        t->left_out = -1;
        fit_intensity(t, c);
        lamp->intensity[c] = t->a;
        for (int b = 0; b < n; b++) sum += (logs[b] - mean / n) * (logs[b] - mean / n);
        lamp->error[c] = n == BLOCKS ? sqrt(sum * (n - 1) / n) : 1;
    }
}

/* Adds its light to what is known, and says where it shows most. */
static void add_light(struct unseen_lamp *lamp, const struct trial *t, struct unseen_light *l)
{
    for (int i = 0; i < l->squares->count; i++) {
        const double was = pick(l->known[i], LUMINANCE);
        for (int c = 0; c < 3; c++) l->known[i][c] += fmax(t->factors[i], 0) * lamp->intensity[c];
        const double excess = was > 0 ? pick(l->known[i], LUMINANCE) / was - 1 : 0;
        if (excess <= lamp->excess) continue;
        lamp->excess = excess;
        lamp->brightest = l->squares->list[i].at;
        lamp->tile = l->squares->list[i].tile;
    }
}

/* A lamp at a bright place. Near squares count again for the next one. */
static bool fit_bright(struct unseen_lamp *lamp, struct search *s, const struct bright_place *place)
{
    struct trial *t = &s->trials[0];
    int faces;
    t->at = *place;
    t->at.at.z -= BELOW * model_rays_height(s->l->rays);
    find_factors(t);
    fit_intensity(t, LUMINANCE);
    *lamp = (struct unseen_lamp){.place = t->at, .gain = gain_of(t, &faces)};
    if (!(t->a > 0) || lamp->gain < LEAST_BRIGHT) return false;
    fit_colours(lamp, t);
    add_light(lamp, t, s->l);
    return true;
}

/* Fits a lamp to the first `count` trials. Returns that which explains most. */
static struct trial *try_all(struct search *s, int count)
{
    int best = 0;
    parallel_for((size_t)count, 1, try_range, s);
    for (int i = 1; i < count; i++)
        if (s->trials[i].loss < s->trials[best].loss) best = i;
    return &s->trials[best];
}

static bool find_one(struct unseen_lamp *lamp, struct search *s)
{
    int faces;
    struct trial *t = try_all(s, s->count - 1);
    refine(t, &s->trials[s->count - 1]);
    *lamp = (struct unseen_lamp){.place = t->at, .gain = gain_of(t, &faces)};
    if (!(t->a > 0) || lamp->gain < LEAST || faces < FACES) return false;
    fit_colours(lamp, t);
    add_light(lamp, t, s->l);
    return true;
}

enum status unseen_fit(struct unseen_lamp *lamps, int *count, struct unseen_light *l, struct err *err)
{
    struct vec3 places[MOST_PLACES];
    struct search s = {.l = l};
    const struct ceiling_grid grid = grid_of(l);
    const int found = ceiling_places_list(places, &grid);
    *count = 0;
    if (!find_logs(&s, err) && !trials_make(&s, found + 1, err)) { /* one more, for refine() */
        bool more = found > 0;
        for (int i = 0; i < l->bright_count && *count < MAX_UNSEEN; i++)
            *count += fit_bright(&lamps[*count], &s, &l->bright[i]);
        while (more && *count < MAX_UNSEEN) {
            for (int i = 0; i <= found; i++) s.trials[i].at = (struct bright_place){.at = places[i < found ? i : 0]};
            more = find_one(&lamps[*count], &s);
            *count += more;
        }
    }
    trials_release(&s);
    return err->status;
}

/* Places in the air, a part of a room's height below its ceiling. */
static int list_standing(struct vec3 *places, const struct unseen_light *l)
{
    int count = 0;
    for (int k = 1; k <= LEVELS; k++) {
        const struct ceiling_grid grid = {
            .rays = l->rays, .spacing = WIDE, .below = (double)k / (LEVELS + 1), .most = MOST_PLACES / LEVELS};
        count += ceiling_places_list(places + count, &grid);
    }
    return count;
}

enum status unseen_fit_standing(struct unseen_lamp *lamp, bool *found, struct unseen_light *l, struct err *err)
{
    struct vec3 places[MOST_PLACES];
    struct search s = {.l = l};
    const int count = list_standing(places, l);
    int faces;
    *found = false;
    if (count && !find_logs(&s, err) && !trials_make(&s, count, err)) {
        for (int i = 0; i < count; i++) s.trials[i].at = (struct bright_place){.at = places[i], .is_round = true};
        struct trial *t = try_all(&s, count);
        *lamp = (struct unseen_lamp){.place = t->at, .gain = gain_of(t, &faces)};
        for (int c = 0; c < 3; c++) lamp->intensity[c] = t->a;
        *found = t->a > 0 && lamp->gain >= LEAST && faces >= FACES;
        if (*found) add_light(lamp, t, l);
    }
    trials_release(&s);
    return err->status;
}
