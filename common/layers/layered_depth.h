/* layered_depth.h - a view as two layers of coloured segments with depth: out/SCENE/depth/VIEW.exr and VIEW.txt
 * [Colburn 2014, 3.5].
 *
 * interior.{R,G,B,A,Z,id}: the segments' interiors, opaque, and one segment of each overlapping boundary pair;
 * boundary.{R,G,B,A,Z,id}: the other segment of the pair, A 0 where there is none. Colours are premultiplied by alpha,
 * so interior.RGB + boundary.RGB is the photo, and the alphas sum to 1 in every valid pixel of the view. Z is depth
 * along the camera axis, 0 unknown, from the segment's plane at the pixel's centre: z(u, v) = 1 / (a u + b v + c).
 * Segment ids start at 1; 0 means none. */
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
    uint32_t id;       /* index in the list + 1 */
    int pixels;        /* of the interior */
    double plane[3];   /* 1/z = plane[0] u + plane[1] v + plane[2] */
    double sigma;      /* relative tolerance of z: dz / z */
    double confidence; /* from 0, depth inherited from neighbours, to 1, certain */
    double deviation;  /* standard deviation of the relative error of 1/z; 0: not stated */
};

/* Below this confidence a segment's depth counts as inherited from its neighbours: no other view saw the segment, or
 * the photos hardly constrain its depth. */
#define DEPTH_INHERITED 0.1

struct layered_depth {
    int width, height;
    struct layer interior, boundary;
    struct depth_segment *segments;
    int segment_count;
};

enum status layered_depth_init(struct layered_depth *d, int width, int height, struct err *err);
void layered_depth_release(struct layered_depth *d);

/* Fractions of all pixels, by the interior's ids. */
struct depth_shares {
    double unknown;   /* without depth: the photo has no such pixel (masked, or outside of the lens) */
    double inherited; /* with depth, but of a segment whose confidence is below DEPTH_INHERITED */
};
struct depth_shares layered_depth_shares(const struct layered_depth *d);

/* Writes the list of segments (path with .exr replaced by .txt), then the EXR, each atomically. view (may be NULL):
 * camera for the EXR's attributes; remodel:unknown and remodel:inherited are the shares. ST_INTERNAL: invalid
 * segments. */
enum status layered_depth_write(const struct layered_depth *d, const struct view *view, const char *path,
                                const struct provenance *prov, struct err *err);
/* Reads both files. Afterwards ids index the list (or are 0), alphas are in [0, 1] and z >= 0; otherwise ST_DATA with
 * the pixel or the line. */
enum status layered_depth_read(struct layered_depth *d, const char *path, struct provenance *prov, struct err *err);
/* Only the list and the interior; the boundary stays empty. */
enum status layered_depth_read_interior(struct layered_depth *d, const char *path, struct provenance *prov,
                                        struct err *err);
/* Only the list and interior.id; the rest of the layers stays empty. */
enum status layered_depth_read_ids(struct layered_depth *d, const char *path, struct provenance *prov, struct err *err);
/* Only the list (path: the .txt): size and segments; the layers stay empty. */
enum status layered_depth_read_segments(struct layered_depth *d, const char *path, struct provenance *prov,
                                        struct err *err);

#endif
