/* subject_list.h - what a camera move shows: rectangles in space around faces, or where a user drew them;
 * out/SCENE/parallax/subjects.txt.
 *
 *   remodel-subjects 1
 *   subjects N
 *   subject VIEW face|user X0 Y0 X1 Y1 DEPTH SCORE CONFIRMED ASKED
 *   corner X Y Z                         four a subject: upper left, upper right, lower right, lower left
 * The rectangle is in the view's pixels, x to the right and y down; it stands in space at one depth along the view's
 * axis, parallel to its picture. Corners are in the world, named as the upright picture shows them: a view that is
 * stored turned begins with another corner of its rectangle. Moves use the first two subjects. */
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
    double score;          /* of the detections, more is surer; 0: a user's */
    int confirmed, asked;  /* other views that see a face there too, of those that were asked; 0: a user's */
    struct vec3 corner[4];
};

struct subject_list {
    struct subject *subjects;
    int count;
};

/* No subject is a valid list. ST_DATA with file and line: numbers out of the ranges above, corners that span no
 * area. */
enum status subject_list_read(struct subject_list *list, const char *path, struct err *err);
enum status subject_list_write(const struct subject_list *list, const char *path, const struct provenance *prov,
                               struct err *err);
/* Takes s over, whose view is then empty; on failure too. */
enum status subject_list_add(struct subject_list *list, struct subject *s, struct err *err);
void subject_release(struct subject *s);
void subject_list_release(struct subject_list *list);

/* Sets the corners from the rectangle and the depth. up: the upright direction in the view's axes, or NULL: -y. */
void subject_place(struct subject *s, const struct view *view, const struct vec3 *up);

struct vec3 subject_center(const struct subject *s);
struct vec3 subject_lower_center(const struct subject *s); /* the middle of the lower half */
/* Height in a camera's pixels: from the middle of the upper to that of the lower edge; 0 if one is not in front of
 * it. */
double subject_size_in(const struct subject *s, const struct view *camera);

#endif
