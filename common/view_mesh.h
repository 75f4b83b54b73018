/* view_mesh.h - which views a ray of a novel camera blends, and with what weights (thesis 3.6).
 *
 * A triangle mesh with its vertices at the views' centres: Delaunay in the plane fitted to them, boundary vertices
 * duplicated at 4.0 times their offset from the centroid. A pixel's ray, forward or (novel camera in front of the mesh)
 * backward, hits one triangle: three views and their barycentric weights. A ray that hits none takes the nearest
 * point's weights. Near the mesh, where its projection is singular, the weights of the nearest mesh point hold for the whole
 * picture, faded in over a band. Fewer than three views, collinear and coincident centres work. */
#ifndef REMODEL_VIEW_MESH_H
#define REMODEL_VIEW_MESH_H

#include "camera_set.h"

struct view_weights { /* of one pixel: up to 3 + 3 while the near-mesh weights fade in; equal views merged; weights sum to 1 */
    int count;
    int view[6]; /* into the camera set, ascending */
    float weight[6];
};

struct view_mesh {
    struct vec3 *vertices; /* the views' centres, then the duplicates */
    int *vertex_view;      /* the view each vertex stands for */
    int (*triangles)[3];
    int vertex_count, triangle_count, view_count;
    struct vec3 centroid, normal; /* of the fitted plane; the normal points towards the scene (mean viewing direction) */
    struct vec3 axis_x, axis_y;   /* with the normal a right-handed frame; axis_x along the largest spread */
    int rank;                     /* of the centres' spread: 0 coincident, 1 collinear, 2 a plane */
    double spacing;               /* median distance to the nearest other centre; 0 if coincident */
};

enum status view_mesh_build(struct view_mesh *mesh, const struct camera_set *set, struct err *err);
void view_mesh_release(struct view_mesh *mesh);

/* A novel camera's weights; make once a frame, read-only afterwards, so rows may run in parallel. */
struct view_mesh_camera {
    const struct view_mesh *mesh;
    struct view camera;
    struct view_weights nearest; /* of the mesh point nearest to the camera's centre */
    double fade;                 /* 1: nearest holds for the whole picture; 0: per pixel */
};
void view_mesh_prepare(struct view_mesh_camera *mc, const struct view_mesh *mesh, const struct view *novel);
/* weights[0..width): of row y. */
void view_mesh_row(const struct view_mesh_camera *mc, int y, struct view_weights *weights);

#endif
