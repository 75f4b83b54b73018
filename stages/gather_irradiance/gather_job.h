/* gather_job.h - what a run of gather_irradiance works with. */
#ifndef REMODEL_GATHER_JOB_H
#define REMODEL_GATHER_JOB_H

#include "common/gather/gatherer.h"
#include "common/gather/model_field.h"
#include "common/model/model_axes.h"
#include "common/relight/light_things.h"

/* {0} is the empty state, but for the parameters; everything but `out` is owned. */
struct gather_job {
    const char *out;
    struct gather_params params;
    struct provenance prov;
    struct model_field field;
    struct model_axes axes;
    struct thing_surfaces things;
    struct field_surfaces furniture; /* of things, which must outlive the field */
    struct gatherer *gatherer;
    int hemicubes; /* points whose hemicube is drawn */
};

void gather_job_release(struct gather_job *j);

/* Sets results[i] for the points with a normal; the others, whose normal is 0 0 0, get 0. Points that lie in a solid
 * just below its surface are moved to it. Shows progress, in `unit`; says at the end what the light came from, and how
 * well it is known. Same bits for any number of threads. ST_NOMEM. */
enum status gather_all(struct irradiance *results, struct gather_point *points, size_t count,
                       const struct gather_job *j, const char *what, struct err *err);

/* The same for a picture or another grid of width x height points, neighbours of which are mostly close to each other:
 * by the cache of irradiance, if the estimator is that or `auto`. */
enum status gather_grid(struct irradiance *results, struct gather_point *points, int width, int height,
                        const struct gather_job *j, const char *what, struct err *err);

#endif
