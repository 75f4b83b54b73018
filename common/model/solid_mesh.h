/* solid_mesh.h - closed half-edge polygon meshes of solid bodies: walls, boxes, slabs of glass.
 *
 * Model frame (z up, floor at 0), model units. Every face is plane; its normal points out of the solid; seen from
 * outside its outer loop runs counter-clockwise and its hole loops clockwise: the face is to the left of each of its
 * half-edges.
 *
 * The mesh is 2-manifold as an indexed mesh: each directed edge (origin, origin of the next) occurs once, and its
 * opposite once. Where solids touch in an edge or a point, or a solid touches itself, vertices stand there more than
 * once. Bodies share no vertices. A face may come by the same vertex twice (a hole that reaches the outer loop in a
 * point is part of that loop).
 *
 * A face's name says which surface it is ("wall/south/in"). A surface that something stands against may be several
 * faces of one name. An id is a name's small number, from 1 (0 means no face in id buffers), unique to the name. */
#ifndef REMODEL_SOLID_MESH_H
#define REMODEL_SOLID_MESH_H

#include "common/base/provenance.h"
#include "common/math/vec.h"

struct solid_vertex {
    struct vec3 p;
    int half_edge; /* one that begins here */
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
    int loop, loops; /* first loop, the outer one, and how many there are: loops - 1 holes */
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
    struct solid_name *names; /* in the order of ids, each used by a face */
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

/* ------------------------------------------------------------------------------------------------ making a mesh */

/* A polygon of a mesh to be made: loops of vertices, the outer loop first. */
struct solid_polygon {
    const char *name, *body;
    struct vec3 normal;
    double offset;
    const int *corners; /* vertices of all loops, one loop after the other */
    const int *sizes;   /* corners of each loop */
    int loops;
};

/* Half-edges, twins, names and bodies from polygons; polygons of one body follow each other. Ids are 1, 2, ... in the
 * order in which names first occur. mesh is empty on entry. ST_DATA: an edge without its opposite or twice, a loop of
 * fewer than 3 corners, an unused vertex, a vertex in which more than one fan of faces meets, bodies that share a
 * vertex, numbers that are not finite; the sentence names the polygon, counted from 1. */
enum status solid_mesh_make(struct solid_mesh *mesh, const struct vec3 *vertices, int vertex_count,
                            const struct solid_polygon *polygons, int count, struct err *err);

/* The same; *wrong is the polygon that an error is about, or -1 if it is about none. */
enum status solid_mesh_make_saying(struct solid_mesh *mesh, const struct vec3 *vertices, int vertex_count,
                                   const struct solid_polygon *polygons, int count, int *wrong, struct err *err);

/* Gives ids to names, ids[i] to names[i], all different and above 0; puts names in the order of ids. */
enum status solid_mesh_set_ids(struct solid_mesh *mesh, const int *ids, struct err *err);

/* An edited mesh keeps the ids that `base` has for the same names; new names get the ids after the largest of base, in
 * the order of their present ids. Names are put into the order of ids again. */
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
    double planarity;     /* greatest distance of a vertex from the plane of a face of its own */
    double shortest_edge; /* 0 without edges */
};

/* Whether the mesh is what it must be: indices whole, edges paired, closed, vertices with one fan each, Euler
 * characteristic even and at most 2 for each shell, faces plane to `tolerance` (model units; 0: 1e-6) with loops that
 * turn the right way around the outward normal, a body's volume above 0, no self-intersection: no two faces of a body
 * cross or cover each other (they may touch in edges and points). ST_DATA with a sentence about the first fault; the
 * report, if not NULL, is filled as far as it could be and is released by the caller in either case. */
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

/* Each face's polygon with holes, by ear clipping. Every vertex on a loop is a corner, so that the triangles of a
 * closed mesh are closed as well. None has zero area, but between corners of oblique faces that are so near each other
 * that doubles do not tell them apart. */
enum status solid_mesh_triangulate(struct solid_triangles *triangles, const struct solid_mesh *mesh, struct err *err);
void solid_triangles_release(struct solid_triangles *triangles);

/* ---------------------------------------------------------------------------------------------------------- files */

/* OBJ for other programs: an object a body, a group a face name, triangles with the normals of their faces. prov may be
 * NULL. */
enum status solid_mesh_write_obj(const struct solid_mesh *mesh, const char *path, const struct provenance *prov,
                                 struct err *err);

/* model.txt (docs/formats.md). prov may be NULL. Reading gives back the same bits, and checks what solid_mesh_make()
 * checks. */
enum status solid_mesh_write(const struct solid_mesh *mesh, const char *path, const struct provenance *prov,
                             struct err *err);
enum status solid_mesh_read(struct solid_mesh *mesh, const char *path, struct err *err);

#endif
