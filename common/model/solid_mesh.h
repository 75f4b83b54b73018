/* solid_mesh.h - closed half-edge polygon meshes of solid bodies: walls, boxes, slabs of glass.
 *
 * Model frame (z up, floor at 0), model units. Every face is planar; its normal points out of the solid; seen from
 * outside its outer loop runs counter-clockwise and its hole loops clockwise: the face is to the left of each of its
 * half-edges.
 *
 * The mesh is 2-manifold as an indexed mesh: each directed edge (origin, origin of the next) occurs once, and its
 * opposite once. Where solids touch in an edge or a point, or a solid touches itself, there are several vertices at the
 * same position. Bodies share no vertices. A face may pass the same vertex twice (a hole that touches the outer loop in
 * a point is part of that loop).
 *
 * A face's name identifies its surface ("wall/south/in"). A surface that another solid divides may be several faces
 * with one name. An id is a name's small number, from 1 (0 means no face in id buffers), unique to the name. */
#ifndef REMODEL_SOLID_MESH_H
#define REMODEL_SOLID_MESH_H

#include <stdbool.h>

#include "common/base/provenance.h"
#include "common/math/vec.h"

struct solid_vertex {
    struct vec3 p;
    int half_edge; /* one that starts here */
};

struct solid_half_edge {
    int origin;           /* vertex */
    int next, prev, twin; /* half-edges */
    int loop;
};

struct solid_loop {
    int half_edge; /* its first */
    int face;
};

struct solid_name {
    char *name; /* owned */
    int id;
};

struct solid_face {
    int name;           /* index into names */
    struct vec3 normal; /* unit, outward: normal . p = offset on the face */
    double offset;
    int loop, loops; /* index of the first loop, the outer one; number of loops, so loops - 1 holes */
    int body;
};

struct solid_body {
    char *name;      /* owned: "walls", "glass/sunny" */
    int face, faces; /* its faces are contiguous */
};

struct solid_mesh {
    struct solid_vertex *vertices; /* all owned */
    struct solid_half_edge *half_edges;
    struct solid_loop *loops;
    struct solid_face *faces;
    struct solid_body *bodies;
    struct solid_name *names; /* in order of id, each used by a face */
    int vertex_count, half_edge_count, loop_count, face_count, body_count, name_count;
};

void solid_mesh_release(struct solid_mesh *mesh);

static inline int solid_face_id(const struct solid_mesh *mesh, int face)
{
    return mesh->names[mesh->faces[face].name].id;
}
static inline const char *solid_face_name(const struct solid_mesh *mesh, int face)
{
    return mesh->names[mesh->faces[face].name].name;
}

/* Whether a face belongs to a pane of glass, a body "glass/...". */
bool solid_face_is_pane(const struct solid_mesh *mesh, int face);
/* The box around a face's outer loop, in coordinates along u and v: from low to high. */
void solid_face_box(const struct solid_mesh *mesh, int face, struct vec3 u, struct vec3 v, double low[2],
                    double high[2]);

/* ------------------------------------------------------------------------------------------------ making a mesh */

/* A polygon from which a mesh is made: loops of vertices, the outer loop first. */
struct solid_polygon {
    const char *name, *body;
    struct vec3 normal;
    double offset;
    const int *corners; /* vertices of all loops, one loop after the other */
    const int *sizes;   /* corners of each loop */
    int loops;
};

/* Makes a mesh from polygons; the polygons of a body are contiguous. Ids are 1, 2, ... in the order in which names
 * first occur. mesh is empty on entry and after a failure; the caller releases it. faulty may be NULL; otherwise
 * *faulty is the polygon that an error is about, -1 if none. ST_DATA: an edge without its opposite or twice, a loop of
 * fewer than 3 corners, an unused vertex, a vertex shared by several fans of faces, bodies that share a vertex, numbers
 * that are not finite; the message names the polygon, counted from 1. */
enum status solid_mesh_make(struct solid_mesh *mesh, const struct vec3 *vertices, int vertex_count,
                            const struct solid_polygon *polygons, int count, int *faulty, struct err *err);

/* Gives ids[i] to names[i], all different and above 0, and sorts names by id. */
enum status solid_mesh_set_ids(struct solid_mesh *mesh, const int *ids, struct err *err);

/* Gives names the ids that they have in `base`; new names get the ids after base's largest, in the order of their
 * present ids. Sorts names by id. */
enum status solid_mesh_carry_ids(struct solid_mesh *mesh, const struct solid_mesh *base, struct err *err);

/* --------------------------------------------------------------------------------------------------------- checks */

/* A shell: faces connected through edges. */
struct solid_shell {
    int body, vertices, edges, faces, loops;
    int euler;     /* vertices - edges + 2 faces - loops: 2 - 2 genus */
    int genus;     /* through-holes: 1 for a wall with a window */
    double volume; /* negative for the inner surface of a cavity */
};

struct solid_report {
    struct solid_shell *shells; /* owned */
    int count;
    double volume, area;  /* of all bodies */
    double planarity;     /* max distance of a vertex from the plane of one of its faces */
    double shortest_edge; /* 0 without edges */
};

/* Checks a mesh: indices are consistent, edges paired, vertices have one fan each, each shell has an even Euler
 * characteristic of at most 2, faces are planar to `tolerance` (model units; 0: 1e-6) with loops oriented about the
 * outward normal, bodies have a volume above 0 and do not intersect themselves: no two faces of a body cross or overlap
 * (they may touch in edges and points). ST_DATA names the first fault. The report, if not NULL, is filled as far as the
 * checks got; the caller releases it in either case. */
enum status solid_mesh_check(const struct solid_mesh *mesh, double tolerance, struct solid_report *report,
                             struct err *err);
void solid_report_release(struct solid_report *report);

double solid_mesh_volume(const struct solid_mesh *mesh, int body); /* body -1: all */
double solid_mesh_area(const struct solid_mesh *mesh, int face);
double solid_mesh_loop_area(const struct solid_mesh *mesh, int loop); /* negative for a hole */

/* -------------------------------------------------------------------------------------------------- triangulation */

struct solid_triangle {
    int v[3]; /* vertices, counter-clockwise seen from outside */
    int face;
};

struct solid_triangles {
    struct solid_triangle *triangles; /* owned; those of a face are contiguous, faces in order */
    int count;
    int *first; /* owned: face f has triangles first[f] .. first[f + 1] - 1 */
};

/* Triangulates the faces by ear clipping. Every vertex of a loop is a corner of triangles, so that the triangles of a
 * closed mesh are closed too. No triangle has zero area, except between corners of oblique faces that are closer than
 * the rounding of doubles. triangles is empty on entry and after a failure; the caller releases it. */
enum status solid_mesh_triangulate(struct solid_triangles *triangles, const struct solid_mesh *mesh, struct err *err);
void solid_triangles_release(struct solid_triangles *triangles);

/* ---------------------------------------------------------------------------------------------------------- files */

/* model.txt (docs/formats.md). prov may be NULL. Reading restores the same bits and checks what solid_mesh_make()
 * checks; a failure leaves mesh empty. */
enum status solid_mesh_write(const struct solid_mesh *mesh, const char *path, const struct provenance *prov,
                             struct err *err);
enum status solid_mesh_read(struct solid_mesh *mesh, const char *path, struct provenance *prov, struct err *err);

#endif
