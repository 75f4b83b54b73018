/* export_lamps.c - see export_lamps.h.
 *
 * Mathematics. Programs know lamps with a cone [KHR_lights_punctual]. The cone ends where the mean intensity about the
 * axis has fallen to a tenth of its largest, and begins to fall where it has half of that. The light of such a cone is
 * I 2 pi ((1 - cos inner) + (cos inner - cos outer) / 3), which is set equal to the lumens of the file; so a program
 * without photometry has a room as bright, if not the same pattern on its walls. A lamp that sends more than a tenth of
 * its light upwards shines to all sides. */
#include "stages/export_model/export_lamps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/numbers.h"
#include "common/model/model_metre.h"
#include "common/texture/texture_map.h"

enum { STEPS = 180, AROUND = 24 };                                        /* half degrees down; around the axis */
static const double LEAST = 0.04, FALLS = 0.5, ENDS = 0.1, UPWARDS = 0.1; /* m; of the largest; of all light */
static const double NARROW = 0.5 * DEGREE;

void export_lamps_release(struct export_lamps *l)
{
    for (int i = 0; l->files && i < l->planned.count; i++) free(l->files[i]);
    free(l->files);
    planned_lamps_release(&l->planned);
    *l = (struct export_lamps){.metre = 0};
}

enum status export_lamps_read(struct export_lamps *l, const struct texture_map *map, const char *scene,
                              const struct model_axes *axes, const struct model_plan *plan, struct provenance *prov,
                              struct err *err)
{
    struct model_metre metre;
    *l = (struct export_lamps){.files = calloc((size_t)map->planned_count + 1, sizeof *l->files)};
    if (!l->files) return err_nomem(err, "lamps", (size_t)map->planned_count * sizeof *l->files);
    if (model_metre_find(&metre, axes, plan, MODEL_METRE_ROOM, err)) return err->status;
    l->metre = metre.units;
    for (int i = 0; i < map->planned_count; i++) {
        const char *file = map->planned[i].file;
        if (planned_lamps_add(&l->planned, &map->planned[i], scene, prov, err)) return err->status;
        if (!(l->files[i] = strdup(file))) return err_nomem(err, "a name", strlen(file) + 1);
    }
    return ST_OK;
}

int export_lamps_outline(struct vec3 corners[PLANNED_LAMP_CORNERS], const struct export_lamps *l, int lamp)
{
    return planned_lamp_outline(corners, &l->planned.list[lamp], LEAST, l->metre);
}

void export_lamps_colour(double rgb[3], const struct planned_lamp *l)
{
    const double most = rgb_max(l->colour);
    rgb[0] = l->colour.r / most;
    rgb[1] = l->colour.g / most;
    rgb[2] = l->colour.b / most;
}

double export_lamps_lumens(const struct planned_lamp *l)
{
    return photometry_tilt(&l->web, acos(clamp(-l->down.z, -1, 1)) / DEGREE) * rgb_luminance(l->colour) *
           photometry_lumens(&l->web);
}

/* The mean intensity at an angle from the axis. */
static double mean_at(const struct photometry *p, double degrees)
{
    double sum = 0;
    for (int k = 0; k < AROUND; k++) sum += photometry_intensity(p, degrees, 360.0 * k / AROUND) / AROUND;
    return sum;
}

bool export_lamps_cone(struct lamp_cone *cone, const struct planned_lamp *l)
{
    double most = 0, up = 0, all = 0;
    for (int i = 0; i <= 2 * STEPS; i++) {
        const double angle = 90.0 * i / STEPS, mean = mean_at(&l->web, angle), part = mean * sin(angle * DEGREE);
        if (i <= STEPS) most = fmax(most, mean);
        if (i > STEPS) up += part;
        all += part;
    }
    const double lumens = export_lamps_lumens(l);
    *cone = (struct lamp_cone){.candela = lumens / (4 * PI)};
    if (up > UPWARDS * all) return false;
    for (int i = 0; i <= STEPS; i++) {
        const double angle = 90.0 * i / STEPS, mean = mean_at(&l->web, angle);
        if (mean >= FALLS * most) cone->inner = angle * DEGREE;
        if (mean >= ENDS * most) cone->outer = angle * DEGREE;
    }
    cone->outer = fmax(cone->outer, NARROW);
    cone->inner = fmin(cone->inner, cone->outer - NARROW / 2);
    const double from = cos(cone->inner), to = cos(cone->outer);
    cone->candela = lumens / (2 * PI * (1 - from + (from - to) / 3));
    return true;
}
