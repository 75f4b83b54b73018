/* depth_rounds.h - how much the depth of a view changed in a round, and whether the next round can carry it over.
 *
 * FOLDER/VIEW.round is the record of a view in a round (docs/formats.md, O/depth). */
#ifndef REMODEL_DEPTH_ROUNDS_H
#define REMODEL_DEPTH_ROUNDS_H

#include "common/base/file_path.h"
#include "common/layers/layered_depth.h"

struct round_record {
    double changed; /* of the pixels with depth, the share whose depth changed, from 0 to 1; 1 in the first round */
    bool estimated; /* false: carried over from the round before */
};

enum status round_record_write(const struct round_record *r, const char *path, const struct provenance *prov,
                               struct err *err);
enum status round_record_read(struct round_record *r, const char *path, struct provenance *prov, struct err *err);

/* Of the pixels of `now` that have depth, the share whose depth differs by more than CHANGED_PART from that of
 * `before`, or that had none there. Both have the same size; their segments may differ. */
#define CHANGED_PART 0.01
double round_change(const struct layered_depth *now, const struct layered_depth *before);

/* *settled: in the round whose records are in `folder`, views[0] changed by less than min_change, and so did, on
 * average, the other count - 1 views, its neighbours. The records that were read are added to prov. */
enum status round_is_settled(bool *settled, const char *folder, const struct camera_set *set, const int *views,
                             int count, double min_change, struct provenance *prov, struct err *err);

/* The file beside a depth map that has `suffix` in place of .exr. ST_USAGE: exr does not end in .exr. */
enum status round_file(char path[FILE_PATH], const char *exr, const char *suffix, struct err *err);

/* Copies the depth map FOLDER/VIEW.txt and VIEW.exr to `out` (ends in .exr), byte for byte, the EXR last. */
enum status round_carry_over(const char *folder, const char *view, const char *out, struct err *err);

#endif
