/* view_record.h - the faces that a view shows: out/SCENE/ids/VIEW.txt.
 *
 *   remodel-view-faces 2
 *   face ID PIXELS CLEAN DISTANCE COSINE SURE OFFSET      in order of ID
 * PIXELS show the face; CLEAN of them are farther than clean_margin from depth jumps and show no clutter (those of
 * unknown clutter count half); DISTANCE is the median distance from the camera (scene units) and COSINE the mean cosine
 * of the angle between the ray and the face's normal, of the clean pixels, or of all if none is clean. SURE pixels, as
 * far from jumps, have a sure depth within a tenth of the face's; OFFSET is their median distance from the face along
 * its normal (scene units, above 0 farther from the camera; 0 without such pixels). */
#ifndef REMODEL_VIEW_RECORD_H
#define REMODEL_VIEW_RECORD_H

#include "stages/trace_ids/view_layers.h"

struct seen_face {
    int id, pixels, clean;
    double distance, cosine;
    int sure;
    double offset;
};

struct view_record {
    struct seen_face *faces; /* in order of id; owned */
    int count;
};

enum status view_record_make(struct view_record *r, const struct view_ids *ids, const struct view_trace *t,
                             const struct layered_depth *depth, const struct trace_params *params, struct err *err);
void view_record_release(struct view_record *r);
enum status view_record_write(const struct view_record *r, const char *path, const struct provenance *prov,
                              struct err *err);
/* ST_DATA with file and line: ids that do not ascend, more clean pixels than pixels, numbers out of range. */
enum status view_record_read(struct view_record *r, const char *path, struct provenance *prov, struct err *err);

#endif
