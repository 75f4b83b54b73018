/* faces.h - the faces that a scene's photographs show: seen in a central view, and at the same place in space in
 * others.
 *
 * Pixels are a view's, depth is along its axis. Where pictures come from and who sees faces in them is the caller's:
 * the stage gives files and OpenCV's cascades, tests give what they know. */
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
    /* The caller releases it. */
    enum status (*depth)(void *ctx, int view_idx, struct layered_depth *d, struct err *err);
    /* As face_detect(). */
    enum status (*detect)(void *ctx, const unsigned char *grey, int width, int height, double least, double most,
                          struct face **faces, int *count, struct err *err);
};

enum face_verdict {
    FACE_KEPT,
    FACE_BEYOND,      /* kept would be more than two: smaller */
    FACE_NO_DEPTH,    /* no pixel of it has a depth: not a subject */
    FACE_UNCONFIRMED, /* too few of the other views see a face there */
    FACE_UNSURE,      /* the mean of the views' scores is too low */
};

struct face_sighting { /* what became of one that was worth a second look */
    struct subject subject;
    enum face_verdict verdict;
    bool alone; /* fewer than two views could be asked: its score alone decides */
};

struct face_report {
    struct face_sighting *sightings; /* view by view, in a view from the largest to the smallest */
    int count, views;                /* views that were looked at */
};

#define MOST_FACES 2

/* Adds at most MOST_FACES subjects, the largest first. ups: each view's upright direction (common/capture/upright.h); NULL: -y.
 * Same subjects for any number of threads. */
enum status find_faces(struct subject_list *list, struct face_report *report, const struct camera_set *set,
                       const struct vec3 *ups, const struct face_source *source, const struct find_params *params,
                       struct err *err);
void face_report_release(struct face_report *report);

#endif
