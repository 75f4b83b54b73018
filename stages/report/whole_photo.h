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
 * averaged; else its centre counts, for pictures whose colours are codes. Samples that are black in `known` (of which
 * there is one for each view) do not count; where nothing does, and where no view shows anything, the picture is
 * black, and covered (NULL, or a byte for each pixel) is 0. */
enum status whole_photo_picture(struct picture *p, const struct whole_photo *w, const struct image *layers,
                                const struct image *known, const float fallback[3], bool smooth, unsigned char *covered,
                                struct err *err);

/* Fills what is not covered from the photo itself, which is multiplied by its mean ratio to the picture where both are
 * well exposed, for each colour. rest: of the size of p. */
void whole_photo_fill(struct picture *p, const unsigned char *covered, const struct picture *rest,
                      const double gain[3]);
/* That ratio; 1 where they have nothing in common. */
void whole_photo_find_gain(double gain[3], const struct picture *p, const unsigned char *covered,
                           const struct picture *rest);

#endif
