/* layered_depth.h - a view as two layers of coloured segments with depth: out/SCENE/depth/VIEW.exr and VIEW.txt.
 *
 * interior.{R,G,B,A,Z,id}: the segments' interiors, opaque, and one segment of each overlapping boundary pair;
 * boundary.{R,G,B,A,Z,id}: the other one, A 0 where there is none. Colours are premultiplied by alpha, so
 * interior.RGB + boundary.RGB is the photo and the alphas sum to 1 wherever the view has a valid pixel. Z is depth along the camera axis,
 * 0 unknown; it follows the segment's plane, z(u, v) = 1 / (a u + b v + c) at the pixel's centre. id is the segment's, from 1; 0 none. */
#ifndef REMODEL_LAYERED_DEPTH_H
#define REMODEL_LAYERED_DEPTH_H

#include <stdint.h>

#include "common/capture/camera_set.h"

struct layer {
    float *rgba;  /* w * h * 4, premultiplied */
    float *z;     /* w * h */
    uint32_t *id; /* w * h */
};

struct depth_segment {
    uint32_t id;       /* its place in the list + 1 */
    int pixels;        /* of the interior */
    double plane[3];   /* 1/z = plane[0] u + plane[1] v + plane[2] */
    double sigma;      /* uncertainty of z, relative: dz / z */
    double confidence; /* 0 inherited from neighbours .. 1 sure */
};

/* Below this confidence a segment's depth is called inherited: no other view saw it, or the pictures say as good as nothing of its
 * depth, which is then its neighbours'. */
#define DEPTH_INHERITED 0.1

struct layered_depth {
    int width, height;
    struct layer interior, boundary;
    struct depth_segment *segments;
    int segment_count;
};

enum status layered_depth_init(struct layered_depth *d, int width, int height, struct err *err);
void layered_depth_release(struct layered_depth *d);

/* What is not known, as parts of all pixels. */
struct depth_shares {
    double unknown;   /* no depth: no photo is there (masked, or outside of the lens) */
    double inherited; /* a depth, but of a segment whose confidence is below DEPTH_INHERITED; by the interior's ids */
};
struct depth_shares layered_depth_shares(const struct layered_depth *d);

/* Writes TXT (path with .exr replaced by .txt), then the EXR; each whole or not at all, the EXR last. The EXR's attributes
 * remodel:unknown and remodel:inherited are the shares. */
enum status layered_depth_write(const struct layered_depth *d, const struct view *view, const char *path,
                                const struct provenance *prov, struct err *err);
/* ids are those of the list (or 0), alphas in [0, 1], z >= 0: ST_DATA with the pixel or the line where that is not so. */
enum status layered_depth_read(struct layered_depth *d, const char *path, struct err *err);
/* TXT and the interior; the boundary stays empty. */
enum status layered_depth_read_interior(struct layered_depth *d, const char *path, struct err *err);
/* TXT and interior.id alone; the rest of the layers stays empty. */
enum status layered_depth_read_ids(struct layered_depth *d, const char *path, struct err *err);
/* TXT alone: size and segments; the layers stay empty. */
enum status layered_depth_read_segments(struct layered_depth *d, const char *path, struct err *err);

#endif
