/* camera_set.h - the rectified views of a scene: pinhole cameras with names, and the sparse points they saw.
 *
 * out/SCENE/views/{cameras,images,points3D}.txt; an image's name there is "VIEW.exr", its view is "VIEW". */
#ifndef REMODEL_CAMERA_SET_H
#define REMODEL_CAMERA_SET_H

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
    struct sfm_model model; /* points, observations (in rectified pixels), same order of images */
};

/* PINHOLE and SIMPLE_PINHOLE only. */
enum status camera_set_read(struct camera_set *set, const char *folder, struct err *err);
/* Names the three files of the folder as inputs: views/cameras.txt, images.txt, points3D.txt. */
enum status camera_set_add_inputs(struct provenance *prov, const char *folder, struct err *err);
int camera_set_find(const struct camera_set *set, const char *name); /* -1: not there */
void camera_set_release(struct camera_set *set);

/* Depth along the camera's z axis and pixel of a world point; z <= 0: behind, u and v unset. */
double view_project(const struct view *view, struct vec3 world, double *u, double *v);
/* World point of a pixel at depth z (along the axis, never along the ray). */
struct vec3 view_unproject(const struct view *view, double u, double v, double z);

/* The camera from a point (a, b) of a lens, an offset of its centre in the camera's x and y, scene units: what lies at
 * the depth `focus` stays where it is in the picture, by the principal point. */
struct view view_from_lens_point(const struct view *view, double a, double b, double focus);
/* The same picture with that many pixels. */
void view_resize(struct view *view, int width, int height);

#endif
