/* texture_rules.c - which place of the unedited model each face of an edited model shows [Colburn 2014, 4.5.4].
 *
 * A face whose id is known goes with its wall, opening or box: along it by how far that was moved, and across it from
 * plane to plane. So texture of walls, floors and ceilings that change size stays in place, and a wall that moves
 * carries it along. Beyond what is baked it repeats its nearest texels.
 *
 * A face with a new id that lies in the plane of faces of the unedited model (a wall that was split, a pier left of a
 * wall that was removed) shows those at the same place, else the nearest texels of the closest of them, if it is near.
 * Other new faces get the default colour, under the light of the faces next to them. Panes show what lies outdoors.
 * What a script's statements say of textures comes before all this (texture_wishes.c), and then the frames of openings
 * that move along their walls (texture_frames.c).
 *
 * The new area of a face is what its polygon has beyond the polygons of its id in the unedited model, moved like it. */
#include "stages/build_model/texture/texture_rules.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "stages/build_model/plan/room_parts.h"
#include "stages/build_model/texture/texture_frames.h"
#include "stages/build_model/texture/texture_wishes.h"

static const float default_albedo[3] = {0.75F, 0.75F, 0.75F}; /* white paint */

static const double near_gap = 0.6; /* model units: farther coplanar faces are not the same surface */

/* ----------------------------------------------------------------------------------------------------------- places */

static struct vec3 wall_shift(const struct plan_wall *before, const struct plan_wall *now)
{
    const double by = now->c - before->c;
    return vec3_make(by * now->d[1], -by * now->d[0], 0);
}

static bool same_size(const double a[2], const double b[2]) { return fabs((a[1] - a[0]) - (b[1] - b[0])) < 1e-9; }

static struct vec3 opening_shift(const struct plan *places, const struct plan *plan, int i)
{
    const struct plan_opening *before = &places->openings[i], *now = &plan->openings[i];
    const struct plan_wall *wall = &plan->walls[now->wall];
    struct vec3 shift = vec3_make(0, 0, 0);
    if (now->wall < places->wall_count) shift = wall_shift(&places->walls[now->wall], wall);
    if (same_size(before->s, now->s)) {
        const double along = wall->sign * (now->s[0] - before->s[0]);
        shift.x += along * wall->d[0];
        shift.y += along * wall->d[1];
    }
    if (same_size(before->z, now->z)) shift.z += now->z[0] - before->z[0];
    return shift;
}

static struct vec3 box_shift(const struct plan_box *before, const struct plan_box *now)
{
    double by[3];
    for (int k = 0; k < 3; k++) {
        const double a[2] = {before->low[k], before->high[k]}, b[2] = {now->low[k], now->high[k]};
        by[k] = same_size(a, b) ? b[0] - a[0] : 0;
    }
    return vec3_make(by[0], by[1], by[2]);
}

static struct vec3 slot_shift(const struct plan_slot *before, const struct plan_slot *now)
{
    const bool same = fabs((now->high[0] - now->low[0]) - (before->high[0] - before->low[0])) < 1e-9 &&
                      fabs((now->high[1] - now->low[1]) - (before->high[1] - before->low[1])) < 1e-9;
    return same ? vec3_make(now->low[0] - before->low[0], now->low[1] - before->low[1], 0) : vec3_make(0, 0, 0);
}

/* How far the edit moved the item that a face belongs to. */
static struct vec3 item_shift(const char *face, const struct plan *before, const struct plan *plan)
{
    for (int i = 0; i < before->wall_count; i++)
        if (!strncmp(face, "wall/", 5) && texture_face_is_of(face, plan->walls[i].name))
            return wall_shift(&before->walls[i], &plan->walls[i]);
    for (int i = 0; i < before->opening_count; i++)
        if (texture_face_is_of(face, plan->openings[i].name)) return opening_shift(before, plan, i);
    for (int i = 0; i < before->slot_count; i++)
        if (texture_face_is_of(face, plan->slots[i].name)) return slot_shift(&before->slots[i], &plan->slots[i]);
    for (int i = 0; i < before->box_count; i++)
        if (texture_face_is_of(face, plan->boxes[i].name)) return box_shift(&before->boxes[i], &plan->boxes[i]);
    return vec3_make(0, 0, 0);
}

/* ------------------------------------------------------------------------------------------------------------ rules */

struct rules_job {
    struct texture_models models;
    struct solid_triangles triangles[2]; /* of the edited and the unedited model */
    struct err *err;
};

static struct texture_rule shifted(enum texture_rule_kind kind, int from, struct vec3 by)
{
    return (struct texture_rule){
        .kind = kind,
        .from = from,
        .matrix = {{1, 0, 0, by.x + 0.0}, {0, 1, 0, by.y + 0.0}, {0, 0, 1, by.z + 0.0}}}; /* -0 is 0 */
}

/* The face's own place: the face of the base with its id whose plane, moved along with the item, is nearest; -1: the
 * base has no face of the id in a parallel plane. *by: from the edited model to the base. */
static int own_place(const struct rules_job *job, int face, struct vec3 *by)
{
    const struct solid_face *f = &job->models.edited->faces[face];
    const int id = solid_face_id(job->models.edited, face);
    const struct vec3 moved =
        item_shift(solid_face_name(job->models.edited, face), job->models.before, job->models.plan);
    const double was = f->offset - vec3_dot(f->normal, moved);
    int best = -1;
    for (int i = 0; i < job->models.base->face_count; i++) {
        if (solid_face_id(job->models.base, i) != id || !texture_faces_are_parallel(f, &job->models.base->faces[i]))
            continue;
        if (best < 0 ||
            fabs(job->models.base->faces[i].offset - was) < fabs(job->models.base->faces[best].offset - was))
            best = i;
    }
    if (best < 0) return -1;
    const double across = job->models.base->faces[best].offset - was;
    *by = vec3_sub(vec3_scale(f->normal, fabs(across) <= SAME_PLANE ? 0 : across), moved);
    return best;
}

struct bounds {
    struct vec3 low, high;
};

static struct bounds face_bounds(const struct solid_mesh *mesh, const struct solid_triangles *t, int face)
{
    struct bounds b = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (int i = t->first[face]; i < t->first[face + 1]; i++)
        for (int k = 0; k < 3; k++) {
            const struct vec3 p = mesh->vertices[t->triangles[i].v[k]].p;
            b.low = vec3_make(fmin(b.low.x, p.x), fmin(b.low.y, p.y), fmin(b.low.z, p.z));
            b.high = vec3_make(fmax(b.high.x, p.x), fmax(b.high.y, p.y), fmax(b.high.z, p.z));
        }
    return b;
}

static double gap_between(struct bounds a, struct bounds b)
{
    const double x = fmax(0, fmax(a.low.x - b.high.x, b.low.x - a.high.x));
    const double y = fmax(0, fmax(a.low.y - b.high.y, b.low.y - a.high.y));
    const double z = fmax(0, fmax(a.low.z - b.high.z, b.low.z - a.high.z));
    return sqrt(x * x + y * y + z * z);
}

static bool has_place(const struct texture_face *face, int from)
{
    for (int i = 0; i < face->rule_count; i++)
        if (face->rules[i].from == from) return true;
    return false;
}

/* Places of a new face among the faces of the base in its plane. *edge: the closest face near it, whose texels are
 * repeated; 0: none. */
static enum status add_coplanar(const struct rules_job *job, struct texture_face *to, int face, int *edge)
{
    const struct bounds own = face_bounds(job->models.edited, &job->triangles[0], face);
    double least = near_gap;
    *edge = 0;
    for (int i = 0; !job->err->status && i < job->models.base->face_count; i++) {
        if (!texture_faces_are_coplanar(&job->models.edited->faces[face], &job->models.base->faces[i]) ||
            solid_face_is_pane(job->models.base, i))
            continue;
        const double gap = gap_between(own, face_bounds(job->models.base, &job->triangles[1], i));
        const int id = solid_face_id(job->models.base, i);
        if (gap <= SAME_PLANE && !has_place(to, id))
            texture_face_add(to, shifted(TEXTURE_PLACE, id, vec3_make(0, 0, 0)), job->err);
        if (gap < least) {
            least = gap;
            *edge = id;
        }
    }
    return job->err->status;
}

static int compare_ints(const void *a, const void *b)
{
    const int x = *(const int *)a, y = *(const int *)b;
    return x < y ? -1 : x > y;
}

/* The faces of the base that show the light of a face: itself, or else those across its edges. */
static enum status find_lit(int **lit, int *count, const struct rules_job *job, int face, bool own)
{
    const struct solid_mesh *m = job->models.edited;
    const struct solid_face *f = &m->faces[face];
    int kept = 0;
    for (int l = f->loop; !job->err->status && l < f->loop + f->loops; l++) {
        int h = m->loops[l].half_edge;
        do {
            const int other = own ? face : m->loops[m->half_edges[m->half_edges[h].twin].loop].face;
            struct vec3 by;
            if (!solid_face_is_pane(m, other) && own_place(job, other, &by) >= 0) {
                if (!array_append(lit, (size_t)*count, sizeof **lit, "faces", job->err))
                    (*lit)[(*count)++] = solid_face_id(m, other);
            }
            h = m->half_edges[h].next;
        } while (!job->err->status && h != m->loops[l].half_edge);
    }
    if (*count) qsort(*lit, (size_t)*count, sizeof **lit, compare_ints);
    for (int i = 0; i < *count; i++)
        if (!kept || (*lit)[kept - 1] != (*lit)[i]) (*lit)[kept++] = (*lit)[i];
    *count = kept;
    return job->err->status;
}

/* The default colour. The rule takes the list. */
static enum status add_colour(const struct rules_job *job, struct texture_face *to, int **lit, int count)
{
    const double *colour = job->models.plan->colour;
    struct texture_rule rule = {.kind = TEXTURE_COLOUR, .lit = *lit, .lit_count = count};
    for (int c = 0; c < 3; c++) rule.albedo[c] = colour[c] < 0 ? default_albedo[c] : (float)colour[c];
    if (!texture_face_add(to, rule, job->err)) *lit = NULL;
    return job->err->status;
}

/* The rules that no statement asks for. */
static enum status add_defaults(const struct rules_job *job, struct texture_face *to, int face, bool own,
                                struct vec3 by, int **lit, int lit_count)
{
    const int id = solid_face_id(job->models.edited, face);
    int edge = 0;
    if (solid_face_is_pane(job->models.edited, face))
        return texture_face_add(to, (struct texture_rule){.kind = TEXTURE_OUTDOORS}, job->err);
    if (own)
        return texture_face_add(to, shifted(TEXTURE_PLACE, id, by), job->err) ||
                       texture_face_add(to, shifted(TEXTURE_EDGE, id, by), job->err)
                   ? job->err->status
                   : ST_OK;
    if (add_coplanar(job, to, face, &edge)) return job->err->status;
    if (!edge) return add_colour(job, to, lit, lit_count);
    return texture_face_add(to, shifted(TEXTURE_EDGE, edge, vec3_make(0, 0, 0)), job->err);
}

static enum status add_rules(const struct rules_job *job, struct texture_face *to, int face, bool *own, struct vec3 *by)
{
    const int place = own_place(job, face, by);
    int *lit = NULL, lit_count = 0;
    bool covered = false;
    *own = place >= 0;
    if (!find_lit(&lit, &lit_count, job, face, *own) &&
        !texture_wishes_add(to, &covered, &job->models, face, place, *by, lit, lit_count, job->err) && !covered &&
        (!*own || !texture_frames_add(to, &job->models, face, place, *by, job->err)))
        add_defaults(job, to, face, *own, *by, &lit, lit_count);
    texture_wishes_gloss(to, &job->models, face);
    free(lit);
    return job->err->status;
}

/* --------------------------------------------------------------------------------------------------------- new area */

/* A triangle as a polygon of the plane; false: it has no area. */
static bool flat_triangle(struct part_corner c[3], const struct plane_axes *axes, const struct solid_mesh *mesh,
                          const struct solid_triangle *t, struct vec3 by)
{
    for (int k = 0; k < 3; k++) {
        const struct vec3 p = vec3_add(mesh->vertices[t->v[k]].p, by);
        c[k] = (struct part_corner){.p = {vec3_dot(axes->u, p), vec3_dot(axes->v, p)}};
    }
    const double *a = c[0].p, *b = c[1].p, *d = c[2].p;
    if ((b[0] - a[0]) * (d[1] - a[1]) - (b[1] - a[1]) * (d[0] - a[0]) < 1e-12) return false;
    for (int k = 0; k < 3; k++) {
        const double *from = c[(k + 2) % 3].p, *to = c[k].p;
        const double x = to[0] - from[0], y = to[1] - from[1], length = hypot(x, y);
        c[k].line = (struct plan_line){{y / length, -x / length}, (y * to[0] - x * to[1]) / length};
    }
    return true;
}

struct added {
    struct texture_face *to;
    const struct plane_axes *axes;
    struct err *err;
};

static enum status add_area(void *ctx, const struct part_corner *c, int count)
{
    struct added *a = ctx;
    for (int i = 1; !a->err->status && i + 1 < count; i++) {
        const double *p[3] = {c[0].p, c[i].p, c[i + 1].p};
        if (fabs((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0])) < 1e-8)
            continue;
        if (array_append(&a->to->added, (size_t)a->to->added_count, sizeof *a->to->added, "triangles", a->err)) break;
        for (int k = 0; k < 3; k++) a->to->added[a->to->added_count][k] = plane_axes_point(a->axes, p[k][0], p[k][1]);
        a->to->added_count++;
    }
    return a->err->status;
}

/* The triangles of the base with the face's id in its plane, moved along with it. The caller frees both arrays. */
static enum status base_parts(struct room_part **parts, struct part_corner **corners, int *count,
                              const struct rules_job *job, int face, const struct plane_axes *axes, struct vec3 by)
{
    const struct solid_triangles *t = &job->triangles[1];
    const struct solid_face *f = &job->models.edited->faces[face];
    const size_t most = (size_t)t->count + 1;
    *parts = malloc(most * sizeof **parts);
    *corners = malloc(3 * most * sizeof **corners);
    *count = 0;
    if (!*parts || !*corners) return err_nomem(job->err, "triangles", 3 * most * sizeof **corners);
    for (int i = 0; i < job->models.base->face_count; i++) {
        const struct solid_face *b = &job->models.base->faces[i];
        if (solid_face_id(job->models.base, i) != solid_face_id(job->models.edited, face) ||
            !texture_faces_are_parallel(f, b))
            continue;
        if (fabs(b->offset - f->offset - vec3_dot(f->normal, by)) > SAME_PLANE) continue;
        for (int k = t->first[i]; k < t->first[i + 1]; k++) {
            struct part_corner *c = *corners + 3 * *count;
            if (!flat_triangle(c, axes, job->models.base, &t->triangles[k], vec3_scale(by, -1))) continue;
            (*parts)[(*count)++] = (struct room_part){c, 3};
        }
    }
    return ST_OK;
}

static enum status add_new_area(const struct rules_job *job, struct texture_face *to, int face, bool own,
                                struct vec3 by)
{
    const struct plane_axes axes = plane_axes_of(&job->models.edited->faces[face]);
    const struct solid_triangles *t = &job->triangles[0];
    struct added added = {to, &axes, job->err};
    struct room_part *parts = NULL;
    struct part_corner *corners = NULL, c[3];
    int count = 0;
    if (own) base_parts(&parts, &corners, &count, job, face, &axes, by);
    for (int i = t->first[face]; !job->err->status && i < t->first[face + 1]; i++) {
        if (!flat_triangle(c, &axes, job->models.edited, &t->triangles[i], vec3_make(0, 0, 0))) continue;
        parts_outside(c, 3, parts, count, add_area, &added, job->err);
    }
    free(parts);
    free(corners);
    return job->err->status;
}

/* ------------------------------------------------------------------------------------------------------------ faces */

static enum status add_face(struct texture_map *map, const struct rules_job *job, int face)
{
    const struct solid_face *f = &job->models.edited->faces[face];
    struct vec3 by = {0, 0, 0};
    bool own;
    if (array_append(&map->faces, (size_t)map->face_count, sizeof *map->faces, "faces", job->err))
        return job->err->status;
    struct texture_face *to = &map->faces[map->face_count++];
    *to =
        (struct texture_face){.id = solid_face_id(job->models.edited, face), .normal = f->normal, .offset = f->offset};
    to->name = strdup(solid_face_name(job->models.edited, face));
    if (!to->name) return err_nomem(job->err, "a name", strlen(solid_face_name(job->models.edited, face)));
    return add_rules(job, to, face, &own, &by) || add_new_area(job, to, face, own, by) ? job->err->status : ST_OK;
}

/* Faces of one id in one plane have one entry: the first of them has the rules, and the area of all. */
static bool is_listed(const struct texture_map *map, const struct solid_mesh *mesh, int face, int *at)
{
    const struct solid_face *f = &mesh->faces[face];
    for (*at = map->face_count - 1; *at >= 0; --*at) {
        const struct texture_face *t = &map->faces[*at];
        const struct solid_face plane = {.normal = t->normal, .offset = t->offset};
        if (t->id == solid_face_id(mesh, face) && texture_faces_are_coplanar(&plane, f)) return true;
    }
    return false;
}

static int compare_texture_faces(const void *a, const void *b)
{
    const struct texture_face *p = a, *q = b;
    if (p->id != q->id) return p->id < q->id ? -1 : 1;
    if (p->offset != q->offset) return p->offset < q->offset ? -1 : 1;
    const double n[3] = {p->normal.x - q->normal.x, p->normal.y - q->normal.y, p->normal.z - q->normal.z};
    for (int k = 0; k < 3; k++)
        if (n[k] != 0) return n[k] < 0 ? -1 : 1;
    return 0;
}

enum status texture_rules_make(struct texture_map *map, const struct solid_mesh *edited, const struct solid_mesh *base,
                               const struct plan *plan, struct err *err)
{
    struct rules_job job = {.models = {edited, base, plan->unedited, plan}, .err = err};
    if (!texture_wishes_check(&job.models, err) && plan->base && !(map->base = strdup(plan->base)))
        err_nomem(err, "a name", strlen(plan->base) + 1);
    if (!err->status && !solid_mesh_triangulate(&job.triangles[0], edited, err))
        solid_mesh_triangulate(&job.triangles[1], base, err);
    for (int f = 0; !err->status && f < edited->face_count; f++) {
        struct vec3 by;
        int at;
        if (!is_listed(map, edited, f, &at))
            add_face(map, &job, f);
        else
            add_new_area(&job, &map->faces[at], f, own_place(&job, f, &by) >= 0, by);
    }
    if (!err->status && !texture_zones_add(map, plan, err) && !texture_things_add(map, plan, err))
        texture_lamps_add(map, plan, err);
    if (map->face_count) qsort(map->faces, (size_t)map->face_count, sizeof *map->faces, compare_texture_faces);
    for (int k = 0; k < 2; k++) solid_triangles_release(&job.triangles[k]);
    return err->status;
}
