/* overlay_edges.h - the edges of a model as a photograph shows them: dots along them, visible or hidden. */
#ifndef REMODEL_OVERLAY_EDGES_H
#define REMODEL_OVERLAY_EDGES_H

#include "common/capture/photo_camera.h"
#include "common/model/solid_mesh.h"

struct overlay_edges {
    const struct photo_camera *camera;
    double scale;         /* of the picture that is drawn on: its pixels per pixel of the stored photo */
    double width, height; /* of that picture */
    double apart;         /* dots are at least that far from each other, in its pixels */
    int steps;            /* places that are tried along an edge */
};

struct overlay_dot {
    double u, v;      /* in the picture */
    bool seen, glass; /* the model does not hide it; it belongs to a pane */
    int half_edge;    /* of the mesh; the dots of an edge follow each other */
};

/* Calls dot() for each place on an edge that lies in the picture. */
enum status overlay_edges_trace(const struct solid_mesh *mesh, const struct overlay_edges *how,
                                void (*dot)(void *ctx, const struct overlay_dot *dot), void *ctx, struct err *err);

#endif
