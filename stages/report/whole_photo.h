/* whole_photo.h - pictures of a photo's views, put together again as the photograph that people took.
 *
 * A photo too wide for one pinhole view became several, which overlap, and reach beyond the photo. Each pixel of the
 * photo is looked up, through its lens, in the view that it is nearest to the middle of. */
#ifndef REMODEL_WHOLE_PHOTO_H
#define REMODEL_WHOLE_PHOTO_H

#include "common/capture/camera_set.h"
#include "common/capture/lens_list.h"
#include "common/image/image.h"
#include "stages/report/page_pictures.h"

struct whole_photo_pixel {
    int view;   /* -1: no view shows it */
    float u, v; /* its centre in that view, px */
};

/* The pixels of the upright photo. {0} is the empty state. */
struct whole_photo {
    int width, height;
    struct whole_photo_pixel *pixels; /* owned */
};

/* `lenses` of the photo's views, `views` their cameras. The picture is at most `upright` px high once it is turned by
 * the EXIF orientation, and never larger than the photo. ST_NOMEM. */
enum status whole_photo_init(struct whole_photo *w, const struct lens *lenses, const struct view *views, int count,
                             int orientation, int upright, struct err *err);
void whole_photo_release(struct whole_photo *w);

/* layers[i] is view i's picture, linear; one without data shows `fallback` instead. With smooth, what a pixel covers is
 * averaged; else its centre counts, for pictures whose colours are codes. What no view shows, and samples that are
 * black in `known` (of which there is one for each view), do not count; where nothing does, the picture is black. */
enum status whole_photo_picture(struct picture *p, const struct whole_photo *w, const struct image *layers,
                                const struct image *known, const float fallback[3], bool smooth, struct err *err);

#endif
