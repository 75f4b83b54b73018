/* light_summary.h - what a gather writes for people beside its numbers: a record of the light (common/gather/
 * light_record.h), pictures of hemicubes, and false-colour pictures of a view's irradiance. */
#ifndef REMODEL_LIGHT_SUMMARY_H
#define REMODEL_LIGHT_SUMMARY_H

#include "common/capture/camera_set.h"
#include "common/gather/light_record.h"
#include "stages/gather_irradiance/gather_job.h"

/* Sums up the points that have a normal. `examples` of them are chosen, by rank of their relative error, evenly from
 * the most to the least; chosen[i] is the index of the i-th, and may be NULL. ST_NOMEM. */
enum status light_summarize(struct light_record *r, size_t chosen[LIGHT_EXAMPLES_MAX],
                            const struct gather_point *points, const struct irradiance *e, size_t count, int examples,
                            struct err *err);

/* Of a list: OUT/NAME.hemicubeN.jpg, then OUT/NAME.light.txt. */
enum status light_summary_of_points(const struct gather_job *j, const char *name, const struct gather_point *points,
                                    const struct irradiance *e, size_t count, struct err *err);

/* Of a picture: OUT/irradiance/VIEW.white.jpg, the view as if all surfaces were white; VIEW.level.jpg, the luminance in
 * false colours; VIEW.unknown.jpg, the share of light that no picture shows; and the above. The chosen points are dots
 * of colour_of_category(N - 1) on the first. */
enum status light_summary_of_view(const struct gather_job *j, const struct view *view,
                                  const struct gather_point *points, const struct irradiance *e, struct err *err);

#endif
