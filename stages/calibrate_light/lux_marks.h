/* lux_marks.h - scenes/NAME/lux.txt: what somebody measured with a lux-meter or a luminance meter, in the light in
 * which the photos were taken.
 *
 *   remodel-lux 1
 *   illuminance NAME LUX in VIEW X Y [within PERCENT]           a meter that lies on the surface at this pixel
 *   illuminance NAME LUX on FACE [within PERCENT]               mean over a face of the model
 *   luminance NAME CD in VIEW X Y [X Y] [within PERCENT]        cd/m2 of a pixel, or of a rectangle of pixels
 *
 * VIEW is a photo's id or a view's name; pixels are those of the stored photo. PERCENT: the meter's error, 95 %. */
#ifndef REMODEL_LUX_MARKS_H
#define REMODEL_LUX_MARKS_H

#include "common/base/provenance.h"
#include "common/daylight/lux_scale.h"

struct lux_mark {
    enum lux_kind kind;
    int line;                       /* of the file */
    char *name, *view, *face;       /* owned; view or face is NULL */
    double value, pixel[4], within; /* lx or cd/m2; x y of one or two pixels; a part, -1: not stated */
    int pixels;                     /* 1 or 2; 0: of a face */
};

/* {0} is the empty state; everything is owned. */
struct lux_marks {
    struct lux_mark *items;
    int count;
    char *path; /* for errors */
};

/* ST_DATA with file and line: an unknown word, a name twice, a value that is not above 0, nothing measured. */
enum status lux_marks_read(struct lux_marks *marks, const char *path, struct provenance *prov, struct err *err);
void lux_marks_release(struct lux_marks *marks);

#endif
