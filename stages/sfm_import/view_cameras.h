/* view_cameras.h - from a photo's lens to the pinhole cameras of its views.
 *
 * 1. The field of view is measured along the two midlines of the photo's border. A field wider than `max_field` in
 *    either direction becomes up to five square pinhole views of 90 degrees with the photo's centre: 0 forward, 1
 *    left, 2 right, 3 up, 4 down. Of 1 to 4, those with less than a quarter of their pixels inside the photo are left
 *    out.
 * 2. A narrower SIMPLE_PINHOLE or PINHOLE photo within `max_megapixels` keeps its camera and its pixels. 3. Any other
 * photo becomes one PINHOLE view with the lens's focal lengths and principal point. Its borders are moved so
 *    that the view is the largest upright rectangle found inside the photo.
 * 4. A view of more than `max_megapixels` (0: no limit) is scaled down with its aspect kept.
 *
 * Pixels are those of the stored photo; pixel (x, y) has its centre at (x + 0.5, y + 0.5). */
#ifndef REMODEL_VIEW_CAMERAS_H
#define REMODEL_VIEW_CAMERAS_H

#include "common/capture/camera.h"

enum { MAX_PHOTO_VIEWS = 5 };

struct photo_view {
    int part;                    /* -1: the photo's only view; otherwise k of PHOTO@k */
    struct camera camera;        /* SIMPLE_PINHOLE or PINHOLE */
    struct quat view_from_photo; /* 1 0 0 0 for the only view and the forward one */
};

/* Angles in radians that the horizontal and the vertical midline span; pixels without a ray do not count. */
void view_lens_field(const struct camera *lens, double *horizontal, double *vertical);

/* max_field is in degrees. ST_DATA: the lens leaves no picture. */
enum status view_cameras_of_photo(struct photo_view views[MAX_PHOTO_VIEWS], int *count, const struct camera *lens,
                                  double max_megapixels, double max_field, struct err *err);

#endif
