/* vec3_read.c - see vec3_read.h. */
#include "common/math/vec3_read.h"

enum status vec3_read(struct textfile *t, const char *what, struct vec3 *v, struct err *err)
{
    return textfile_double(t, what, &v->x, err) || textfile_double(t, what, &v->y, err) ||
                   textfile_double(t, what, &v->z, err)
               ? err->status
               : ST_OK;
}

enum status vec3_read_bounded(struct textfile *t, const char *what, struct vec3 *v, struct err *err)
{
    if (vec3_read(t, what, v, err)) return err->status;
    const double length = vec3_length(*v);
    return length <= 1e9 ? ST_OK : textfile_wrong_number(t, length, "numbers of at most 1e9", err);
}
