/* outdoors_map.c - resamples what cameras show of the outdoors to maps of azimuth and elevation, and finds features.
 *
 * In such maps what is far away has the same size and is upright, whatever the lenses, as far as the poses are known.
 * The pitch is half a pixel of the reference image at its centre: photos are often sharper, and finer maps give more
 * matches. A map's pixel is the mean of TAPS x TAPS samples where the
 * picture has finer pixels.
 *
 * Features want eight bits. Outdoors are far brighter than rooms, so the grey of a map is set by the outdoors alone:
 * WHITE_SHARE of its pixels are darker than white, then the sRGB curve. The radiance of brackets holds what only the
 * shortest exposure shows. Pixels that show no outdoors have its mean grey, and features need FEATURE_CLEARANCE times
 * their blur to these. */
#include "stages/hdr_merge/outdoors_map.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/sort.h"
#include "common/capture/opencv_sift.h"
#include "common/image/luminance.h"
#include "common/math/numbers.h"

enum { TAPS_MAX = 8, MAX_SIDE = 3200, EDGE_SAMPLES = 16, SEEN_STEPS = 24 };

static const double WHITE_SHARE = 0.98, FEATURE_CLEARANCE = 4, FINER = 0.5, LEFT = -90 * DEGREE, TOP = 45 * DEGREE;
static const struct sift_limits limits = {.longest = MAX_SIDE, .contrast = 0.01, .edge = 15};

struct vec3 outdoors_map_direction(const struct outdoors_grid *g, double x, double y)
{
    const double azimuth = g->left + x * g->pitch, elevation = g->top - y * g->pitch;
    /* to the right of who looks out: out x up */
    const struct vec3 right = vec3_make(g->out.y, -g->out.x, 0);
    const struct vec3 level = vec3_add(vec3_scale(g->out, cos(azimuth)), vec3_scale(right, sin(azimuth)));
    return vec3_make(level.x * cos(elevation), level.y * cos(elevation), sin(elevation));
}

/* Where a direction is in the map. */
static void place_of(double *x, double *y, const struct outdoors_grid *g, struct vec3 d)
{
    const struct vec3 right = vec3_make(g->out.y, -g->out.x, 0);
    *x = (atan2(vec3_dot(d, right), vec3_dot(d, g->out)) - g->left) / g->pitch;
    *y = (g->top - atan2(d.z, hypot(d.x, d.y))) / g->pitch;
}

struct map {
    struct outdoors_grid grid;
    float *luminance;     /* owned */
    unsigned char *shows; /* 1: the outdoors; owned */
};

static void map_release(struct map *m)
{
    free(m->luminance);
    free(m->shows);
    *m = (struct map){0};
}

static enum status map_init(struct map *m, const struct outdoors_grid *grid, struct err *err)
{
    const size_t pixels = (size_t)grid->width * (size_t)grid->height;
    *m = (struct map){*grid, calloc(pixels, sizeof *m->luminance), calloc(pixels, 1)};
    if (m->luminance && m->shows) return ST_OK;
    map_release(m);
    return err_nomem(err, "a map of the outdoors", pixels * (sizeof *m->luminance + 1));
}

/* --------------------------------------------------------------------------------------------------------- features */

/* The luminance that is white. */
static enum status find_white(float *white, const struct map *m, struct err *err)
{
    const size_t pixels = (size_t)m->grid.width * (size_t)m->grid.height;
    float *values = malloc((pixels + 1) * sizeof *values);
    size_t count = 0;
    if (!values) return err_nomem(err, "luminances", pixels * sizeof *values);
    for (size_t i = 0; i < pixels; i++)
        if (m->shows[i]) values[count++] = m->luminance[i];
    sort_floats(values, count);
    *white = count ? values[(size_t)(WHITE_SHARE * (double)(count - 1))] : 0;
    free(values);
    return ST_OK;
}

static bool shows_around(const struct map *m, const struct feature *f)
{
    static const int sides[9][2] = {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
    for (int k = 0; k < 9; k++) {
        const double reach = FEATURE_CLEARANCE * (double)f->scale;
        const int x = (int)floor((double)f->x + reach * sides[k][0]),
                  y = (int)floor((double)f->y + reach * sides[k][1]);
        if (x < 0 || y < 0 || x >= m->grid.width || y >= m->grid.height ||
            !m->shows[(size_t)y * (size_t)m->grid.width + (size_t)x])
            return false;
    }
    return true;
}

static void fill_grey(unsigned char *grey, const struct map *m, float white)
{
    const size_t pixels = (size_t)m->grid.width * (size_t)m->grid.height;
    double sum = 0, count = 0;
    for (size_t i = 0; i < pixels; i++) {
        if (!m->shows[i]) continue;
        grey[i] = (unsigned char)lrintf(255 * srgb_from_linear(m->luminance[i] / white));
        sum += grey[i];
        count++;
    }
    for (size_t i = 0; i < pixels; i++)
        if (!m->shows[i]) grey[i] = (unsigned char)(count > 0 ? sum / count : 0);
}

static enum status find_features(struct feature_list *list, const struct map *m, struct err *err)
{
    const int width = m->grid.width, height = m->grid.height;
    float white = 0;
    int kept = 0;
    unsigned char *grey = malloc((size_t)width * (size_t)height);
    *list = (struct feature_list){0};
    if (!grey) err_nomem(err, "a grey picture", (size_t)width * (size_t)height);
    if (!err->status && !find_white(&white, m, err) && white > 0) {
        fill_grey(grey, m, white);
        sift_find(list, grey, width, height, &limits, err);
    }
    for (int i = 0; i < list->count; i++)
        if (shows_around(m, &list->features[i])) list->features[kept++] = list->features[i];
    list->count = kept;
    free(grey);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------- reference images */

/* Bilinear luminance of a picture of 3 channels; pixel centres are at 0.5. */
static float luminance_at(const struct image *im, double u, double v)
{
    const double x = clamp(u - 0.5, 0, im->width - 1), y = clamp(v - 0.5, 0, im->height - 1);
    const int x0 = (int)x, y0 = (int)y, x1 = x0 + 1 < im->width ? x0 + 1 : x0, y1 = y0 + 1 < im->height ? y0 + 1 : y0;
    const float a = (float)(x - x0), b = (float)(y - y0);
    return (1 - b) * ((1 - a) * luminance_of(image_at(im, x0, y0)) + a * luminance_of(image_at(im, x1, y0))) +
           b * ((1 - a) * luminance_of(image_at(im, x0, y1)) + a * luminance_of(image_at(im, x1, y1)));
}

enum status outdoors_map_of_reference(struct feature_list *list, struct outdoors_grid *grid,
                                      const struct image *radiance, const struct camera *lens,
                                      const struct pose *cam_from_model, struct err *err)
{
    const struct mat3 turn = mat3_from_quat(cam_from_model->rotation);
    struct map m;
    double fx, fy, cx, cy;
    camera_focal(lens, &fx, &fy, &cx, &cy);
    grid->left = LEFT;
    grid->top = TOP;
    grid->pitch = fmax(FINER / fmax(fx, fy), -2 * LEFT / MAX_SIDE);
    grid->width = (int)ceil(-2 * LEFT / grid->pitch);
    grid->height = (int)ceil(2 * TOP / grid->pitch);
    *list = (struct feature_list){0};
    if (map_init(&m, grid, err)) return err->status;
    for (int y = 0; y < grid->height; y++)
        for (int x = 0; x < grid->width; x++) {
            const size_t i = (size_t)y * (size_t)grid->width + (size_t)x;
            double u, v;
            if (!camera_project(lens, mat3_apply(turn, outdoors_map_direction(grid, x + 0.5, y + 0.5)), &u, &v) ||
                u < 0 || v < 0 || u > radiance->width || v > radiance->height)
                continue;
            m.luminance[i] = luminance_at(radiance, u, v);
            m.shows[i] = 1;
        }
    find_features(list, &m, err);
    map_release(&m);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------ views */

/* The pixel in which a view shows a direction; false: in none. */
static bool pixel_of(double *u, double *v, const struct view *view, struct vec3 direction)
{
    return view_project(view, vec3_add(view->center, direction), u, v) > 0 && *u >= 0 && *v >= 0 && *u <= view->width &&
           *v <= view->height;
}

double outdoors_map_seen(const struct view *view, const struct opening_sight *sight)
{
    const struct vec3 a = sight->corners[0], b = sight->corners[1],
                      normal = vec3_make(sight->wall->normal[0], sight->wall->normal[1], 0);
    const double area = hypot(b.x - a.x, b.y - a.y) * (b.z - a.z) / (SEEN_STEPS * SEEN_STEPS);
    double seen = 0;
    for (int y = 0; y < SEEN_STEPS; y++)
        for (int x = 0; x < SEEN_STEPS; x++) {
            const struct vec3 to =
                vec3_sub(opening_sight_at(sight, (x + 0.5) / SEEN_STEPS, (y + 0.5) / SEEN_STEPS), view->center);
            const double length = vec3_length(to);
            double u, v;
            if (length > 0 && pixel_of(&u, &v, view, to) && opening_sight_passes(sight, view->center, to))
                seen += area * fabs(vec3_dot(to, normal)) / (length * length * length);
        }
    return seen;
}

/* The part of the map that an opening fills for a camera indoors. */
static bool bound(struct outdoors_grid *grid, const struct view *view, const struct opening_sight *sight)
{
    double least[2] = {INFINITY, INFINITY}, most[2] = {-INFINITY, -INFINITY};
    grid->left = grid->top = 0;
    for (int k = 0; k <= EDGE_SAMPLES; k++)
        for (int side = 0; side < 4; side++) {
            const double t = (double)k / EDGE_SAMPLES, end = side & 1;
            const struct vec3 p = side < 2 ? opening_sight_at(sight, t, end) : opening_sight_at(sight, end, t);
            double at[2];
            place_of(&at[0], &at[1], grid, vec3_sub(p, view->center));
            for (int c = 0; c < 2; c++) {
                least[c] = fmin(least[c], at[c]);
                most[c] = fmax(most[c], at[c]);
            }
        }
    grid->left = floor(least[0]) * grid->pitch;
    grid->top = -floor(least[1]) * grid->pitch;
    grid->width = (int)(ceil(most[0]) - floor(least[0]));
    grid->height = (int)(ceil(most[1]) - floor(least[1]));
    return grid->width > 0 && grid->height > 0 && grid->width <= MAX_SIDE && grid->height <= MAX_SIDE;
}

struct sampled_view {
    const struct view *view;
    const struct view_planes *planes;
};

/* Adds a bilinear sample; false: the view has none there. */
static bool add_sample(float *sum, const struct sampled_view *s, struct vec3 direction)
{
    const int width = s->view->width, height = s->view->height;
    double u, v;
    if (!pixel_of(&u, &v, s->view, direction)) return false;
    const double x = clamp(u - 0.5, 0, width - 1), y = clamp(v - 0.5, 0, height - 1);
    const int x0 = (int)x, y0 = (int)y;
    for (int k = 0; k < 4; k++) {
        const int px = x0 + k % 2 < width ? x0 + k % 2 : x0, py = y0 + k / 2 < height ? y0 + k / 2 : y0;
        const size_t i = (size_t)py * (size_t)width + (size_t)px;
        const float *const *c = s->planes->channel, rgb[3] = {c[VIEW_R][i], c[VIEW_G][i], c[VIEW_B][i]};
        const double weight = (k % 2 ? x - x0 : 1 - (x - x0)) * (k / 2 ? y - y0 : 1 - (y - y0));
        if (c[VIEW_A][i] < 0.5f) return false;
        *sum += (float)weight * luminance_of(rgb);
    }
    return true;
}

static void fill_pixel(struct map *m, int x, int y, const struct sampled_view *s, int taps)
{
    const size_t i = (size_t)y * (size_t)m->grid.width + (size_t)x;
    float sum = 0;
    for (int k = 0; k < taps * taps; k++) {
        const struct vec3 d =
            outdoors_map_direction(&m->grid, x + (k % taps + 0.5) / taps, y + (k / taps + 0.5) / taps);
        if (!add_sample(&sum, s, d)) return;
    }
    m->luminance[i] = sum / (float)(taps * taps);
    m->shows[i] = 1;
}

enum status outdoors_map_of_view(struct feature_list *list, struct outdoors_grid *grid,
                                 const struct view_planes *planes, const struct view *view,
                                 const struct opening_sight *sight, struct err *err)
{
    const struct sampled_view s = {view, planes};
    const int taps = clamp_int((int)lrint(grid->pitch * fmax(view->fx, view->fy)), 1, TAPS_MAX);
    struct map m;
    *list = (struct feature_list){0};
    if (!bound(grid, view, sight) || map_init(&m, grid, err)) return err->status;
    for (int y = 0; y < grid->height; y++)
        for (int x = 0; x < grid->width; x++)
            if (opening_sight_passes(sight, view->center, outdoors_map_direction(grid, x + 0.5, y + 0.5)))
                fill_pixel(&m, x, y, &s, taps);
    find_features(list, &m, err);
    map_release(&m);
    return err->status;
}
