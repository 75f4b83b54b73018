/* geometry.c - described items as faces, cut into triangles.
 *
 * Each item of a described scene (wall, opening, box, room, disk, mesh) becomes faces with names and ids, and each
 * face triangles for the ray tracer. u and v of a face are lengths along its plane, u to the right for a viewer in
 * front of it, for textures.
 *
 * A wall's side with openings is cut along the lines of all their edges into a grid of rectangles; those whose
 * middle is inside an opening are left out. The grid has no T-junctions, so there are no cracks between its
 * triangles. With n openings there are O(n^2) rectangles; walls have few. Openings add reveals, except where those
 * would lie on the wall's own edge.
 *
 * Items are not united. Walls that overlap at corners stay as they are, since a ray meets the outer surface first.
 *
 * Ids. An edited scene keeps the ids of its base by name, and new faces get ids beyond those, so that pictures of
 * ids can be compared before and after an edit. */
#include "stages/simulate/geometry.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/sort.h"
#include "common/light/frame.h"
#include "common/light/value_noise.h"
#include "common/math/numbers.h"

struct builder {
    struct scene_geometry *g;
    const struct scene *scene;
    int item;
};

static uint32_t name_seed(const char *name)
{
    uint32_t seed = 0;
    while (*name) seed = noise_mix(seed + (unsigned char)*name++);
    return seed;
}

/* Adds a face without triangles. `side` NULL: it is named like its item. */
static enum status add_face(struct builder *b, const char *side, int material, struct vec3 origin, struct vec3 u,
                            struct vec3 v, struct err *err)
{
    struct scene_geometry *g = b->g;
    const char *item = b->scene->items[b->item].name;
    char *name = NULL;
    if (array_append(&g->faces, (size_t)g->face_count, sizeof *g->faces, "faces", err)) return err->status;
    if (asprintf(&name, side ? "%s.%s" : "%s", item, side) < 0) return err_nomem(err, "a face's name", strlen(item));
    g->faces[g->face_count] = (struct scene_face){
        .name = name,
        .id = (uint32_t)g->face_count + 1,
        .item = b->item,
        .material = material,
        .origin = origin,
        .u = vec3_normalize(u),
        .v = vec3_normalize(v),
        .normal = vec3_normalize(vec3_cross(u, v)),
        .seed = name_seed(name),
    };
    g->face_count++;
    return ST_OK;
}

/* Adds a triangle to the last face. */
static enum status add_triangle(struct builder *b, struct vec3 p, struct vec3 q, struct vec3 r, struct err *err)
{
    struct scene_geometry *g = b->g;
    const struct vec3 corner[3] = {p, q, r};
    const int face = g->face_count - 1;
    g->faces[face].area += vec3_length(vec3_cross(vec3_sub(q, p), vec3_sub(r, p))) / 2;
    ray_scene_add_triangle(&g->rays, corner, (uint32_t)face, err);
    if (!err->status && g->has_furniture && !b->scene->items[b->item].furniture)
        ray_scene_add_triangle(&g->bare, corner, (uint32_t)face, err);
    return err->status;
}

static enum status add_parallelogram(struct builder *b, struct vec3 p, struct vec3 u, struct vec3 v, struct err *err)
{
    const struct vec3 pu = vec3_add(p, u), pv = vec3_add(p, v), puv = vec3_add(pu, v);
    return add_triangle(b, p, pu, puv, err) || add_triangle(b, p, puv, pv, err) ? err->status : ST_OK;
}

static enum status add_quad(struct builder *b, const char *side, int material, struct vec3 p, struct vec3 u,
                            struct vec3 v, struct err *err)
{
    return add_face(b, side, material, p, u, v, err) || add_parallelogram(b, p, u, v, err) ? err->status : ST_OK;
}

void geometry_wall_axes(const struct scene_item *wall, struct vec3 *along, struct vec3 *left, double *length)
{
    const struct vec3 line = {wall->x1 - wall->x0, wall->y1 - wall->y0, 0};
    *length = vec3_length(line);
    *along = vec3_normalize(line);
    *left = vec3_make(-along->y, along->x, 0);
}

/* Sorts cuts, and removes duplicates and those outside [from, to]; returns how many remain. */
static int tidy_cuts(double *cuts, int count, double from, double to)
{
    int kept = 0;
    sort_doubles(cuts, (size_t)count);
    for (int i = 0; i < count; i++)
        if (cuts[i] >= from && cuts[i] <= to && (!kept || cuts[i] > cuts[kept - 1])) cuts[kept++] = cuts[i];
    return kept;
}

static bool is_opening_of(const struct scene_item *o, int wall)
{
    return (o->kind == ITEM_OPENING || o->kind == ITEM_WINDOW) && o->wall == wall;
}

/* The left (side 1) or right (-1) face of a wall, with holes at its openings. */
static enum status add_wall_side(struct builder *b, int side, struct err *err)
{
    const struct scene *s = b->scene;
    const struct scene_item *w = &s->items[b->item];
    struct vec3 along, left;
    double length;
    int openings = 0, s_count = 0, z_count = 0;
    for (int i = 0; i < s->item_count; i++) openings += is_opening_of(&s->items[i], b->item);
    double *cuts = malloc((size_t)(4 * openings + 4) * sizeof *cuts);
    if (!cuts) return err_nomem(err, "a wall's openings", (size_t)openings * 4 * sizeof *cuts);
    double *s_cuts = cuts, *z_cuts = cuts + 2 * openings + 2;

    geometry_wall_axes(w, &along, &left, &length);
    s_cuts[s_count++] = 0, s_cuts[s_count++] = length;
    z_cuts[z_count++] = w->z0, z_cuts[z_count++] = w->z1;
    for (int i = 0; i < s->item_count; i++) {
        const struct scene_item *o = &s->items[i];
        if (!is_opening_of(o, b->item)) continue;
        s_cuts[s_count++] = o->s0, s_cuts[s_count++] = fmin(o->s1, length);
        z_cuts[z_count++] = o->z0, z_cuts[z_count++] = o->z1;
    }
    s_count = tidy_cuts(s_cuts, s_count, 0, length);
    z_count = tidy_cuts(z_cuts, z_count, w->z0, w->z1);

    /* u points right as seen from outside, so on the left side it runs against the wall's direction */
    const struct vec3 foot = vec3_add(vec3_make(w->x0, w->y0, w->z0), vec3_scale(left, side * w->thickness / 2));
    const struct vec3 up = {0, 0, 1}, u = vec3_scale(along, -side);
    const struct vec3 origin = side > 0 ? vec3_add(foot, vec3_scale(along, length)) : foot;
    add_face(b, side > 0 ? "left" : "right", w->material, origin, u, up, err);
    for (int i = 0; !err->status && i + 1 < s_count; i++)
        for (int j = 0; !err->status && j + 1 < z_count; j++) {
            const double sm = (s_cuts[i] + s_cuts[i + 1]) / 2, zm = (z_cuts[j] + z_cuts[j + 1]) / 2;
            bool hole = false;
            for (int k = 0; k < s->item_count && !hole; k++) {
                const struct scene_item *o = &s->items[k];
                hole = is_opening_of(o, b->item) && sm > o->s0 && sm < o->s1 && zm > o->z0 && zm < o->z1;
            }
            if (hole) continue;
            const struct vec3 p = vec3_add(foot, vec3_scale(along, side > 0 ? s_cuts[i + 1] : s_cuts[i]));
            add_parallelogram(b, vec3_make(p.x, p.y, z_cuts[j]), vec3_scale(u, s_cuts[i + 1] - s_cuts[i]),
                              vec3_make(0, 0, z_cuts[j + 1] - z_cuts[j]), err);
        }
    free(cuts);
    return err->status;
}

static enum status add_wall(struct builder *b, struct err *err)
{
    const struct scene_item *w = &b->scene->items[b->item];
    struct vec3 along, left;
    double length;
    geometry_wall_axes(w, &along, &left, &length);
    const struct vec3 across = vec3_scale(left, w->thickness), up = {0, 0, w->z1 - w->z0},
                      line = vec3_scale(along, length);
    const struct vec3 right_foot = vec3_add(vec3_make(w->x0, w->y0, w->z0), vec3_scale(across, -0.5));
    const struct vec3 left_foot = vec3_add(right_foot, across);
    if (!add_wall_side(b, 1, err) && !add_wall_side(b, -1, err) &&
        !add_quad(b, "begin", w->material, left_foot, vec3_scale(across, -1), up, err) &&
        !add_quad(b, "end", w->material, vec3_add(right_foot, line), across, up, err) &&
        !add_quad(b, "top", w->material, vec3_add(right_foot, up), line, across, err))
        add_quad(b, "bottom", w->material, right_foot, across, line, err);
    return err->status;
}

/* The reveals of an opening, except those that would lie on the wall's own edge. */
static enum status add_reveals(struct builder *b, struct err *err)
{
    const struct scene_item *o = &b->scene->items[b->item], *w = &b->scene->items[o->wall];
    struct vec3 along, left;
    double length;
    geometry_wall_axes(w, &along, &left, &length);
    const struct vec3 across = vec3_scale(left, w->thickness), line = vec3_scale(along, o->s1 - o->s0);
    const struct vec3 up = {0, 0, o->z1 - o->z0};
    const struct vec3 p =
        vec3_add(vec3_add(vec3_make(w->x0, w->y0, o->z0), vec3_scale(along, o->s0)), vec3_scale(across, -0.5));
    if (o->s0 > 0) add_quad(b, "begin", w->material, p, across, up, err);
    if (!err->status && o->s1 < length)
        add_quad(b, "end", w->material, vec3_add(vec3_add(p, line), across), vec3_scale(across, -1), up, err);
    if (!err->status && o->z1 < w->z1) add_quad(b, "head", w->material, vec3_add(p, up), across, line, err);
    if (!err->status && o->z0 > w->z0) add_quad(b, "sill", w->material, p, line, across, err);
    return err->status;
}

static struct vec3 turned(struct vec3 p, double degrees)
{
    const double a = degrees * DEGREE, c = cos(a), s = sin(a);
    return vec3_make(c * p.x - s * p.y, s * p.x + c * p.y, p.z);
}

static enum status add_box(struct builder *b, struct err *err)
{
    static const char *const sides[6] = {"left", "right", "front", "back", "bottom", "top"};
    const struct scene_item *it = &b->scene->items[b->item];
    const struct vec3 middle = {(it->x0 + it->x1) / 2, (it->y0 + it->y1) / 2, it->z0};
    const double wx = it->x1 - it->x0, wy = it->y1 - it->y0, wz = it->z1 - it->z0;
    const struct vec3 x = {wx, 0, 0}, y = {0, wy, 0}, z = {0, 0, wz}, low = {-wx / 2, -wy / 2, 0};
    const struct vec3 minus_x = vec3_scale(x, -1), minus_y = vec3_scale(y, -1);
    const struct vec3 parts[6][3] = {
        {vec3_add(low, y), minus_y, z},              /* -x */
        {vec3_add(low, x), y, z},                    /* +x */
        {low, x, z},                                 /* -y */
        {vec3_add(vec3_add(low, x), y), minus_x, z}, /* +y */
        {vec3_add(low, y), x, minus_y},              /* -z */
        {vec3_add(low, z), x, y},                    /* +z */
    };
    for (int i = 0; !err->status && i < 6; i++)
        add_quad(b, sides[i], it->material, vec3_add(middle, turned(parts[i][0], it->turn)),
                 turned(parts[i][1], it->turn), turned(parts[i][2], it->turn), err);
    return err->status;
}

static enum status add_room(struct builder *b, struct err *err)
{
    const struct scene_item *it = &b->scene->items[b->item];
    const struct vec3 x = {it->x1 - it->x0, 0, 0}, y = {0, it->y1 - it->y0, 0};
    return add_quad(b, "floor", it->material, vec3_make(it->x0, it->y0, it->z0), x, y, err) ||
                   add_quad(b, "ceiling", it->ceiling, vec3_make(it->x0, it->y0, it->z1), y, x, err)
               ? err->status
               : ST_OK;
}

static enum status add_mesh(struct builder *b, struct err *err)
{
    const struct scene_item *it = &b->scene->items[b->item];
    struct vec3 sum = {0, 0, 0};
    add_face(b, NULL, it->material, it->at, vec3_make(1, 0, 0), vec3_make(0, 1, 0), err);
    for (int i = 0; !err->status && i < it->triangle_count; i++) {
        struct vec3 p[3];
        for (int k = 0; k < 3; k++)
            p[k] = vec3_add(it->at, turned(vec3_scale(it->triangles[i][k], it->scale), it->turn));
        const struct vec3 n = vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
        if (!(vec3_length(n) > 0)) continue;
        sum = vec3_add(sum, n);
        add_triangle(b, p[0], p[1], p[2], err);
    }
    if (!err->status) {
        struct scene_face *f = &b->g->faces[b->g->face_count - 1];
        f->mesh = true;
        f->normal = vec3_normalize(sum);
    }
    return err->status;
}

static enum status add_disk(struct builder *b, struct err *err)
{
    const struct scene_item *it = &b->scene->items[b->item];
    struct scene_geometry *g = b->g;
    struct vec3 x, y;
    frame_from_normal(vec3_normalize(it->u), &x, &y);
    if (add_face(b, NULL, -1, it->at, x, y, err)) return err->status;
    const int face = g->face_count - 1;
    g->faces[face].area = PI * it->radius * it->radius;
    ray_scene_add_disk(&g->rays, it->at, it->u, it->radius, (uint32_t)face, err);
    if (!err->status && g->has_furniture) ray_scene_add_disk(&g->bare, it->at, it->u, it->radius, (uint32_t)face, err);
    return err->status;
}

static enum status add_item(struct builder *b, struct err *err)
{
    const struct scene_item *it = &b->scene->items[b->item];
    switch (it->kind) {
    case ITEM_WALL:
        return add_wall(b, err);
    case ITEM_OPENING:
    case ITEM_WINDOW:
        return add_reveals(b, err);
    case ITEM_BOX:
        return add_box(b, err);
    case ITEM_ROOM:
        return add_room(b, err);
    case ITEM_MESH:
        return add_mesh(b, err);
    case ITEM_LAMP_DISK:
        return add_disk(b, err);
    default: /* a quad, a square lamp */
        return add_quad(b, NULL, it->material, it->at, it->u, it->v, err);
    }
}

enum status geometry_init(struct scene_geometry *g, const struct scene *s, struct err *err)
{
    struct builder b = {g, s, 0};
    *g = (struct scene_geometry){0};
    for (int i = 0; i < s->item_count; i++) g->has_furniture = g->has_furniture || s->items[i].furniture;
    if (!(g->lamp_faces = malloc((size_t)(s->item_count + 1) * sizeof *g->lamp_faces)))
        err_nomem(err, "lamps", (size_t)s->item_count * sizeof *g->lamp_faces);
    for (; !err->status && b.item < s->item_count; b.item++) {
        g->lamp_faces[b.item] = s->items[b.item].material < 0 ? g->face_count : -1;
        add_item(&b, err);
    }
    if (err->status) geometry_release(g);
    return err->status;
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(((const struct scene_face *)a)->name, ((const struct scene_face *)b)->name);
}

enum status geometry_keep_ids(struct scene_geometry *g, const char *folder, const char *base, struct err *err)
{
    struct scene s = {0};
    struct scene_geometry before = {0};
    if (!scene_read(&s, folder, base, NULL, err)) geometry_init(&before, &s, err);
    uint32_t next = (uint32_t)before.face_count + 1;
    if (!err->status) qsort(before.faces, (size_t)before.face_count, sizeof *before.faces, compare_names);
    for (int i = 0; !err->status && i < g->face_count; i++) {
        const struct scene_face *same =
            before.face_count
                ? bsearch(&g->faces[i], before.faces, (size_t)before.face_count, sizeof *g->faces, compare_names)
                : NULL;
        g->faces[i].id = same ? same->id : next++;
    }
    geometry_release(&before);
    scene_release(&s);
    return err->status;
}

enum status geometry_commit(struct scene_geometry *g, struct err *err)
{
    ray_scene_commit(&g->rays, err);
    return err->status || !g->has_furniture ? err->status : ray_scene_commit(&g->bare, err);
}

void geometry_release(struct scene_geometry *g)
{
    if (!g) return;
    ray_scene_release(&g->rays);
    ray_scene_release(&g->bare);
    for (int i = 0; i < g->face_count; i++) free(g->faces[i].name);
    free(g->faces);
    free(g->lamp_faces);
    *g = (struct scene_geometry){0};
}

void geometry_texture_coordinates(const struct scene_face *f, const struct ray_hit *hit, double *u, double *v)
{
    const struct vec3 p = vec3_sub(hit->point, f->origin);
    const struct vec3 n = hit->normal;
    if (!f->mesh) {
        *u = vec3_dot(p, f->u);
        *v = vec3_dot(p, f->v);
    } else if (fabs(n.z) >= fabs(n.x) && fabs(n.z) >= fabs(n.y)) { /* a mesh: projected along the normal's main axis */
        *u = p.x, *v = p.y;
    } else {
        *u = fabs(n.x) > fabs(n.y) ? p.y : p.x;
        *v = p.z;
    }
}
