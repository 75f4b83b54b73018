/* inherit.c - depth of border areas that no evidence holds apart from their surroundings.
 *
 * At the picture's border a near depth is out of view of most neighbours, which costs less than a bad match. A dark or
 * changed area there matches badly at every depth that can be seen; so it moves to the front, as a block. Raising the
 * cost of being out of view would cure it, but pushes true foreground away. A place far behind everything is hidden
 * from all neighbours, which costs less than a bad match, too; so an area that only this view sees may become a hole.
 * Blocks and holes are found by what surrounds them.
 *
 * Two adjacent segments are connected if their planes lie within `jump` steps at their border. A segment is held if it
 * and those connected to it have a mean confidence of at least `held`, and if its surface, of connected segments with
 * that mean, is large enough: confidence times size, in mean segments, sums to MIN_HELD. So are segments on a dominant
 * plane of the scene (scene_planes.h), and slanted planes that continue a held one: at both centres they agree within
 * COPLANAR steps. So a blank ceiling or floor, which comes near towards the border, stays on its plane. The others take
 * the inverse depths d that minimize
 *   sum over adjacent i, j  w_ij |d_i - d_j|  +  far_bias sum_i size_i d_i
 * given those of held segments; first with d_i at most what it was, then, from there, at least that. w_ij is the weight
 * of the smoothness cost, so that contact with an object of another colour hardly counts; contact with held segments on
 * the side where an area lies counts `keep` times that. An area stays in front as long as its contact with held
 * foreground outweighs its contact with what lies behind, and the bias. It stays behind as long as its contact with
 * what is held there, and the bias, outweigh its contact with what is nearer. A ramp costs as much as a jump, so that
 * it holds nothing.
 *
 * The minimum is found level by level [Hochbaum 2001]: the segments above a level and those below it are separated by a
 * minimum cut, independently of other levels. Levels are `jump` steps apart, and FINE times as near forwards: most of a
 * room lies within one jump of the far end. Areas that touch the picture's border on their side of the level are cut.
 * Inside the picture thin objects are often unsure, and neighbours see them: there areas only move back, in the last
 * round, and only if they then match the other views hardly worse, as a patch of a blank wall does.
 *
 * What differs from the source: d only says which surface an area continues: one between the last level that cuts the
 * area off and the next. The area takes over planes P that are harmonic on the segment graph,
 *   P_i = sum_j w_ij P_j / sum_j w_ij,
 * given the planes of the adjoining segments between these levels. So it continues a slanted surface, and blends
 * different ones. A segment that this moves by less than a level keeps its plane. All this is repeated, up to ROUNDS
 * times, since a segment that was held by chance may now be alone.
 *
 * Areas come forward in the last round only, since few depths are confirmed before. Those larger than MAX_HOLE are the
 * background, and stay. So does one that would match the other views worse; where none sees a segment, it counts as a
 * chance match.
 *
 * At last, where straight edges or the model show floor, ceiling and walls, nothing unsure stays clearly
 * beyond them. */
#include "stages/segment_depth/inherit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/numbers.h"
#include "stages/segment_depth/max_flow.h"

#define MIN_HELD     8 /* mean segments of confidence 1 */
#define MAX_LEVELS   64
#define ROUNDS       3
#define ITERATIONS   200
#define SHELL_MARGIN 0.9  /* of the shell's inverse depth, above which nothing is clearly beyond it */
#define MAX_HOLE     0.15 /* part of the picture that may come forward at once */
#define HARDLY_WORSE 0.2  /* cost of a match, by which an area inside the picture may match worse behind */
#define FINE         4    /* levels of areas that move forwards, in one of those that move back */
#define COPLANAR     2    /* steps by which planes of one surface may differ */
#define CAPACITY     1e6  /* of weight 1 */

struct caution {
    double held;           /* mean confidence */
    double keep, far_bias; /* as above */
    bool inside;           /* areas inside the picture are cut, too */
};
/* If another round follows: few depths are confirmed yet. In the last one, a bias of 0.02 sends unsure foreground
 * behind its surroundings. */
static const struct caution early = {0.1, 3, 0, false}, last = {0.3, 1.0, 0.005, true};

struct inherit {
    const struct plane_problem *p;
    const struct segmentation *s;
    struct plane *planes;
    const double *confidence;
    struct caution caution;
    bool forwards;         /* which way areas move */
    double spacing, level; /* of levels, and the one that is cut; inverse depths */
    int levels;
    bool *held, *listed, *moves;
    int *members;        /* segments of an area */
    int *node;           /* of each member: its place among the members */
    int *cut_at;         /* of each segment: number of the last level that it is cut off at; 0: none */
    struct plane *taken; /* of each segment that is cut off: what it takes over */
    struct max_flow flow;
};

/* Inverse depth of segment i at border t. */
static double at_border(const struct inherit *x, int i, int t)
{
    const struct border *b = &x->s->borders[t];
    return plane_at(x->planes[i], (double)b->u, (double)b->v);
}

static double at_centre(const struct inherit *x, int i)
{
    return plane_at(x->planes[i], x->s->segments[i].cx, x->s->segments[i].cy);
}

/* Whether segment i is connected to the other side of its border t. */
static bool connected(const struct inherit *x, int i, int t)
{
    return fabs(at_border(x, i, t) - at_border(x, x->s->borders[t].other, t)) <= x->p->params->jump * x->p->step;
}

/* Lists the area of segment `from` in members: the segments that `joins` adds across their borders. Returns how many.
 */
static int gather(struct inherit *x, int from, bool (*joins)(const struct inherit *x, int i, int t))
{
    int count = 0;
    x->listed[from] = true;
    x->members[count++] = from;
    for (int k = 0; k < count; k++)
        for (int i = x->members[k], t = x->s->first_border[i]; t < x->s->first_border[i + 1]; t++) {
            const int j = x->s->borders[t].other;
            if (x->listed[j] || !joins(x, i, t)) continue;
            x->listed[j] = true;
            x->members[count++] = j;
        }
    return count;
}

static bool joins_surface(const struct inherit *x, int i, int t)
{
    return x->held[x->s->borders[t].other] && connected(x, i, t);
}

/* Whether both sides of border t are slanted, and continue each other: at both centres their planes agree. */
static bool joins_plane(const struct inherit *x, int i, int t)
{
    const int j = x->s->borders[t].other;
    const struct segment *g = &x->s->segments[i], *h = &x->s->segments[j];
    const struct plane a = x->planes[i], b = x->planes[j];
    const double step = COPLANAR * x->p->step;
    return (a.a != 0 || a.b != 0) && (b.a != 0 || b.b != 0) &&
           fabs(plane_at(a, g->cx, g->cy) - plane_at(b, g->cx, g->cy)) <= step &&
           fabs(plane_at(a, h->cx, h->cy) - plane_at(b, h->cx, h->cy)) <= step;
}

/* Whether an inverse depth is on the side of the level where areas come from. */
static bool from_there(const struct inherit *x, double inverse) { return (inverse >= x->level) != x->forwards; }

static bool may_move(const struct inherit *x, int i) { return !x->held[i] && from_there(x, at_centre(x, i)); }

static bool joins_unsure(const struct inherit *x, int i, int t)
{
    (void)i;
    return may_move(x, x->s->borders[t].other);
}

static double confidence_around(const struct inherit *x, int i)
{
    const struct segmentation *s = x->s;
    double area = s->segments[i].pixels, sum = area * x->confidence[i];
    for (int t = s->first_border[i]; t < s->first_border[i + 1]; t++) {
        const int j = s->borders[t].other;
        if (!connected(x, i, t)) continue;
        area += s->segments[j].pixels;
        sum += s->segments[j].pixels * x->confidence[j];
    }
    return sum / area;
}

/* Whether segment i is on a plane of the scene. A known one counts everywhere against moving back: straight edges often
 * miss the end of a wall. Against moving forwards it counts only where it is expected. */
static bool is_on_scene(const struct inherit *x, int i)
{
    const struct scene_planes *scene = x->p->scene;
    if (!scene_planes_have(scene, x->planes[i])) return false;
    for (int k = 0; x->forwards && k < scene->known; k++)
        if (memcmp(&scene->planes[k], &x->planes[i], sizeof *x->planes) == 0)
            return problem_expects(x->p, i) == &scene->planes[k];
    return true;
}

static bool always_held(const struct inherit *x, int i) { return given_depth_has(x->p->given, i) || is_on_scene(x, i); }

static void find_held(struct inherit *x)
{
    const struct segmentation *s = x->s;
    for (int i = 0; i < s->count; i++) {
        x->held[i] = always_held(x, i) || confidence_around(x, i) >= x->caution.held;
        x->listed[i] = false;
    }
    for (int i = 0; i < s->count; i++) {
        double sure = 0;
        if (x->listed[i] || !x->held[i]) continue;
        const int count = gather(x, i, joins_surface);
        for (int k = 0; k < count; k++) sure += x->confidence[x->members[k]] * s->segments[x->members[k]].pixels;
        if (sure >= MIN_HELD * x->p->params->segment_pixels) continue;
        for (int k = 0; k < count; k++) x->held[x->members[k]] = always_held(x, x->members[k]);
    }
    memset(x->listed, 0, (size_t)s->count * sizeof *x->listed);
    for (int i = 0; i < s->count; i++) {
        if (x->listed[i] || !x->held[i]) continue;
        const int count = gather(x, i, joins_plane);
        for (int k = 0; k < count; k++) x->held[x->members[k]] = true;
    }
}

static bool touches_picture_border(const struct inherit *x, int count)
{
    for (int k = 0; k < count; k++) {
        const struct segment *g = &x->s->segments[x->members[k]];
        if (!g->x0 || !g->y0 || g->x1 == x->s->width - 1 || g->y1 == x->s->height - 1) return true;
    }
    return false;
}

/* Adds the terms of member k: on the sink's side it moves. */
static void add_terms(struct inherit *x, int k)
{
    const struct segmentation *s = x->s;
    const int i = x->members[k];
    const double bias = x->caution.far_bias * s->segments[i].pixels / x->p->params->segment_pixels;
    double stays = x->forwards ? bias : -bias;
    for (int t = s->first_border[i]; t < s->first_border[i + 1]; t++) {
        const int j = s->borders[t].other;
        const double w = (double)x->p->weights[t];
        const int64_t capacity = (int64_t)(w * CAPACITY);
        if (x->held[j])
            stays += from_there(x, at_border(x, j, t)) ? x->caution.keep * w : -w;
        else if (!may_move(x, j))
            stays -= w;
        else if (j > i)
            max_flow_edge(&x->flow, k, x->node[j], capacity, capacity);
    }
    max_flow_terminal(&x->flow, k, (int64_t)(stays * CAPACITY));
}

/* Cuts the area of the members at a level. */
static enum status cut_area(struct inherit *x, int count, int number, struct err *err)
{
    const struct segmentation *s = x->s;
    int edges = 0;
    for (int k = 0; k < count; k++) {
        const int i = x->members[k];
        x->node[i] = k;
        edges += s->first_border[i + 1] - s->first_border[i];
    }
    if (max_flow_begin(&x->flow, count, edges, err)) return err->status;
    for (int k = 0; k < count; k++) add_terms(x, k);
    if (max_flow_solve(&x->flow, err)) return err->status;
    for (int k = 0; k < count; k++) {
        int *cut_at = &x->cut_at[x->members[k]];
        if (!*cut_at && max_flow_on_sink_side(&x->flow, k)) *cut_at = number;
    }
    return ST_OK;
}

static enum status cut_level(struct inherit *x, int number, struct err *err)
{
    x->level = x->p->min_inverse_z + number * x->spacing;
    memset(x->listed, 0, (size_t)x->s->count * sizeof *x->listed);
    for (int i = 0; !err->status && i < x->s->count; i++) {
        if (x->listed[i] || !may_move(x, i)) continue;
        const int count = gather(x, i, joins_unsure);
        const bool inside = x->caution.inside && !x->forwards;
        if (inside || touches_picture_border(x, count)) cut_area(x, count, number, err);
    }
    return err->status;
}

/* Whether segment i, which is cut off, continues the plane of the other side of its border t. */
static bool continues(const struct inherit *x, int i, int t)
{
    const int j = x->s->borders[t].other, number = x->cut_at[i];
    if (x->cut_at[j]) return x->taken[j].c != 0 && abs(number - x->cut_at[j]) <= 1;
    const double level = (at_border(x, j, t) - x->p->min_inverse_z) / x->spacing;
    if (x->forwards) return level >= number && (number == x->levels || level < number + 1);
    return level < number && (number == 1 || level >= number - 1);
}

static struct plane mean_plane(const struct inherit *x, int i)
{
    struct plane sum = {0, 0, 0};
    double total = 0;
    for (int t = x->s->first_border[i]; t < x->s->first_border[i + 1]; t++) {
        const int j = x->s->borders[t].other;
        if (!continues(x, i, t)) continue;
        const struct plane other = (x->cut_at[j] ? x->taken : x->planes)[j];
        const double w = (double)x->p->weights[t];
        sum = (struct plane){sum.a + w * other.a, sum.b + w * other.b, sum.c + w * other.c};
        total += w;
    }
    return total > 0 ? (struct plane){sum.a / total, sum.b / total, sum.c / total} : x->taken[i];
}

/* Finds the planes that what is cut off takes over. */
static void find_taken(struct inherit *x)
{
    int count = 0;
    for (int i = 0; i < x->s->count; i++) {
        if (!x->cut_at[i]) continue;
        x->members[count++] = i;
        x->taken[i] = (struct plane){0, 0, 0}; /* unknown yet */
    }
    for (int round = 0; round < ITERATIONS; round++)
        for (int n = 0; n < count; n++) {
            const int i = x->members[round & 1 ? count - 1 - n : n];
            x->taken[i] = mean_plane(x, i);
        }
}

/* Brings the plane of segment i into the range of depths. Returns whether it moves the segment. */
static bool moves(struct inherit *x, int i)
{
    const double min = x->p->min_inverse_z, max = x->p->max_inverse_z;
    const struct segment *g = &x->s->segments[i];
    struct plane *plane = &x->taken[i];
    if (!x->cut_at[i] || !(plane->c != 0)) return false;
    if (!plane_within(*plane, g, min, max))
        *plane = (struct plane){0, 0, clamp(plane_at(*plane, g->cx, g->cy), min, max)};
    const double moved = plane_at(*plane, g->cx, g->cy) - at_centre(x, i);
    return (x->forwards ? moved : -moved) > fmin(x->spacing, x->p->params->jump * x->p->step);
}

static bool joins_moving(const struct inherit *x, int i, int t)
{
    (void)i;
    return x->moves[x->s->borders[t].other];
}

/* How badly a segment on a plane matches the views that see it there; as a chance match where none does. */
static double mismatch(const struct inherit *x, int i, struct plane plane)
{
    unsigned occluded = 0;
    float cost = MATCH_CHANCE;
    if (x->p->cross) cross_view_cost(x->p->cross, i, plane, &occluded);
    return match_evidence(x->p->m, i, plane, occluded, &cost) ? (double)cost : (double)MATCH_CHANCE;
}

/* Whether the area of the members may take over its planes. At the border it may always move back. Elsewhere the other
 * views decide by how badly it then matches; and an area that comes forward must be smaller than the background. */
static bool may_take_over(const struct inherit *x, int count)
{
    double rise = 0, pixels = 0;
    if (!x->forwards && touches_picture_border(x, count)) return true;
    for (int k = 0; k < count; k++) {
        const int i = x->members[k];
        rise += x->s->segments[i].pixels * (mismatch(x, i, x->taken[i]) - mismatch(x, i, x->planes[i]));
        pixels += x->s->segments[i].pixels;
    }
    if (!x->forwards) return rise <= HARDLY_WORSE * pixels;
    return rise <= 0 && pixels <= MAX_HOLE * x->s->width * x->s->height;
}

/* Replaces the planes of what is cut off. Returns whether any changed. */
static bool take_over(struct inherit *x, bool *inherited)
{
    bool changed = false;
    find_taken(x);
    for (int i = 0; i < x->s->count; i++) {
        x->moves[i] = moves(x, i);
        x->listed[i] = false;
    }
    for (int i = 0; i < x->s->count; i++) {
        if (x->listed[i] || !x->moves[i]) continue;
        const int count = gather(x, i, joins_moving);
        if (!may_take_over(x, count)) continue;
        for (int k = 0; k < count; k++) {
            const int j = x->members[k];
            x->planes[j] = x->taken[j];
            inherited[j] = changed = true;
        }
    }
    return changed;
}

/* Brings what is unsure, and lies clearly beyond the room's shell, to it. What lies near it stays: heights of rooms are
 * measured with it, and would be too low without what is a little too far. */
static void stay_in_room(struct inherit *x, bool *inherited)
{
    x->forwards = true;
    for (int i = 0; i < x->s->count; i++) {
        const struct segment *g = &x->s->segments[i];
        const struct plane *shell = problem_expects(x->p, i);
        if (!shell || !problem_allows(x->p, g, *shell) || always_held(x, i)) continue;
        if (!inherited[i] && confidence_around(x, i) >= x->caution.held) continue;
        if (!(at_centre(x, i) < SHELL_MARGIN * plane_at(*shell, g->cx, g->cy))) continue;
        x->planes[i] = *shell;
        inherited[i] = true;
    }
}

/* Moves areas one way. */
static enum status move_areas(struct inherit *x, bool *inherited, bool forwards, struct err *err)
{
    const struct plane_problem *p = x->p;
    const double range = PLANE_MAX_FACTOR * p->max_inverse_z - p->min_inverse_z, jump = p->params->jump * p->step;
    x->forwards = forwards;
    x->spacing = fmax(forwards ? jump / FINE : jump, range / MAX_LEVELS);
    x->levels = (int)ceil(range / x->spacing) - 1;
    for (int round = 0; !err->status && round < ROUNDS; round++) {
        find_held(x);
        memset(x->cut_at, 0, (size_t)x->s->count * sizeof *x->cut_at);
        for (int n = 1; !err->status && n <= x->levels; n++) cut_level(x, forwards ? x->levels + 1 - n : n, err);
        if (err->status || !take_over(x, inherited)) break;
    }
    return err->status;
}

enum status inherit_planes(struct plane *planes, bool *inherited, const double *confidence,
                           const struct plane_problem *p, bool cautious, struct err *err)
{
    const struct segmentation *s = p->m->segments;
    const size_t count = (size_t)s->count + 1;
    struct inherit x = {.p = p, .s = s, .planes = planes, .confidence = confidence};
    x.caution = cautious ? early : last;
    x.held = malloc(count * sizeof *x.held);
    x.listed = malloc(count * sizeof *x.listed);
    x.moves = malloc(count * sizeof *x.moves);
    x.members = malloc(count * sizeof *x.members);
    x.node = malloc(count * sizeof *x.node);
    x.cut_at = malloc(count * sizeof *x.cut_at);
    x.taken = malloc(count * sizeof *x.taken);
    if (!x.held || !x.listed || !x.moves || !x.members || !x.node || !x.cut_at || !x.taken)
        err_nomem(err, "border areas", count * 39);
    if (!err->status && !move_areas(&x, inherited, false, err) && (cautious || !move_areas(&x, inherited, true, err)))
        stay_in_room(&x, inherited);
    max_flow_release(&x.flow);
    free(x.held);
    free(x.listed);
    free(x.moves);
    free(x.members);
    free(x.node);
    free(x.cut_at);
    free(x.taken);
    return err->status;
}
