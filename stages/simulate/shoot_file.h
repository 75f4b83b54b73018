/* shoot_file.h - what the photographer did, as scenes/NAME/cameras.txt tells it (docs/scenes.md), and the lenses.
 *
 * Camera axes: x right, y down, z forward; pixel (x, y) has its centre at (x + 0.5, y + 0.5). */
#ifndef REMODEL_SIMULATE_SHOOT_FILE_H
#define REMODEL_SIMULATE_SHOOT_FILE_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/err.h"
#include "common/base/provenance.h"
#include "common/capture/camera.h"

enum lens_kind { LENS_PINHOLE, LENS_EQUISOLID };

struct lens {
    char *name;
    enum lens_kind kind;
    int width, height;
    double fx, fy, cx, cy; /* px; equisolid: r = 2 fx sin(theta / 2), fy = fx */
};

struct exposure {
    double seconds, f_number, iso, filter; /* filter: a neutral one divides the light by this */
};

struct sensor {
    double full_well, read_noise; /* electrons */
    double gain;                  /* signal of radiance 1 in 1 s at f/8, ISO 100; 1 is white */
    uint64_t seed;
};

struct shot {
    char *name;
    int lens;
    bool reference; /* a lighting reference image */
    struct vec3 at, look_at;
    double roll; /* degrees, clockwise as the photographer sees it */
    struct pose cam_from_world;
};

struct shoot {
    struct lens *lenses;
    struct exposures {
        struct exposure *list;
        int count;
    } exposures[2]; /* of photos, of reference images */
    struct shot *shots;
    int lens_count, shot_count;
    struct sensor sensor;
    int quality; /* of the JPEGs */
};

/* Reads FOLDER/cameras.txt; sizes and focal lengths are multiplied by `scale`. ST_DATA with file, line, what was found
 * and what was wanted. */
enum status shoot_read(struct shoot *s, const char *folder, double scale, struct provenance *prov, struct err *err);
void shoot_release(struct shoot *s);
const struct exposures *shoot_exposures(const struct shoot *s, const struct shot *shot);
int shoot_find(const struct shoot *s, const char *name); /* -1: none */

/* Pixel -> unit ray in camera coordinates, and back. False: an equisolid lens shows nothing there; a pinhole sees
 * nothing behind it. */
bool lens_ray(const struct lens *l, double u, double v, struct vec3 *ray);
bool lens_project(const struct lens *l, struct vec3 p, double *u, double *v);

/* COLMAP's model of it: PINHOLE, or OPENCV_FISHEYE with the series of 2 sin(theta / 2). */
struct camera lens_camera(const struct lens *l);

#endif
