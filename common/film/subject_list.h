/* subject_list.h - subjects of camera moves: rectangles in space around faces or around regions drawn by a user;
 * out/SCENE/parallax/subjects.txt.
 *
 *   remodel-subjects 1
 *   subjects N
 *   subject VIEW face|user X0 Y0 X1 Y1 DEPTH SCORE CONFIRMED ASKED
 *   corner X Y Z                         four per subject: upper left, upper right, lower right, lower left
 * The rectangle is in pixels of the view, x to the right and y down; in space it is parallel to the picture plane, at
 * one depth along the view's axis. Corners are in the world and named after the upright picture: for a view stored on
 * its side, the first corner is not that of (X0, Y0). Moves use the first two subjects. */
#ifndef REMODEL_SUBJECT_LIST_H
#define REMODEL_SUBJECT_LIST_H

#include <stdbool.h>

#include "common/base/provenance.h"
#include "common/capture/camera_set.h"

enum subject_source { SUBJECT_FACE, SUBJECT_USER };

struct subject {
    char *view; /* owned */
    enum subject_source source;
    double x0, y0, x1, y1; /* x0 < x1, y0 < y1 */
    double depth;          /* > 0, scene units */
    double score;          /* of the detections, higher is more certain; 0 for SUBJECT_USER */
    int confirmed, asked;  /* other views in which a face was found there too, of those searched; 0 for SUBJECT_USER */
    struct vec3 corner[4];
};

struct subject_list {
    struct subject *subjects;
    int count;
};

/* An empty list is valid. ST_DATA with file and line: a number out of the ranges above, corners that span no area. */
enum status subject_list_read(struct subject_list *list, const char *path, struct provenance *prov, struct err *err);
enum status subject_list_write(const struct subject_list *list, const char *path, const struct provenance *prov,
                               struct err *err);
/* Takes ownership of s and empties it, on failure too. */
enum status subject_list_add(struct subject_list *list, struct subject *s, struct err *err);
void subject_release(struct subject *s);
void subject_list_release(struct subject_list *list);

/* Sets the corners from the rectangle and the depth. up: the upright direction in the view's camera; NULL: -y. */
void subject_set_corners(struct subject *s, const struct view *view, const struct vec3 *up);

struct vec3 subject_center(const struct subject *s);
struct vec3 subject_lower_center(const struct subject *s); /* centre of the lower half */
/* Height in a camera's pixels, between the midpoints of the upper and the lower edge; 0 if either is not in front of
 * the camera. */
double subject_size_in(const struct subject *s, const struct view *camera);

#endif
