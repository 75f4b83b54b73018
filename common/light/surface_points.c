/* surface_points.c - see surface_points.h. */
#include "common/light/surface_points.h"

#include <stdlib.h>

#include "common/base/array.h"
#include "common/base/textfile.h"
#include "common/math/vec3_read.h"

enum { MAX_POINTS = 10000000 };

static enum status read_point(struct surface_points *points, struct textfile *t, struct err *err)
{
    struct surface_point p;
    if (points->count == MAX_POINTS) return textfile_error(t, err, "one more", "at most %d points", MAX_POINTS);
    if (vec3_read_bounded(t, "a point", &p.at, err) || vec3_read_bounded(t, "a normal", &p.normal, err))
        return err->status;
    if (!(vec3_length(p.normal) > 1e-9)) return textfile_error(t, err, "0 0 0", "a normal");
    p.normal = vec3_normalize(p.normal);
    if (textfile_end(t, err) || array_append(&points->list, (size_t)points->count, sizeof p, "points", err))
        return err->status;
    points->list[points->count++] = p;
    return ST_OK;
}

enum status surface_points_read(struct surface_points *points, const char *path, struct err *err)
{
    struct textfile t = {0};
    *points = (struct surface_points){0};
    textfile_open(&t, path, err);
    while (!err->status && textfile_next(&t)) read_point(points, &t, err);
    if (!err->status && !points->count)
        err_set(err, ST_DATA, "%s has no points; write one on each line: X Y Z NX NY NZ.", path);
    textfile_release(&t);
    if (err->status) surface_points_release(points);
    return err->status;
}

void surface_points_release(struct surface_points *points)
{
    free(points->list);
    *points = (struct surface_points){0};
}
