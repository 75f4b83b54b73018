/* sky_patches.c - the sky in patches.
 *
 * Overview. [Tregenza 1987] divides the sky into seven rows of patches of 12 degrees in altitude and a cap around the
 * zenith, of 145 patches of nearly equal solid angle, for instruments that scan the sky. [Bourgeois 2008] divides each
 * further, for simulation: with MF:m each patch becomes m x m, and the cap keeps one patch of half a row.
 *
 * Mathematics. A row is 90 / (7 m + 1/2) degrees high, so that the cap reaches half of that from the zenith. Patches of
 * a row have the same width in azimuth. Between sines s and t of the altitude a full turn has the solid angle 2 pi
 * (t - s), and its share of a horizontal illuminance is pi (t^2 - s^2). */
#include "common/daylight/sky_patches.h"

#include "common/math/numbers.h"

enum { TREGENZA_ROWS = 7 };
static const int in_row[TREGENZA_ROWS] = {30, 30, 24, 24, 18, 12, 6};

enum status sky_patches_init(struct sky_patches *s, int subdivision, double north, struct err *err)
{
    if (subdivision < 1 || subdivision > SKY_SUBDIVISION_MAX)
        return err_set(err, ST_USAGE, "a subdivision of the sky of %d: wanted 1 to %d.", subdivision,
                       SKY_SUBDIVISION_MAX);
    *s = (struct sky_patches){.subdivision = subdivision, .north = north, .rows = TREGENZA_ROWS * subdivision + 1};
    const double height = 90 / (TREGENZA_ROWS * subdivision + 0.5);
    int patch = SKY_GROUND + 1;
    for (int row = 0; row < s->rows; row++) {
        s->first[row] = patch;
        s->edge[row] = sin(row * height * DEGREE);
        patch += row < s->rows - 1 ? in_row[row / subdivision] * subdivision : 1;
    }
    s->first[s->rows] = s->count = patch;
    s->edge[s->rows] = 1;
    return ST_OK;
}

static int row_of(const struct sky_patches *s, int patch)
{
    int row = 0;
    while (patch >= s->first[row + 1]) row++;
    return row;
}

static int width_of(const struct sky_patches *s, int row) { return s->first[row + 1] - s->first[row]; }

struct vec3 sky_compass_direction(double north, double azimuth, double altitude)
{
    const double turn = (north - azimuth) * DEGREE, up = altitude * DEGREE;
    return vec3_make(cos(up) * cos(turn), cos(up) * sin(turn), sin(up));
}

struct vec3 sky_patch_direction(const struct sky_patches *s, int patch)
{
    if (patch == SKY_GROUND) return vec3_make(0, 0, -1);
    const int row = row_of(s, patch);
    if (row == s->rows - 1) return vec3_make(0, 0, 1);
    const double height = 90 / (TREGENZA_ROWS * s->subdivision + 0.5);
    return sky_compass_direction(s->north, 360.0 * (patch - s->first[row]) / width_of(s, row), (row + 0.5) * height);
}

double sky_patch_solid_angle(const struct sky_patches *s, int patch)
{
    if (patch == SKY_GROUND) return 2 * PI;
    const int row = row_of(s, patch);
    return 2 * PI * (s->edge[row + 1] - s->edge[row]) / width_of(s, row);
}

double sky_patch_projected(const struct sky_patches *s, int patch)
{
    if (patch == SKY_GROUND) return 0;
    const int row = row_of(s, patch);
    return PI * (s->edge[row + 1] * s->edge[row + 1] - s->edge[row] * s->edge[row]) / width_of(s, row);
}

int sky_patch_at(const struct sky_patches *s, struct vec3 direction)
{
    if (direction.z < 0) return SKY_GROUND;
    int row = s->rows - 1;
    while (row > 0 && direction.z < s->edge[row]) row--;
    const int width = width_of(s, row);
    const double east = s->north / 360 - atan2(direction.y, direction.x) / (2 * PI); /* turns from north */
    const int column = (int)floor(width * (east - floor(east)) + 0.5);
    return s->first[row] + column % width;
}

struct vec3 sky_patch_point(const struct sky_patches *s, int patch, double u, double v)
{
    double low = -1, high = 0, azimuth = 360 * u;
    if (patch != SKY_GROUND) {
        const int row = row_of(s, patch);
        low = s->edge[row], high = s->edge[row + 1];
        azimuth = 360 * (patch - s->first[row] + u - 0.5) / width_of(s, row);
    }
    return sky_compass_direction(s->north, azimuth, asin(low + v * (high - low)) / DEGREE);
}
