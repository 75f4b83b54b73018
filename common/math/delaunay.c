/* delaunay.c - Delaunay triangulation in the plane, by qhull [Barber 1996].
 *
 * qhull lifts the points onto a paraboloid; the lower convex hull of the lifted points is the triangulation. Cocircular
 * points (grids) make facets of more than three vertices. qhull splits these facets without moving the points (option
 * Qt, no joggling), which can leave triangles of zero area along the hull; they are dropped here. */
#include "common/math/delaunay.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <libqhull_r/qhull_ra.h>

#define FLAT 1e-9 /* points within this part of their extent from a line are collinear */

static double cross_at(const double *a, const double *b, const double *c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Shifts and scales the points to the unit square, for the tolerances. False if they are collinear. */
static bool normalize(const double (*points)[2], int count, double (*unit)[2])
{
    double low[2] = {points[0][0], points[0][1]}, high[2] = {points[0][0], points[0][1]};
    for (int i = 1; i < count; i++)
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], points[i][k]);
            high[k] = fmax(high[k], points[i][k]);
        }
    double extent = fmax(high[0] - low[0], high[1] - low[1]);
    if (!(extent > 0)) return false;
    int far = 0;
    double longest = 0, widest = 0;
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < 2; k++) unit[i][k] = (points[i][k] - low[k]) / extent;
        double d = hypot(unit[i][0] - unit[0][0], unit[i][1] - unit[0][1]);
        if (d > longest) longest = d, far = i;
    }
    for (int i = 0; i < count; i++) widest = fmax(widest, fabs(cross_at(unit[0], unit[far], unit[i])));
    return widest > FLAT * longest;
}

static int compare_triangles(const void *a, const void *b)
{
    const int *p = a, *q = b;
    for (int k = 0; k < 3; k++)
        if (p[k] != q[k]) return p[k] < q[k] ? -1 : 1;
    return 0;
}

/* Orders a triangle counter-clockwise, smallest index first. False if its area is zero. */
static bool arrange(int t[3], const double (*unit)[2])
{
    double area = cross_at(unit[t[0]], unit[t[1]], unit[t[2]]);
    if (fabs(area) < 1e-14) return false;
    if (area < 0) {
        int swap = t[1];
        t[1] = t[2];
        t[2] = swap;
    }
    while (t[0] > t[1] || t[0] > t[2]) {
        int first = t[0];
        t[0] = t[1];
        t[1] = t[2];
        t[2] = first;
    }
    return true;
}

static enum status collect(qhT *qh, const double (*unit)[2], int (**triangles)[3], int *count, struct err *err)
{
    size_t facets = 0;
    facetT *facet;
    vertexT *vertex, **vertexp;
    FORALLfacets
    {
        if (!facet->upperdelaunay) facets++;
    }
    int(*t)[3] = malloc((facets ? facets : 1) * sizeof *t);
    if (!t) return err_nomem(err, "a triangulation", facets * sizeof *t);
    int n = 0;
    FORALLfacets
    {
        if (facet->upperdelaunay || qh_setsize(qh, facet->vertices) != 3) continue;
        int k = 0;
        FOREACHvertex_(facet->vertices) t[n][k++] = qh_pointid(qh, vertex->point);
        if (arrange(t[n], unit)) n++;
    }
    qsort(t, (size_t)n, sizeof *t, compare_triangles);
    *triangles = t;
    *count = n;
    return ST_OK;
}

enum status delaunay(const double (*points)[2], int point_count, int (**triangles)[3], int *count, struct err *err)
{
    *triangles = NULL;
    *count = 0;
    if (point_count < 3) return ST_OK;
    char *text = NULL;
    size_t text_size = 0;
    FILE *messages = NULL; /* qhull's output */
    bool opened = false;
    char command[] = "qhull d Qt Qbb Qc Qz";
    qhT qh;
    double(*unit)[2] = malloc((size_t)point_count * sizeof *unit);
    if (!unit) return err_nomem(err, "a triangulation", (size_t)point_count * sizeof *unit);
    if (!normalize(points, point_count, unit)) goto done;
    if (point_count == 3) { /* too few for qhull's initial simplex */
        *triangles = malloc(sizeof **triangles);
        if (!*triangles) {
            err_nomem(err, "a triangulation", sizeof **triangles);
            goto done;
        }
        memcpy(**triangles, (int[3]){0, 1, 2}, sizeof **triangles);
        *count = arrange(**triangles, unit) ? 1 : 0;
        goto done;
    }
    messages = open_memstream(&text, &text_size);
    if (!messages) {
        err_nomem(err, "qhull's messages", 1);
        goto done;
    }
    qh_zero(&qh, messages);
    opened = true;
    if (qh_new_qhull(&qh, 2, point_count, &unit[0][0], False, command, NULL, messages)) {
        fflush(messages);
        err_set(err, ST_INTERNAL, "qhull cannot triangulate %d points: %.200s", point_count, text ? text : "");
        goto done;
    }
    collect(&qh, unit, triangles, count, err);
done:
    if (opened) {
        int left, total;
        qh_freeqhull(&qh, !qh_ALL);
        qh_memfreeshort(&qh, &left, &total);
    }
    if (messages) fclose(messages);
    free(text);
    free(unit);
    return err->status;
}
