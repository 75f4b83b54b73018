/* exposure_list.h - exposures.txt: exposures of photographs, written by the user.
 *
 *   FILE SECONDS [F_NUMBER ISO [FILTER]]
 * One line per photo. FILTER is the factor of a neutral density filter: 1000 transmits a thousandth of the light.
 * SECONDS, F_NUMBER and ISO are taken from EXIF if they are missing or 0. The FILE * stands for all photos, for what
 * neither EXIF nor a line of their own says. */
#ifndef REMODEL_EXPOSURE_LIST_H
#define REMODEL_EXPOSURE_LIST_H

#include "common/base/err.h"

struct exposure {
    double seconds, f_number, iso; /* 0: unknown */
    double filter;                 /* factor; 1 without one */
};

/* seconds x ISO / (f-number^2 x filter), proportional to the recorded value of a given radiance. An unknown f-number or
 * ISO is left out, so exposures can only be compared if the same quantities are known. 0 if the time is unknown. */
double exposure_value(const struct exposure *e);

#define EXPOSURE_OF_ALL "*"

struct exposure_line {
    char *file; /* owned */
    struct exposure exposure;
    int line; /* in the file, from 1 */
};

struct exposure_list {
    char *path; /* owned */
    struct exposure_line *lines;
    int count;
};

/* ST_DATA with file and line: duplicate photo, negative number, seconds or filter of 0. {0} is the empty list. */
enum status exposure_list_read(struct exposure_list *list, const char *path, struct err *err);
void exposure_list_release(struct exposure_list *list);

#endif
