/* sky_patches.h - the sky in patches: Tregenza's 145, and Reinhart's subdivision of them.
 *
 * Directions are unit vectors in the model's frame, z up; azimuth counts from x towards y, in degrees. A compass counts
 * from north towards east, the other way around: north is the azimuth of the model's frame in which it lies.
 *
 * Patch 0 is the ground, everything below the horizon. Then come the rows of patches, the lowest first. The first patch
 * of a row is centred at north, the next ones follow towards east; the zenith is the last. These are the order and the
 * numbers of Radiance's gendaymtx and genskyvec. */
#ifndef REMODEL_SKY_PATCHES_H
#define REMODEL_SKY_PATCHES_H

#include "common/base/err.h"
#include "common/math/vec.h"

enum {
    SKY_GROUND = 0,
    SKY_SUBDIVISION_MAX = 8,
    SKY_ROWS_MAX = 7 * SKY_SUBDIVISION_MAX + 1 /* with the zenith */
};

/* Holds no memory. */
struct sky_patches {
    int subdivision;               /* MF: 1 for Tregenza's patches; each is MF x MF smaller ones */
    double north;                  /* degrees */
    int count;                     /* with the ground: 144 MF^2 + 2 */
    int rows;                      /* with the zenith: 7 MF + 1 */
    int first[SKY_ROWS_MAX + 1];   /* first patch of each row; last, count */
    double edge[SKY_ROWS_MAX + 1]; /* sine of the lower edge of each row; last, 1 */
};

/* ST_USAGE: the subdivision is not 1 to SKY_SUBDIVISION_MAX. */
enum status sky_patches_init(struct sky_patches *s, int subdivision, double north, struct err *err);

/* The centre: halfway between its edges in altitude and azimuth. The ground's is straight down. */
struct vec3 sky_patch_direction(const struct sky_patches *s, int patch);
/* Steradian. Those of the sky sum to 2 pi; the ground has 2 pi. */
double sky_patch_solid_angle(const struct sky_patches *s, int patch);
/* The solid angle times the mean of the sine of the altitude, the patch's share of a horizontal illuminance. Those of
 * the sky sum to pi; the ground has 0. */
double sky_patch_projected(const struct sky_patches *s, int patch);
/* The patch of a unit direction; at an edge the upper one, and the one towards east. */
int sky_patch_at(const struct sky_patches *s, struct vec3 direction);
/* The direction at u, v of 0 to 1 within a patch, the ground included: uniform u, v are uniform in solid angle. */
struct vec3 sky_patch_point(const struct sky_patches *s, int patch, double u, double v);

/* The unit vector at an azimuth of a compass, from north towards east, and an altitude, both in degrees. */
struct vec3 sky_compass_direction(double north, double azimuth, double altitude);

#endif
