/* reference_marks.h - points of the room's model that a user marked in lighting reference images: scenes/NAME/lri.txt.
 *
 *   corner IMAGE OPENING left|right bottom|top X Y [outer]   a corner of an opening in a wall, as seen from the wall's
 *                                                            inside; outer: on the wall's outer face
 *   point IMAGE X Y MX MY MZ                                 a point at MX, MY, MZ in the model's frame
 *   lens IMAGE|* MODEL WIDTH HEIGHT PARAMS...                the image's lens, or that of all images, as in lenses.txt
 *   lens IMAGE|* EQUISOLID WIDTH HEIGHT F [CX CY]            an equisolid fisheye; default: centred
 *   near IMAGE MX MY MZ                                      where the camera is, roughly: of several poses that
 *                                                            explain the marks, the nearest is taken
 *   in IMAGE OPENING [at U V] looking out                    without marks: the camera is in an opening, on the outer
 *                                                            face of its wall, and looks straight out; U from the left
 *                                                            as seen from inside, V from the bottom, 0 to 1 (0.5 0.5)
 *   horizon IMAGE X Y X Y                                    beside `in`: two pixels of the horizon; without it the
 *                                                            camera counts as level
 *
 * IMAGE is the image's id or the file name of one of its exposures. X, Y are pixels of the image as it is stored, x to
 * the right and y down, (0, 0) its upper left corner. */
#ifndef REMODEL_REFERENCE_MARKS_H
#define REMODEL_REFERENCE_MARKS_H

#include "common/capture/camera.h"
#include "common/capture/photo_list.h"
#include "common/model/model_plan.h"

enum reference_mark_kind {
    REFERENCE_CORNER,
    REFERENCE_POINT,
    REFERENCE_LENS,
    REFERENCE_NEAR,
    REFERENCE_WINDOW,
    REFERENCE_HORIZON
};

struct reference_mark { /* a line of the file */
    enum reference_mark_kind kind;
    int line;
    char *image, *opening; /* owned; opening is NULL unless it is a corner's or a window's */
    bool right, top, outer;
    bool at;           /* of a window: U, V are stated */
    double x, y;       /* of a window: U, V */
    double other[2];   /* of a horizon: the second pixel */
    struct vec3 point; /* also where the camera is */
    struct camera lens;
};

struct reference_marks {
    struct reference_mark *marks;
    int count;
    char *path; /* owned; for errors */
};

/* The caller releases the list, which a failure leaves empty. ST_DATA with file and line: an unknown or damaged line,
 * or what was stated before. */
enum status reference_marks_read(struct reference_marks *list, const char *path, struct provenance *prov,
                                 struct err *err);
void reference_marks_release(struct reference_marks *list);

/* Whether the line is of this image; `*` is not. */
bool reference_mark_is_of(const struct reference_mark *m, const struct photo_record *image);
/* The position of a corner, point or window in the model's frame. *wall: that of the opening, NULL of a point. ST_DATA
 * with file and line: an opening that the plan does not have, or in a wall along no axis. */
enum status reference_mark_locate(struct vec3 *at, const struct model_wall **wall, const struct reference_mark *m,
                                  const struct reference_marks *list, const struct model_plan *plan, struct err *err);

#endif
