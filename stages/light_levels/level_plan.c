/* level_plan.c - see level_plan.h.
 *
 * Each point of a work plane is a square of its spacing, in the colour of its value (level_scale.h). In each square of
 * four points a level cuts the sides where it lies between their values, at the place of linear
 * interpolation. Every line has its level once a room. */
#include "stages/light_levels/level_plan.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/base/outfile.h"
#include "common/model/plan_sheet.h"
#include "stages/light_levels/level_lattice.h"
#include "stages/light_levels/level_scale.h"

struct drawing {
    const struct level_picture *picture;
    const struct sensors *sensors;
    struct plan_sheet sheet;
    struct level_scale scale;
};

static void put_square(const struct drawing *d, double x, double y, double side, double value)
{
    unsigned char c[3];
    level_scale_colour(&d->scale, value, c);
    fprintf(d->sheet.to, "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"#%02x%02x%02x\"/>\n",
            plan_sheet_x(&d->sheet, x - side / 2), plan_sheet_y(&d->sheet, y + side / 2), d->sheet.scale * side,
            d->sheet.scale * side, c[0], c[1], c[2]);
}

/* --------------------------------------------------------------------------------------------------------- isolines */

/* Where a level cuts the sides of a square: pairs of places. Corners are in order around it. */
static int cut_square(double cuts[4][2], const double corner[4][2], const double value[4], double level)
{
    int count = 0;
    for (int k = 0; k < 4; k++) {
        const int n = (k + 1) % 4;
        if ((value[k] < level) == (value[n] < level)) continue;
        const double t = (level - value[k]) / (value[n] - value[k]);
        for (int c = 0; c < 2; c++) cuts[count][c] = corner[k][c] + t * (corner[n][c] - corner[k][c]);
        count++;
    }
    return count;
}

static void put_level(const struct drawing *d, const struct level_lattice *l, double level)
{
    static const int around[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    bool named = false;
    for (int i = 0; i + 1 < l->height; i++)
        for (int j = 0; j + 1 < l->width; j++) {
            double corner[4][2], value[4], cuts[4][2];
            bool whole = true;
            for (int k = 0; k < 4; k++) {
                const int x = j + around[k][0], y = i + around[k][1], point = l->point[y * l->width + x];
                whole &= point >= 0;
                corner[k][0] = l->x + x * l->step;
                corner[k][1] = l->y + y * l->step;
                value[k] = point >= 0 ? d->picture->values[point] : 0;
            }
            const int count = whole ? cut_square(cuts, (const double(*)[2])corner, value, level) : 0;
            for (int k = 0; k + 1 < count; k += 2)
                fprintf(d->sheet.to, "<path class=\"level\" d=\"M%.2f %.2fL%.2f %.2f\"/>\n",
                        plan_sheet_x(&d->sheet, cuts[k][0]), plan_sheet_y(&d->sheet, cuts[k][1]),
                        plan_sheet_x(&d->sheet, cuts[k + 1][0]), plan_sheet_y(&d->sheet, cuts[k + 1][1]));
            if (count && !named) {
                char text[32];
                snprintf(text, sizeof text, "%g", level);
                plan_sheet_put_text(&d->sheet, (cuts[0][0] + cuts[1][0]) / 2, (cuts[0][1] + cuts[1][1]) / 2, "number",
                                    text);
                named = true;
            }
        }
}

static enum status put_area(const struct drawing *d, const struct sensor_area *a, struct err *err)
{
    struct level_lattice l;
    if (level_lattice_make(&l, d->sensors, a, err)) return err->status;
    for (int i = a->first; i < a->first + a->count; i++)
        put_square(d, d->sensors->points[i].at.x, d->sensors->points[i].at.y, a->step, d->picture->values[i]);
    for (int k = 0; k < d->scale.line_count; k++) put_level(d, &l, d->scale.lines[k]);
    level_lattice_release(&l);
    return ST_OK;
}

/* The means of named places, written where they are. */
static void put_places(const struct drawing *d)
{
    for (int k = 0; k < d->sensors->area_count; k++) {
        const struct sensor_area *a = &d->sensors->areas[k];
        double x = 0, y = 0, mean = 0;
        char text[128];
        if (a->kind != SENSOR_PLACE) continue;
        for (int i = a->first; i < a->first + a->count; i++) {
            x += d->sensors->points[i].at.x / a->count;
            y += d->sensors->points[i].at.y / a->count;
            mean += d->picture->values[i] / a->count;
        }
        snprintf(text, sizeof text, "%s %.3g", a->name, mean);
        plan_sheet_put_text(&d->sheet, x, y, "place", text);
    }
}

static void put_title(const struct drawing *d)
{
    const struct sensors *s = d->sensors;
    double low = INFINITY, high = 0;
    char text[256];
    for (int a = 0; a < s->area_count; a++)
        for (int i = 0; s->areas[a].kind == SENSOR_WORK_PLANE && i < s->areas[a].count; i++) {
            low = fmin(low, d->picture->values[s->areas[a].first + i]);
            high = fmax(high, d->picture->values[s->areas[a].first + i]);
        }
    snprintf(text, sizeof text, "%s: %.3g to %.3g %s on the work planes", d->picture->title, fmin(low, high), high,
             d->picture->unit);
    plan_sheet_put_text(&d->sheet, (d->sheet.low[0] + d->sheet.high[0]) / 2, d->sheet.high[1] - 24 / d->sheet.scale,
                        "name", text);
}

/* In the margin below the plan. */
static void put_key(const struct drawing *d)
{
    const double width = d->sheet.scale * (d->sheet.high[0] - d->sheet.low[0]);
    const double bottom = d->sheet.scale * (d->sheet.high[1] - d->sheet.low[1]);
    level_scale_put_key(&d->scale, d->sheet.to, 0.08 * width, bottom - 44, 0.8 * width);
}

enum status level_plan_write(const struct level_picture *picture, const struct sensors *sensors,
                             const struct model_plan *plan, const char *path, struct err *err)
{
    struct drawing d = {
        .picture = picture, .sensors = sensors, .scale = level_scale_of(picture->unit, picture->annual)};
    struct outfile f = {0};
    if (outfile_open(&f, path, err)) return err->status;
    plan_sheet_fit(&d.sheet, plan);
    plan_sheet_begin(&d.sheet, f.fp, "Light levels", LEVEL_STYLES);
    plan_sheet_put_plan(&d.sheet, plan);
    for (int k = 0; !err->status && k < sensors->area_count; k++)
        if (sensors->areas[k].kind == SENSOR_WORK_PLANE) put_area(&d, &sensors->areas[k], err);
    put_places(&d);
    put_title(&d);
    put_key(&d);
    plan_sheet_end(&d.sheet);
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}
