/* gloss.h - materials as the words of text files, in the models of brdf.h: gloss alone, on top of a face's texture
 * (`matt`, `phong KS N`, `ward KS ALPHA`), or with a colour (`matt R G B`, `phong R G B KS N`, `ward R G B KS ALPHA`).
 *
 * R G B is an albedo, 0 to 1. N is 1 to GLOSS_PHONG_MAX, ALPHA 0.02 to 1. */
#ifndef REMODEL_GLOSS_H
#define REMODEL_GLOSS_H

#include <stdio.h>

#include "common/base/textfile.h"
#include "common/light/brdf.h"

#define GLOSS_PHONG_MAX 5000.0

/* The part of a material that is not diffuse; {0} is matt. */
struct gloss {
    enum brdf_kind kind; /* BRDF_LAMBERT: matt */
    double ks, shape;    /* as in struct brdf; 0 if matt */
};

/* The range of `shape`: of Phong's exponent, Ward's roughness; 0 to 0 for Lambert. */
void gloss_shape_bounds(enum brdf_kind kind, double *least, double *most);

/* The reflectance of a surface of this albedo under the gloss. Takes 10 ms for Ward: call it once for a material, not
 * for each point. */
struct brdf gloss_brdf(const struct gloss *g, struct rgb albedo);

/* Both read the next words of the line. ST_DATA with file and line: another word, a number out of range;
 * gloss_read_brdf() also refuses what gloss_check() does. */
enum status gloss_read(struct gloss *g, struct textfile *t, struct err *err);
enum status gloss_read_brdf(struct brdf *b, struct textfile *t, struct err *err);

/* ST_DATA with the file and line of t: a surface of this greatest albedo would reflect more light than it gets: that
 * and brdf_gloss_albedo() are more than 1 together. */
enum status gloss_check(const struct gloss *g, double albedo, const struct textfile *t, struct err *err);

/* Print the words that the functions above read, bit for bit, without a blank before or after; in the C locale. */
void gloss_print(const struct gloss *g, FILE *to);
void gloss_print_brdf(const struct brdf *b, FILE *to);

#endif
