/* face_nets.h - samples on the faces of a model, and the interpolation between them: a Delaunay triangulation of the
 * samples of each face [Colburn 2014, 5.5]. */
#ifndef REMODEL_FACE_NETS_H
#define REMODEL_FACE_NETS_H

#include "common/model/solid_mesh.h"

struct net_sample {
    int face; /* index into the mesh */
    struct vec3 at;
};

/* The samples of a face. */
struct face_net {
    struct vec3 u, v;                    /* unit: a point p has the coordinates (u . p, v . p) */
    int *samples, count;                 /* indices into the list; owned */
    double (*at)[2];                     /* their coordinates; owned */
    int (*triangles)[3], triangle_count; /* places in `samples`; owned */
    int (*beside)[3];                    /* the triangle across the side that begins at the corner; -1: none; owned */
    int *hints, hint_width, hint_height; /* a triangle near the middle of each cell; owned */
    double low[2];
};

/* {0} is the empty state; everything but the mesh is owned. */
struct face_nets {
    const struct solid_mesh *mesh;
    struct face_net *nets; /* of each face */
    struct net_sample *samples;
    int sample_count;
    double spacing; /* of the first samples, model units */
};

/* Spreads samples over all faces for which wanted[face] is set: a lattice, and points close to the edges. The caller
 * releases the nets in each case. */
enum status face_nets_make(struct face_nets *n, const struct solid_mesh *mesh, const bool *wanted, double spacing,
                           struct err *err);
void face_nets_release(struct face_nets *n);

/* Adds a sample; face_nets_connect() must follow before the next look-up. */
enum status face_nets_add(struct face_nets *n, int face, struct vec3 at, struct err *err);
/* Triangulates the samples of each face anew. */
enum status face_nets_connect(struct face_nets *n, struct err *err);

/* What a point takes from each sample; weights are not below 0 and sum to 1. */
struct net_weights {
    int sample[3];
    double weight[3];
};
/* Beyond the outermost samples the nearest side's values hold. False: the face has no sample. */
bool face_nets_find(const struct face_nets *n, int face, struct vec3 p, struct net_weights *w);

#endif
