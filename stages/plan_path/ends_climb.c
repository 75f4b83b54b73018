/* ends_climb.c - improvement of a move's ends off the grid. Not in the thesis.
 *
 * First Levenberg-Marquardt on a smooth surrogate (refine_ends.c), from which only as much is kept as the real validity
 * and parallax confirm; then hill climbing by small steps of one end along one axis, each of which must increase the
 * parallax. Intermediate results pass a coarse test of their path; at the end, the one with the most parallax whose
 * whole path is valid is taken. */
#include "stages/plan_path/ends_climb.h"

#include "stages/plan_path/refine_ends.h"

#define BACK_STEPS      3   /* attempts between the refined ends and those on the grid */
#define PATHS_PER_ROUND 4   /* steps whose path is tested in a round */
#define FIRST_STEP      0.5 /* of the climb, in units of the grid's spacing */
#define MIN_STEP        0.1
#define Z_SPACING       8 /* spacing in z, in steps of the region's z */

/* Adds the refined ends, or a point between them and the grid's ends that is valid and has more parallax. */
static enum status refine(struct ascent *a, struct ends_search *s, struct err *err)
{
    const struct move_ends *best = &a->up[a->height];
    struct vec3 refined[2] = {best->at[0], best->at[1]};
    bool valid = false;
    if (refine_ends(refined, s->scene, s->v, s->params->max_angle, err)) return err->status;
    for (int i = 0; i < BACK_STEPS && !valid; i++) {
        struct move_ends e = {.valid = false};
        for (int k = 0; k < 2; k++) e.at[k] = point_between(best->at[k], refined[k], pow(0.5, i));
        if (!ends_are_allowed(s, e.at)) continue;
        if (ends_measure_parallax(s, &e, err)) return err->status;
        if (!(e.parallax > best->parallax)) continue;
        if (ends_test_path(&valid, s, e.at, err)) return err->status;
        if (valid) a->up[++a->height] = e;
    }
    return ST_OK;
}

enum { AXES = 3, STEPS = 4 * AXES };

/* All single steps: each end, forwards and backwards along each axis. length: in units of the grid's spacing. */
static void list_steps(struct move_ends step[STEPS], const struct validity *v, const struct move_ends *from,
                       double length)
{
    for (int i = 0; i < STEPS; i++) {
        const int k = i / (2 * AXES), axis = i / 2 % AXES;
        const struct validity_region *r = &v->region[k];
        const struct validity_cell *first = &r->cells[0], *last = &r->cells[cell_count(r) - 1];
        const double spacing[AXES] = {(last->x - first->x) / fmax(1, r->columns - 1),
                                      (last->y - first->y) / fmax(1, r->rows - 1), Z_SPACING * v->step};
        const struct vec3 at = shot_from_world(&v->shot, from->at[k]);
        double to[AXES] = {at.x, at.y, at.z};
        to[axis] += (i % 2 ? -1 : 1) * length * spacing[axis];
        step[i] = (struct move_ends){.at = {from->at[0], from->at[1]}};
        step[i].at[k] = world_from_shot(&v->shot, to[0], to[1], to[2]);
    }
}

/* Measures the parallax of single steps; 0 for those that are not allowed. */
static enum status score_steps(struct move_ends step[STEPS], struct ends_search *s, const struct move_ends *from,
                               struct err *err)
{
    struct picture_batch b; /* the end that each step moves, then the two ends where they were */
    if (ends_batch_init(&b, s, STEPS + 2, err)) return err->status;
    for (int i = 0; i < STEPS + 2; i++) {
        b.end[i] = i < STEPS ? i / (2 * AXES) : i - STEPS;
        b.at[i] = i < STEPS ? step[i].at[b.end[i]] : from->at[b.end[i]];
        b.wanted[i] = i >= STEPS || ends_are_allowed(s, step[i].at);
    }
    ends_batch_render(&b, err);
    for (int i = 0; !err->status && i < STEPS; i++)
        if (b.wanted[i])
            step[i].parallax = parallax_between(&b.pictures[b.end[i] ? STEPS : i],
                                                &b.pictures[b.end[i] ? i : STEPS + 1], parallax_tolerance(s->scene));
    ends_batch_release(&b);
    return err->status;
}

static int max_parallax(const struct move_ends step[STEPS])
{
    int best = 0;
    for (int i = 1; i < STEPS; i++)
        if (step[i].parallax > step[best].parallax) best = i;
    return best;
}

enum status climb_begin(struct ascent *a, struct ends_search *s, const struct move_ends *from, struct err *err)
{
    *a = (struct ascent){.up = {*from}, .length = FIRST_STEP};
    return refine(a, s, err);
}

/* Takes the best step whose path is valid while it gives more parallax; halves the steps when none does. This covers
 * what the surrogate leaves out: what hides what after the step, and the true borders of the regions. */
enum status climb_on(struct ascent *a, struct ends_search *s, int rounds, struct err *err)
{
    const int end = rounds < CLIMB_ROUNDS - a->rounds ? a->rounds + rounds : CLIMB_ROUNDS;
    for (; a->rounds < end && a->length >= MIN_STEP; a->rounds++) {
        const struct move_ends *from = &a->up[a->height];
        struct move_ends step[STEPS];
        bool moved = false;
        list_steps(step, s->v, from, a->length);
        if (score_steps(step, s, from, err)) return err->status;
        for (int n = 0; !moved && n < PATHS_PER_ROUND; n++) {
            const int best = max_parallax(step);
            if (!(step[best].parallax > from->parallax)) break;
            if (ends_test_path(&moved, s, step[best].at, err)) return err->status;
            if (moved) a->up[++a->height] = step[best];
            step[best].parallax = 0;
        }
        if (!moved) a->length *= 0.5;
    }
    return ST_OK;
}

enum status climb_take_top(struct move_ends *best, bool *moved, const struct ascent *a, struct ends_search *s,
                           struct err *err)
{
    *moved = false;
    for (int i = a->height; !err->status && !*moved && i > 0; i--) {
        struct move_ends e = a->up[i];
        if (ends_measure_path(s, &e, err) || !e.valid) continue;
        *best = e;
        *moved = true;
    }
    return err->status;
}
