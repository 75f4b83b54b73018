/* irradiance_list.h - reads irradiance at points: lines "X Y Z NX NY NZ R G B", a point, the normal there, and the
 * integral of radiance times cosine over the hemisphere about the normal (docs/formats.md). */
#ifndef REMODEL_IRRADIANCE_LIST_H
#define REMODEL_IRRADIANCE_LIST_H

#include "common/base/err.h"
#include "common/math/vec.h"

struct irradiance_at {
    struct vec3 point, normal; /* normal: of length 1 */
    double rgb[3];             /* >= 0 */
};

struct irradiance_list {
    struct irradiance_at *points;
    int count;
};

/* list is overwritten, and empty after an error. ST_DATA with file and line: another number of numbers, a normal of
 * another length than 1 (by more than a thousandth), a negative irradiance. */
enum status irradiance_list_read(struct irradiance_list *list, const char *path, struct err *err);
void irradiance_list_release(struct irradiance_list *list);

#endif
