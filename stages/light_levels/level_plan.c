/* level_plan.c - see level_plan.h.
 *
 * Each point of a work plane is a square of its spacing, in the colour of its value (level_scale.h). Isolines
 * (level_lines.h) bear their level once a room. */
#include "stages/light_levels/level_plan.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/base/outfile.h"
#include "common/model/plan_sheet.h"
#include "stages/light_levels/level_lattice.h"
#include "stages/light_levels/level_lines.h"
#include "stages/light_levels/level_scale.h"

static const double KEY = 0.06; /* of the plan's larger side: height of the key below it */

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

/* The line of a level, in the lattice: rows go up. */
struct level_drawing {
    const struct drawing *d;
    const struct level_lattice *lattice;
    double level;
    bool named;
};

static void put_path(const struct level_drawing *l, const char *class, const double (*at)[2], int count)
{
    const struct plan_sheet *sheet = &l->d->sheet;
    fprintf(sheet->to, "<path class=\"%s\" d=\"", class);
    for (int i = 0; i < count; i++)
        fprintf(sheet->to, "%s%.2f %.2f", i ? "L" : "M", plan_sheet_x(sheet, l->lattice->x + at[i][0]),
                plan_sheet_y(sheet, l->lattice->y + at[i][1]));
    fputs("\"/>\n", sheet->to);
}

static void put_line(void *ctx, const double (*at)[2], int count)
{
    struct level_drawing *l = ctx;
    char text[32];
    put_path(l, "under", at, count);
    put_path(l, "level", at, count);
    if (l->named) return;
    const double *middle = at[count / 2];
    snprintf(text, sizeof text, "%g", l->level);
    plan_sheet_put_text(&l->d->sheet, l->lattice->x + middle[0], l->lattice->y + middle[1], "number", text);
    l->named = true;
}

static enum status put_levels(const struct drawing *d, const struct level_lattice *lattice, struct err *err)
{
    const size_t count = (size_t)lattice->width * (size_t)lattice->height;
    struct level_grid grid = {lattice->width, lattice->height, lattice->step, calloc(count + 1, sizeof(float)),
                              malloc((count + 1) * sizeof(int))};
    if (!grid.values || !grid.surface) err_nomem(err, "isolines", count * sizeof(float));
    for (size_t i = 0; !err->status && i < count; i++) {
        const int point = lattice->point[i];
        grid.surface[i] = point >= 0 ? 0 : -1;
        if (point >= 0) grid.values[i] = (float)d->picture->values[point];
    }
    for (int k = 0; !err->status && k < d->scale.line_count; k++) {
        struct level_drawing l = {d, lattice, d->scale.lines[k], false};
        level_lines_find(&grid, l.level, put_line, &l, err);
    }
    free(grid.values);
    free(grid.surface);
    return err->status;
}

static enum status put_area(const struct drawing *d, const struct sensor_area *a, struct err *err)
{
    struct level_lattice l;
    if (!level_lattice_make(&l, d->sensors, a, err)) {
        for (int i = a->first; i < a->first + a->count; i++)
            put_square(d, d->sensors->points[i].at.x, d->sensors->points[i].at.y, a->step, d->picture->values[i]);
        put_levels(d, &l, err);
    }
    level_lattice_release(&l);
    return err->status;
}

/* A mean and its interval, such as "desk 320 (210 to 480)". */
static void put_mean(const struct drawing *d, double x, double y, int area, double mean)
{
    const double *ends = d->picture->ends ? d->picture->ends[area] : NULL;
    const char *name = d->sensors->areas[area].name;
    char text[256], numbers[3][32];
    snprintf(text, sizeof text, "%s %s", name, level_scale_number(numbers[0], mean));
    if (ends)
        snprintf(text, sizeof text, "%s %s (%s to %s)", name, level_scale_number(numbers[0], mean),
                 level_scale_number(numbers[1], ends[0]), level_scale_number(numbers[2], ends[1]));
    plan_sheet_put_text(&d->sheet, x, y, "place", text);
}

/* The means of named places, written where they are, and of work planes, below their rooms' upper ends. */
static void put_places(const struct drawing *d)
{
    for (int k = 0; k < d->sensors->area_count; k++) {
        const struct sensor_area *a = &d->sensors->areas[k];
        double x = 0, y = 0, mean = 0, top = -INFINITY;
        if (a->kind != SENSOR_PLACE && a->kind != SENSOR_WORK_PLANE) continue;
        for (int i = a->first; i < a->first + a->count; i++) {
            x += d->sensors->points[i].at.x / a->count;
            y += d->sensors->points[i].at.y / a->count;
            mean += d->picture->values[i] / a->count;
            top = fmax(top, d->sensors->points[i].at.y);
        }
        put_mean(d, x, a->kind == SENSOR_PLACE ? y : top, k, mean);
    }
}

/* Planned lamps that shine, each a circle with a cross, as on electrical plans. */
static void put_lamps(const struct drawing *d)
{
    const struct level_picture *p = d->picture;
    for (int i = 0; p->lamps && i < p->lamps->count; i++) {
        const struct planned_lamp *l = &p->lamps->list[i];
        if (!(p->shines[i] > 0)) continue;
        plan_sheet_put_lamp(&d->sheet, l->at.x, l->at.y, l->name);
    }
}

static void put_title(const struct drawing *d)
{
    const struct sensors *s = d->sensors;
    double low = INFINITY, high = 0;
    char text[256], numbers[2][32];
    for (int a = 0; a < s->area_count; a++)
        for (int i = 0; s->areas[a].kind == SENSOR_WORK_PLANE && i < s->areas[a].count; i++) {
            low = fmin(low, d->picture->values[s->areas[a].first + i]);
            high = fmax(high, d->picture->values[s->areas[a].first + i]);
        }
    snprintf(text, sizeof text, "%s: %s to %s %s on the work planes", d->picture->title,
             level_scale_number(numbers[0], fmin(low, high)), level_scale_number(numbers[1], high), d->picture->unit);
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
    const double wide = fmax(d.sheet.high[0] - d.sheet.low[0], d.sheet.high[1] - d.sheet.low[1]);
    plan_sheet_hold(&d.sheet, d.sheet.low[0], d.sheet.low[1] - KEY * wide);
    plan_sheet_begin(&d.sheet, f.fp, "Light levels", LEVEL_STYLES);
    plan_sheet_put_plan(&d.sheet, plan);
    for (int k = 0; !err->status && k < sensors->area_count; k++)
        if (sensors->areas[k].kind == SENSOR_WORK_PLANE) put_area(&d, &sensors->areas[k], err);
    put_lamps(&d);
    put_places(&d);
    put_title(&d);
    put_key(&d);
    plan_sheet_end(&d.sheet);
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}
