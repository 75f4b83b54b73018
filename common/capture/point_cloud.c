/* point_cloud.c - reading and writing oriented points. */
#include "common/capture/point_cloud.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "common/base/outfile.h"
#include "common/base/scan.h"

enum { RECORD_SIZE = 3 * 8 + 3 * 4 + 3 + 2 + 4, BLOCK = 4096 };

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
    char *text = NULL;
    size_t size = 0;
    FILE *lines = open_memstream(&text, &size);
    if (!lines) return err_nomem(err, "a file's head", 1);
    provenance_print(prov, lines);
    const int failed = ferror(lines);
    if (fclose(lines) || failed) {
        free(text);
        return err_nomem(err, "a file's head", size);
    }
    for (const char *p = text; *p;) {
        const size_t n = strcspn(p, "\n");
        fprintf(to, "comment %.*s\n", (int)n - 2, p + 2);
        p += n + (p[n] == '\n');
    }
    free(text);
    return ST_OK;
}

enum status point_cloud_write(const struct point_cloud *cloud, const char *path, const struct provenance *prov,
                              struct err *err)
{
    for (size_t i = 0; i < cloud->count; i++)
        if (!is_valid(&cloud->points[i])) return invalid_point(&cloud->points[i], i, path, err);

    struct outfile file = {0};
    enum status st = outfile_open(&file, path, err);
    if (!st) {
        fprintf(file.fp, "ply\nformat binary_little_endian 1.0\n%s\n", kind);
        fprintf(file.fp, "comment x y z: scene units, in the world's axes, those of views/images.txt\n"
                         "comment nx ny nz: of length 1, towards the cameras that saw the surface\n"
                         "comment red green blue: sRGB, white is 255; views: how many agree; confidence: 0 to 1\n");
        fprintf(file.fp, "%s%.17g\n", cell_word, cloud->cell);
        if (prov) st = print_provenance(file.fp, prov, err);
        fprintf(file.fp, "element vertex %zu\n", cloud->count);
        for (int i = 0; i < PROPERTIES; i++) fprintf(file.fp, "%s\n", properties[i]);
        fputs("end_header\n", file.fp);
        for (size_t i = 0; i < cloud->count; i++) {
            uint8_t record[RECORD_SIZE];
            pack(record, &cloud->points[i]);
            fwrite(record, sizeof record, 1, file.fp);
        }
        if (!st) st = outfile_commit(&file, err);
    }
    outfile_discard(&file);
    return st;
}

struct header {
    FILE *fp;
    const char *path;
    char *text; /* of the current line, without its end */
    size_t room;
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
    const ssize_t n = getline(&h->text, &h->room, h->fp);
    h->line++;
    if (n < 1 || h->text[n - 1] != '\n' || memchr(h->text, '\0', (size_t)n)) {
        if (n < 1) {
            free(h->text);
            h->text = NULL;
        }
        return false;
    }
    h->text[n - 1] = '\0';
    return true;
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

static enum status read_points(struct point_cloud *cloud, FILE *fp, const char *path, struct err *err)
{
    uint8_t *block = malloc((size_t)BLOCK * RECORD_SIZE);
    enum status st = block ? ST_OK : err_nomem(err, "a block of points", (size_t)BLOCK * RECORD_SIZE);
    for (size_t at = 0; !st && at < cloud->count; at += BLOCK) {
        const size_t n = cloud->count - at < BLOCK ? cloud->count - at : BLOCK;
        if (fread(block, RECORD_SIZE, n, fp) != n) {
            st = err_errno(err, "read", path);
            break;
        }
        for (size_t i = 0; !st && i < n; i++) {
            unpack(&cloud->points[at + i], block + i * RECORD_SIZE);
            if (!is_valid(&cloud->points[at + i])) st = invalid_point(&cloud->points[at + i], at + i, path, err);
        }
    }
    free(block);
    return st;
}

enum status point_cloud_read(struct point_cloud *cloud, const char *path, struct err *err)
{
    struct header h = {.path = path};
    struct stat info;
    int64_t count = 0;
    *cloud = (struct point_cloud){0};
    h.fp = fopen(path, "rbe");
    if (!h.fp) return err_errno(err, "open", path);
    enum status st = fstat(fileno(h.fp), &info) ? err_errno(err, "get the size of", path) : ST_OK;
    if (!st) st = read_header(&h, &cloud->cell, &count, err);
    if (!st) {
        /* memory is allocated only for as many points as the file contains */
        const int64_t left = (int64_t)info.st_size - (int64_t)ftello(h.fp);
        if (left % RECORD_SIZE || left / RECORD_SIZE != count)
            st = err_set(err, ST_DATA,
                         "%s: found %" PRId64 " bytes after the header, wanted %d for each of %" PRId64
                         " points; make the points again.",
                         path, left, RECORD_SIZE, count);
    }
    if (!st) {
        cloud->count = (size_t)count;
        cloud->points = malloc((cloud->count + 1) * sizeof *cloud->points);
        st = cloud->points ? read_points(cloud, h.fp, path, err)
                           : err_nomem(err, "points", cloud->count * sizeof *cloud->points);
    }
    fclose(h.fp);
    free(h.text);
    if (st) point_cloud_release(cloud);
    return st;
}

void point_cloud_release(struct point_cloud *cloud)
{
    if (!cloud) return;
    free(cloud->points);
    *cloud = (struct point_cloud){0};
}
