/* point_cloud.c - reading and writing oriented points, as PLY.
 *
 * Binary little-endian PLY with fixed properties, in a fixed order: position as doubles, normal and confidence as
 * floats, colour as bytes, the number of views as a short. Any viewer opens it, and a reader needs no general parser
 * of PLY: what is not of exactly this form is refused, with the line of the header.
 *
 * The header's comments say units and axes, hold the provenance, and the cell size of the fusion. Records are packed
 * byte by byte into a block, because a struct has padding. Machine and file are both little-endian.
 *
 * Every point is checked both when it is written and when it is read: finite numbers, a normal of length 1, at least
 * one view, a confidence from 0 to 1. The number of points in the header is compared with the size of the file
 * before memory is allocated by it. */
#include "common/capture/point_cloud.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/memory_text.h"
#include "common/base/scan.h"
#include "common/product/product.h"

enum { RECORD_SIZE = 3 * 8 + 3 * 4 + 3 + 2 + 4 };

static const char *const properties[] = {
    "property double x",   "property double y",     "property double z",         "property float nx",
    "property float ny",   "property float nz",     "property uchar red",        "property uchar green",
    "property uchar blue", "property ushort views", "property float confidence",
};
enum { PROPERTIES = sizeof properties / sizeof *properties };

static const char kind[] = "comment remodel-points 1";
static const char cell_word[] = "comment cell ";

static bool is_valid(const struct cloud_point *p)
{
    const double length = vec3_length(cloud_normal(p));
    return isfinite(p->position.x) && isfinite(p->position.y) && isfinite(p->position.z) && fabs(length - 1) < 1e-3 &&
           p->views > 0 && p->confidence >= 0 && p->confidence <= 1;
}

static enum status invalid_point(const struct cloud_point *p, size_t i, const char *path, struct err *err)
{
    return err_set(
        err, ST_DATA,
        "%s: point %zu has position (%g, %g, %g), normal (%g, %g, %g), %u views, confidence %g; wanted finite "
        "numbers, a normal of length 1, at least one view and a confidence from 0 to 1.",
        path, i, p->position.x, p->position.y, p->position.z, (double)p->normal[0], (double)p->normal[1],
        (double)p->normal[2], p->views, (double)p->confidence);
}

/* Machine (common/math/lanes.h) and file are both little-endian. */
static void pack(uint8_t *to, const struct cloud_point *p)
{
    const double position[3] = {p->position.x, p->position.y, p->position.z};
    memcpy(to, position, 24);
    memcpy(to + 24, p->normal, 12);
    memcpy(to + 36, p->color, 3);
    memcpy(to + 39, &p->views, 2);
    memcpy(to + 41, &p->confidence, 4);
}

static void unpack(struct cloud_point *p, const uint8_t *from)
{
    double position[3];
    memcpy(position, from, 24);
    p->position = vec3_make(position[0], position[1], position[2]);
    memcpy(p->normal, from + 24, 12);
    memcpy(p->color, from + 36, 3);
    memcpy(&p->views, from + 39, 2);
    memcpy(&p->confidence, from + 41, 4);
}

/* Writes the provenance, whose lines begin with "# ", as comments. */
static enum status print_provenance(FILE *to, const struct provenance *prov, struct err *err)
{
    struct memory_text m = {0};
    if (memory_text_open(&m, "a file's head", err)) return err->status;
    provenance_print(prov, m.to);
    if (memory_text_close(&m, "a file's head", err)) return err->status;
    for (const char *p = m.text; *p;) {
        const size_t n = strcspn(p, "\n");
        fprintf(to, "comment %.*s\n", (int)n - 2, p + 2);
        p += n + (p[n] == '\n');
    }
    memory_text_release(&m);
    return ST_OK;
}

enum status point_cloud_write(const struct point_cloud *cloud, const char *path, const struct provenance *prov,
                              struct err *err)
{
    for (size_t i = 0; i < cloud->count; i++)
        if (!is_valid(&cloud->points[i])) return invalid_point(&cloud->points[i], i, path, err);

    struct outfile file = {0};
    if (!outfile_open(&file, path, err)) {
        fprintf(file.fp, "ply\nformat binary_little_endian 1.0\n%s\n", kind);
        fprintf(file.fp, "comment x y z: scene units, in the world's axes, those of views/images.txt\n"
                         "comment nx ny nz: of length 1, towards the cameras that saw the surface\n"
                         "comment red green blue: sRGB, white is 255; views: how many agree; confidence: 0 to 1\n");
        fprintf(file.fp, "%s%.17g\n", cell_word, cloud->cell);
        if (prov) print_provenance(file.fp, prov, err);
        fprintf(file.fp, "element vertex %zu\n", cloud->count);
        for (int i = 0; i < PROPERTIES; i++) fprintf(file.fp, "%s\n", properties[i]);
        fputs("end_header\n", file.fp);
        for (size_t i = 0; i < cloud->count; i++) {
            uint8_t record[RECORD_SIZE];
            pack(record, &cloud->points[i]);
            fwrite(record, sizeof record, 1, file.fp);
        }
        if (!err->status) outfile_commit(&file, err);
    }
    outfile_discard(&file);
    return err->status;
}

struct header {
    char *at, *end; /* what is left of the file */
    const char *path;
    const char *text; /* the current line, without its end; NULL: the file has ended */
    int line;
};

static enum status header_error(const struct header *h, const char *what, struct err *err)
{
    char shown[SCAN_QUOTED];
    return err_set(err, ST_DATA,
                   "%s:%d: found %s, wanted %s; this is not a point cloud of remodel, or the file is damaged.", h->path,
                   h->line, h->text ? scan_quote(shown, h->text) : "the end of the file", what);
}

static bool next_line(struct header *h)
{
    char *newline = memchr(h->at, '\n', (size_t)(h->end - h->at)), *stop = newline ? newline : h->end;
    const bool whole = newline && !memchr(h->at, '\0', (size_t)(stop - h->at));

    h->line++;
    h->text = h->at < h->end ? h->at : NULL;
    *stop = '\0';
    h->at = newline ? newline + 1 : h->end;
    return whole;
}

static enum status expect_line(struct header *h, const char *text, struct err *err)
{
    char shown[64];
    if (next_line(h) && !strcmp(h->text, text)) return ST_OK;
    snprintf(shown, sizeof shown, "\"%s\"", text);
    return header_error(h, shown, err);
}

static enum status read_header(struct header *h, double *cell, int64_t *count, struct err *err)
{
    static const char element[] = "element vertex ";
    const size_t cell_length = sizeof cell_word - 1, element_length = sizeof element - 1;
    if (expect_line(h, "ply", err) || expect_line(h, "format binary_little_endian 1.0", err) ||
        expect_line(h, kind, err))
        return err->status;
    *cell = -1;
    for (;;) {
        if (!next_line(h)) return header_error(h, "a line of a PLY header", err);
        if (*cell < 0 && !strncmp(h->text, cell_word, cell_length)) {
            if (!scan_double(h->text + cell_length, cell) || *cell < 0)
                return header_error(h, "a cell size of 0 or more", err);
        } else if (strncmp(h->text, "comment ", 8)) {
            break;
        }
    }
    if (*cell < 0) return header_error(h, "\"comment cell SIZE\" before it", err);
    if (strncmp(h->text, element, element_length) || !scan_int(h->text + element_length, count) || *count < 0)
        return header_error(h, "\"element vertex COUNT\"", err);
    for (int i = 0; i < PROPERTIES; i++)
        if (expect_line(h, properties[i], err)) return err->status;
    return expect_line(h, "end_header", err);
}

static enum status read_points(struct point_cloud *cloud, const char *records, const char *path, struct err *err)
{
    for (size_t i = 0; i < cloud->count; i++) {
        unpack(&cloud->points[i], (const uint8_t *)records + i * RECORD_SIZE);
        if (!is_valid(&cloud->points[i])) return invalid_point(&cloud->points[i], i, path, err);
    }
    return ST_OK;
}

enum status point_cloud_read(struct point_cloud *cloud, const char *path, struct provenance *prov, struct err *err)
{
    struct file_bytes file = {0};
    int64_t count = 0;
    *cloud = (struct point_cloud){0};
    if (provenance_read(prov, product_name(PRODUCT_POINTS, path), &file, path, err)) return err->status;
    struct header h = {.at = file.bytes, .end = file.bytes + file.size, .path = path};
    read_header(&h, &cloud->cell, &count, err);
    /* memory is allocated only for as many points as the file contains */
    const int64_t left = h.end - h.at;
    if (!err->status && (left % RECORD_SIZE || left / RECORD_SIZE != count))
        err_set(err, ST_DATA,
                "%s: found %" PRId64 " bytes after the header, wanted %d for each of %" PRId64
                " points; make the points again.",
                path, left, RECORD_SIZE, count);
    if (!err->status) {
        cloud->count = (size_t)count;
        cloud->points = malloc((cloud->count + 1) * sizeof *cloud->points);
        if (cloud->points)
            read_points(cloud, h.at, path, err);
        else
            err_nomem(err, "points", cloud->count * sizeof *cloud->points);
    }
    file_bytes_release(&file);
    if (err->status) point_cloud_release(cloud);
    return err->status;
}

size_t point_cloud_thin(struct point_cloud *cloud, size_t most)
{
    const size_t wanted = most ? most : 1, step = (cloud->count + wanted - 1) / wanted;
    if (step <= 1) return 1;
    const size_t kept = (cloud->count + step - 1) / step;
    for (size_t i = 0; i < kept; i++) cloud->points[i] = cloud->points[i * step];
    cloud->count = kept;
    return step;
}

void point_cloud_release(struct point_cloud *cloud)
{
    if (!cloud) return;
    free(cloud->points);
    *cloud = (struct point_cloud){0};
}
