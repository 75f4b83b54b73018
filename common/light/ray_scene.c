/* ray_scene.c - an Embree scene of triangles and disks, made to give the same hits on every processor.
 *
 * The device is opened for one instruction set (AVX2) and one building thread, so that the tree, and with it which of
 * two surfaces in one place is hit, does not depend on the processor or the number of threads. Triangles do not share
 * vertices in Embree's buffers, and the scene is `robust`: no ray slips through an edge that two triangles share.
 *
 * Embree reports the distance in single precision. With the surface found, the distance is computed again as the
 * intersection with the surface's plane in double precision, so that depth is exact to the precision of the corners.
 * Near grazing angles, where that quotient is unstable, Embree's distance is kept.
 *
 * A disk is a square of two triangles with a filter: Embree asks it about each hit, and hits outside the radius are
 * rejected, whereupon the ray goes on. */
#include "common/light/ray_scene.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/light/embree.h"
#include "common/light/frame.h"

#define MAX_PRIMITIVES (1 << 23)
#define EPSILON        4e-6

enum { GEOMETRY_TRIANGLES, GEOMETRY_DISKS }; /* Embree's geometry ids */

/* --------------------------------------------------------------------------------------------------------- building */

static enum status too_many(const char *what, struct err *err)
{
    return err_set(err, ST_DATA, "the scene has more than %d %s; make it simpler.", MAX_PRIMITIVES, what);
}

enum status ray_scene_add_triangle(struct ray_scene *s, const struct vec3 corner[3], uint32_t id, struct err *err)
{
    if (s->triangle_count == MAX_PRIMITIVES) return too_many("triangles", err);
    if (array_append(&s->triangles, (size_t)s->triangle_count, sizeof *s->triangles, "triangles", err))
        return err->status;
    const struct vec3 n = vec3_cross(vec3_sub(corner[1], corner[0]), vec3_sub(corner[2], corner[0]));
    s->triangles[s->triangle_count++] = (struct ray_triangle){{corner[0], corner[1], corner[2]}, vec3_normalize(n), id};
    for (int i = 0; i < 3; i++) {
        const double largest = fmax(fabs(corner[i].x), fmax(fabs(corner[i].y), fabs(corner[i].z)));
        s->epsilon = fmax(s->epsilon, EPSILON * largest);
    }
    return ST_OK;
}

enum status ray_scene_add_disk(struct ray_scene *s, struct vec3 centre, struct vec3 normal, double radius, uint32_t id,
                               struct err *err)
{
    if (s->disk_count == MAX_PRIMITIVES) return too_many("disks", err);
    if (array_append(&s->disks, (size_t)s->disk_count, sizeof *s->disks, "disks", err)) return err->status;
    struct vec3 x, y;
    frame_from_normal(vec3_normalize(normal), &x, &y);
    const struct vec3 n = vec3_normalize(vec3_cross(x, y));
    s->disks[s->disk_count++] = (struct ray_disk){centre, vec3_normalize(x), vec3_normalize(y), n, radius, id};
    return ST_OK;
}

/* Embree's packets are arrays of `n` values, one array for each field of RTCRay and RTCHit, in their order. */
enum { RAY_ORIGIN_X = 0, RAY_DIRECTION_X = 4, RAY_T_FAR = 8, HIT_PRIMITIVE = 5 };

/* Rejects hits in the corners of a disk's square. Embree calls it for packets of `n` rays, and with n = 1 for single
 * rays. */
static void disk_filter(const struct RTCFilterFunctionNArguments *args)
{
    const struct ray_disk *disks = args->geometryUserPtr;
    const float *ray = (const float *)args->ray;
    const uint32_t *hit = (const uint32_t *)args->hit;
    const size_t n = args->N;
    for (size_t i = 0; i < n; i++) {
        if (!args->valid[i]) continue;
        const struct ray_disk *d = &disks[hit[HIT_PRIMITIVE * n + i] / 2];
        const float *o = ray + RAY_ORIGIN_X * n + i, *v = ray + RAY_DIRECTION_X * n + i;
        const double t = (double)ray[RAY_T_FAR * n + i];
        const struct vec3 p = {(double)o[0] + t * (double)v[0], (double)o[n] + t * (double)v[n],
                               (double)o[2 * n] + t * (double)v[2 * n]};
        if (vec3_length(vec3_sub(p, d->centre)) > d->radius) args->valid[i] = 0;
    }
}

static float *put_vertex(float *v, struct vec3 p)
{
    *v++ = (float)p.x, *v++ = (float)p.y, *v++ = (float)p.z;
    return v;
}

/* The two triangles of the square around a disk, a little larger than the disk. */
static float *put_square(float *v, const struct ray_disk *d)
{
    const struct vec3 x = vec3_scale(d->x, 1.00001 * d->radius), y = vec3_scale(d->y, 1.00001 * d->radius);
    const struct vec3 a = vec3_add(x, y), b = vec3_sub(x, y), c = d->centre;
    const struct vec3 corners[6] = {vec3_sub(c, a), vec3_add(c, b), vec3_add(c, a),
                                    vec3_sub(c, a), vec3_add(c, a), vec3_sub(c, b)};
    for (int k = 0; k < 6; k++) v = put_vertex(v, corners[k]);
    return v;
}

/* All triangles, or the squares of all disks, as one Embree geometry. */
static enum status attach(struct ray_scene *s, unsigned geometry_id, struct err *err)
{
    const bool disks = geometry_id == GEOMETRY_DISKS;
    const size_t count = disks ? 2 * (size_t)s->disk_count : (size_t)s->triangle_count;
    if (!count) return ST_OK;
    RTCGeometry made = rtcNewGeometry(s->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *v = rtcSetNewGeometryBuffer(made, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof *v, 3 * count);
    uint32_t *index =
        rtcSetNewGeometryBuffer(made, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof *index, count);
    if (!v || !index) {
        rtcReleaseGeometry(made);
        return err_nomem(err, "a scene for ray tracing", count * 48);
    }
    for (size_t i = 0; i < 3 * count; i++) index[i] = (uint32_t)i;
    for (size_t i = 0; !disks && i < 3 * count; i++) v = put_vertex(v, s->triangles[i / 3].corner[i % 3]);
    for (int i = 0; disks && i < s->disk_count; i++) v = put_square(v, &s->disks[i]);
    if (disks) {
        rtcSetGeometryUserData(made, s->disks);
        rtcSetGeometryIntersectFilterFunction(made, disk_filter);
        rtcSetGeometryOccludedFilterFunction(made, disk_filter);
    }
    rtcCommitGeometry(made);
    rtcAttachGeometryByID(s->embree, made, geometry_id);
    rtcReleaseGeometry(made);
    return ST_OK;
}

enum status ray_scene_commit(struct ray_scene *s, struct err *err)
{
    s->device = rtcNewDevice("threads=1,isa=avx2");
    if (!s->device)
        return err_set(err, ST_INTERNAL, "Embree does not start (error %d); it needs a processor with AVX2.",
                       (int)rtcGetDeviceError(NULL));
    s->embree = rtcNewScene(s->device);
    rtcSetSceneFlags(s->embree, RTC_SCENE_FLAG_ROBUST);
    if (attach(s, GEOMETRY_TRIANGLES, err) || attach(s, GEOMETRY_DISKS, err)) return err->status;
    rtcCommitScene(s->embree);
    const enum RTCError error = rtcGetDeviceError(s->device);
    if (error != RTC_ERROR_NONE) err_set(err, ST_INTERNAL, "Embree could not build the scene (error %d).", (int)error);
    return err->status;
}

void ray_scene_release(struct ray_scene *s)
{
    if (!s) return;
    if (s->embree) rtcReleaseScene(s->embree);
    if (s->device) rtcReleaseDevice(s->device);
    free(s->triangles);
    free(s->disks);
    *s = (struct ray_scene){0};
}

/* ---------------------------------------------------------------------------------------------------------- tracing */

/* Computes in double precision what Embree found at t_embree. */
static inline void exact_hit(struct ray_hit *hit, const struct ray_scene *s, struct vec3 from, struct vec3 direction,
                             unsigned geometry, unsigned primitive, double t_embree)
{
    struct vec3 on_plane, n;
    if (geometry == GEOMETRY_DISKS) {
        const struct ray_disk *d = &s->disks[primitive / 2];
        hit->id = d->id;
        on_plane = d->centre;
        n = d->normal;
    } else {
        const struct ray_triangle *t = &s->triangles[primitive];
        hit->id = t->id;
        on_plane = t->corner[0];
        n = t->normal;
    }
    const double slope = vec3_dot(direction, n);
    hit->front = slope < 0;
    hit->normal = hit->front ? n : vec3_scale(n, -1);
    hit->t = vec3_dot(vec3_sub(on_plane, from), n) / slope;
    if (!(fabs(hit->t - t_embree) <= 1e-3 * (1 + t_embree))) hit->t = t_embree; /* grazing, or 0 / 0 */
    hit->point = vec3_add(from, vec3_scale(direction, hit->t));
}

bool ray_scene_hit(const struct ray_scene *s, struct vec3 from, struct vec3 direction, struct ray_hit *hit)
{
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
    embree_intersect(s->embree, &r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    exact_hit(hit, s, from, direction, r.hit.geomID, r.hit.primID, (double)r.ray.tfar);
    return true;
}

bool ray_scene_blocked(const struct ray_scene *s, struct vec3 from, struct vec3 direction, double t_max)
{
    struct RTCRay r = {
        .org_x = (float)from.x,
        .org_y = (float)from.y,
        .org_z = (float)from.z,
        .dir_x = (float)direction.x,
        .dir_y = (float)direction.y,
        .dir_z = (float)direction.z,
        .tfar = (float)t_max,
        .mask = UINT32_MAX,
    };
    embree_occluded(s->embree, &r);
    return r.tfar < 0;
}

/* Embree takes -1 for an active ray. */
static void fill_packet(struct RTCRay8 *r, int valid[RAY_PACKET], const struct vec3 *from, const struct vec3 *direction,
                        const double *t_max, unsigned active)
{
    *r = (struct RTCRay8){0};
    for (int i = 0; i < RAY_PACKET; i++) {
        valid[i] = active >> i & 1 ? -1 : 0;
        if (!valid[i]) continue;
        r->org_x[i] = (float)from[i].x, r->org_y[i] = (float)from[i].y, r->org_z[i] = (float)from[i].z;
        r->dir_x[i] = (float)direction[i].x, r->dir_y[i] = (float)direction[i].y, r->dir_z[i] = (float)direction[i].z;
        r->tfar[i] = t_max ? (float)t_max[i] : INFINITY;
        r->mask[i] = UINT32_MAX;
    }
}

unsigned ray_scene_hit_packet(const struct ray_scene *s, const struct vec3 from[RAY_PACKET],
                              const struct vec3 direction[RAY_PACKET], unsigned active, struct ray_hit hit[RAY_PACKET])
{
    struct RTCRayHit8 r;
    _Alignas(32) int valid[RAY_PACKET];
    unsigned found = 0;
    fill_packet(&r.ray, valid, from, direction, NULL, active);
    for (int i = 0; i < RAY_PACKET; i++) r.hit.geomID[i] = r.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    embree_intersect_packet(s->embree, valid, &r);
    for (int i = 0; i < RAY_PACKET; i++) {
        if (!valid[i] || r.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
        found |= 1u << i;
        exact_hit(&hit[i], s, from[i], direction[i], r.hit.geomID[i], r.hit.primID[i], (double)r.ray.tfar[i]);
    }
    return found;
}

unsigned ray_scene_blocked_packet(const struct ray_scene *s, const struct vec3 from[RAY_PACKET],
                                  const struct vec3 direction[RAY_PACKET], const double t_max[RAY_PACKET],
                                  unsigned active)
{
    struct RTCRay8 r;
    _Alignas(32) int valid[RAY_PACKET];
    unsigned blocked = 0;
    fill_packet(&r, valid, from, direction, t_max, active);
    embree_occluded_packet(s->embree, valid, &r);
    for (int i = 0; i < RAY_PACKET; i++)
        if (valid[i] && r.tfar[i] < 0) blocked |= 1u << i;
    return blocked;
}
