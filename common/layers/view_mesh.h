/* view_mesh.h - the view mesh: which views a ray of a novel camera blends, and their weights [Colburn 2014, 3.6].
 *
 * Fewer than three views, collinear and coincident centres are supported. See view_mesh.c. */
#ifndef REMODEL_VIEW_MESH_H
#define REMODEL_VIEW_MESH_H

#include <stdbool.h>

#include "common/capture/camera_set.h"

#define VIEW_WEIGHTS_MAX 6

/* Blending weights of one pixel, which sum to 1. A view occurs once. There are up to 3 + 3 views while the weights of
 * the nearest mesh point fade in. */
struct view_weights {
    int count;
    int view[VIEW_WEIGHTS_MAX]; /* into the camera set, ascending */
    float weight[VIEW_WEIGHTS_MAX];
};

struct view_mesh {
    const struct camera_set *set; /* not owned; outlives the mesh */
    struct vec3 *vertices;        /* the views' centres, then the duplicates */
    int *vertex_view;             /* the view of each vertex; the first of the views with the same centre */
    int (*triangles)[3];          /* counter-clockwise in (axis_x, axis_y) */
    int (*rim)[2];                /* edges of the boundary, counter-clockwise */
    int *next_same;               /* of each view: the next view with the same centre, in a ring; itself if alone */
    int vertex_count, triangle_count, rim_count, view_count;
    bool shared;                /* some vertex has several views */
    struct vec3 centroid;       /* of the centres */
    struct vec3 normal;         /* of the fitted plane; points towards the scene (mean viewing direction) */
    struct vec3 axis_x, axis_y; /* a right-handed frame with the normal; axis_x along the largest spread */
    int rank;                   /* of the spread of the centres: 0 coincident, 1 collinear, 2 planar */
    double spacing;             /* median distance between nearest centres; 0 if coincident */
};

/* ST_DATA: no view. The set must outlive the mesh. */
enum status view_mesh_build(struct view_mesh *mesh, const struct camera_set *set, struct err *err);
void view_mesh_release(struct view_mesh *mesh);

/* The mesh seen from a novel camera: prepared once a frame, read-only afterwards, so rows may run in parallel. */
struct view_mesh_camera {
    const struct view_mesh *mesh;
    struct view camera;
    struct view_weights nearest; /* weights of the mesh point nearest to the camera's centre, along the normal */
    double height; /* of the camera's centre above that point, along the normal; > 0: in front of the mesh */
    double fade;   /* weight of `nearest` in every pixel: 1 near the mesh, 0 away from it */
};
void view_mesh_prepare(struct view_mesh_camera *mc, const struct view_mesh *mesh, const struct view *novel);
/* Fills weights[0 .. width) of row y. */
void view_mesh_row(const struct view_mesh_camera *mc, int y, struct view_weights *weights);

#endif
