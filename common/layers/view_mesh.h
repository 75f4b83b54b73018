/* view_mesh.h - which views a ray of a novel camera blends, and with what weights (thesis 3.6).
 *
 * A triangle mesh with its vertices at the views' centres: Delaunay in the plane fitted to them, boundary vertices
 * duplicated at 4.0 times their offset from the centroid. A pixel's ray, forward or (novel camera in front of the
 * mesh) backward, hits one triangle: three views and their barycentric weights. A ray that hits none takes the
 * weights of the boundary point in its direction. Near the mesh, where its projection is singular, the weights of the
 * nearest mesh point hold for the whole picture, faded in over a band. Fewer than three views, collinear and
 * coincident centres work.
 *
 * Views with the same centre (a tripod, a photo that became several views) share a vertex; its weight goes to those
 * of them whose pictures contain the ray best. */
#ifndef REMODEL_VIEW_MESH_H
#define REMODEL_VIEW_MESH_H

#include <stdbool.h>

#include "common/capture/camera_set.h"

#define VIEW_WEIGHTS_MAX 6

/* Of one pixel: up to 3 + 3 while the near-mesh weights fade in; equal views merged; weights sum to 1. */
struct view_weights {
    int count;
    int view[VIEW_WEIGHTS_MAX]; /* into the camera set, ascending */
    float weight[VIEW_WEIGHTS_MAX];
};

struct view_mesh {
    const struct camera_set *set; /* not owned; outlives the mesh */
    struct vec3 *vertices;        /* the views' centres, then the duplicates */
    int *vertex_view;             /* the view each vertex stands for; of views with the same centre, the first */
    int (*triangles)[3];          /* counter-clockwise in (axis_x, axis_y) */
    int (*rim)[2];                /* the edges of the outer boundary, counter-clockwise */
    int *next_same;               /* a view: the next view with the same centre, in a ring; itself if there is none */
    int vertex_count, triangle_count, rim_count, view_count;
    bool shared;                /* some vertex stands for several views */
    struct vec3 centroid;       /* of the centres */
    struct vec3 normal;         /* of the fitted plane; points towards the scene (mean viewing direction) */
    struct vec3 axis_x, axis_y; /* with the normal a right-handed frame; axis_x along the largest spread */
    int rank;                   /* of the centres' spread: 0 coincident, 1 collinear, 2 a plane */
    double spacing;             /* median distance to the nearest other centre; 0 if coincident */
};

enum status view_mesh_build(struct view_mesh *mesh, const struct camera_set *set, struct err *err);
void view_mesh_release(struct view_mesh *mesh);

/* A novel camera's weights; make once a frame, read-only afterwards, so rows may run in parallel. */
struct view_mesh_camera {
    const struct view_mesh *mesh;
    struct view camera;
    struct view_weights nearest; /* of the mesh point nearest to the camera's centre, along the normal */
    double height; /* of the camera's centre above that point, along the normal: > 0 is in front of the mesh */
    double fade;   /* 1: nearest holds for the whole picture; 0: per pixel */
};
void view_mesh_prepare(struct view_mesh_camera *mc, const struct view_mesh *mesh, const struct view *novel);
/* weights[0..width): of row y. */
void view_mesh_row(const struct view_mesh_camera *mc, int y, struct view_weights *weights);

#endif
