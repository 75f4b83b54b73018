/* camera_set.h - the rectified views of a scene: named pinhole cameras and the sparse points that they see.
 *
 * out/SCENE/views/{cameras,images,points3D}.txt; an image is named "VIEW.exr", its view "VIEW". */
#ifndef REMODEL_CAMERA_SET_H
#define REMODEL_CAMERA_SET_H

#include <stdbool.h>

#include "common/capture/sfm_model.h"
#include "common/capture/view.h"

struct camera_set {
    struct view *views; /* in order of name */
    int view_count;
    struct sfm_model model; /* points, observations (in rectified pixels); images in the order of the views */
};

/* ST_DATA for camera models other than PINHOLE and SIMPLE_PINHOLE. */
enum status camera_set_read(struct camera_set *set, const char *folder, struct provenance *prov, struct err *err);
/* The same without points and observations, of which there are many in a scene of many views. */
enum status camera_set_read_cameras(struct camera_set *set, const char *folder, struct provenance *prov,
                                    struct err *err);
/* Leaves only the views that are marked in keep[set->view_count], and the points that they see. Views keep their order.
 * The set is unchanged on failure. */
enum status camera_set_keep(struct camera_set *set, const bool *keep, struct err *err);
int camera_set_find(const struct camera_set *set, const char *name); /* -1: not found */
/* Whether at least two views show a point and what lies below it, for a twentieth of its depth. If not, the points may
 * end there only because the photos do. down: unit vector in the world. */
bool camera_set_shows_below(const struct camera_set *set, struct vec3 point, struct vec3 down);
void camera_set_release(struct camera_set *set);

#endif
