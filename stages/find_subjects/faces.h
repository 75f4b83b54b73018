/* faces.h - the faces in a scene's photographs: detected in a central view, and checked at the same place in space in
 * others.
 *
 * Pixels are a view's, depth is along its axis. Pictures and detection are the caller's: the stage provides files and
 * OpenCV's cascades, tests provide synthetic ones. */
#ifndef REMODEL_FACES_H
#define REMODEL_FACES_H

#include "common/film/subject_list.h"
#include "common/layers/layered_depth.h"
#include "stages/find_subjects/find_params.h"
#include "stages/find_subjects/opencv_faces.h"

struct face_source {
    void *ctx;
    /* 8-bit grey picture of a view as it is stored, width * height; malloc'ed, the caller frees it. */
    enum status (*picture)(void *ctx, int view_idx, unsigned char **grey, struct err *err);
    /* d: the view's depth; the caller releases it. */
    enum status (*depth)(void *ctx, int view_idx, struct layered_depth *d, struct err *err);
    /* As face_detect(). */
    enum status (*detect)(void *ctx, const unsigned char *grey, int width, int height, double min_width,
                          double max_width, struct face_box **faces, int *count, struct err *err);
};

enum face_verdict {
    FACE_KEPT,
    FACE_SURPLUS,     /* confirmed, but MAX_FACES larger ones are kept */
    FACE_NO_DEPTH,    /* no pixel has a depth */
    FACE_UNCONFIRMED, /* too few of the other views detect it */
    FACE_LOW_SCORE,   /* the mean score of the views is too low */
};

struct face_sighting { /* a face that was checked */
    struct subject subject;
    enum face_verdict verdict;
    bool unchecked; /* fewer than two other views could check it: only its score decides */
};

struct face_report {
    struct face_sighting *sightings; /* by view, the largest first in each */
    int count, views;                /* views: number of views searched */
};

#define MAX_FACES 2

/* Adds at most MAX_FACES subjects to the list, the largest first. ups: each view's upright direction
 * (common/capture/upright.h); NULL: -y. report: the caller releases it; empty after a failure. Same subjects for any
 * number of threads. */
enum status faces_find(struct subject_list *list, struct face_report *report, const struct camera_set *set,
                       const struct vec3 *ups, const struct face_source *source, const struct find_params *params,
                       struct err *err);
void face_report_release(struct face_report *report);

#endif
