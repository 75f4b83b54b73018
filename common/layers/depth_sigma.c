/* depth_sigma.c - uncertainty of depth.
 *
 * The estimator states a standard deviation (stages/segment_depth/depth_deviation.c). Depth of other origin states a
 * tolerance only, sigma, that grows as the confidence falls; about 97 % of the pixels of confident segments are within
 * two of it. The errors are those of a mixture: most depths of any class are right to about half a step of the plane
 * sweep, and the others are far off. A factor per class makes sigma the width of the former, which is also what a
 * comparison with a surface that is known should allow. How many are far off follows from the confidence.
 *
 * The factors are the geometric means of those of two simulated scenes, loft (draft) and still-life: sure 0.29 and
 * 0.53, unsure 0.17 and 0.24, inherited 1.05 and 0.24. The third scene, apartment, took no part. */
#include "common/layers/depth_sigma.h"

static const struct {
    const char *name;
    double factor;
} classes[DEPTH_CLASSES] = {{"inherited", 0.5}, {"unsure", 0.2}, {"sure", 0.39}};

enum depth_class depth_class(double confidence)
{
    return confidence < DEPTH_INHERITED ? DEPTH_CLASS_INHERITED
           : confidence < DEPTH_SURE    ? DEPTH_CLASS_UNSURE
                                        : DEPTH_CLASS_SURE;
}

const char *depth_class_name(enum depth_class c) { return classes[c].name; }

double depth_width(const struct depth_segment *s) { return s->sigma * classes[depth_class(s->confidence)].factor; }

double depth_sigma(const struct depth_segment *s) { return s->deviation > 0 ? s->deviation : depth_width(s); }
