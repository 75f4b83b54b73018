/* pictures.h - the axes, the floor's and the ceiling's outline drawn on photographs, to check them by eye.
 *
 * x is red, y green, z blue: arrows on the floor, at a corner that the user marked or in the lower middle of the
 * picture. The floor's outline is yellow, the ceiling's cyan: the rectangle of the outermost walls. A line is not
 * hidden by what stands before it. */
#ifndef REMODEL_AXES_PICTURES_H
#define REMODEL_AXES_PICTURES_H

#include "common/image/image.h"
#include "stages/find_axes/room.h"

/* The views to draw on: of `count` photos, evenly by name, and of those with a corner, the view that looks straightest
 * along the photo's axis. chosen: of each view; false on entry. ST_DATA: a corner's view that is not there. */
enum status choose_pictures(bool *chosen, int count, const struct room_inputs *in, struct err *err);

/* pixels: 8-bit sRGB of the view, 3 * w * h; drawn on. corners: world points of marked corners. */
void draw_room(unsigned char *pixels, const struct view *view, const struct room *room, const struct vec3 *corners,
               int corner_count);

/* 8-bit sRGB of a view's linear picture, exposed so that all but its brightest twentieth is below white. */
enum status picture_to_look_at(unsigned char *pixels, const struct image *im, struct err *err);

#endif
