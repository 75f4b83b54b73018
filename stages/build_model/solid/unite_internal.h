/* unite_internal.h - what the files that unite solids share: the half-edges, loops and faces of a body. */
#ifndef REMODEL_BUILD_MODEL_UNITE_INTERNAL_H
#define REMODEL_BUILD_MODEL_UNITE_INTERNAL_H

#include "stages/build_model/solid/borders.h"
#include "stages/build_model/solid/unite_names.h"

#include "stages/build_model/solid/unite_names.h"

struct half {
    int border, from;     /* point where it begins; -1: in the middle of an edge, at `middle` */
    int next, prev, twin; /* twin -1: removed */
    int vertex, loop;
    double middle[3];
};

struct union_loop {
    int half; /* one of its half-edges that is not removed */
    int face; /* -1: unknown yet */
    bool hole;
    double area; /* of the projection along the axis of the normal's largest component */
};

struct union_face {
    int plane, side, name; /* name: the lowest rank */
    int loop, holes;       /* outer loop, number of holes */
};

struct body_union { /* the body being united */
    struct convex_set set;
    struct border_set borders;
    struct half *halves; /* all owned */
    struct union_loop *loops;
    struct union_face *faces;
    int half_count, half_capacity, loop_count, loop_capacity, face_count, face_capacity;
    int vertex_count;
};

/* unite_edges.c; s: a solid of the body, for messages */

/* ST_INTERNAL: the surface of the solid's body does not close. */
enum status unite_broken(const struct solid *s, const char *what, struct err *err);
void unite_half_direction(const struct body_union *j, int half, int64_t d[3]);
void unite_half_outward(const struct body_union *j, int half, int64_t n[3]); /* the outward normal of its face */
void unite_half_position(const struct body_union *j, int half,
                         double p[3]); /* where it begins, in steps of the lattice */
void unite_negated(const int64_t a[3], int64_t out[3]);
enum status unite_add_half(struct body_union *j, int border, int from, struct err *err);
/* Cuts the borders at each other's ends, and pairs the half-edges around each edge. */
enum status unite_make_halves(struct body_union *j, const struct solid *s, struct err *err);
/* Links the half-edges to loops. */
enum status unite_link_halves(struct body_union *j, const struct solid *s, struct err *err);
/* Finds the fans of faces, and removes vertices in the middle of an edge. */
void unite_make_vertices(struct body_union *j);

/* unite_faces.c */

bool unite_position_in_loop(const struct body_union *j, const double p[3], int loop);
/* Sorts loops into faces with their holes, and names the faces. */
enum status unite_make_faces(struct body_union *j, const int *loop_of_border, struct merges *merges,
                             const struct name_table *names, const struct solid *s, struct err *err);

/* unite_split.c */

/* Splits edges in the middle where several join the same two vertices, or cross a third face. */
enum status unite_split_edges(struct body_union *j, struct err *err);

#endif
