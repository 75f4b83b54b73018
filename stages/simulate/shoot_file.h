/* shoot_file.h - lenses, exposures, sensor and camera positions of a described scene: scenes/NAME/cameras.txt
 * (docs/scenes.md).
 *
 * Camera axes: x right, y down, z forward; pixel (x, y) has its centre at (x + 0.5, y + 0.5). */
#ifndef REMODEL_SIMULATE_SHOOT_FILE_H
#define REMODEL_SIMULATE_SHOOT_FILE_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/err.h"
#include "common/base/provenance.h"
#include "common/capture/camera.h"

enum shoot_lens_kind { SHOOT_PINHOLE, SHOOT_EQUISOLID };

struct shoot_lens {
    char *name;
    enum shoot_lens_kind kind;
    int width, height;
    double fx, fy, cx, cy; /* px; equisolid: r = 2 fx sin(theta / 2), fy = fx */
    double circle;         /* equisolid: degrees across the image circle, outside of which pictures are black; 0: all */
};

struct shoot_exposure {
    double seconds, f_number, iso, filter; /* filter: a neutral-density filter divides the light by this factor */
};

struct shoot_exposure_list {
    struct shoot_exposure *list;
    int count;
};

struct shoot_sensor {
    double full_well, read_noise; /* electrons */
    double gain;                  /* signal of radiance 1 after 1 s at f/8, ISO 100; signal 1 is white */
    uint64_t seed;
};

/* A photo, a lighting reference image, or a camera that nobody photographed with: truth only. */
enum shoot_kind { SHOOT_PHOTO, SHOOT_REFERENCE, SHOOT_WITNESS };

struct shoot_photo {
    char *name;
    int lens; /* index */
    enum shoot_kind kind;
    int exposure; /* the only one that is taken; -1: all of its kind */
    bool own_sun; /* the sun stands here while the photo is taken: */
    double sun_azimuth, sun_elevation;
    struct vec3 at, look_at;
    double roll; /* degrees, clockwise as seen by the photographer */
    struct pose cam_from_world;
};

struct shoot {
    struct shoot_lens *lenses;
    struct shoot_exposure_list exposures[2]; /* of photos, of reference images */
    struct shoot_photo *photos;
    int lens_count, photo_count;
    struct shoot_sensor sensor;
    int quality; /* of the JPEGs, 1..100 */
};

/* Reads FOLDER/cameras.txt; image sizes and focal lengths are multiplied by `scale`. ST_DATA names file, line, the word
 * found and the word expected. The caller releases *s; on failure there is nothing to release. prov may be NULL. */
enum status shoot_read(struct shoot *s, const char *folder, double scale, struct provenance *prov, struct err *err);
void shoot_release(struct shoot *s);
/* Those that a photo has. Reference images without exposures of their own have those of the photos. */
struct shoot_exposure_list shoot_exposures(const struct shoot *s, const struct shoot_photo *photo);
int shoot_find(const struct shoot *s, const char *name); /* index of a photo, reference image or witness; -1: none */

/* Pixel to unit ray in camera coordinates, and back. False outside the image circle of an equisolid lens, and behind a
 * pinhole. */
bool shoot_lens_ray(const struct shoot_lens *l, double u, double v, struct vec3 *ray);
bool shoot_lens_project(const struct shoot_lens *l, struct vec3 p, double *u, double *v);

/* The lens as a COLMAP camera: PINHOLE, or OPENCV_FISHEYE with the series of 2 sin(theta / 2). */
struct camera shoot_lens_camera(const struct shoot_lens *l);

#endif
