/* indirect.h - indirect irradiance at annotated points: all light but that of the lamps.
 *
 * It is needed at nodes: each lit and unlit point, and a few points of each line, between which it is interpolated. */
#ifndef REMODEL_FIT_LIGHTS_INDIRECT_H
#define REMODEL_FIT_LIGHTS_INDIRECT_H

#include "common/gather/gatherer.h"
#include "stages/fit_lights/lit_scene.h"

/* {0} is the empty state. */
struct indirect {
    int *nodes; /* indices of points; owned */
    int count;
    double (*at)[3]; /* of each point of the scene; owned */
};

enum status indirect_init(struct indirect *in, const struct lit_scene *scene, struct err *err);
void indirect_release(struct indirect *in);

/* Writes the nodes as `X Y Z NX NY NZ`, in the frame of the views. */
enum status indirect_list(const struct indirect *in, const struct lit_scene *scene, const struct model_axes *axes,
                          const char *path, const struct provenance *prov, struct err *err);
/* Reads `X Y Z NX NY NZ R G B` for the same nodes in the same order. ST_DATA with file and line: another point, a
 * negative irradiance, too few or too many lines. */
enum status indirect_read(struct indirect *in, const struct lit_scene *scene, const struct model_axes *axes,
                          const char *path, struct provenance *prov, struct err *err);
/* Gathers it from a field of light in which the lamps are off. Same bits for any number of threads. */
void indirect_gather(struct indirect *in, const struct lit_scene *scene, const struct light_field *field,
                     const struct gatherer *gatherer);
/* Sets the irradiance of node k. */
void indirect_set(struct indirect *in, int k, struct rgb irradiance);
/* Interpolates between the nodes of lines; after all nodes are set. */
void indirect_spread(struct indirect *in, const struct lit_scene *scene);

#endif
