/* trace_params.h - parameters of trace_ids. */
#ifndef REMODEL_TRACE_PARAMS_H
#define REMODEL_TRACE_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define TRACE_PARAMS(X)                                                                                               \
    X(jump, double, 0.01, 1e-6, 1, "", "minimum difference of inverse depths, relative to them, that is a jump")      \
    X(depth_tolerance, double, 0.03, 0, 1, "",                                                                        \
      "difference of depths, relative to them, that the model and the cameras may have without clutter")              \
    X(depth_sigmas, double, 2, 0, 100, "",                                                                            \
      "difference of depths that they may have beside that, in standard deviations of the view's depth")              \
    X(max_depth_error, double, 0.1, 0, 1, "",                                                                         \
      "standard deviation of depth, relative to it, above which a depth does not show that a surface is clean")       \
    X(furniture, double, 0.037, 0, 1, "",                                                                             \
      "depth of the flattest furniture that a view must tell from a surface to show it clean, of the model's height") \
    X(min_confidence, double, 0.1, 0, 1, "",                                                                          \
      "confidence of a segment of the view's depth below which what it says of clutter counts half")                  \
    X(min_clutter, int, 1, 0, 100, "px", "half width of the narrowest clutter; narrower spots count as unsure")       \
    X(clutter_margin, int, 6, 0, 100, "px", "width of the rim around clutter that counts as clutter")                 \
    X(clean_margin, int, 5, 0, 32, "px", "distance from depth jumps at which a pixel of a face counts as clean")      \
    X(index_views, int, 256, 1, 100000, "", "maximum number of views that the index lists for a face")

struct trace_params {
    TRACE_PARAMS(PARAM_FIELD)
};
#define TRACE_PARAMS_DEFAULT        \
    {                               \
        TRACE_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param trace_param_table[];

#endif
