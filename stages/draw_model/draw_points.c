/* draw_points.c - the points of a scene for the page: few bytes of each.
 *
 * Of a point the page needs its position, its normal and its confidence. Positions are counted in steps of a 64th of
 * the cell on which points were merged, normals in steps of half a degree: on an octahedron that is folded open into a
 * square [Cigolle 2014]. Neighbours in the file are near each other in space, so the differences from one point to the
 * next are small numbers. Each number's bytes stand apart, in planes: the lowest of all points, then the next. zlib
 * finds the zeros of the higher ones. */
#include <libdeflate.h>
#include <math.h>
#include <stdlib.h>

#include "common/base/base64.h"
#include "common/base/outfile.h"
#include "common/capture/point_cloud.h"
#include "stages/draw_model/draw_data.h"

enum { PART = 6 << 20, PLANES = 12, COUNTS = 1 << 24, LEVEL = 6 }; /* PART: bytes, a multiple of three */

enum status draw_data_write_packed(FILE *to, const void *bytes, size_t size, struct err *err)
{
    struct libdeflate_compressor *c = libdeflate_alloc_compressor(LEVEL);
    const size_t room = c ? libdeflate_zlib_compress_bound(c, size) : 0;
    unsigned char *packed = malloc(room + 1);
    const size_t made = c && packed ? libdeflate_zlib_compress(c, bytes, size, packed, room) : 0;
    if (!made) err_nomem(err, "data of a page", room);
    putc('[', to);
    for (size_t at = 0; at < made; at += PART) {
        fputs(at ? ",\n\"" : "\n\"", to);
        base64_write(to, packed + at, made - at < PART ? made - at : PART);
        putc('"', to);
    }
    putc(']', to);
    free(packed);
    if (c) libdeflate_free_compressor(c);
    return err->status;
}

static double fold(double v, double other) { return (1 - fabs(other)) * (v < 0 ? -1 : 1); }

/* Two bytes of a direction. */
static void pack_normal(unsigned char to[2], const float n[3])
{
    const double sum = fabs((double)n[0]) + fabs((double)n[1]) + fabs((double)n[2]);
    const double x = (double)n[0] / sum, y = (double)n[1] / sum;
    const double at[2] = {n[2] < 0 ? fold(x, y) : x, n[2] < 0 ? fold(y, x) : y};
    for (int k = 0; k < 2; k++) to[k] = (unsigned char)lround((at[k] + 1) * 127);
}

static void pack_points(unsigned char *planes, const struct point_cloud *cloud, const double low[3], double step)
{
    const size_t n = cloud->count;
    uint32_t last[3] = {0};
    for (size_t i = 0; i < n; i++) {
        const struct cloud_point *p = &cloud->points[i];
        const double at[3] = {p->position.x, p->position.y, p->position.z};
        unsigned char normal[2];
        for (size_t k = 0; k < 3; k++) {
            const uint32_t now = (uint32_t)llround((at[k] - low[k]) / step), by = now - last[k];
            /* small differences of both signs become small numbers: 0 -1 1 -2 2 */
            const uint32_t zigzag = (by << 1) ^ (by >> 31 ? 0xffffffffU : 0);
            for (size_t b = 0; b < 3; b++) planes[(3 * k + b) * n + i] = (unsigned char)(zigzag >> 8 * b);
            last[k] = now;
        }
        pack_normal(normal, p->normal);
        planes[9 * n + i] = normal[0];
        planes[10 * n + i] = normal[1];
        planes[11 * n + i] = (unsigned char)lround(255 * (double)p->confidence);
    }
}

static enum status write_points(FILE *to, const struct draw_sources *from, struct err *err)
{
    struct point_cloud cloud = {0};
    if (point_cloud_read(&cloud, from->points, NULL, err)) return err->status;
    const size_t every = point_cloud_thin(&cloud, (size_t)from->params->max_points);
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, wide = 0;
    for (size_t i = 0; i < cloud.count; i++) {
        const struct vec3 p = cloud.points[i].position;
        const double at[3] = {p.x, p.y, p.z};
        for (int k = 0; k < 3; k++) low[k] = fmin(low[k], at[k]), high[k] = fmax(high[k], at[k]);
    }
    for (int k = 0; k < 3; k++) wide = fmax(wide, cloud.count ? high[k] - low[k] : 0);
    /* a difference of 24 bits with its sign must hold the whole width */
    const double step = fmax(fmax(cloud.cell / 64, wide / (COUNTS / 2 - 1)), 1e-300);
    unsigned char *planes = malloc(PLANES * cloud.count + 1);
    if (!planes) err_nomem(err, "the points of a page", PLANES * cloud.count);
    if (!err->status && cloud.count) {
        pack_points(planes, &cloud, low, step);
        fprintf(to, "remodel.points({\"every\": %zu, \"count\": %zu, \"cell\": %.17g, \"step\": %.17g, ", every,
                cloud.count, cloud.cell, step);
        fprintf(to, "\"low\": [%.17g, %.17g, %.17g], \"parts\": ", low[0], low[1], low[2]);
        draw_data_write_packed(to, planes, PLANES * cloud.count, err);
        fputs("});\n", to);
    } else if (!err->status)
        fputs("remodel.points(null);\n", to);
    free(planes);
    point_cloud_release(&cloud);
    return err->status;
}

enum status draw_points_write(const char *path, const struct draw_sources *from, struct err *err)
{
    struct outfile out = {0};
    if (!outfile_open(&out, path, err)) {
        if (from->points)
            write_points(out.fp, from, err);
        else
            fputs("remodel.points(null);\n", out.fp);
        if (!err->status) outfile_commit(&out, err);
    }
    outfile_discard(&out);
    return err->status;
}
