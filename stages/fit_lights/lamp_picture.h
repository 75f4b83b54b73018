/* lamp_picture.h - a lamp on the views that show it and its light best. */
#ifndef REMODEL_FIT_LIGHTS_LAMP_PICTURE_H
#define REMODEL_FIT_LIGHTS_LAMP_PICTURE_H

#include "common/image/draw.h"
#include "stages/fit_lights/cone_edge.h"
#include "stages/fit_lights/lit_scene.h"

/* The length of the parts of a curve that a view (in the model's frame) shows, as a fraction of the view's width; draws
 * them on k unless that is NULL. A point is seen if it is in the picture, its surface faces the camera, and the model
 * does not hide it. */
double lamp_curve_draw(const struct canvas *k, const struct curve *c, const struct view *view,
                       const struct model_rays *model, double half, const unsigned char colour[3]);

/* For each lamp of the scene FOLDER/NAME.jpg (light_list_lamp_file()): the view that shows most of the edge of its cone
 * and of its marks, and beside it, where that one does not show the lamp, the one that shows it best. The lamp's
 * outline is green, the edge of its cone orange; lit points are yellow, unlit ones blue, lines violet. A lamp that no
 * view shows has no picture. views: folder of VIEW.exr. */
enum status lamp_pictures_write(const struct lit_scene *scene, const struct lit_model *model, const char *views,
                                const char *folder, struct err *err);

#endif
