/* irradiance_list.c - see irradiance_list.h. */
#include "stages/evaluate/light/irradiance_list.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/base/textfile.h"

static enum status read_point(struct irradiance_list *list, struct textfile *t, struct err *err)
{
    static const char *const fields[9] = {"x",
                                          "y",
                                          "z",
                                          "x of the normal",
                                          "y of the normal",
                                          "z of the normal",
                                          "red irradiance",
                                          "green irradiance",
                                          "blue irradiance"};
    double v[9];
    for (int i = 0; i < 6; i++)
        if (textfile_double(t, fields[i], &v[i], err)) return err->status;
    for (int i = 6; i < 9; i++)
        if (textfile_number(t, fields[i], 0, INFINITY, &v[i], err)) return err->status;
    if (textfile_end(t, err)) return err->status;
    struct irradiance_at p = {vec3_make(v[0], v[1], v[2]), vec3_make(v[3], v[4], v[5]), {v[6], v[7], v[8]}};
    const double length = vec3_length(p.normal);
    if (!(fabs(length - 1) <= 1e-3)) return textfile_wrong_number(t, length, "a normal of length 1", err);
    p.normal = vec3_scale(p.normal, 1 / length);
    if (array_append(&list->points, (size_t)list->count, sizeof p, "irradiance points", err)) return err->status;
    list->points[list->count++] = p;
    return ST_OK;
}

enum status irradiance_list_read(struct irradiance_list *list, const char *path, struct err *err)
{
    struct textfile t = {0};
    *list = (struct irradiance_list){0};
    textfile_open(&t, path, err);
    while (!err->status && textfile_next(&t)) read_point(list, &t, err);
    textfile_release(&t);
    if (err->status) irradiance_list_release(list);
    return err->status;
}

void irradiance_list_release(struct irradiance_list *list)
{
    free(list->points);
    *list = (struct irradiance_list){0};
}
