/* sun_search.c - the direction of the sun from the patches that it throws on walls and floors.
 *
 * Overview. A patch of direct sun is the projection of a window along one direction, the same for all windows of the
 * model. So a direction says which texels are lit: those from which a ray towards the sun leaves the model through an
 * opening. The right direction is the one at which the edges between lit and unlit are edges of the picture: brighter
 * on the lit side, in all three colours.
 *
 * Mathematics. The view-independent atlas is cut into squares (atlas_squares.c); pairs of squares a small distance
 * apart on one face have nearly the same indirect light, so that the logarithm of their quotient is that of the sun's
 * light plus the texture's noise, which has no sign. A direction's contrast is the mean over the pairs that it parts,
 * and its score that mean times the square root of their number: a mean in units of its chance deviation, but for a
 * constant.
 * The quotient of a pair is the least of those of the three colours, because paint and carpets differ in colour and
 * light hardly does, and is cut off at CUT, so that a few lamps and mirrors do not decide.
 *   1. All directions, in a grid of STEP degrees, with squares of which COARSE cover the model.
 *   2. The best PEAKS, each far from the others, are refined with smaller squares close to their edges, by steps in
 *      eight directions whose length is halved, first with pairs that are far apart, then with close ones.
 *   3. The interval comes from leaving out one part of the edges in turn [Efron 1982, the jackknife]: parts are cubes
 *      of space, so that a piece of texture is in one of them.
 * What chance can do is seen from directions whose patches are darker than what is around them: light never does that.
 *   A wrong direction may throw a patch through another window onto an edge of the right patch, and then explains a
 * part of it. So the other peaks count by what they explain of what the best one leaves.
 *   Boards with a pattern hide how large the contrast is. What tells the sun from chance is a sign test: many more than
 * half of the edges are brighter on the side that should be lit. Neighbouring pairs share their texture, so that its
 * standard deviations are not to be taken literally: chance reaches 16 of them, patches of sun 26 and more.
 *
 * Source: none for this form. That shadows and patches give the direction of the sun is common knowledge; the search
 * over directions with the model's own openings follows [Colburn 2014, 5.3.2] in treating a window as the light. */
#include "stages/bake_outdoors/sun_search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/math/numbers.h"
#include "stages/bake_outdoors/sun_fit.h"

enum { COARSE = 16000, PEAKS = 6, GAP = 2, FINE_GAP = 4, ROWS = 8 };
static const double STEP = 2.5, LOWEST = 4, HIGHEST = 82; /* degrees */
static const double CUT = 1;                              /* of a logarithm */
static const double FEW = 40;                             /* pairs, added to the number that a direction parts */
static const double APART = 8, NEAR = 4, SMALLEST = 0.02; /* degrees: of peaks; around a peak; of a step */
static const double GRAZING = 0.05;                       /* cosine: surfaces that the sun only grazes count as unlit */
static const double FINER = 0.25;                         /* of a coarse square's side */
/* what a patch of sun has at least */
static const double MIN_SURE = 20, MIN_OVER_RIVAL = 1.4, MIN_OVER_NEXT = 2, MIN_GAIN = 0.05, MIN_CONTRAST = 0.06;

static struct vec3 direction_at(double azimuth, double elevation)
{
    return vec3_make(cos(elevation) * cos(azimuth), cos(elevation) * sin(azimuth), sin(elevation));
}

static double angle_between(struct vec3 a, struct vec3 b)
{
    return atan2(vec3_length(vec3_cross(a, b)), vec3_dot(a, b)) / DEGREE;
}

/* ------------------------------------------------------------------------------------------------------------ score */

static void light_squares(bool *lit, const struct atlas_squares *texels, const struct model_rays *model,
                          struct vec3 to_sun)
{
    struct vec3 from[RAY_PACKET], direction[RAY_PACKET];
    double reach[RAY_PACKET];
    int index[RAY_PACKET], waiting = 0;
    for (int k = 0; k < RAY_PACKET; k++) {
        direction[k] = to_sun;
        reach[k] = INFINITY;
    }
    for (int i = 0; i <= texels->count; i++) {
        if (i < texels->count) {
            const struct atlas_square *t = &texels->list[i];
            lit[i] = false;
            if (!(vec3_dot(t->normal, to_sun) > GRAZING)) continue;
            from[waiting] = vec3_add(t->at, vec3_scale(t->normal, 4 * model->rays.epsilon));
            index[waiting++] = i;
        }
        if (waiting < RAY_PACKET && i < texels->count) continue;
        const unsigned active = (1u << waiting) - 1;
        const unsigned blocked = ray_scene_blocked_packet(&model->rays, from, direction, reach, active);
        for (int k = 0; k < waiting; k++) lit[index[k]] = !(blocked >> k & 1);
        waiting = 0;
    }
}

/* How much brighter a is than b, by the colour in which the difference is least. */
static double quotient(const struct atlas_square *a, const struct atlas_square *b)
{
    double least = INFINITY;
    for (int c = 0; c < 3; c++) {
        const double d = (double)(a->level[c] - b->level[c]);
        if (fabs(d) < fabs(least)) least = d;
    }
    const double first = (double)(a->level[0] - b->level[0]);
    for (int c = 1; c < 3; c++) /* colours that disagree about the sign say nothing */
        if ((double)(a->level[c] - b->level[c]) * first < 0) return 0;
    return clamp(least, -CUT, CUT);
}

static struct sun_evidence judge(const struct atlas_squares *texels, const bool *lit)
{
    struct sun_evidence e = {0};
    double sum = 0;
    int agree = 0;
    for (int i = 0; i < texels->pair_count; i++) {
        const struct atlas_pair *p = &texels->pairs[i];
        if (lit[p->a] == lit[p->b]) continue;
        const double d = lit[p->a] ? quotient(&texels->list[p->a], &texels->list[p->b])
                                   : quotient(&texels->list[p->b], &texels->list[p->a]);
        sum += d;
        agree += d > 0;
        e.border++;
    }
    if (!e.border) return e;
    e.score = sum / sqrt(e.border + FEW);
    e.contrast = sum / e.border;
    e.agree = (double)agree / e.border;
    e.sure = (2 * e.agree - 1) * sqrt(e.border);
    return e;
}

/* ------------------------------------------------------------------------------------------------------- directions */

struct survey {
    const struct model_rays *model;
    const struct atlas_squares *texels;
    const struct vec3 *directions;
    struct sun_evidence *evidence;
    bool *lit; /* a thread's own part of it has texels->count elements */
};

static void survey_range(void *ctx, size_t begin, size_t end, int thread)
{
    struct survey *s = ctx;
    bool *lit = s->lit + (size_t)thread * (size_t)(s->texels->count + 1);
    for (size_t i = begin; i < end; i++) {
        light_squares(lit, s->texels, s->model, s->directions[i]);
        s->evidence[i] = judge(s->texels, lit);
    }
}

/* Evidence for each direction. */
static enum status survey(struct sun_evidence *evidence, const struct vec3 *directions, int count,
                          const struct atlas_squares *texels, const struct model_rays *model, struct err *err)
{
    struct survey s = {model, texels, directions, evidence, NULL};
    const size_t size = (size_t)parallel_threads() * (size_t)(texels->count + 1);
    s.lit = malloc(size * sizeof *s.lit);
    if (!s.lit) return err_nomem(err, "squares", size);
    parallel_for((size_t)count, ROWS, survey_range, &s);
    free(s.lit);
    return ST_OK;
}

/* All directions of the sky, STEP degrees apart. Returns their number; to may be NULL. */
static int list_directions(struct vec3 *to)
{
    int count = 0;
    for (double elevation = LOWEST; elevation <= HIGHEST; elevation += STEP) {
        const int columns = (int)ceil(360 / STEP * cos(elevation * DEGREE));
        for (int k = 0; k < columns; k++, count++)
            if (to) to[count] = direction_at(2 * PI * k / columns, elevation * DEGREE);
    }
    return count;
}

struct peak {
    struct vec3 direction;
    struct sun_evidence evidence;
    struct sun_fit fit;
};

/* The best directions that are far from each other, best first. Returns their number. */
static int find_peaks(struct peak peaks[PEAKS], const struct vec3 *directions, const struct sun_evidence *evidence,
                      int count)
{
    int found = 0;
    for (; found < PEAKS; found++) {
        int best = -1;
        for (int i = 0; i < count; i++) {
            bool taken = !(evidence[i].score > 0);
            for (int k = 0; k < found && !taken; k++) taken = angle_between(directions[i], peaks[k].direction) < APART;
            if (!taken && (best < 0 || evidence[i].score > evidence[best].score)) best = i;
        }
        if (best < 0) break;
        peaks[found] = (struct peak){.direction = directions[best], .evidence = evidence[best]};
    }
    return found;
}

/* ------------------------------------------------------------------------------------------------------- refinement */

/* Coarse squares at which the light changes in directions near one. */
struct edges {
    const struct atlas_squares *coarse;
    struct atlas_places places;
};

static bool is_near_edge(const void *ctx, int tile, struct vec3 at)
{
    const struct edges *e = ctx;
    return atlas_places_near(&e->places, tile, at, 1.5 * e->coarse->side);
}

/* Marks the squares whose light changes within NEAR degrees of a direction. */
static enum status mark_edges(bool *edge, const struct atlas_squares *coarse, const struct model_rays *model,
                              struct vec3 direction, struct err *err)
{
    const size_t count = (size_t)coarse->count + 1;
    bool *lit = malloc(count * sizeof *lit), *other = malloc(count * sizeof *other);
    if (!lit || !other) err_nomem(err, "squares", 2 * count);
    if (!err->status) {
        light_squares(lit, coarse, model, direction);
        memset(edge, 0, count);
        for (int k = 0; k < 8; k++) {
            light_squares(other, coarse, model, sun_aside(direction, k * PI / 4, NEAR));
            for (int i = 0; i < coarse->count; i++) edge[i] |= lit[i] != other[i];
        }
        for (int i = 0; i < coarse->pair_count; i++) {
            const struct atlas_pair *p = &coarse->pairs[i];
            if (lit[p->a] != lit[p->b]) edge[p->a] = edge[p->b] = true;
        }
    }
    free(lit);
    free(other);
    return err->status;
}

/* Moves a direction uphill. */
static enum status climb(struct peak *peak, const struct atlas_squares *texels, const struct model_rays *model,
                         double step, struct err *err)
{
    bool *lit = malloc(((size_t)texels->count + 1) * sizeof *lit);
    if (!lit) return err_nomem(err, "squares", (size_t)texels->count);
    light_squares(lit, texels, model, peak->direction);
    peak->evidence = judge(texels, lit);
    while (step >= SMALLEST) {
        struct peak best = *peak;
        for (int k = 0; k < 8; k++) {
            const struct vec3 d = sun_aside(peak->direction, k * PI / 4, step);
            light_squares(lit, texels, model, d);
            const struct sun_evidence e = judge(texels, lit);
            if (e.score > best.evidence.score) best = (struct peak){.direction = d, .evidence = e};
        }
        if (best.evidence.score > peak->evidence.score)
            *peak = best;
        else
            step /= 2;
    }
    free(lit);
    return ST_OK;
}

/* Also lists the squares close to the edges, which the caller releases. */
static enum status refine(struct peak *peak, struct atlas_squares *fine, const struct edges *edges,
                          const struct atlas_scene *scene, struct err *err)
{
    const struct atlas_filter filter = {is_near_edge, edges};
    if (atlas_squares_list(fine, scene, FINER * edges->coarse->side, FINE_GAP, &filter, err) ||
        climb(peak, fine, scene->model, STEP / 2, err))
        return err->status;
    peak->fit.direction = peak->direction;
    return sun_fit_edges(&peak->fit, fine, scene->model, err);
}

static enum status refine_peak(struct peak *peak, struct atlas_squares *fine, const struct atlas_squares *coarse,
                               const struct atlas_scene *scene, struct err *err)
{
    bool *edge = calloc((size_t)coarse->count + 1, sizeof *edge);
    struct edges edges = {.coarse = coarse};
    if (!edge) err_nomem(err, "squares", (size_t)coarse->count);
    if (!err->status && !mark_edges(edge, coarse, scene->model, peak->direction, err) &&
        !atlas_places_list(&edges.places, coarse, edge, scene->atlas->atlas.tile_count, err))
        refine(peak, fine, &edges, scene, err);
    atlas_places_release(&edges.places);
    free(edge);
    return err->status;
}

/* ----------------------------------------------------------------------------------------------------------- search */

/* Whether the best direction is that of a sun. No other one is nearly as sure, or explains half as much beside it. */
static bool is_sun(const struct sun_search *s)
{
    const bool alone = s->evidence.sure >= MIN_OVER_RIVAL * s->rival || s->fit.gain >= MIN_OVER_NEXT * s->next;
    return alone && s->evidence.sure >= MIN_SURE && s->fit.gain >= fmax(s->next, MIN_GAIN) &&
           s->evidence.contrast >= MIN_CONTRAST;
}

/* Refines the peaks, and keeps the surest one. What the others explain, they explain beside it. */
static enum status choose_peak(struct sun_search *s, struct peak *peaks, int count, const struct atlas_squares *coarse,
                               const struct atlas_scene *scene, struct err *err)
{
    struct atlas_squares fine[PEAKS] = {{0}};
    int best = 0;
    for (int k = 0; !err->status && k < count; k++)
        if (!refine_peak(&peaks[k], &fine[k], coarse, scene, err) && peaks[k].evidence.sure > peaks[best].evidence.sure)
            best = k;
    for (int k = 0; !err->status && k < count; k++) {
        double rest = 0;
        if (angle_between(peaks[k].fit.direction, peaks[best].fit.direction) < APART) continue;
        s->rival = fmax(s->rival, peaks[k].evidence.sure);
        if (!sun_fit_rest(&rest, &peaks[best].fit, &peaks[k].fit, &fine[k], scene->model, err))
            s->next = fmax(s->next, rest);
    }
    if (!err->status && count) {
        s->fit = peaks[best].fit;
        s->evidence = peaks[best].evidence;
        s->edges = fine[best];
        fine[best] = (struct atlas_squares){0};
        s->found = is_sun(s);
    }
    for (int k = 0; k < count; k++) atlas_squares_release(&fine[k]);
    return err->status;
}

static enum status search(struct sun_search *s, const struct atlas_squares *coarse, const struct atlas_scene *scene,
                          struct err *err)
{
    const int count = list_directions(NULL);
    struct vec3 *directions = malloc((size_t)count * sizeof *directions);
    struct sun_evidence *evidence = calloc((size_t)count, sizeof *evidence);
    struct peak peaks[PEAKS];
    if (!directions || !evidence) err_nomem(err, "directions", (size_t)count * sizeof *evidence);
    if (!err->status) {
        list_directions(directions);
        survey(evidence, directions, count, coarse, scene->model, err);
    }
    if (!err->status) choose_peak(s, peaks, find_peaks(peaks, directions, evidence, count), coarse, scene, err);
    free(directions);
    free(evidence);
    return err->status;
}

void sun_search_release(struct sun_search *s) { atlas_squares_release(&s->edges); }

enum status sun_search(struct sun_search *s, const struct atlas_scene *scene, struct err *err)
{
    struct atlas_squares coarse = {0};
    const double side = atlas_squares_side(scene, COARSE);
    *s = (struct sun_search){0};
    if (side > 0 && !atlas_squares_list(&coarse, scene, side, GAP, NULL, err)) search(s, &coarse, scene, err);
    atlas_squares_release(&coarse);
    return err->status;
}
