/* calibrate_params.h - parameters of calibrate_light. */
#ifndef REMODEL_CALIBRATE_PARAMS_H
#define REMODEL_CALIBRATE_PARAMS_H

#include "common/gather/gatherer.h"

/* name, type, default, min, max, unit, help */
#define CALIBRATE_PARAMS(X)                                                                                     \
    X(constant, double, 120, 1, 10000, "",                                                                      \
      "luminance (cd/m2) of white times its exposure, seconds x ISO / (f-number^2 x filter); 120 by ISO 12232") \
    X(stops, double, 1, 0, 10, "stops",                                                                         \
      "half width of the 95 % interval of a scale that follows from exposures alone")                           \
    X(meter_error, double, 0.05, 0, 1, "",                                                                      \
      "95 % error of a measurement, as a part of it, where its line in lux.txt states none (within)")           \
    X(irradiance_error, double, 0.09, 0, 1, "",                                                                 \
      "relative standard error of gathered irradiance beside that of its rays")                                 \
    X(luminance_error, double, 0.05, 0, 1, "", "relative standard error of a photographed luminance")           \
    X(common_error, double, 0.05, 0, 1, "", "relative standard error that all measurements of a scene share")   \
    X(off, double, 3, 1, 100, "", "deviation, in standard errors, beyond which a measurement is named as off")

struct calibrate_params {
    CALIBRATE_PARAMS(PARAM_FIELD)
    GATHER_PARAMS(PARAM_FIELD)
};
#define CALIBRATE_PARAMS_DEFAULT        \
    {                                   \
        CALIBRATE_PARAMS(PARAM_DEFAULT) \
        GATHER_PARAMS(PARAM_DEFAULT)    \
    }

#endif
