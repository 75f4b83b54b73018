/* axes_pictures.h - draws the axes and the outlines of floor and ceiling on photographs, to check them by eye.
 *
 * x is red, y green, z blue: arrows on the floor, at a corner that the user marked or in the lower middle of the
 * picture. The floor's outline is yellow, the ceiling's cyan: the rectangle of the outermost walls. Lines are not
 * hidden by objects in front of them. */
#ifndef REMODEL_AXES_PICTURES_H
#define REMODEL_AXES_PICTURES_H

#include "common/image/image.h"
#include "stages/find_axes/room_axes.h"

/* Chooses the views to draw on: of `count` photos, spread evenly by name, and of photos with a marked corner, the view
 * nearest to the photo's axis. chosen: an item per view, false on entry. ST_DATA: a corner's view is unknown. */
enum status pictures_choose(bool *chosen, int count, const struct room_inputs *in, struct err *err);

/* pixels: 8-bit sRGB of the view, 3 * w * h, which is drawn on. corners: world points of marked corners. */
void pictures_draw_room(unsigned char *pixels, const struct view *view, const struct room *room,
                        const struct vec3 *corners, int corner_count);

/* pixels: 8-bit sRGB of a view's linear picture, exposed so that all but its brightest 5 % is below white. */
enum status pictures_expose(unsigned char *pixels, const struct image *im, struct err *err);

#endif
