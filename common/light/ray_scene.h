/* ray_scene.h - rays against triangles and round disks (Embree): nearest surfaces, and occlusion.
 *
 * Surfaces have two sides and carry an id that the caller chooses. Lengths are in scene units. Embree finds the surface
 * in single precision; the point is then computed on the surface's plane in double precision. Packets are eight rays
 * traced together: about four times the speed of single rays when the rays are coherent (neighbouring pixels).
 *
 * A ray begins at t = 0. One that leaves a surface must begin `epsilon` off it, on the side that it goes to, or it may
 * hit the same surface again. Origins, directions and corners must be finite. */
#ifndef REMODEL_RAY_SCENE_H
#define REMODEL_RAY_SCENE_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/err.h"
#include "common/math/vec.h"

#define RAY_PACKET 8 /* rays */

struct ray_triangle {
    struct vec3 corner[3], normal; /* unit normal, (corner[1] - corner[0]) x (corner[2] - corner[0]) */
    uint32_t id;
};

struct ray_disk {
    struct vec3 centre, x, y, normal; /* orthonormal, right-handed */
    double radius;
    uint32_t id;
};

/* {0} is the empty state. Everything is owned. Rays may be traced by many threads at once. */
struct ray_scene {
    struct ray_triangle *triangles;
    struct ray_disk *disks;
    int triangle_count, disk_count;
    /* How far off a surface rays must begin: 4e-6 of the largest coordinate of a triangle, about 70 times the spacing
     * of single-precision numbers there. Valid as soon as the triangles were added. */
    double epsilon;
    struct RTCDeviceTy *device; /* Embree's; NULL before ray_scene_commit() */
    struct RTCSceneTy *embree;
};

struct ray_hit {
    struct vec3 point, normal; /* the unit normal of the side that was hit: it faces the ray */
    double t;                  /* point = origin + t direction */
    uint32_t id;
    bool front; /* hit from the side that the triangle's or the disk's own normal points to */
};

/* Adds a surface; before ray_scene_commit(). `normal` has any length but 0. ST_DATA: more than 2^23 triangles or disks;
 * ST_NOMEM. */
enum status ray_scene_add_triangle(struct ray_scene *s, const struct vec3 corner[3], uint32_t id, struct err *err);
enum status ray_scene_add_disk(struct ray_scene *s, struct vec3 centre, struct vec3 normal, double radius, uint32_t id,
                               struct err *err);

/* Builds the search tree; once, after everything was added. An empty scene is allowed: no ray hits anything.
 * ST_INTERNAL: Embree does not start, or fails; ST_NOMEM. The caller releases the scene in each case. */
enum status ray_scene_commit(struct ray_scene *s, struct err *err);
void ray_scene_release(struct ray_scene *s);

/* The nearest surface along a ray; false if there is none (*hit is unchanged). The direction has any length but 0, and
 * t is in units of that length: a pinhole ray with 1 along the camera's axis gives t = z depth, a unit direction the
 * distance. */
bool ray_scene_hit(const struct ray_scene *s, struct vec3 from, struct vec3 direction, struct ray_hit *hit);

/* Whether a surface lies between t = 0 and t = t_max (INFINITY allowed). */
bool ray_scene_blocked(const struct ray_scene *s, struct vec3 from, struct vec3 direction, double t_max);

/* The same for RAY_PACKET rays. Rays whose bit in `active` is 0 are left out, and their array elements are not read.
 * Returns a bit for each ray that hit (is blocked); the other elements of hit are unchanged. A packet agrees with
 * single rays but for rays through an edge that surfaces share, which may be given to either of them. */
unsigned ray_scene_hit_packet(const struct ray_scene *s, const struct vec3 from[RAY_PACKET],
                              const struct vec3 direction[RAY_PACKET], unsigned active, struct ray_hit hit[RAY_PACKET]);
unsigned ray_scene_blocked_packet(const struct ray_scene *s, const struct vec3 from[RAY_PACKET],
                                  const struct vec3 direction[RAY_PACKET], const double t_max[RAY_PACKET],
                                  unsigned active);

#endif
