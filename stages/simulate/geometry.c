/* geometry.c - see geometry.h.
 *
 * A wall's side with openings is cut along all their edges into a grid of rectangles, of which those inside an opening
 * are left out: no T junctions, so no cracks. Embree finds the triangle in single precision; the point is then taken on
 * the triangle's plane in double precision, so that depth is exact. */
#include "stages/simulate/geometry.h"

#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/sort.h"
#include "common/light/frame.h"
#include "common/light/noise.h"
#include "common/math/numbers.h"

#define MOST_TRIANGLES (1 << 23)

/* -------------------------------------------------------------------------------------------------------------- faces */

/* Doubles an array when `count` fills it: the array is full at 0 and at powers of two. */
static enum status grow(void **list, int count, size_t size, const char *what, struct err *err)
{
    if (count & (count - 1)) return ST_OK;
    if (count >= MOST_TRIANGLES)
        return err_set(err, ST_DATA, "the scene has more than %d %s; make it simpler.", count, what);
    const size_t bytes = (size_t)(count ? 2 * count : 1) * size;
    void *grown = realloc(*list, bytes);
    if (!grown) return err_nomem(err, what, bytes);
    *list = grown;
    return ST_OK;
}

struct builder {
    struct geometry *g;
    const struct scene *scene;
    int item;
};

static uint32_t name_seed(const char *name)
{
    uint32_t seed = 0;
    while (*name) seed = noise_mix(seed + (unsigned char)*name++);
    return seed;
}

/* A face without triangles yet; `side` NULL: it is called as its item. */
static enum status add_face(struct builder *b, const char *side, int material, struct vec3 origin, struct vec3 u,
                            struct vec3 v, struct err *err)
{
    struct geometry *g = b->g;
    const char *item = b->scene->items[b->item].name;
    void *list = g->faces;
    enum status st = grow(&list, g->face_count, sizeof *g->faces, "faces", err);
    g->faces = list;
    if (st) return st;
    char *name = NULL;
    if (asprintf(&name, side ? "%s.%s" : "%s", item, side) < 0) return err_nomem(err, "a face's name", strlen(item));
    g->faces[g->face_count++] = (struct face){
        .name = name,
        .item = b->item,
        .material = material,
        .origin = origin,
        .u = vec3_normalize(u),
        .v = vec3_normalize(v),
        .normal = vec3_normalize(vec3_cross(u, v)),
        .seed = name_seed(name),
    };
    return ST_OK;
}

/* Adds a triangle to the last face. */
static enum status add_triangle(struct builder *b, struct vec3 p, struct vec3 q, struct vec3 r, struct err *err)
{
    struct geometry *g = b->g;
    void *list = g->triangles;
    enum status st = grow(&list, g->triangle_count, sizeof *g->triangles, "triangles", err);
    g->triangles = list;
    if (st) return st;
    const struct vec3 n = vec3_cross(vec3_sub(q, p), vec3_sub(r, p));
    g->triangles[g->triangle_count++] = (struct triangle){{p, q, r}, vec3_normalize(n), g->face_count - 1};
    g->faces[g->face_count - 1].area += vec3_length(n) / 2;
    return ST_OK;
}

static enum status add_parallelogram(struct builder *b, struct vec3 p, struct vec3 u, struct vec3 v, struct err *err)
{
    const struct vec3 pu = vec3_add(p, u), pv = vec3_add(p, v), puv = vec3_add(pu, v);
    enum status st = add_triangle(b, p, pu, puv, err);
    return st ? st : add_triangle(b, p, puv, pv, err);
}

static enum status add_quad(struct builder *b, const char *side, int material, struct vec3 p, struct vec3 u,
                            struct vec3 v, struct err *err)
{
    enum status st = add_face(b, side, material, p, u, v, err);
    return st ? st : add_parallelogram(b, p, u, v, err);
}

void wall_axes(const struct item *wall, struct vec3 *along, struct vec3 *left, double *length)
{
    const struct vec3 line = {wall->x1 - wall->x0, wall->y1 - wall->y0, 0};
    *length = vec3_length(line);
    *along = vec3_normalize(line);
    *left = vec3_make(-along->y, along->x, 0);
}

/* Sorted, without repetitions, without what is outside [from, to]. */
static int tidy_cuts(double *cuts, int count, double from, double to)
{
    int kept = 0;
    sort_doubles(cuts, (size_t)count);
    for (int i = 0; i < count; i++)
        if (cuts[i] >= from && cuts[i] <= to && (!kept || cuts[i] > cuts[kept - 1])) cuts[kept++] = cuts[i];
    return kept;
}

static bool is_opening_of(const struct item *o, int wall)
{
    return (o->kind == ITEM_OPENING || o->kind == ITEM_WINDOW) && o->wall == wall;
}

/* The left (side 1) or right (-1) face of a wall, its openings left out. */
static enum status add_wall_side(struct builder *b, int side, struct err *err)
{
    const struct scene *s = b->scene;
    const struct item *w = &s->items[b->item];
    struct vec3 along, left;
    double length;
    int openings = 0, s_count = 0, z_count = 0;
    for (int i = 0; i < s->item_count; i++) openings += is_opening_of(&s->items[i], b->item);
    double *cuts = malloc((size_t)(4 * openings + 4) * sizeof *cuts);
    if (!cuts) return err_nomem(err, "a wall's openings", (size_t)openings * 4 * sizeof *cuts);
    double *s_cuts = cuts, *z_cuts = cuts + 2 * openings + 2;

    wall_axes(w, &along, &left, &length);
    s_cuts[s_count++] = 0, s_cuts[s_count++] = length;
    z_cuts[z_count++] = w->z0, z_cuts[z_count++] = w->z1;
    for (int i = 0; i < s->item_count; i++) {
        const struct item *o = &s->items[i];
        if (!is_opening_of(o, b->item)) continue;
        s_cuts[s_count++] = o->s0, s_cuts[s_count++] = fmin(o->s1, length);
        z_cuts[z_count++] = o->z0, z_cuts[z_count++] = o->z1;
    }
    s_count = tidy_cuts(s_cuts, s_count, 0, length);
    z_count = tidy_cuts(z_cuts, z_count, w->z0, w->z1);

    /* u to the right for who looks at the face, so that it runs against the wall's direction on its left side */
    const struct vec3 foot = vec3_add(vec3_make(w->x0, w->y0, w->z0), vec3_scale(left, side * w->thickness / 2));
    const struct vec3 up = {0, 0, 1}, u = vec3_scale(along, -side);
    const struct vec3 origin = side > 0 ? vec3_add(foot, vec3_scale(along, length)) : foot;
    enum status st = add_face(b, side > 0 ? "left" : "right", w->material, origin, u, up, err);
    for (int i = 0; !st && i + 1 < s_count; i++)
        for (int j = 0; !st && j + 1 < z_count; j++) {
            const double sm = (s_cuts[i] + s_cuts[i + 1]) / 2, zm = (z_cuts[j] + z_cuts[j + 1]) / 2;
            bool hole = false;
            for (int k = 0; k < s->item_count && !hole; k++) {
                const struct item *o = &s->items[k];
                hole = is_opening_of(o, b->item) && sm > o->s0 && sm < o->s1 && zm > o->z0 && zm < o->z1;
            }
            if (hole) continue;
            const struct vec3 p = vec3_add(foot, vec3_scale(along, side > 0 ? s_cuts[i + 1] : s_cuts[i]));
            st = add_parallelogram(b, vec3_make(p.x, p.y, z_cuts[j]), vec3_scale(u, s_cuts[i + 1] - s_cuts[i]),
                                   vec3_make(0, 0, z_cuts[j + 1] - z_cuts[j]), err);
        }
    free(cuts);
    return st;
}

static enum status add_wall(struct builder *b, struct err *err)
{
    const struct item *w = &b->scene->items[b->item];
    struct vec3 along, left;
    double length;
    wall_axes(w, &along, &left, &length);
    const struct vec3 across = vec3_scale(left, w->thickness), up = {0, 0, w->z1 - w->z0},
                      line = vec3_scale(along, length);
    const struct vec3 right_foot = vec3_add(vec3_make(w->x0, w->y0, w->z0), vec3_scale(across, -0.5));
    const struct vec3 left_foot = vec3_add(right_foot, across);
    enum status st = add_wall_side(b, 1, err);
    if (!st) st = add_wall_side(b, -1, err);
    if (!st) st = add_quad(b, "begin", w->material, left_foot, vec3_scale(across, -1), up, err);
    if (!st) st = add_quad(b, "end", w->material, vec3_add(right_foot, line), across, up, err);
    if (!st) st = add_quad(b, "top", w->material, vec3_add(right_foot, up), line, across, err);
    if (!st) st = add_quad(b, "bottom", w->material, right_foot, across, line, err);
    return st;
}

/* The reveals of an opening, but for those that would lie on the wall's own edge. */
static enum status add_reveals(struct builder *b, struct err *err)
{
    const struct item *o = &b->scene->items[b->item], *w = &b->scene->items[o->wall];
    struct vec3 along, left;
    double length;
    wall_axes(w, &along, &left, &length);
    const struct vec3 across = vec3_scale(left, w->thickness), line = vec3_scale(along, o->s1 - o->s0);
    const struct vec3 up = {0, 0, o->z1 - o->z0};
    const struct vec3 p =
        vec3_add(vec3_add(vec3_make(w->x0, w->y0, o->z0), vec3_scale(along, o->s0)), vec3_scale(across, -0.5));
    enum status st = ST_OK;
    if (o->s0 > 0) st = add_quad(b, "begin", w->material, p, across, up, err);
    if (!st && o->s1 < length)
        st = add_quad(b, "end", w->material, vec3_add(vec3_add(p, line), across), vec3_scale(across, -1), up, err);
    if (!st && o->z1 < w->z1) st = add_quad(b, "head", w->material, vec3_add(p, up), across, line, err);
    if (!st && o->z0 > w->z0) st = add_quad(b, "sill", w->material, p, line, across, err);
    return st;
}

static struct vec3 turned(struct vec3 p, double degrees)
{
    const double a = degrees * (PI / 180), c = cos(a), s = sin(a);
    return vec3_make(c * p.x - s * p.y, s * p.x + c * p.y, p.z);
}

static enum status add_box(struct builder *b, struct err *err)
{
    static const char *const sides[6] = {"left", "right", "front", "back", "bottom", "top"};
    const struct item *it = &b->scene->items[b->item];
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
    enum status st = ST_OK;
    for (int i = 0; !st && i < 6; i++)
        st = add_quad(b, sides[i], it->material, vec3_add(middle, turned(parts[i][0], it->turn)),
                      turned(parts[i][1], it->turn), turned(parts[i][2], it->turn), err);
    return st;
}

static enum status add_room(struct builder *b, struct err *err)
{
    const struct item *it = &b->scene->items[b->item];
    const struct vec3 x = {it->x1 - it->x0, 0, 0}, y = {0, it->y1 - it->y0, 0};
    enum status st = add_quad(b, "floor", it->material, vec3_make(it->x0, it->y0, it->z0), x, y, err);
    return st ? st : add_quad(b, "ceiling", it->ceiling, vec3_make(it->x0, it->y0, it->z1), y, x, err);
}

static enum status add_mesh(struct builder *b, struct err *err)
{
    const struct item *it = &b->scene->items[b->item];
    struct vec3 sum = {0, 0, 0};
    enum status st = add_face(b, NULL, it->material, it->at, vec3_make(1, 0, 0), vec3_make(0, 1, 0), err);
    for (int i = 0; !st && i < it->triangle_count; i++) {
        struct vec3 p[3];
        for (int k = 0; k < 3; k++)
            p[k] = vec3_add(it->at, turned(vec3_scale(it->triangles[i][k], it->scale), it->turn));
        const struct vec3 n = vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
        if (!(vec3_length(n) > 0)) continue;
        sum = vec3_add(sum, n);
        st = add_triangle(b, p[0], p[1], p[2], err);
    }
    if (!st) {
        struct face *f = &b->g->faces[b->g->face_count - 1];
        f->mesh = true;
        f->normal = vec3_normalize(sum);
    }
    return st;
}

static enum status add_disk(struct builder *b, struct err *err)
{
    const struct item *it = &b->scene->items[b->item];
    struct geometry *g = b->g;
    struct vec3 x, y;
    frame_from_normal(vec3_normalize(it->u), &x, &y);
    enum status st = add_face(b, NULL, -1, it->at, x, y, err);
    void *list = g->disks;
    if (!st) st = grow(&list, g->disk_count, sizeof *g->disks, "lamps", err);
    g->disks = list;
    if (st) return st;
    g->faces[g->face_count - 1].area = PI * it->radius * it->radius;
    g->disks[g->disk_count++] = (struct disk_face){it->at, it->radius, g->face_count - 1};
    return ST_OK;
}

static enum status add_item(struct builder *b, struct err *err)
{
    const struct item *it = &b->scene->items[b->item];
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

enum status geometry_init(struct geometry *g, const struct scene *s, struct err *err)
{
    struct builder b = {g, s, 0};
    enum status st = ST_OK;
    *g = (struct geometry){0};
    if (!(g->lamp_faces = malloc((size_t)(s->item_count + 1) * sizeof *g->lamp_faces)))
        st = err_nomem(err, "lamps", (size_t)s->item_count * sizeof *g->lamp_faces);
    for (; !st && b.item < s->item_count; b.item++) {
        g->lamp_faces[b.item] = s->items[b.item].material < 0 ? g->face_count : -1;
        st = add_item(&b, err);
    }
    if (st) {
        geometry_release(g);
        return st;
    }
    double farthest = 0;
    for (int i = 0; i < 3 * g->triangle_count; i++) {
        const struct vec3 p = g->triangles[i / 3].corner[i % 3];
        farthest = fmax(farthest, fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))));
    }
    g->epsilon = 4e-6 * farthest; /* single precision resolves 6e-8 of the largest coordinate */
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------- tracing */

enum { GEOMETRY_TRIANGLES, GEOMETRY_DISKS };

/* Embree asks whether the corner of a round lamp's square is lamp. Rays are traced one by one, so N is 1 and what it
 * gives is a plain ray and hit. */
static void disk_filter(const struct RTCFilterFunctionNArguments *args)
{
    const struct disk_face *disks = args->geometryUserPtr;
    const struct RTCRay *ray = (const struct RTCRay *)args->ray;
    const struct disk_face *d = &disks[((const struct RTCHit *)args->hit)->primID / 2];
    const double t = (double)ray->tfar;
    const struct vec3 p = {(double)ray->org_x + t * (double)ray->dir_x, (double)ray->org_y + t * (double)ray->dir_y,
                           (double)ray->org_z + t * (double)ray->dir_z};
    if (vec3_length(vec3_sub(p, d->centre)) > d->radius) args->valid[0] = 0;
}

static float *put_vertex(float *v, struct vec3 p)
{
    *v++ = (float)p.x, *v++ = (float)p.y, *v++ = (float)p.z;
    return v;
}

/* All triangles, or two for every round lamp, as an Embree geometry. */
static enum status attach(struct geometry *g, unsigned id, struct err *err)
{
    const size_t count = id == GEOMETRY_DISKS ? 2 * (size_t)g->disk_count : (size_t)g->triangle_count;
    if (!count) return ST_OK;
    RTCGeometry made = rtcNewGeometry(g->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *v = rtcSetNewGeometryBuffer(made, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof *v, 3 * count);
    uint32_t *index =
        rtcSetNewGeometryBuffer(made, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof *index, count);
    const bool made_room = v && index;
    for (size_t i = 0; made_room && i < 3 * count; i++) {
        index[i] = (uint32_t)i;
        if (id == GEOMETRY_TRIANGLES) v = put_vertex(v, g->triangles[i / 3].corner[i % 3]);
    }
    for (int i = 0; made_room && id == GEOMETRY_DISKS && i < g->disk_count; i++) {
        const struct disk_face *d = &g->disks[i];
        const struct vec3 x = vec3_scale(g->faces[d->face].u, 1.00001 * d->radius);
        const struct vec3 y = vec3_scale(g->faces[d->face].v, 1.00001 * d->radius);
        const struct vec3 a = vec3_add(x, y), b = vec3_sub(x, y), c = d->centre;
        const struct vec3 corners[6] = {vec3_sub(c, a), vec3_add(c, b), vec3_add(c, a),
                                        vec3_sub(c, a), vec3_add(c, a), vec3_sub(c, b)};
        for (int k = 0; k < 6; k++) v = put_vertex(v, corners[k]);
    }
    if (made_room && id == GEOMETRY_DISKS) {
        rtcSetGeometryUserData(made, g->disks);
        rtcSetGeometryIntersectFilterFunction(made, disk_filter);
        rtcSetGeometryOccludedFilterFunction(made, disk_filter);
    }
    if (made_room) {
        rtcCommitGeometry(made);
        rtcAttachGeometryByID(g->scene, made, id);
    }
    rtcReleaseGeometry(made);
    return made_room ? ST_OK : err_nomem(err, "a scene for ray tracing", count * 48);
}

enum status geometry_commit(struct geometry *g, struct err *err)
{
    /* one thread builds, and its instructions are named, so that the tree, and with it which of two faces in one place
       is hit, is the same on every processor */
    g->device = rtcNewDevice("threads=1,isa=avx2");
    if (!g->device)
        return err_set(err, ST_INTERNAL, "Embree does not start (error %d); a processor with AVX2 is needed.",
                       (int)rtcGetDeviceError(NULL));
    g->scene = rtcNewScene(g->device);
    rtcSetSceneFlags(g->scene, RTC_SCENE_FLAG_ROBUST);
    enum status st = attach(g, GEOMETRY_TRIANGLES, err);
    if (!st) st = attach(g, GEOMETRY_DISKS, err);
    if (st) return st;
    rtcCommitScene(g->scene);
    const enum RTCError error = rtcGetDeviceError(g->device);
    if (error != RTC_ERROR_NONE)
        st = err_set(err, ST_INTERNAL, "Embree could not build the scene (error %d).", (int)error);
    return st;
}

void geometry_release(struct geometry *g)
{
    if (!g) return;
    if (g->scene) rtcReleaseScene(g->scene);
    if (g->device) rtcReleaseDevice(g->device);
    for (int i = 0; i < g->face_count; i++) free(g->faces[i].name);
    free(g->faces);
    free(g->triangles);
    free(g->disks);
    free(g->lamp_faces);
    *g = (struct geometry){0};
}

bool geometry_hit(const struct geometry *g, struct vec3 from, struct vec3 direction, struct hit *hit)
{
    struct RTCIntersectContext context;
    struct RTCRayHit r = {
        .ray = {.org_x = (float)from.x,
                .org_y = (float)from.y,
                .org_z = (float)from.z,
                .dir_x = (float)direction.x,
                .dir_y = (float)direction.y,
                .dir_z = (float)direction.z,
                .tfar = INFINITY,
                .mask = UINT32_MAX},
        .hit = {.geomID = RTC_INVALID_GEOMETRY_ID, .instID = {RTC_INVALID_GEOMETRY_ID}},
    };
    rtcInitIntersectContext(&context);
    rtcIntersect1(g->scene, &context, &r);
    hit->face = -1;
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;

    struct vec3 anchor, n;
    if (r.hit.geomID == GEOMETRY_DISKS) {
        const struct disk_face *d = &g->disks[r.hit.primID / 2];
        hit->face = d->face;
        anchor = d->centre;
        n = g->faces[d->face].normal;
    } else {
        const struct triangle *t = &g->triangles[r.hit.primID];
        hit->face = t->face;
        anchor = t->corner[0];
        n = t->normal;
    }
    const double slope = vec3_dot(direction, n);
    hit->front = slope < 0;
    hit->normal = hit->front ? n : vec3_scale(n, -1);
    hit->t = vec3_dot(vec3_sub(anchor, from), n) / slope;
    /* seen along its plane a face has no one distance: Embree's is kept */
    if (!(fabs(hit->t - (double)r.ray.tfar) <= 1e-3 * (1 + (double)r.ray.tfar))) hit->t = (double)r.ray.tfar;
    hit->point = vec3_add(from, vec3_scale(direction, hit->t));
    return true;
}

bool geometry_blocked(const struct geometry *g, struct vec3 from, struct vec3 direction, double distance)
{
    struct RTCIntersectContext context;
    struct RTCRay r = {
        .org_x = (float)from.x,
        .org_y = (float)from.y,
        .org_z = (float)from.z,
        .dir_x = (float)direction.x,
        .dir_y = (float)direction.y,
        .dir_z = (float)direction.z,
        .tfar = (float)distance,
        .mask = UINT32_MAX,
    };
    rtcInitIntersectContext(&context);
    rtcOccluded1(g->scene, &context, &r);
    return r.tfar < 0;
}

void geometry_texture_place(const struct face *f, const struct hit *hit, double *u, double *v)
{
    const struct vec3 p = vec3_sub(hit->point, f->origin);
    const struct vec3 n = hit->normal;
    if (!f->mesh) {
        *u = vec3_dot(p, f->u);
        *v = vec3_dot(p, f->v);
    } else if (fabs(n.z) >= fabs(n.x) && fabs(n.z) >= fabs(n.y)) { /* a mesh: along the axis it looks to most */
        *u = p.x, *v = p.y;
    } else {
        *u = fabs(n.x) > fabs(n.y) ? p.y : p.x;
        *v = p.z;
    }
}
