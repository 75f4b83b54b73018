/* level_film.c - see level_film.h.
 *
 * A frame has the date and the hour, the plan on the left, the photograph in false colours on the right, and below it
 * the photograph relit: each pixel times the quotient of the hour's illuminance and the photographed one, both
 * interpolated between patches (level_views.h), with one exposure for the film, at which the brightest hour is well
 * exposed. What lies outdoors follows the sky's horizontal illuminance. Lamps are off. Edges of photographed sun stay
 * faintly visible, because patches are wider than they. */
#include "stages/light_levels/level_film.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/progress.h"
#include "common/film/frame_encoder.h"
#include "common/image/image.h"
#include "common/image/luminance.h"
#include "common/math/numbers.h"
#include "common/math/weighted.h"
#include "stages/light_levels/level_lattice.h"
#include "stages/light_levels/level_lines.h"
#include "stages/light_levels/level_scale.h"
#include "stages/light_levels/segment_text.h"

enum {
    WIDTH = 1280,
    HEIGHT = 720,
    PER_HOUR = 4,
    FPS = 8,
    CRF = 20,
    TOP = 64,
    BOTTOM = 656,
    MIDDLE = 640,
    EDGE = 20,
    NUMBERED = 6
};
static const double NUMBER = 13;                            /* px: height */
static const double LAMP_COVER = 0.8;                       /* reflectance */
static const double WELL_EXPOSED = 0.8, LEAST_LIGHT = 0.02; /* LEAST_LIGHT: of the median */
static const unsigned char dark[3] = {34, 34, 34}, white[3] = {255, 255, 255}, grey[3] = {107, 112, 120},
                           window[3] = {143, 193, 234};

/* Where a model's or a picture's place lies in a frame: at + scale x. */
struct box {
    double at[2], scale;
};

struct filming {
    const struct level_film *f;
    struct canvas frame;
    struct level_scale scale;
    struct state_weights weights;
    double *patches;
    float *values, *before; /* of the photograph's pixels, at the hour and as photographed */
    bool *of_lamp;          /* pixels that show a lamp */
    double *of_points;
    double exposure, brightest; /* brightest: horizontal illuminance outdoors over the day, lx */
};

/* -------------------------------------------------------------------------------------------------------------- sky */

/* The sky of the weather file at the hour: the record of that hour. */
static bool weather_at(struct sky_weather *sky, const struct weather *w, const struct sun_time *t)
{
    for (int i = 0; i < w->count; i++) {
        const struct sun_time *m = &w->hours[i].middle;
        if (m->month == t->month && m->day == t->day && fabs(m->hour - t->hour) <= 0.5) {
            *sky = w->hours[i].sky;
            return true;
        }
    }
    return false;
}

static enum status set_sky(struct filming *j, const struct level_hour *hour, double *horizontal, struct err *err)
{
    const struct level_film *f = j->f;
    const char *cover = f->params->day_sky;
    const enum sky_cover usual = !strcmp(cover, "clear")    ? SKY_COVER_CLEAR
                                 : !strcmp(cover, "partly") ? SKY_COVER_PARTLY
                                                            : SKY_COVER_OVERCAST;
    struct sky_weather weather;
    struct sky_luminance sky = sky_of_cover(usual, &hour->sun, f->states->north, f->params->ground);
    if (f->weather) {
        if (!weather_at(&weather, f->weather, &hour->time))
            return err_set(err, ST_DATA, "the weather file has no hour %.4g of %02d-%02d; give one of a whole year.",
                           hour->time.hour, hour->time.month, hour->time.day);
        sky = sky_from_weather(&weather, &hour->sun, f->states->north, f->params->ground);
    }
    memset(j->weights.absolute, 0, (size_t)f->light->groups.count * sizeof *j->weights.absolute);
    level_weights_add_sky(&j->weights, &sky, &f->light->groups, f->params);
    *horizontal = sky_horizontal_illuminance(&sky);
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------- plan */

static void fill(const struct canvas *k, double x0, double y0, double x1, double y1, const unsigned char colour[3])
{
    for (int y = (int)fmax(0, lround(y0)); y < fmin(k->height, lround(y1)); y++)
        for (int x = (int)fmax(0, lround(x0)); x < fmin(k->width, lround(x1)); x++)
            memcpy(k->rgb + 3 * (y * k->width + x), colour, 3);
}

static struct box plan_box(const struct model_plan *plan, double right)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int r = 0; r < plan->room_count; r++)
        for (int k = 0; k < plan->rooms[r].corner_count; k++) {
            low[0] = fmin(low[0], plan->rooms[r].corners[k].x);
            high[0] = fmax(high[0], plan->rooms[r].corners[k].x);
            low[1] = fmin(low[1], plan->rooms[r].corners[k].y);
            high[1] = fmax(high[1], plan->rooms[r].corners[k].y);
        }
    if (!(low[0] < high[0] && low[1] < high[1])) return (struct box){{EDGE, BOTTOM}, 1};
    const double wide = right - 2.0 * EDGE, tall = BOTTOM - TOP;
    const double scale = fmin(wide / (high[0] - low[0]), tall / (high[1] - low[1]));
    return (struct box){{EDGE + (wide - scale * (high[0] - low[0])) / 2 - scale * low[0],
                         TOP + (tall + scale * (high[1] - low[1])) / 2 + scale * low[1]},
                        scale};
}

/* Lines of a level, black below white. */
struct line_drawing {
    const struct canvas *frame;
    struct box box;
    double level;
};

/* The level in the middle of a long line, light on dark. */
static void draw_number(const struct line_drawing *d, const double at[2])
{
    static const double around[][2] = {{-1.5, 0}, {1.5, 0}, {0, -1.5}, {0, 1.5}};
    char text[32];
    snprintf(text, sizeof text, "%g", d->level);
    const double x = d->box.at[0] + d->box.scale * at[0] - segment_text_width(text, NUMBER) / 2;
    const double y = d->box.at[1] + d->box.scale * at[1] - NUMBER / 2;
    for (int i = 0; i < 4; i++) segment_text_draw(d->frame, x + around[i][0], y + around[i][1], NUMBER, text, dark);
    segment_text_draw(d->frame, x, y, NUMBER, text, white);
}

static void draw_level(void *ctx, const double (*at)[2], int count)
{
    const struct line_drawing *d = ctx;
    for (int pass = 0; pass < 2; pass++)
        for (int i = 1; i < count; i++)
            draw_line(d->frame, d->box.at[0] + d->box.scale * at[i - 1][0], d->box.at[1] + d->box.scale * at[i - 1][1],
                      d->box.at[0] + d->box.scale * at[i][0], d->box.at[1] + d->box.scale * at[i][1], pass ? 0.8 : 1.8,
                      pass ? white : dark);
    if (count >= NUMBERED) draw_number(d, at[count / 2]);
}

static enum status draw_levels(const struct filming *j, const struct level_grid *grid, struct box box, struct err *err)
{
    for (int k = 0; !err->status && k < j->scale.line_count; k++) {
        struct line_drawing d = {&j->frame, box, j->scale.lines[k]};
        level_lines_find(grid, d.level, draw_level, &d, err);
    }
    return err->status;
}

/* The isolines of a room; rows of the lattice go up, those of a frame down. */
static enum status draw_room_levels(const struct filming *j, const struct sensor_area *a, struct box plan,
                                    struct err *err)
{
    struct level_lattice l;
    if (!level_lattice_make(&l, j->f->sensors, a, err)) {
        const size_t count = (size_t)l.width * (size_t)l.height;
        struct level_grid grid = {l.width, l.height, plan.scale * l.step, calloc(count + 1, sizeof(float)),
                                  malloc((count + 1) * sizeof(int))};
        if (!grid.values || !grid.surface) err_nomem(err, "isolines", count * sizeof(float));
        for (int i = 0; !err->status && i < l.width * l.height; i++) {
            const int point = l.point[(l.height - 1 - i / l.width) * l.width + i % l.width];
            grid.surface[i] = point >= 0 ? 0 : -1;
            if (point >= 0) grid.values[i] = (float)j->of_points[point];
        }
        const struct box box = {
            {plan.at[0] + plan.scale * l.x, plan.at[1] - plan.scale * (l.y + l.step * (l.height - 1))}, 1};
        if (!err->status) draw_levels(j, &grid, box, err);
        free(grid.values);
        free(grid.surface);
    }
    level_lattice_release(&l);
    return err->status;
}

static void draw_walls(const struct filming *j, struct box plan)
{
    const struct model_plan *p = j->f->plan;
    for (int r = 0; r < p->room_count; r++)
        for (int k = 0, n = p->rooms[r].corner_count; k < n; k++) {
            const struct model_room_corner *a = &p->rooms[r].corners[k], *b = &p->rooms[r].corners[(k + 1) % n];
            draw_line(&j->frame, plan.at[0] + plan.scale * a->x, plan.at[1] - plan.scale * a->y,
                      plan.at[0] + plan.scale * b->x, plan.at[1] - plan.scale * b->y, 2, grey);
        }
    for (int i = 0; i < p->opening_count; i++) {
        struct vec3 c[2];
        if (p->openings[i].kind != MODEL_WINDOW || !model_opening_corners(p, i, c)) continue;
        draw_line(&j->frame, plan.at[0] + plan.scale * c[0].x, plan.at[1] - plan.scale * c[0].y,
                  plan.at[0] + plan.scale * c[1].x, plan.at[1] - plan.scale * c[1].y, 3.5, window);
    }
}

static enum status draw_plan(struct filming *j, double right, struct err *err)
{
    const struct sensors *s = j->f->sensors;
    const struct box plan = plan_box(j->f->plan, right);
    for (int i = 0; i < s->count; i++) {
        double sums[2];
        level_points_sum(sums, j->f->points, i, &j->weights, j->f->light->groups.field);
        j->of_points[i] = sums[1];
    }
    for (int k = 0; !err->status && k < s->area_count; k++) {
        const struct sensor_area *a = &s->areas[k];
        if (a->kind != SENSOR_WORK_PLANE) continue;
        for (int i = a->first; i < a->first + a->count; i++) {
            unsigned char c[3];
            const double x = plan.at[0] + plan.scale * s->points[i].at.x,
                         y = plan.at[1] - plan.scale * s->points[i].at.y;
            const double half = plan.scale * a->step / 2;
            level_scale_colour(&j->scale, j->of_points[i], c);
            fill(&j->frame, x - half, y - half, x + half, y + half, c);
        }
        draw_room_levels(j, a, plan, err);
    }
    draw_walls(j, plan);
    return err->status;
}

/* ----------------------------------------------------------------------------------------------------------- photos */

/* A picture of a view into a box of the frame: the mean of the pixels that a pixel covers. */
static void put_picture(const struct canvas *frame, const unsigned char *rgb, int width, int height, double left,
                        double top, double box_width, double box_height, struct box *at)
{
    const double scale = fmin(box_width / width, box_height / height);
    const int w = (int)(scale * width), h = (int)(scale * height);
    const int x0 = (int)(left + (box_width - w) / 2), y0 = (int)(top + (box_height - h) / 2);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
            for (int c = 0; c < 3; c++) {
                int sum = 0;
                for (int k = 0; k < 4; k++) {
                    const int u = (int)((x + 0.25 + 0.5 * (k & 1)) / scale),
                              v = (int)((y + 0.25 + 0.5 * (k >> 1)) / scale);
                    sum += rgb[3 * (v * width + u) + c];
                }
                frame->rgb[3 * ((y0 + y) * frame->width + x0 + x) + c] = (unsigned char)(sum / 4);
            }
    *at = (struct box){{x0, y0}, scale};
}

static const struct level_view *view_of(const struct filming *j)
{
    return j->f->views->count ? &j->f->views->list[0] : NULL;
}

/* Sets values to what falls on the surfaces of the photograph. */
static enum status value_photo(struct filming *j, float *values, const double factors[2], struct err *err)
{
    const struct level_views_state state = {"", "lx", {factors[0], factors[1]}, &j->weights};
    if (level_views_patches(j->patches, j->f->light, &state, err)) return err->status;
    level_views_values(values, view_of(j), j->f->light, j->patches, &state);
    return ST_OK;
}

/* The light of a pixel of the photograph; of a lamp, which is off, that of a white cover. */
static double photographed(const struct filming *j, int i, int channel)
{
    if (j->of_lamp[i] && isfinite(j->before[i])) return LAMP_COVER * (double)j->before[i] / PI;
    return (double)linear_from_srgb((float)view_of(j)->photo[3 * i + channel] / 255);
}

static void find_lamps(const struct filming *j)
{
    const struct level_view *v = view_of(j);
    for (int i = 0; i < v->width * v->height; i++) {
        const struct level_pixel *p = &v->pixels[i];
        const struct vec3 ray = vec3_make((double)p->ray[0], (double)p->ray[1], (double)p->ray[2]);
        double at;
        j->of_lamp[i] = p->surface != NO_PHOTO && p->surface != -1 &&
                        model_field_lamp(j->f->light->groups.field, v->from, ray, (double)p->away, &at);
    }
}

/* What the light of a pixel is multiplied by, before exposure. */
static double quotient_at(const struct filming *j, int i, double horizontal)
{
    if (!isfinite(j->values[i]) || !isfinite(j->before[i])) return horizontal / j->brightest * j->exposure;
    return (double)j->values[i] / (double)j->before[i];
}

static enum status draw_photo(struct filming *j, double horizontal, struct err *err)
{
    static const double factors[2] = {0, 1};
    const struct level_view *v = view_of(j);
    const int pixels = v->width * v->height;
    unsigned char *rgb = malloc(3 * (size_t)pixels);
    struct box at;
    if (!rgb) return err_nomem(err, "a picture", 3 * (size_t)pixels);
    if (!value_photo(j, j->values, factors, err)) {
        level_views_paint(rgb, v, j->values, &j->scale);
        put_picture(&j->frame, rgb, v->width, v->height, MIDDLE, TOP, WIDTH - MIDDLE - EDGE, (BOTTOM - TOP) / 2.0 - 6,
                    &at);
        for (int i = 0; i < pixels; i++) {
            const double by = quotient_at(j, i, horizontal) / j->exposure;
            for (int c = 0; c < 3; c++)
                rgb[3 * i + c] = (unsigned char)(255 * srgb_from_linear((float)(by * photographed(j, i, c))) + 0.5f);
        }
        put_picture(&j->frame, rgb, v->width, v->height, MIDDLE, (TOP + BOTTOM) / 2.0 + 6, WIDTH - MIDDLE - EDGE,
                    (BOTTOM - TOP) / 2.0 - 6, &at);
    }
    free(rgb);
    return err->status;
}

/* The light of the photograph, and the exposure of the brightest hour. */
static enum status prepare_photo(struct filming *j, const struct level_days *d, struct err *err)
{
    static const double relative[2] = {1, 0}, factors[2] = {0, 1};
    static const struct light_state state = {.lamps = true, .sky = STATE_SKY_PHOTOGRAPHED};
    const struct level_view *v = view_of(j);
    const int pixels = v->width * v->height;
    struct weighted *room = malloc(((size_t)pixels + 1) * sizeof *room);
    double horizontal;
    int best = 0;
    size_t count = 0;
    if (!room) return err_nomem(err, "a picture", (size_t)pixels * sizeof *room);
    level_weights_release(&j->weights);
    if (!level_weights_make(&j->weights, &state, j->f->states, &j->f->light->groups, j->f->params, err))
        value_photo(j, j->before, relative, err);
    for (int i = 0; !err->status && i < pixels; i++)
        if (isfinite(j->before[i])) room[count++] = (struct weighted){(double)j->before[i], 1};
    const double least = count ? LEAST_LIGHT * weighted_percentile(room, count, 0.5) : 1;
    for (int i = 0; !err->status && i < pixels; i++) j->before[i] = fmaxf(j->before[i], (float)least);
    for (int i = 0; !err->status && i < pixels; i++)
        if (v->pixels[i].surface == -1 || v->pixels[i].surface == NO_PHOTO) j->before[i] = NAN;
    find_lamps(j);
    memset(j->weights.relative, 0, (size_t)j->f->light->groups.count * sizeof *j->weights.relative);
    for (int i = 0; !err->status && i < d->days[0].count; i++) {
        if (set_sky(j, &d->hours[i], &horizontal, err)) break;
        if (horizontal > j->brightest) j->brightest = horizontal, best = i;
    }
    if (!err->status && !set_sky(j, &d->hours[best], &horizontal, err)) value_photo(j, j->values, factors, err);
    count = 0;
    for (int i = 0; !err->status && i < pixels; i++)
        if (isfinite(j->before[i]) && isfinite(j->values[i])) {
            double light = 0;
            for (int c = 0; c < 3; c++) light += photographed(j, i, c) / 3;
            room[count++] = (struct weighted){light * quotient_at(j, i, horizontal), 1};
        }
    j->exposure = count ? weighted_percentile(room, count, 0.95) / WELL_EXPOSED : 1;
    if (!(j->exposure > 0)) j->exposure = 1;
    free(room);
    return err->status;
}

/* ----------------------------------------------------------------------------------------------------------- frames */

static void draw_key(const struct filming *j)
{
    const double left = EDGE + 20, right = WIDTH - 110, top = BOTTOM + 14;
    for (int x = (int)left; x < right; x++) {
        unsigned char c[3];
        level_scale_colour(&j->scale, j->scale.low * pow(j->scale.high / j->scale.low, (x - left) / (right - left)), c);
        fill(&j->frame, x, top, x + 1, top + 14, c);
    }
    for (int i = 0; i < j->scale.line_count; i++) {
        char text[32];
        const double x = left + (right - left) * level_scale_place(&j->scale, j->scale.lines[i]);
        snprintf(text, sizeof text, "%g", j->scale.lines[i]);
        draw_line(&j->frame, x, top + 14, x, top + 20, 0.7, dark);
        segment_text_draw(&j->frame, x - segment_text_width(text, 13) / 2, top + 25, 13, text, dark);
    }
    segment_text_draw(&j->frame, right + 24, top, 14, j->scale.unit, dark);
}

static enum status draw_frame(struct filming *j, const struct level_hour *hour, struct err *err)
{
    const bool photo = view_of(j) != NULL;
    char date[32], at[32];
    double horizontal;
    memset(j->frame.rgb, 255, 3 * (size_t)WIDTH * HEIGHT);
    const int minutes = (int)lround(60 * hour->time.hour);
    snprintf(date, sizeof date, "%04d-%02d-%02d", hour->time.year, hour->time.month, hour->time.day);
    snprintf(at, sizeof at, "%d:%02d", minutes / 60, minutes % 60);
    segment_text_draw(&j->frame, EDGE + 20, 22, 24, date, grey);
    segment_text_draw(&j->frame, EDGE + 260, 18, 32, at, dark);
    draw_key(j);
    if (set_sky(j, hour, &horizontal, err) || draw_plan(j, photo ? MIDDLE : WIDTH, err)) return err->status;
    return photo ? draw_photo(j, horizontal, err) : ST_OK;
}

static enum status write_frames(struct filming *j, const struct level_days *d, const char *path, struct err *err)
{
    static const struct frame_quality quality = {.preset = "medium", .crf = CRF};
    struct frame_encoder encoder = {0};
    struct progress progress;
    const int frames = d->days[0].count;
    progress_start(&progress, "the film of a day", frames, "frames");
    frame_encoder_begin(&encoder, path, WIDTH, HEIGHT, FPS, &quality, err);
    for (int i = 0; !err->status && !encoder.ended && i < frames; i++) {
        if (!draw_frame(j, &d->hours[i], err)) frame_encoder_put(&encoder, j->frame.rgb);
        progress_add(&progress, 1);
    }
    progress_end(&progress);
    if (!err->status) frame_encoder_end(&encoder, frames, err);
    frame_encoder_release(&encoder);
    return err->status;
}

static enum status allocate(struct filming *j, struct err *err)
{
    const struct level_view *v = view_of(j);
    const size_t pixels = v ? (size_t)v->width * (size_t)v->height : 0;
    j->frame = (struct canvas){malloc(3 * (size_t)WIDTH * HEIGHT), WIDTH, HEIGHT};
    j->patches = malloc(((size_t)j->f->light->patches.count + 1) * sizeof *j->patches);
    j->values = malloc((pixels + 1) * sizeof *j->values);
    j->before = malloc((pixels + 1) * sizeof *j->before);
    j->of_points = malloc(((size_t)j->f->sensors->count + 1) * sizeof *j->of_points);
    j->of_lamp = calloc(pixels + 1, sizeof *j->of_lamp);
    if (!j->of_lamp || !j->frame.rgb || !j->patches || !j->values || !j->before || !j->of_points)
        return err_nomem(err, "a film", 3 * (size_t)WIDTH * HEIGHT);
    return level_weights_init(&j->weights, &j->f->light->groups, err);
}

enum status level_film_write(const struct level_film *f, const char *path, struct err *err)
{
    struct filming j = {.f = f, .scale = level_scale_of("lx", 0), .exposure = 1};
    struct level_days d;
    if (!f->states->has_site)
        return err_set(err, ST_DATA,
                       "a film of a day needs the place: write `site LATITUDE LONGITUDE ZONE north DEGREES` into "
                       "states.txt.");
    if (!level_days_make(&d, f->states, f->day, PER_HOUR, err) && !d.days[0].count)
        err_set(err, ST_DATA, "the sun does not rise on %02d-%02d at this place; choose another day.", f->day->month,
                f->day->day);
    if (!err->status && !allocate(&j, err) && (!view_of(&j) || !prepare_photo(&j, &d, err)))
        write_frames(&j, &d, path, err);
    level_weights_release(&j.weights);
    level_days_release(&d);
    free(j.frame.rgb);
    free(j.patches);
    free(j.values);
    free(j.before);
    free(j.of_lamp);
    free(j.of_points);
    return err->status;
}
