/* draft.c - a draft of an edited room in a photograph; see draft.h.
 *
 * The pixel's ray meets a surface before the edit and one after it.
 *
 *  * Where these are one surface at one place, and the edit keeps its texture, the photograph's own pixel stays, unless
 * it shows furniture that the edit removes. Furniture that stays, and stands before the new surface, stays in sight.
 *  * Otherwise the edit's rules (common/texture/texture_map.h) lead from the surface to a place of the rooms as they
 * were photographed. The photographs that show this place are those in whose frame it lies, with no surface and no
 * furniture before it. Of these the one counts that looks at it most as this one does: the angle between the two
 * directions, and 0.2 of how much farther it is, as render_model chooses viewpoints [Buehler 2001].
 *  * Furniture at a new place and objects stand before that (draft_things.c).
 *  * Panes are transparent; what lies outdoors is looked up by its direction.
 *
 * A model has some hundred faces, so a ray tries them all: first the plane, then the face's box, then its triangles. */
#include "stages/build_model/live/draft.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "stages/build_model/texture/texture_rules.h"

static const double FARTHER = 0.2, /* a photo twice as far counts as one turned by so many radians */
    FAR = 1e5,                     /* sizes of the model: where outdoors is */
    NEAR = 1e-4;                   /* the same: what is one place */

struct flat_face {
    struct vec3 normal;
    double offset, low[2], high[2]; /* its box, in the coordinates `axis` */
    int axis[2], id, first, count;  /* of its triangles */
    bool is_pane;
};

struct draft_solid {
    struct flat_face *faces;
    double (*flat)[6];         /* of each triangle a corner and two edges, in the coordinates of its face */
    struct vec3 (*corners)[3]; /* and its corners */
    int count;
};

static double part(struct vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

static void solid_free(struct draft_solid *s)
{
    if (!s) return;
    free(s->faces);
    free(s->flat);
    free(s->corners);
    free(s);
}

static void flatten(struct draft_solid *s, const struct solid_mesh *m, const struct solid_triangles *tris, int at)
{
    struct flat_face *f = &s->faces[at];
    const struct vec3 n = m->faces[at].normal;
    const double size[3] = {fabs(n.x), fabs(n.y), fabs(n.z)};
    const int drop = size[0] > size[1] && size[0] > size[2] ? 0 : size[1] > size[2] ? 1 : 2;
    *f = (struct flat_face){.normal = n,
                            .offset = m->faces[at].offset,
                            .axis = {drop == 0 ? 1 : 0, drop == 2 ? 1 : 2},
                            .id = solid_face_id(m, at),
                            .first = tris->first[at],
                            .count = tris->first[at + 1] - tris->first[at],
                            .is_pane = solid_face_is_pane(m, at)};
    for (int k = 0; k < 2; k++) f->low[k] = HUGE_VAL, f->high[k] = -HUGE_VAL;
    for (int i = f->first; i < f->first + f->count; i++) {
        for (int c = 0; c < 3; c++) s->corners[i][c] = m->vertices[tris->triangles[i].v[c]].p;
        for (int k = 0; k < 2; k++) {
            const double a = part(s->corners[i][0], f->axis[k]);
            s->flat[i][k] = a;
            for (int c = 1; c < 3; c++) s->flat[i][2 * c + k] = part(s->corners[i][c], f->axis[k]) - a;
            for (int c = 0; c < 3; c++) {
                f->low[k] = fmin(f->low[k], part(s->corners[i][c], f->axis[k]));
                f->high[k] = fmax(f->high[k], part(s->corners[i][c], f->axis[k]));
            }
        }
    }
}

static struct draft_solid *solid_of(const struct solid_mesh *m, struct err *err)
{
    struct solid_triangles tris = {0};
    struct draft_solid *s = calloc(1, sizeof *s);
    if (!s) err_nomem(err, "a draft", sizeof *s);
    if (s && !solid_mesh_triangulate(&tris, m, err)) {
        const size_t count = (size_t)tris.count + 1;
        s->count = m->face_count;
        s->faces = calloc((size_t)m->face_count + 1, sizeof *s->faces);
        s->flat = calloc(count, sizeof *s->flat);
        s->corners = calloc(count, sizeof *s->corners);
        if (!s->faces || !s->flat || !s->corners) err_nomem(err, "a draft", count * sizeof *s->corners);
        for (int f = 0; !err->status && f < m->face_count; f++) flatten(s, m, &tris, f);
    }
    solid_triangles_release(&tris);
    if (!err->status) return s;
    solid_free(s);
    return NULL;
}

/* Whether a face has the point of its plane with two coordinates. */
static bool face_has(const struct draft_solid *s, const struct flat_face *f, double a, double b, double slack)
{
    if (a < f->low[0] - slack || a > f->high[0] + slack || b < f->low[1] - slack || b > f->high[1] + slack)
        return false;
    for (int i = f->first; i < f->first + f->count; i++) {
        const double *t = s->flat[i], x = a - t[0], y = b - t[1], det = t[2] * t[5] - t[3] * t[4];
        const double p = (x * t[5] - y * t[4]) / det, q = (t[2] * y - t[3] * x) / det, g = 1e-9;
        if (p >= -g && q >= -g && p + q <= 1 + g) return true;
    }
    return false;
}

/* The first face that a ray meets from outside, nearer than `most`; -1: none. Panes count only if `panes`. */
static int meet(const struct draft_solid *s, struct vec3 from, struct vec3 ray, bool panes, double most, double *at)
{
    int found = -1;
    *at = most;
    for (int i = 0; i < s->count; i++) {
        const struct flat_face *f = &s->faces[i];
        const double down = vec3_dot(f->normal, ray);
        if (!(down < 0) || (f->is_pane && !panes)) continue;
        const double t = (f->offset - vec3_dot(f->normal, from)) / down;
        if (!(t > 0 && t < *at)) continue;
        if (!face_has(s, f, part(from, f->axis[0]) + t * part(ray, f->axis[0]),
                      part(from, f->axis[1]) + t * part(ray, f->axis[1]), 0))
            continue;
        *at = t;
        found = i;
    }
    return found;
}

/* ---------------------------------------------------------------------------------------------------------- places */

static struct vec3 nearest_on_triangle(const struct vec3 c[3], struct vec3 p)
{
    const struct vec3 u = vec3_sub(c[1], c[0]), v = vec3_sub(c[2], c[0]), n = vec3_cross(u, v), w = vec3_sub(p, c[0]);
    const double size = vec3_dot(n, n), b = vec3_dot(vec3_cross(w, v), n) / size,
                 g = vec3_dot(vec3_cross(u, w), n) / size;
    if (b >= 0 && g >= 0 && b + g <= 1) return vec3_add(c[0], vec3_add(vec3_scale(u, b), vec3_scale(v, g)));
    struct vec3 best = c[0];
    for (int i = 0; i < 3; i++) {
        const struct vec3 a = c[i], e = vec3_sub(c[(i + 1) % 3], a);
        const double t = fmin(1, fmax(0, vec3_dot(vec3_sub(p, a), e) / fmax(vec3_dot(e, e), 1e-300)));
        const struct vec3 q = vec3_add(a, vec3_scale(e, t)), to = vec3_sub(q, p), was = vec3_sub(best, p);
        if (vec3_dot(to, to) < vec3_dot(was, was)) best = q;
    }
    return best;
}

/* The place of the photographed face of an id that is nearest to p; -1: the rooms have no such face. */
static int nearest_of(const struct draft_solid *s, int id, struct vec3 p, struct vec3 *place)
{
    double least = HUGE_VAL;
    int found = -1;
    for (int f = 0; f < s->count; f++)
        for (int i = s->faces[f].first; s->faces[f].id == id && i < s->faces[f].first + s->faces[f].count; i++) {
            const struct vec3 q = nearest_on_triangle(s->corners[i], p), to = vec3_sub(q, p);
            const double away = vec3_dot(to, to);
            if (!(away < least)) continue;
            least = away;
            found = f;
            *place = q;
        }
    return found;
}

/* --------------------------------------------------------------------------------------------------------- photos */

/* How little a photo suits a place that another camera looks at along `ray` from a distance: the less the better. A
 * negative number: it does not show it. away: HUGE_VAL for outdoors. */
static double misfit(const struct draft *d, const struct placer *placer, int own, int photo, struct vec3 place,
                     int face, struct vec3 ray, double away, double at[2])
{
    const struct photo_camera *c = &placer->photos[photo].camera;
    const bool outdoors = away == HUGE_VAL;
    const struct vec3 to = outdoors ? vec3_scale(ray, FAR * d->size) : vec3_sub(place, c->center);
    const double length = vec3_length(to);
    if (!outdoors && !(vec3_dot(to, d->solids[0]->faces[face].normal) < -0.05 * length)) return -1;
    if (!photo_camera_project(c, vec3_add(c->center, to), &at[0], &at[1]) || !(at[0] >= 0 && at[1] >= 0) ||
        !(at[0] <= c->lens.width && at[1] <= c->lens.height))
        return -1;
    if (draft_things_at(&d->things, photo, c, at[0], at[1])) return -1;
    const double cosine = fmin(1, fmax(-1, vec3_dot(to, ray) / length));
    return outdoors ? vec3_length(vec3_sub(c->center, placer->photos[own].camera.center))
                    : acos(cosine) + FARTHER * fmax(0, length / away - 1);
}

/* Nothing stands between a photo's camera and a place. */
static bool is_clear(const struct draft *d, struct vec3 from, struct vec3 to)
{
    const struct vec3 by = vec3_sub(to, from);
    const double length = vec3_length(by);
    double at;
    return meet(d->solids[0], from, vec3_scale(by, 1 / length), false, length - 10 * NEAR * d->size, &at) < 0;
}

static struct draft_pixel best_photo(const struct draft *d, const struct placer *placer, int own, struct vec3 place,
                                     int face, struct vec3 ray, double away)
{
    enum { MOST = 512 };
    double fits[MOST], at[MOST][2];
    const int count = placer->photo_count < MOST ? placer->photo_count : MOST;
    for (int i = 0; i < count; i++) fits[i] = misfit(d, placer, own, i, place, face, ray, away, at[i]);
    if (own < count && fits[own] >= 0) fits[own] = 0;
    for (;;) {
        int best = -1;
        for (int i = 0; i < count; i++)
            if (fits[i] >= 0 && (best < 0 || fits[i] < fits[best])) best = i;
        if (best < 0) return (struct draft_pixel){.kind = DRAFT_UNSEEN};
        const struct vec3 from = placer->photos[best].camera.center;
        if (is_clear(d, from, away == HUGE_VAL ? vec3_add(from, vec3_scale(ray, FAR * d->size)) : place))
            return (struct draft_pixel){.kind = DRAFT_PIXEL, .photo = best, .at = {at[best][0], at[best][1]}};
        fits[best] = -1;
    }
}

static struct draft_pixel outdoors(const struct draft *d, const struct placer *placer, int own, struct vec3 ray)
{
    return best_photo(d, placer, own, (struct vec3){0}, -1, ray, HUGE_VAL);
}

/* What a place of an edited face shows. */
static struct draft_pixel surface(const struct draft *d, const struct placer *placer, int own, int face, struct vec3 p,
                                  struct vec3 ray, double away)
{
    const struct flat_face *f = &d->solids[1]->faces[face];
    const struct texture_face *t = texture_map_find(&d->map, f->id, p);
    const struct texture_rule itself = {
        .kind = TEXTURE_EDGE, .from = f->id, .matrix = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    const int count = t && vec3_dot(t->normal, f->normal) > 0.999 ? t->rule_count : 0;
    for (int i = 0; i <= count; i++) {
        const struct texture_rule *r = i < count ? &t->rules[i] : &itself;
        struct vec3 place;
        if (r->limited && !texture_rule_holds(r, f->normal, p)) continue;
        if (r->kind == TEXTURE_OUTDOORS) return outdoors(d, placer, own, ray);
        if (r->kind == TEXTURE_COLOUR)
            return (struct draft_pixel){DRAFT_COLOUR, 0, {r->albedo[0], r->albedo[1], r->albedo[2]}};
        const struct vec3 wanted = texture_rule_place(r, p);
        const int from = nearest_of(d->solids[0], r->from, wanted, &place);
        if (from < 0 || (r->kind == TEXTURE_PLACE && vec3_length(vec3_sub(place, wanted)) > NEAR * d->size)) continue;
        return best_photo(d, placer, own, place, from, ray, away);
    }
    return (struct draft_pixel){.kind = DRAFT_UNSEEN};
}

struct draft_pixel draft_pixel_of(const struct draft *d, const struct placer *placer, int photo, double u, double v)
{
    const struct draft_pixel own = {DRAFT_PIXEL, photo, {u, v}};
    const struct photo_camera *c = &placer->photos[photo].camera;
    struct draft_pixel placed;
    struct vec3 ray;
    double was, is, wall;
    if (!photo_camera_ray(c, u, v, &ray)) return own;
    const struct draft_thing *thing = draft_things_at(&d->things, photo, c, u, v);
    const int before = meet(d->solids[0], c->center, ray, true, HUGE_VAL, &was);
    const int after = meet(d->solids[1], c->center, ray, true, HUGE_VAL, &is);
    const int face = meet(d->solids[1], c->center, ray, false, HUGE_VAL, &wall);
    const bool stays = thing && !thing->is_gone;
    const double front = stays ? draft_things_distance(thing, c->center, ray) : HUGE_VAL;
    if (draft_things_meet(&d->things, placer, c->center, ray, fmin(front, wall), &placed)) return placed;
    const bool same = before < 0 || after < 0
                          ? before == after
                          : fabs(is - was) < NEAR * d->size &&
                                texture_map_keeps(&d->map, d->solids[1]->faces[after].id,
                                                  vec3_add(c->center, vec3_scale(ray, is)), 10 * NEAR * d->size);
    if (same && !(thing && thing->is_gone)) return own;
    if (stays && is > vec3_length(vec3_sub(thing->middle, c->center)) - thing->radius) return own;
    return face < 0 ? outdoors(d, placer, photo, ray)
                    : surface(d, placer, photo, face, vec3_add(c->center, vec3_scale(ray, wall)), ray, wall);
}

bool draft_other_pixel(const struct draft *d, const struct placer *placer, int photo, double u, double v, int other,
                       double at[2])
{
    const struct photo_camera *c = &placer->photos[photo].camera;
    struct vec3 ray;
    double away;
    if (!photo_camera_ray(c, u, v, &ray) || draft_things_at(&d->things, photo, c, u, v)) return false;
    const int face = meet(d->solids[0], c->center, ray, false, HUGE_VAL, &away);
    const struct vec3 place = vec3_add(c->center, vec3_scale(ray, away));
    return face >= 0 && misfit(d, placer, photo, other, place, face, ray, away, at) >= 0 &&
           is_clear(d, placer->photos[other].camera.center, place);
}

/* ------------------------------------------------------------------------------------------------------ beginning */

enum status draft_begin(struct draft *d, struct building *after, const char *scene, struct err *err)
{
    for (int k = 0; k < 2; k++) {
        solid_free(d->solids[k]);
        d->solids[k] = NULL;
    }
    texture_map_release(&d->map);
    d->map = (struct texture_map){0};
    if (solid_mesh_carry_ids(&after->mesh, &d->before.mesh, err)) return err->status;
    if (after->plan.unedited && texture_rules_make(&d->map, &after->mesh, &d->before.mesh, &after->plan, err))
        return err->status;
    d->size = 0;
    for (int i = 0; i < d->before.mesh.vertex_count; i++)
        d->size = fmax(d->size, vec3_length(vec3_sub(d->before.mesh.vertices[i].p, d->before.mesh.vertices[0].p)));
    d->solids[0] = solid_of(&d->before.mesh, err);
    if (!err->status) d->solids[1] = solid_of(&after->mesh, err);
    for (int i = 0; !err->status && i < d->things.thing_count; i++) {
        struct draft_thing *t = &d->things.things[i];
        if (meet(d->solids[0], t->middle, vec3_make(0, 0, -1), true, HUGE_VAL, &t->above) < 0) t->above = t->middle.z;
    }
    if (!err->status) draft_things_begin(&d->things, &d->map, &after->plan, scene, err);
    return err->status;
}

bool draft_is_begun(const struct draft *d) { return d->solids[0] && d->solids[1]; }

void draft_end(struct draft *d)
{
    for (int k = 0; k < 2; k++) {
        solid_free(d->solids[k]);
        d->solids[k] = NULL;
    }
    draft_things_end(&d->things);
    texture_map_release(&d->map);
    building_release(&d->before);
    d->map = (struct texture_map){0};
}

void draft_release(struct draft *d)
{
    draft_end(d);
    draft_things_release(&d->things);
    *d = (struct draft){0};
}
