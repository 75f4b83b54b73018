/* sequence_textures.h - where the faces of an edited model take their texture; for sequences.c. */
#ifndef REMODEL_TESTS_SEQUENCE_TEXTURES_H
#define REMODEL_TESTS_SEQUENCE_TEXTURES_H

#include "tests/unit/build_model/script_textures.h"
#include "tests/unit/build_model/sequence_identity.h"

static const double map_plane = 1e-4; /* positions in one plane */

/* ---------------------------------------------------------------------------------------------------------- reading */

static inline bool same_point(struct vec3 a, struct vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

static inline bool same_rule(const struct texture_rule *a, const struct texture_rule *b)
{
    bool same = a->kind == b->kind && a->from == b->from && a->lit_count == b->lit_count && a->limited == b->limited;
    for (int i = 0; same && i < 12; i++) same = a->matrix[i / 4][i % 4] == b->matrix[i / 4][i % 4];
    for (int i = 0; same && i < 3; i++) same = a->albedo[i] == b->albedo[i];
    for (int i = 0; same && i < a->lit_count; i++) same = a->lit[i] == b->lit[i];
    for (int i = 0; same && a->limited && i < 4; i++) same = same_point(a->within[i], b->within[i]);
    return same;
}

static inline bool same_texture_face(const struct texture_face *a, const struct texture_face *b)
{
    bool same = a->id == b->id && !strcmp(a->name, b->name) && same_point(a->normal, b->normal) &&
                a->offset == b->offset && a->rule_count == b->rule_count && a->added_count == b->added_count &&
                a->has_gloss == b->has_gloss && a->gloss.kind == b->gloss.kind && a->gloss.ks == b->gloss.ks &&
                a->gloss.shape == b->gloss.shape;
    for (int i = 0; same && i < a->rule_count; i++) same = same_rule(&a->rules[i], &b->rules[i]);
    for (int i = 0; same && i < a->added_count; i++)
        for (int k = 0; k < 3; k++) same &= same_point(a->added[i][k], b->added[i][k]);
    return same;
}

static inline bool same_zone(const struct texture_zone *a, const struct texture_zone *b)
{
    bool same = !strcmp(a->name, b->name) && a->keep == b->keep && a->low == b->low && a->high == b->high &&
                a->corner_count == b->corner_count;
    for (int i = 0; same && i < a->corner_count; i++)
        same = a->corners[i][0] == b->corners[i][0] && a->corners[i][1] == b->corners[i][1];
    return same;
}

/* The bases are not compared. */
static inline bool same_map(const struct texture_map *a, const struct texture_map *b)
{
    bool same = a->face_count == b->face_count && a->zone_count == b->zone_count;
    for (int i = 0; same && i < a->face_count; i++) same = same_texture_face(&a->faces[i], &b->faces[i]);
    for (int i = 0; same && i < a->zone_count; i++) same = same_zone(&a->zones[i], &b->zones[i]);
    same = same && a->lamp_count == b->lamp_count;
    for (int i = 0; same && i < a->lamp_count; i++) {
        const double *scale = texture_map_lamp(b, a->lamps[i].name);
        same = scale && !memcmp(scale, a->lamps[i].scale, sizeof a->lamps[i].scale);
    }
    return same;
}

static inline void check_map_file(const struct texture_map *map, const char *text, const char *edit)
{
    struct texture_map read = {0};
    struct err err = ERR_INIT;
    const char *path = scratch_path("texture.txt");
    if (texture_map_write(map, path, NULL, &err) || texture_map_read(&read, path, NULL, &err) ||
        !same_map(map, &read)) {
        explain(text, edit);
        fail_msg("texture.txt does not read back: %s", err.text);
    }
    texture_map_release(&read);
}

/* --------------------------------------------------------------------------------------------------------- coverage */

static inline bool is_in_plane_of(const struct solid_mesh *mesh, int id, struct vec3 p)
{
    for (int i = 0; i < mesh->face_count; i++)
        if (solid_face_id(mesh, i) == id &&
            fabs(vec3_dot(mesh->faces[i].normal, p) - mesh->faces[i].offset) < map_plane)
            return true;
    return false;
}

static inline bool has_id(const struct solid_mesh *mesh, int id)
{
    bool found = false;
    for (int i = 0; i < mesh->name_count && !found; i++) found = mesh->names[i].id == id;
    return found;
}

/* The rules of a point of a face: the last one covers every point, places lie in a plane of the face that they name. */
static inline const char *rules_error(const struct texture_face *face, const struct solid_mesh *base, struct vec3 p)
{
    if (!face->rule_count) return "it has no rule";
    const struct texture_rule *last = &face->rules[face->rule_count - 1];
    if (last->limited || last->kind == TEXTURE_PLACE) return "its last rule does not cover all of it";
    for (int i = 0; i < face->rule_count; i++) {
        const struct texture_rule *r = &face->rules[i];
        for (int k = 0; k < r->lit_count; k++)
            if (!has_id(base, r->lit[k])) return "the light is that of a face that the base does not have";
        if (r->kind != TEXTURE_PLACE && r->kind != TEXTURE_EDGE) continue;
        if (texture_rule_holds(r, face->normal, p) && !is_in_plane_of(base, r->from, texture_rule_place(r, p)))
            return "a place is in no plane of the face that it names";
    }
    return NULL;
}

/* The entry of a face's id and plane. texture_map_find() is for points that are not on the edge of two planes. */
static inline const struct texture_face *entry_of(const struct texture_map *map, int id, const struct solid_face *f)
{
    for (int i = 0; i < map->face_count; i++)
        if (map->faces[i].id == id && vec3_dot(map->faces[i].normal, f->normal) > 1 - 1e-6 &&
            fabs(map->faces[i].offset - f->offset) < map_plane)
            return &map->faces[i];
    return NULL;
}

static inline void check_coverage(const struct model *m, const struct model *base, const char *text, const char *edit)
{
    struct solid_triangles t = {0};
    struct err err = ERR_INIT;
    assert_ok(solid_mesh_triangulate(&t, &m->mesh, &err), err);
    for (int i = 0; i < t.count; i++) {
        const struct solid_face *f = &m->mesh.faces[t.triangles[i].face];
        struct vec3 p = {0, 0, 0};
        for (int k = 0; k < 3; k++) p = vec3_add(p, vec3_scale(m->mesh.vertices[t.triangles[i].v[k]].p, 1.0 / 3));
        const struct texture_face *face = entry_of(&m->map, solid_face_id(&m->mesh, t.triangles[i].face), f);
        const char *error = face ? rules_error(face, &base->mesh, p) : "it is not listed";
        if (!error) continue;
        explain(text, edit);
        fail_msg("%s at %g %g %g: %s", solid_face_name(&m->mesh, t.triangles[i].face), p.x, p.y, p.z, error);
    }
    solid_triangles_release(&t);
}

/* ----------------------------------------------------------------------------------------------------------- points */

static inline const struct texture_rule *rule_at(const struct texture_face *face, struct vec3 p)
{
    int i = 0;
    while (!texture_rule_holds(&face->rules[i], face->normal, p)) i++;
    return &face->rules[i];
}

/* 1: p is in an added triangle, 0: it is not, -1: it is near the edge of one. */
static inline int is_new(const struct texture_face *face, struct vec3 p)
{
    int found = 0;
    for (int i = 0; i < face->added_count; i++) {
        const struct vec3 *t = face->added[i];
        double least = HUGE_VAL;
        for (int k = 0; k < 3; k++) {
            const struct vec3 edge = vec3_normalize(vec3_sub(t[(k + 1) % 3], t[k]));
            least = fmin(least, vec3_dot(vec3_cross(edge, vec3_sub(p, t[k])), face->normal));
        }
        if (least > 1e-4) return 1;
        if (least > -1e-4) found = -1;
    }
    return found;
}

static inline bool was_there(const struct solid_mesh *base, int id, const struct hit *old, int count, double t)
{
    for (int i = 0; i < count; i++)
        if (fabs(old[i].t - t) < 1e-4 && has_id(base, id) && id_of(base, old[i].name) == id) return true;
    return false;
}

/* Whether a point of a wall is in the frame of an opening that moved along it, or where it was: an eighth of the
 * shorter side around it. */
static inline bool is_frame_moved(const struct model *m, const char *face, struct vec3 p)
{
    const struct plan *now = &m->plan, *before = m->plan.unedited;
    for (int i = 0; before && i < before->opening_count; i++) {
        const struct plan_opening *o[2] = {&before->openings[i], &now->openings[i]};
        const struct plan_wall *wall = &now->walls[o[1]->wall];
        const double s = wall->sign * (wall->d[0] * p.x + wall->d[1] * p.y) - wall->origin;
        const size_t length = strlen(wall->name);
        if (strncmp(face, "wall/", 5) || strncmp(face + 5, wall->name, length) || face[5 + length] != '/') continue;
        if (fabs(o[0]->s[0] - o[1]->s[0]) < 1e-9 && fabs(o[0]->z[0] - o[1]->z[0]) < 1e-9) continue;
        const double band = fmin(o[1]->s[1] - o[1]->s[0], o[1]->z[1] - o[1]->z[0]) / 8 + 1e-6;
        for (int k = 0; k < 2; k++)
            if (s > o[k]->s[0] - band && s < o[k]->s[1] + band && p.z > o[k]->z[0] - band && p.z < o[k]->z[1] + band)
                return true;
    }
    return false;
}

/* What is wrong with what a point of an edited model shows; NULL: nothing. */
static inline const char *shown_error(const struct model *base, const struct model *m, const struct expected *expected,
                                      const struct touched *touched, const struct hit *hit, struct vec3 p,
                                      const struct hit *old, int old_count)
{
    const char *name = solid_face_name(&m->mesh, hit->face);
    const int id = solid_face_id(&m->mesh, hit->face);
    const struct texture_face *face = texture_map_find(&m->map, id, p);
    const struct texture_rule *rule = rule_at(face, p);
    const struct expected_shown shown = expected_shown_at(expected, &m->mesh, &base->mesh, hit->face, p);
    const int new_here = is_new(face, p);
    if (!has_id(&base->mesh, id) && !new_here) return "a point of a new face is not new area";
    if (shown.kind == SHOWN_COLOUR) {
        if (rule->kind != TEXTURE_COLOUR) return "it has not the colour that a statement gives it";
        for (int c = 0; c < 3; c++)
            if (fabs(rule->albedo[c] - shown.colour[c]) > 1e-6) return "its colour is not that of the statement";
    }
    if (shown.kind == SHOWN_PLACE) {
        if (rule->kind != TEXTURE_PLACE || rule->from != id_of(&base->mesh, shown.from)) return "it is not copied";
        if (vec3_length(vec3_sub(texture_rule_place(rule, p), shown.at)) > 1e-5) return "it is copied from elsewhere";
    }
    if (shown.kind != SHOWN_DEFAULT) return NULL;
    if (rule->kind == TEXTURE_COLOUR)
        for (int c = 0; c < 3; c++)
            if (fabs(rule->albedo[c] - expected->colour[c]) > 1e-6) return "its colour is not the common one";
    const bool pane = !strncmp(hit->body, "glass/", 6);
    if (pane != (rule->kind == TEXTURE_OUTDOORS)) return "outdoors are shown by panes alone";
    /* a sloping ceiling changes with its walls */
    const bool changed = is_among(touched->names, touched->count, name) ||
                         (!expected->exact && is_among(touched->beside, touched->beside_count, name));
    if (is_frame_moved(m, name, p)) return NULL;
    if (pane || changed || !was_there(&base->mesh, id, old, old_count, hit->t)) return NULL;
    if (rule->kind != TEXTURE_PLACE || rule->from != id) return "it does not show itself, but nothing changed it";
    if (vec3_length(vec3_sub(texture_rule_place(rule, p), p)) > 1e-5) return "it does not show its own place";
    return new_here == 1 ? "it was there before, but is new area" : NULL;
}

static inline void check_points(const struct model *base, const struct model *m, const struct expected *expected,
                                const struct touched *touched, const struct ray *rays, int ray_count, int *shown,
                                const char *text, const char *edit)
{
    static struct hit old[MAX_HITS], new[MAX_HITS];
    for (int r = 0; r < ray_count; r++) {
        const int old_count = hit_mesh(&base->mesh, &rays[r], old), count = hit_mesh(&m->mesh, &rays[r], new);
        for (int i = 0; i < count; i++, ++*shown) {
            const struct vec3 p = vec3_add(rays[r].o, vec3_scale(rays[r].d, new[i].t));
            const char *error = shown_error(base, m, expected, touched, &new[i], p, old, old_count);
            if (!error) continue;
            explain(text, edit);
            fail_msg("%s at %g %g %g: %s", new[i].name, p.x, p.y, p.z, error);
        }
    }
}

/* The last statement about a lamp, a face's gloss or an object counts. */
static inline const char *light_error(const struct model *m, const struct expected *expected)
{
    for (int i = 0; i < expected->lamp_count; i++) {
        const double *scale = texture_map_lamp(&m->map, expected->lamps[i].name);
        for (int c = 0; c < 3; c++)
            if ((scale ? scale[c] : 1) != expected->lamps[i].scale[c]) return "a lamp has another scale";
    }
    for (int i = 0; i < m->map.face_count; i++) {
        const struct texture_face *f = &m->map.faces[i];
        if ((f->has_gloss ? f->gloss.ks : -1) != expected_gloss(expected, f->name)) return "a face has another gloss";
    }
    if (m->plan.object_count != expected->object_count) return "the number of objects differs";
    for (int i = 0; i < expected->object_count; i++) {
        const struct plan_object *o = &m->plan.objects[i];
        if (strcmp(o->name, expected->objects[i].name) || o->removed != expected->objects[i].gone)
            return "an object is not there, or was not removed";
        if (!o->removed && o->placed.at[0] != expected->objects[i].x) return "an object is elsewhere";
    }
    return NULL;
}

static inline void check_light(const struct model *m, const struct expected *expected, const char *text,
                               const char *edit)
{
    const char *error = light_error(m, expected);
    if (!error) return;
    explain(text, edit);
    fail_msg("%s", error);
}

/* expected->exact must be true, and expected_shape() have been called. */
static inline void check_clearing(const struct model *m, const struct expected *expected, const char *text,
                                  const char *edit)
{
    for (int i = 0; i < 16; i++) {
        const double p[3] = {random_unit() * 10 - 2, random_unit() * 10 - 2, random_unit() * 4 - 1};
        const bool clears = texture_map_clears(&m->map, vec3_make(p[0], p[1], p[2]));
        if (clears == expected_clears(expected, p)) continue;
        explain(text, edit);
        fail_msg("clutter at %g %g %g is %s", p[0], p[1], p[2], clears ? "cleared" : "not cleared");
    }
}

static inline void check_textures(const struct model *base, const struct model *m, const struct expected *expected,
                                  const struct touched *touched, const struct ray *rays, int ray_count, int *shown,
                                  const char *text, const char *edit)
{
    check_map_file(&m->map, text, edit);
    check_coverage(m, base, text, edit);
    check_points(base, m, expected, touched, rays, ray_count, shown, text, edit);
    check_light(m, expected, text, edit);
    if (expected->exact) check_clearing(m, expected, text, edit);
}

#endif
