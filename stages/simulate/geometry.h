/* geometry.h - the faces of a scene, as triangles that rays can be traced against (Embree).
 *
 * Every planar piece of an item is a face with a name ("wall.left", "box.top"; the item's own name where it has but one)
 * and an id from 1 in file order; a mesh is one face. Faces are seen from both sides; their normals point out of solids,
 * into rooms, along U x V for quads, and where a lamp shines. */
#ifndef REMODEL_SIMULATE_GEOMETRY_H
#define REMODEL_SIMULATE_GEOMETRY_H

#include <embree3/rtcore.h>
#include <stdbool.h>

#include "stages/simulate/scene_file.h"

struct face {
    char *name;
    int item;                 /* that it belongs to */
    int material;             /* -1: a lamp */
    struct vec3 origin, u, v; /* texture coordinates are along the unit vectors u, v from the origin */
    struct vec3 normal;       /* of a mesh: the mean */
    double area;
    uint32_t seed; /* of its texture: by its name, so that it stays when the scene is edited elsewhere */
    bool mesh;
};

struct triangle {
    struct vec3 corner[3], normal; /* unit */
    int face;
};

struct geometry {
    struct face *faces;
    struct triangle *triangles;
    int face_count, triangle_count;
    int *lamp_faces;   /* of an item: its face if it is a lamp, else -1 */
    struct disk_face { /* round lamps: for Embree squares, outside the radius of which rays go on */
        struct vec3 centre;
        double radius;
        int face;
    } * disks;
    int disk_count;
    double epsilon; /* m: how far off a surface rays begin, so that they do not meet it again */
    RTCDevice device;
    RTCScene scene;
};

struct hit {
    struct vec3 point, normal; /* the normal of the side that was hit */
    double t;
    int face; /* index; -1: nothing */
    bool front;
};

/* The faces alone; enough to list them. The scene must outlive the geometry. */
enum status geometry_init(struct geometry *g, const struct scene *s, struct err *err);
/* Prepares for tracing. */
enum status geometry_commit(struct geometry *g, struct err *err);
void geometry_release(struct geometry *g);

/* The nearest surface in a unit direction. */
bool geometry_hit(const struct geometry *g, struct vec3 from, struct vec3 direction, struct hit *hit);
/* Whether anything stands between a point and another one `distance` away. */
bool geometry_blocked(const struct geometry *g, struct vec3 from, struct vec3 direction, double distance);

/* Where the texture of a face is looked up for a point on it. */
void geometry_texture_place(const struct face *f, const struct hit *hit, double *u, double *v);

/* A wall's centre line: unit direction, unit normal to the left of it, length. */
void wall_axes(const struct item *wall, struct vec3 *along, struct vec3 *left, double *length);

#endif
