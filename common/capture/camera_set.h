/* camera_set.h - the rectified views of a scene: named pinhole cameras and the sparse points that they see.
 *
 * out/SCENE/views/{cameras,images,points3D}.txt; an image is named "VIEW.exr", its view "VIEW". */
#ifndef REMODEL_CAMERA_SET_H
#define REMODEL_CAMERA_SET_H

#include <stdbool.h>

#include "common/capture/sfm_model.h"

struct view {
    const char *name; /* without .exr; owned by the set */
    int width, height;
    double fx, fy, cx, cy;
    struct mat3 cam_from_world;
    struct vec3 translation; /* p_cam = cam_from_world p_world + translation */
    struct vec3 center;
};

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
void camera_set_release(struct camera_set *set);

/* Returns the depth of a world point along the camera's z axis, and its pixel if the depth is > 0. */
double view_project(const struct view *view, struct vec3 world, double *u, double *v);
/* World point of a pixel at depth z (along the axis, not along the ray). */
struct vec3 view_unproject(const struct view *view, double u, double v, double z);

/* The camera moved to a point (a, b) of the lens, an offset of its centre along its x and y axes in scene units. The
 * principal point is shifted so that points at the depth `focus` keep their pixels. */
struct view view_from_lens_point(const struct view *view, double a, double b, double focus);
/* The same picture with another number of pixels. */
void view_resize(struct view *view, int width, int height);

#endif
