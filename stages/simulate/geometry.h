/* geometry.h - the faces of a described scene, and the triangles and disks that rays are traced against.
 *
 * Each planar piece of an item is a face with a name ("wall.left", "box.top"; the item's own name if it has only one)
 * and an id, counted from 1 in file order; a mesh is one face. A face of an edited scene has the id of the base's
 * face of that name; the ids of names that the base does not have follow the base's last. Faces are visible from both
 * sides. Normals point out of solids, into rooms, along U x V for quads, and in the direction in which a lamp
 * shines. */
#ifndef REMODEL_SIMULATE_GEOMETRY_H
#define REMODEL_SIMULATE_GEOMETRY_H

#include <stdbool.h>

#include "common/light/ray_scene.h"
#include "stages/simulate/scene_file.h"

struct scene_face {
    char *name;
    uint32_t id;              /* from 1 */
    int item;                 /* index of its item */
    int material;             /* -1: a lamp */
    struct vec3 origin, u, v; /* texture coordinates are measured from the origin along the unit vectors u and v */
    struct vec3 normal;       /* of a mesh: the mean */
    double area;              /* m^2 */
    uint32_t seed; /* of its texture: a hash of the name, so that edits elsewhere in the scene do not change it */
    bool mesh;
};

struct scene_geometry {
    struct scene_face *faces;
    int face_count;
    int *lamp_faces;       /* for each item: the index of its face if it is a lamp, else -1 */
    struct ray_scene rays; /* ids are indices of faces */
    struct ray_scene bare; /* the same without furniture; empty if the scene has none */
    bool has_furniture;
};

/* Builds the faces and adds them to g->rays, which the caller commits before tracing. The scene must outlive the
 * geometry. On failure nothing has to be released. */
enum status geometry_init(struct scene_geometry *g, const struct scene *s, struct err *err);
/* Gives the faces of an edit the ids that they have in FOLDER/BASE. */
enum status geometry_keep_ids(struct scene_geometry *g, const char *folder, const char *base, struct err *err);
enum status geometry_commit(struct scene_geometry *g, struct err *err);
void geometry_release(struct scene_geometry *g);

/* What a camera's rays meet: everything, or with `shell` what is left without the furniture. */
static inline const struct ray_scene *geometry_seen(const struct scene_geometry *g, bool shell)
{
    return shell && g->has_furniture ? &g->bare : &g->rays;
}

/* Texture coordinates (m) of a point on a face. */
void geometry_texture_coordinates(const struct scene_face *f, const struct ray_hit *hit, double *u, double *v);

/* The centre line of a wall: unit direction, unit normal to its left, length. */
void geometry_wall_axes(const struct scene_item *wall, struct vec3 *along, struct vec3 *left, double *length);

#endif
