/* thing_marks.h - names of things and the places where users marked them: scenes/NAME/things.txt.
 *
 *   remodel-marked-things 1
 *   thing NAME in VIEW X Y [in VIEW X Y ...]
 *   flat NAME in VIEW X Y X Y X Y ...
 *
 * flat: what lies flat on a face of the model, such as a rug or a picture: the corners of its outline, in order, or one
 * pixel of it.
 * VIEW: a photo's id or a view's name; X Y: a pixel of the stored photo. */
#ifndef REMODEL_THING_MARKS_H
#define REMODEL_THING_MARKS_H

#include "common/base/provenance.h"
#include "common/capture/camera_set.h"
#include "common/capture/lens_list.h"

struct thing_mark {
    int name, line;                /* index into names; of the file */
    char *view;                    /* as it was written; owned */
    double u, v;                   /* px */
    struct vec3 origin, direction; /* of the pixel's ray, world */
};

/* {0} is the empty state; everything is owned. */
struct thing_marks {
    char **names; /* in the order of the file */
    int *lines;   /* in which each name stands first */
    struct thing_mark *marks;
    bool *flat; /* of each name: its marks are the corners of an outline, or one pixel */
    int name_count, mark_count;
};

/* ST_DATA with file and line: a name that no script could use, or that stands for a thing
 * and for an outline, an outline of two corners, an unknown view, a pixel outside of its photo. A failure
 * leaves marks empty. */
enum status thing_marks_read(struct thing_marks *marks, const char *path, const struct camera_set *set,
                             const struct lens_list *lenses, struct provenance *prov, struct err *err);
/* The same without cameras: names and lines alone; views and pixels are not checked, and there are no marks. */
enum status thing_names_read(struct thing_marks *marks, const char *path, struct provenance *prov, struct err *err);
void thing_marks_release(struct thing_marks *marks);

#endif
