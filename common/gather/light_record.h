/* light_record.h - NAME.light.txt: what the light of a gather came from, how well it is known, and the points whose
 * hemicubes have pictures. Written by gather_irradiance beside NAME.txt or NAME.exr, for people and for the report. */
#ifndef REMODEL_LIGHT_RECORD_H
#define REMODEL_LIGHT_RECORD_H

#include "common/base/provenance.h"
#include "common/gather/irradiance.h"

enum { LIGHT_EXAMPLES_MAX = 9 };

/* A point with a picture of what it sees, NAME.hemicubeN.jpg. */
struct light_example {
    struct gather_point point; /* model frame */
    struct rgb value;          /* irradiance */
    double error;              /* standard error of its luminance, as a fraction */
};

struct light_record {
    int points, dark;           /* number of points; of those that no light reaches */
    double error[3];            /* relative error of the luminance by the gather's own estimate: median, 95 %, most */
    double from[LIGHT_SOURCES]; /* mean share of the light from each source; they sum to 1, or are 0 in the dark */
    double level[2];            /* of a picture: luminance of irradiance at the ends of its colours; 0 0: no picture */
    struct light_example examples[LIGHT_EXAMPLES_MAX];
    int example_count;
};

enum status light_record_write(const struct light_record *r, const char *path, const struct provenance *prov,
                               struct err *err);
/* ST_DATA with file and line: a damaged line, a number out of range. */
enum status light_record_read(struct light_record *r, const char *path, struct err *err);

#endif
