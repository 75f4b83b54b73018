/* model_prior.c - the faces of the solid model as what segments are expected to lie on, and what may stand before them.
 *
 * A segment is expected on the face that the ray of its middle pixel meets first. Panes of glass show what is behind
 * the model, so that nothing is expected there; faces on one plane count as one. A model may have walls without a room:
 * then a ray that meets no face ends on the floor, which is at 0, or on the ceiling, which is where the highest wall
 * ends, if this is within the plan of the walls.
 *
 * Evidence beats the model. A segment costs its gain less on its face, and less so the surer its depth was before. What
 * still lies off its face stays only with evidence from two views, or as part of a thing that has it: adjacent segments
 * off their faces whose planes meet at the border are a thing, and a thing stays if segments on whose depth AGREEING
 * other views agree make up HELD_PART of it. Everything else takes its face, without confidence. */
#include "stages/segment_depth/model_prior.h"

#include <math.h>
#include <stdlib.h>

#include "common/layers/layered_depth.h"
#include "common/math/numbers.h"

#define SAME_PLANE 1e-3 /* part of a plane's normal by which faces on one plane may differ */
#define SURE_PART  0.75 /* part of the gain that a sure depth before takes away */
#define OFF_PART   0.02 /* part of the inverse depth, and ... */
#define OFF_STEPS  1.0  /* ... steps, from which on a segment lies off its face */
#define MEET_STEPS 3.0  /* by which planes of one thing may differ at their border */
#define AGREEING   0.9  /* other views, weighted with their confidence */
#define HELD_PART  0.15 /* of a thing's pixels */

static int candidate_of(struct prior_candidate *list, int *count, struct vec3 normal)
{
    for (int k = 0; k < *count; k++)
        if (vec3_length(vec3_sub(list[k].normal, normal)) <= SAME_PLANE * vec3_length(normal)) return k;
    list[*count] = (struct prior_candidate){normal, 0};
    return (*count)++;
}

/* The box of the model. */
struct extent {
    struct vec3 low, high;
};

static struct extent extent_of(const struct solid_mesh *mesh)
{
    struct extent e = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (int i = 0; i < mesh->vertex_count; i++) {
        const struct vec3 p = mesh->vertices[i].p;
        e.low = vec3_make(fmin(e.low.x, p.x), fmin(e.low.y, p.y), fmin(e.low.z, p.z));
        e.high = vec3_make(fmax(e.high.x, p.x), fmax(e.high.y, p.y), fmax(e.high.z, p.z));
    }
    return e;
}

/* Whether the ray of a pixel ends on the floor or the ceiling of walls that have no room; *normal: of that plane. */
static bool meets_level(struct vec3 *normal, const struct view_trace *t, const struct extent *e, double scale, double u,
                        double v)
{
    const struct view *view = &t->view;
    const struct vec3 ray = vec3_make((u - view->cx) / view->fx, (v - view->cy) / view->fy, 1),
                      up = mat3_apply(view->cam_from_world, vec3_make(0, 0, 1));
    const double rise = vec3_dot(up, ray), height = view->center.z;
    const double off = rise > 0 ? e->high.z - height : -height; /* of the level from the camera */
    if (t->in_solid || !(off * rise > 0)) return false;
    const struct vec3 at = view_unproject(view, u, v, off / rise);
    *normal = vec3_scale(up, scale / off);
    return at.x > e->low.x && at.x < e->high.x && at.y > e->low.y && at.y < e->high.y;
}

enum status model_prior_make(struct plane_prior *prior, const struct view_trace *t, double scale,
                             const struct view *view, const struct segmentation *s, struct err *err)
{
    const struct solid_mesh *mesh = &t->model->mesh;
    const struct extent extent = extent_of(mesh);
    struct prior_candidate *candidates = calloc((size_t)mesh->face_count + 2, sizeof *candidates);
    int count = 0;
    if (candidates)
        plane_prior_init(prior, s->count, err);
    else
        err_nomem(err, "expected planes", (size_t)mesh->face_count * sizeof *candidates);
    for (int i = 0; !err->status && i < s->count; i++) {
        const struct segment *g = &s->segments[i];
        const uint32_t face = t->faces[s->pixel[g->first + g->pixels / 2]];
        struct vec3 normal;
        if (face) {
            const double *plane = t->planes[face - 1];
            if (solid_face_is_pane(mesh, (int)face - 1)) continue;
            normal = plane_normal(view, (struct plane){plane[0], plane[1], plane[2]});
        } else if (!meets_level(&normal, t, &extent, scale, g->cx, g->cy))
            continue;
        const int k = prior->expected[i] = candidate_of(candidates, &count, normal);
        candidates[k].pixels += g->pixels;
    }
    if (!err->status) plane_prior_keep(prior, candidates, count, view, s, err);
    free(candidates);
    return err->status;
}

void model_prior_weigh(struct plane_prior *prior, double gain, const double *sure, const struct segmentation *s)
{
    for (int i = 0; i < s->count; i++) prior->gain[i] = (float)(gain * (1 - SURE_PART * clamp(sure[i], 0, 1)));
}

static bool is_off(const struct plane_problem *p, int segment, struct plane plane)
{
    const struct segment *g = &p->m->segments->segments[segment];
    const struct plane *face = problem_expects(p, segment);
    if (!face) return false;
    const double there = plane_at(*face, g->cx, g->cy);
    return !(fabs(plane_at(plane, g->cx, g->cy) - there) <= fmax(OFF_PART * there, OFF_STEPS * p->step));
}

static int root_of(int *parent, int i)
{
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

/* Joins adjacent segments off their faces whose planes meet. */
static void join_things(int *parent, const bool *off, const struct plane *planes, const struct plane_problem *p)
{
    const struct segmentation *s = p->m->segments;
    for (int i = 0; i < s->count; i++)
        for (int t = s->first_border[i]; off[i] && t < s->first_border[i + 1]; t++) {
            const struct border *b = &s->borders[t];
            if (b->other <= i || !off[b->other]) continue;
            const double gap = plane_at(planes[i], (double)b->u, (double)b->v) -
                               plane_at(planes[b->other], (double)b->u, (double)b->v);
            if (fabs(gap) <= MEET_STEPS * p->step) parent[root_of(parent, i)] = root_of(parent, b->other);
        }
}

enum status model_prior_settle(struct plane *planes, bool *inherited, const double *confidence,
                               const struct plane_problem *p, struct err *err)
{
    const struct segmentation *s = p->m->segments;
    const size_t count = (size_t)s->count + 1;
    int *parent = malloc(count * sizeof *parent);
    bool *off = malloc(count * sizeof *off);
    double *pixels = calloc(count, sizeof *pixels), *held = calloc(count, sizeof *held);
    if (!parent || !off || !pixels || !held) err_nomem(err, "things before the model", count * 21);
    for (int i = 0; !err->status && i < s->count; i++) {
        parent[i] = i;
        off[i] = !given_depth_has(p->given, i) && is_off(p, i, planes[i]);
    }
    if (!err->status) join_things(parent, off, planes, p);
    for (int i = 0; !err->status && i < s->count; i++) {
        if (!off[i]) continue;
        const int k = root_of(parent, i);
        pixels[k] += s->segments[i].pixels;
        if (p->cross && !inherited[i] && confidence[i] >= DEPTH_INHERITED &&
            cross_view_support(p->cross, i, planes[i]) >= AGREEING)
            held[k] += s->segments[i].pixels;
    }
    for (int i = 0; !err->status && i < s->count; i++) {
        if (!off[i] || held[root_of(parent, i)] >= HELD_PART * pixels[root_of(parent, i)]) continue;
        planes[i] = *problem_expects(p, i);
        inherited[i] = true;
    }
    free(parent);
    free(off);
    free(pixels);
    free(held);
    return err->status;
}
