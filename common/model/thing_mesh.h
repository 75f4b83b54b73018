/* thing_mesh.h - the surface of a thing as triangles. See thing_mesh.c. */
#ifndef REMODEL_THING_MESH_H
#define REMODEL_THING_MESH_H

#include "common/model/thing_volume.h"

/* {0} is the empty state; everything is owned. */
struct thing_mesh {
    struct vec3 *vertices; /* model frame */
    int vertex_count;
    int (*triangles)[3]; /* counter-clockwise seen from outside */
    int triangle_count;
};

/* The surface of the thing `id`: open where no view shows it. The caller releases m in each case. ST_NOMEM. */
enum status thing_mesh_make(struct thing_mesh *m, const struct thing_volume *v, uint32_t id, struct err *err);
void thing_mesh_release(struct thing_mesh *m);

#endif
