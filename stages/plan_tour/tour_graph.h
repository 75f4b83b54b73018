/* tour_graph.h - which viewpoints a tour can walk between, and the shortest ways [Colburn 2014, 4.7.1]. */
#ifndef REMODEL_TOUR_GRAPH_H
#define REMODEL_TOUR_GRAPH_H

#include "common/capture/lens_list.h"
#include "common/light/model_rays.h"
#include "common/model/model_axes.h"
#include "stages/plan_tour/tour_params.h"

/* A photograph; its views have one centre. */
struct tour_node {
    const char *photo;  /* owned by the lens list */
    struct vec3 centre; /* model frame */
    struct vec3 axis;   /* of the photo, unit, model frame */
    bool usable;        /* not inside the model, nor nearer to it than the clearance */
    double open;        /* median length of rays from here, model units: how much it sees */
};

struct tour_graph {
    struct tour_node *nodes; /* in order of photo; owned */
    float *weights;          /* count x count; INFINITY: no way; owned */
    int count;
    double unit; /* model units of one step of distance: 1 with a scale, else the median distance to the nearest node */
};

/* Where a tour rests. */
struct tour_stop {
    int node;
    double speed; /* of walking here, in units of the graph per second, > 0 */
    bool passes;  /* the camera does not rest here */
    bool looks;   /* at a place, on the way here and at the stop; otherwise as the photo and the way do */
    struct vec3 look;
};

/* The caller releases the graph in each case. ST_DATA: no viewpoint is usable; warns of those that are not. */
enum status tour_graph_make(struct tour_graph *g, const struct camera_set *set, const struct lens_list *lenses,
                            const struct model_axes *axes, const struct model_rays *model,
                            const struct tour_params *params, struct err *err);
void tour_graph_release(struct tour_graph *g);

/* w = 1 + d + (2 / pi) theta / max(d, 2 / pi): finite for coincident centres, where turning by theta costs as much as
 * walking theta. d in units of the graph, theta in radians. */
double tour_weight(double d, double theta);

/* The shortest way from one node to all others (Dijkstra): costs (INFINITY: none) and the node before each on the
 * way (-1: none). Arrays of g->count. ST_NOMEM. */
enum status tour_shortest(double *costs, int *before, const struct tour_graph *g, int from, struct err *err);

#endif
