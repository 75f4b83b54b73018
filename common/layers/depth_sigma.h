/* depth_sigma.h - the uncertainty that a segment's depth has, by what the estimator states of it. */
#ifndef REMODEL_DEPTH_SIGMA_H
#define REMODEL_DEPTH_SIGMA_H

#include "common/layers/layered_depth.h"

enum depth_class {                        /* of a segment's confidence */
                   DEPTH_CLASS_INHERITED, /* below DEPTH_INHERITED */
                   DEPTH_CLASS_UNSURE,    /* below DEPTH_SURE */
                   DEPTH_CLASS_SURE,
                   DEPTH_CLASSES
};
#define DEPTH_SURE 0.5

enum depth_class depth_class(double confidence);
const char *depth_class_name(enum depth_class c); /* "inherited", "unsure", "sure" */

/* Standard deviation of the relative error of the segment's inverse depth, (1/z - 1/z_true) z: what the estimator
 * states, or else depth_width(). */
double depth_sigma(const struct depth_segment *s);
/* The same of the depths of the segment's class that are right: sigma times the factor that was calibrated for the
 * class. */
double depth_width(const struct depth_segment *s);

#endif
