/* script_textures.h - what faces show and where clutter is cleared, from the statements that script_model.h interprets
 * (docs/model-script.md). */
#ifndef REMODEL_TESTS_SCRIPT_TEXTURES_H
#define REMODEL_TESTS_SCRIPT_TEXTURES_H

#include "tests/unit/build_model/script_volume.h"

#include "common/model/solid_mesh.h"

/* Whether a face is `name`, or a part of it. */
static inline bool expected_is_part(const char *face, const char *name)
{
    const size_t length = strlen(name);
    return !strncmp(face, name, length) && (!face[length] || face[length] == '/');
}

static inline bool expected_is_of_item(const char *face, const char *item)
{
    return expected_is_part(strchr(face, '/') + 1, item);
}

/* ---------------------------------------------------------------------------------------------------------- clutter */

/* Whether clutter at p is left out. t->exact must be true, and expected_shape() have been called. */
static inline bool expected_clears(const struct expected *t, const double p[3])
{
    bool clear = false;
    for (int i = 0; i < t->zone_count; i++) {
        const struct expected_zone *z = &t->zones[i];
        bool in = p[2] > z->low[2] && p[2] < z->high[2];
        if (z->all || z->room >= 0) {
            bool in_room = false;
            for (int r = 0; r < t->room_count; r++)
                if (!t->rooms[r].gone && (z->all || z->room == r))
                    in_room |= expected_in_outline(t, &t->rooms[r], t->rooms[r].face, p);
            in &= in_room;
        } else {
            for (int k = 0; k < 2; k++) in &= p[k] > z->low[k] && p[k] < z->high[k];
        }
        if (in && z->keep) return false;
        clear |= in;
    }
    return clear;
}

/* ----------------------------------------------------------------------------------------------------------- planes */

/* Seen from outside, u points to the right and v up; on floors and ceilings u is x. For planes along the axes. */
struct expected_flat {
    struct vec3 u, v, n;
    double offset;
};

static inline bool expected_flat_of(struct expected_flat *flat, const struct solid_face *f)
{
    const struct vec3 n = f->normal;
    if (fmax(fabs(n.x), fmax(fabs(n.y), fabs(n.z))) < 1) return false;
    flat->u = n.z != 0 ? vec3_make(1, 0, 0) : vec3_make(-n.y, n.x, 0);
    flat->v = n.z != 0 ? vec3_make(0, n.z, 0) : vec3_make(0, 0, 1);
    flat->n = n;
    flat->offset = f->offset;
    return true;
}

/* A rectangle of S and Z, or of X and Y, as u and v. */
static inline void expected_flat_rect(const struct expected_flat *f, const double rect[4], double u[2], double v[2])
{
    const double along = f->n.z != 0 ? 1 : f->n.x - f->n.y, up = f->n.z != 0 ? f->n.z : 1;
    u[0] = fmin(along * rect[0], along * rect[2]);
    u[1] = fmax(along * rect[0], along * rect[2]);
    v[0] = fmin(up * rect[1], up * rect[3]);
    v[1] = fmax(up * rect[1], up * rect[3]);
}

/* The bounding rectangle of all faces of an id in the plane. */
static inline void expected_surface_rect(const struct solid_mesh *mesh, int id, const struct expected_flat *f,
                                         double u[2], double v[2])
{
    u[0] = v[0] = HUGE_VAL;
    u[1] = v[1] = -HUGE_VAL;
    for (int i = 0; i < mesh->face_count; i++) {
        const struct solid_face *face = &mesh->faces[i];
        if (solid_face_id(mesh, i) != id || vec3_dot(face->normal, f->n) < 1 || fabs(face->offset - f->offset) > 2e-5)
            continue;
        const int first = mesh->loops[face->loop].half_edge;
        int h = first;
        do {
            const struct vec3 p = mesh->vertices[mesh->half_edges[h].origin].p;
            u[0] = fmin(u[0], vec3_dot(f->u, p));
            u[1] = fmax(u[1], vec3_dot(f->u, p));
            v[0] = fmin(v[0], vec3_dot(f->v, p));
            v[1] = fmax(v[1], vec3_dot(f->v, p));
            h = mesh->half_edges[h].next;
        } while (h != first);
    }
}

/* ------------------------------------------------------------------------------------------------------------ shown */

struct expected_shown {
    enum { SHOWN_UNKNOWN, SHOWN_DEFAULT, SHOWN_COLOUR, SHOWN_PLACE } kind;
    const double *colour;
    const char *from; /* the face of the base, and the point of it */
    struct vec3 at;
};

static inline int expected_face_called(const struct solid_mesh *mesh, const char *name)
{
    for (int i = 0; i < mesh->face_count; i++)
        if (!strcmp(solid_face_name(mesh, i), name)) return i;
    return -1;
}

/* What a copy shows at p, which is in the face's plane; false: p is outside of it. UNKNOWN: near the edge of a copy. */
static inline bool expected_copy_at(struct expected_shown *shown, const struct expected_wish *w,
                                    const struct solid_mesh *edited, const struct solid_mesh *base, int face,
                                    struct vec3 p)
{
    const double edge = 1e-4;
    const int from = expected_face_called(base, w->from);
    struct expected_flat a, b;
    double to[2][2], patch[2][2], at[2];
    shown->kind = SHOWN_UNKNOWN;
    if (w->unsure || !expected_flat_of(&a, &edited->faces[face]) || !expected_flat_of(&b, &base->faces[from]))
        return true;
    expected_flat_rect(&b, w->patch, patch[0], patch[1]);
    if (w->whole)
        expected_surface_rect(edited, solid_face_id(edited, face), &a, to[0], to[1]);
    else
        expected_flat_rect(&a, w->target, to[0], to[1]);
    const double q[2] = {vec3_dot(a.u, p), vec3_dot(a.v, p)};
    for (int k = 0; k < 2; k++)
        if (q[k] < to[k][0] - edge || q[k] > to[k][1] + edge) return false;
    for (int k = 0; k < 2; k++) {
        const double size = patch[k][1] - patch[k][0], in = fmod(q[k] - to[k][0], size);
        if (q[k] < to[k][0] + edge || q[k] > to[k][1] - edge || in < edge || in > size - edge) return true;
        at[k] = patch[k][0] + in;
    }
    *shown = (struct expected_shown){.kind = SHOWN_PLACE, .from = w->from};
    shown->at = vec3_add(vec3_scale(b.n, b.offset), vec3_add(vec3_scale(b.u, at[0]), vec3_scale(b.v, at[1])));
    return true;
}

/* What stretched texture shows at p; UNKNOWN: the base has no face of the id in a parallel plane, or several. */
static inline struct expected_shown expected_stretched(const struct solid_mesh *edited, const struct solid_mesh *base,
                                                       int face, struct vec3 p)
{
    const int id = solid_face_id(edited, face);
    struct expected_shown shown = {.kind = SHOWN_UNKNOWN, .from = solid_face_name(edited, face)};
    struct expected_flat a, b = {.offset = HUGE_VAL};
    double now[2][2], then[2][2], at[2];
    if (!expected_flat_of(&a, &edited->faces[face])) return shown;
    for (int i = 0; i < base->face_count; i++) {
        const struct solid_face *f = &base->faces[i];
        if (solid_face_id(base, i) != id || vec3_dot(f->normal, a.n) < 1) continue;
        if (b.offset < HUGE_VAL && fabs(b.offset - f->offset) > 2e-5) return shown;
        expected_flat_of(&b, f);
    }
    if (b.offset == HUGE_VAL) return shown;
    expected_surface_rect(edited, id, &a, now[0], now[1]);
    expected_surface_rect(base, id, &b, then[0], then[1]);
    const double q[2] = {vec3_dot(a.u, p), vec3_dot(a.v, p)};
    for (int k = 0; k < 2; k++)
        at[k] = then[k][0] + (q[k] - now[k][0]) / (now[k][1] - now[k][0]) * (then[k][1] - then[k][0]);
    shown.kind = SHOWN_PLACE;
    shown.at = vec3_add(vec3_scale(b.n, b.offset), vec3_add(vec3_scale(b.u, at[0]), vec3_scale(b.v, at[1])));
    return shown;
}

/* Whether p, which is in the face's plane, is in the place that is painted: 1 or 0; -1: near its edge, or unknown. */
static inline int expected_paints(const struct expected_wish *w, const struct solid_face *face, struct vec3 p)
{
    const double edge = 1e-4;
    struct expected_flat flat;
    double to[2][2];
    if (w->whole) return 1;
    if (w->unsure || !expected_flat_of(&flat, face)) return -1;
    expected_flat_rect(&flat, w->target, to[0], to[1]);
    const double q[2] = {vec3_dot(flat.u, p), vec3_dot(flat.v, p)};
    for (int k = 0; k < 2; k++)
        if (q[k] < to[k][0] - edge || q[k] > to[k][1] + edge) return 0;
    for (int k = 0; k < 2; k++)
        if (q[k] < to[k][0] + edge || q[k] > to[k][1] - edge) return -1;
    return 1;
}

/* What the statements say that the point p of a face of the edited model shows. DEFAULT: they say nothing; UNKNOWN: not
 * computed here. */
static inline struct expected_shown expected_shown_at(const struct expected *t, const struct solid_mesh *edited,
                                                      const struct solid_mesh *base, int face, struct vec3 p)
{
    const char *name = solid_face_name(edited, face);
    struct expected_shown shown = {.kind = SHOWN_DEFAULT};
    for (int i = t->wish_count - 1; i >= 0; i--) {
        const struct expected_wish *w = &t->wishes[i];
        if (w->kind == MODEL_COPY && !strcmp(w->face, name) && expected_copy_at(&shown, w, edited, base, face, p))
            return shown;
        if (w->kind == MODEL_COLOUR && (w->whole ? expected_is_part(name, w->face) : !strcmp(name, w->face))) {
            const int painted = expected_paints(w, &edited->faces[face], p);
            if (painted)
                return (struct expected_shown){painted < 0 ? SHOWN_UNKNOWN : SHOWN_COLOUR, .colour = w->colour};
        }
        if (w->kind == MODEL_STRETCH && expected_is_of_item(name, w->face))
            return expected_stretched(edited, base, face, p);
        if (w->kind == MODEL_CROP && expected_is_of_item(name, w->face))
            return (struct expected_shown){.kind = SHOWN_UNKNOWN};
        shown.kind = SHOWN_DEFAULT;
    }
    return shown;
}

/* The strength of a face's gloss; -1: no statement gives it one. */
static inline double expected_gloss(const struct expected *t, const char *face)
{
    double ks = -1;
    for (int i = 0; i < t->wish_count; i++)
        if (t->wishes[i].kind == MODEL_GLOSS && expected_is_part(face, t->wishes[i].face)) ks = t->wishes[i].ks;
    return ks;
}

#endif
