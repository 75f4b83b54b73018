/* relit_picture.c - see relit_picture.h.
 *
 * Mathematics. A matt surface of reflectance rho sends out rho E / pi. The photograph knows rho E0 / pi of each pixel,
 * so in other light E it shows the photographed radiance times E / E0. Both are interpolated between patches, over the
 * faces of the model; furniture has one value a patch. Pixels of lamps follow their lamp, and where it is off show a
 * white cover in the mean light of the room. The outdoors follow the sky's horizontal illuminance. levels.js does the
 * same in the page. */
#include "stages/light_levels/relit_picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/parallel.h"
#include "common/image/photo.h"
#include "common/math/numbers.h"
#include "common/product/product.h"
#include "stages/light_levels/relit_file.h"

enum { ROWS = 16, SPARSE = 4, CURVE = 4096 }; /* SPARSE: px between those that choose the exposure */
static const double COVER = 0.8, WELL_EXPOSED = 0.8, MOST_OF = 0.95;

void relit_sum_release(struct relit_sum *s)
{
    free(s->light);
    free(s->lamps);
    free(s->windows);
    free(s->blinds);
    *s = (struct relit_sum){.sun = 0};
}

/* ------------------------------------------------------------------------------------------------------------- sums */

static int find_lamp(const struct relit_light *r, const char *name)
{
    for (int i = 0; i < r->lamp_count; i++)
        if (r->lamps[i].kind != RELIT_REST && !strcmp(r->lamps[i].name, name)) return i;
    return -1;
}

static int find_window(const struct relit_light *r, const char *name)
{
    for (int i = 0; i + 1 < r->window_count; i++)
        if (!strcmp(r->windows[i], name)) return i;
    return -1;
}

static enum status set_switches(struct relit_sum *s, const struct relit_light *r, const struct light_state *state,
                                struct err *err)
{
    for (int i = 0; i < r->lamp_count; i++)
        s->lamps[i] = state->lamps && (r->lamps[i].kind != RELIT_PLANNED || (r->lamps[i].on && r->scale > 0));
    for (int i = 0; i < r->window_count; i++) s->blinds[i] = 1;
    for (int k = 0; k < state->named_count; k++) {
        const int lamp = find_lamp(r, state->named[k].name);
        if (lamp < 0)
            return err_set(err, ST_DATA,
                           "found the lamp %s, which the pictures do not have; make them again: make lux.",
                           state->named[k].name);
        s->lamps[lamp] = state->named[k].factor;
    }
    for (int k = 0; k < state->blind_count; k++) {
        const int window = find_window(r, state->blinds[k].name);
        if (window < 0)
            return err_set(err, ST_DATA, "found a blind of the window %s, which the pictures do not have.",
                           state->blinds[k].name);
        s->blinds[window] = state->blinds[k].factor;
    }
    return ST_OK;
}

static enum status set_sky(struct relit_sum *s, const struct relit_light *r, const struct light_state *state,
                           const struct relit_sky **found, double *by, struct err *err)
{
    const bool photographed = state->sky == STATE_SKY_PHOTOGRAPHED;
    *found = NULL;
    *by = 1 / (r->scale > 0 ? r->scale : 1);
    s->shade = -1;
    for (int i = 0; photographed && i < r->window_count; i++) s->windows[i] = s->blinds[i];
    if (photographed || state->sky == STATE_SKY_NONE) return ST_OK;
    const int sky = relit_light_find_sky(r, state);
    if (sky < 0)
        return err_set(
            err, ST_DATA,
            "the pictures have no sky of %d %d, %g o'clock; they have each half hour of the days on the page, "
            "and the skies of states.txt. Write the state there, or give DAY=, and run make lux.",
            state->time.month, state->time.day, state->time.hour);
    *found = &r->skies[sky];
    if (state->sky == STATE_SKY_OVERCAST) *by *= state->horizontal / (*found)->state.horizontal;
    for (int i = 0; i < r->window_count; i++)
        s->windows[i] = r->horizontal > 0 ? s->blinds[i] * *by * (*found)->horizontal / r->horizontal : 0;
    s->sun = *by * (*found)->sun;
    s->to_sun = (*found)->to_sun;
    s->shade = (*found)->shade;
    return ST_OK;
}

static enum status check_units(const struct relit_sum *s, const struct relit_light *r, const struct light_state *state,
                               struct err *err)
{
    bool relative = state->sky == STATE_SKY_PHOTOGRAPHED;
    bool absolute = state->sky != STATE_SKY_NONE && state->sky != STATE_SKY_PHOTOGRAPHED;
    for (int i = 0; i < r->lamp_count; i++) {
        relative |= r->lamps[i].kind != RELIT_PLANNED && s->lamps[i] > 0;
        absolute |= r->lamps[i].kind == RELIT_PLANNED && s->lamps[i] > 0;
    }
    if (r->scale > 0 || !relative || !absolute) return ST_OK;
    return err_set(err, ST_DATA,
                   "the state has light of the photographs and a sky or a lamp that was not photographed; their sum "
                   "needs lux/scale.txt. Measure a point (lux.txt), or say `lamps off`.");
}

/* What a field is multiplied by; parts are added up with their level. */
static double factor_of(const struct relit_sum *s, const struct relit_light *r, const struct relit_field *f,
                        const struct light_state *state)
{
    const double lx = 1 / (r->scale > 0 ? r->scale : 1);
    if (f->kind == RELIT_LAMP) return s->lamps[f->of] * (r->lamps[f->of].kind == RELIT_PLANNED ? lx : 1);
    if (f->kind == RELIT_WINDOW) return state->sky == STATE_SKY_PHOTOGRAPHED ? s->blinds[f->of] : 0;
    return 0;
}

static void add_sky(struct relit_sum *s, const struct relit_light *r, const struct relit_sky *sky, double by)
{
    for (int i = 0; i < r->field_count; i++) {
        const struct relit_field *level = &r->fields[i];
        int count;
        if (level->kind != RELIT_LEVEL || !(s->blinds[level->of] > 0)) continue;
        const int first = relit_light_first_part(r, level->of, &count);
        for (int k = 0; k < 3 * r->places; k++) {
            double sum = 0;
            for (int part = 0; part < count && i + 1 + part < r->field_count; part++)
                sum += sky->mixes[first + part] * (double)r->fields[i + 1 + part].values[k];
            s->light[k] += (float)(by * s->blinds[level->of] * (double)level->values[k] * fmax(0, sum));
        }
    }
}

enum status relit_sum_make(struct relit_sum *s, const struct relit_light *r, const struct light_state *state,
                           struct err *err)
{
    const size_t values = 3 * (size_t)r->places;
    const struct relit_sky *sky;
    double by;
    *s = (struct relit_sum){.light = calloc(values + 1, sizeof *s->light),
                            .lamps = calloc((size_t)r->lamp_count + 1, sizeof *s->lamps),
                            .windows = calloc((size_t)r->window_count + 1, sizeof *s->windows),
                            .blinds = calloc((size_t)r->window_count + 1, sizeof *s->blinds)};
    if (!s->light || !s->lamps || !s->windows || !s->blinds)
        return err_nomem(err, "light of places", values * sizeof *s->light);
    if (set_switches(s, r, state, err) || set_sky(s, r, state, &sky, &by, err) || check_units(s, r, state, err))
        return err->status;
    for (int i = 0; i < r->field_count; i++) {
        const struct relit_field *f = &r->fields[i];
        const double factor = factor_of(s, r, f, state);
        if (f->kind == RELIT_TEXTURE) s->texture = f->values;
        for (size_t k = 0; factor > 0 && k < values; k++) s->light[k] += (float)(factor * (double)f->values[k]);
    }
    if (!s->texture) return err_set(err, ST_DATA, "the pictures lack the light in which they were taken.");
    if (sky) add_sky(s, r, sky, by);
    return ST_OK;
}

/* ----------------------------------------------------------------------------------------------------------- pixels */

/* The ray through the middle of a pixel: between those that were kept. False: the lens has none there. */
static bool ray_at(struct vec3 *ray, const struct relit_photo *p, int x, int y)
{
    const int columns = relit_light_lens_size(p->width), rows = relit_light_lens_size(p->height);
    const int column = x / RELIT_LENS, row = y / RELIT_LENS;
    const int next_column = (int)fmin(column + 1, columns - 1), next_row = (int)fmin(row + 1, rows - 1);
    const double wide = fmin(RELIT_LENS * next_column, p->width - 1) - RELIT_LENS * column;
    const double tall = fmin(RELIT_LENS * next_row, p->height - 1) - RELIT_LENS * row;
    const double a = wide > 0 ? (x - RELIT_LENS * column) / wide : 0, b = tall > 0 ? (y - RELIT_LENS * row) / tall : 0;
    double sum[3] = {0, 0, 0};
    for (int i = 0; i < 4; i++) {
        const float *from = p->rays + 3 * ((i >> 1 ? next_row : row) * columns + (i & 1 ? next_column : column));
        const double weight = (i & 1 ? a : 1 - a) * (i >> 1 ? b : 1 - b);
        if (fabsf(from[0]) + fabsf(from[1]) + fabsf(from[2]) < 0.5f) return false;
        for (int c = 0; c < 3; c++) sum[c] += weight * (double)from[c];
    }
    *ray = vec3_make(sum[0], sum[1], sum[2]);
    return true;
}

/* Light and texture at a pixel of a face. */
static bool light_of_face(double light[3], double texture[3], const struct relit_sum *s, const struct relit_face *f,
                          const struct relit_photo *p, int x, int y)
{
    struct vec3 ray;
    if (!ray_at(&ray, p, x, y)) return false;
    const double t = (f->offset - vec3_dot(f->normal, p->from)) / vec3_dot(f->normal, ray);
    if (!(t > 0) || !isfinite(t)) return false;
    const struct vec3 at = vec3_add(p->from, vec3_scale(ray, t));
    const double a = clamp((vec3_dot(f->u, at) - f->low[0]) / f->step[0] - 0.5, 0, f->columns - 1);
    const double b = clamp((vec3_dot(f->v, at) - f->low[1]) / f->step[1] - 0.5, 0, f->rows - 1);
    const int column = (int)fmin(floor(a), fmax(0, f->columns - 2)), row = (int)fmin(floor(b), fmax(0, f->rows - 2));
    double sum = 0;
    for (int i = 0; i < 4; i++) {
        const double weight = (i & 1 ? a - column : 1 - a + column) * (i >> 1 ? b - row : 1 - b + row);
        if (!(weight > 0)) continue;
        const int place = f->places[(row + (i >> 1)) * f->columns + column + (i & 1)];
        if (place < 0) continue;
        sum += weight;
        for (int c = 0; c < 3; c++) {
            light[c] += weight * (double)s->light[3 * place + c];
            texture[c] += weight * (double)s->texture[3 * place + c];
        }
    }
    return sum > 0;
}

static double sun_at(const struct relit_sum *s, const struct relit_photo *p, struct vec3 normal, int x, int y)
{
    const double cosine = vec3_dot(normal, s->to_sun);
    const int width = p->width / 2, height = p->height / 2, *shade = s->shade < 0 ? NULL : p->shades[s->shade];
    double part = 0;
    if (!shade || !(s->sun > 0) || !(cosine > 0)) return 0;
    for (int i = 0; i < 4; i++) { /* pixels between those of the picture of half the size have their mean */
        const int column = (x + (i & 1)) / 2, row = (y + (i >> 1)) / 2;
        const int window = shade[(int)fmin(row, height - 1) * width + (int)fmin(column, width - 1)];
        part += window ? s->blinds[window - 1] / 4 : 0;
    }
    return part * s->sun * cosine;
}

/* In the room's mean light. */
static double mean_quotient(const struct relit_sum *s, const struct relit_light *r)
{
    double light = 0, texture = 0;
    for (int k = 1; k < 3 * r->places; k += 3) {
        light += (double)s->light[k];
        texture += (double)s->texture[k];
    }
    return texture > 0 ? light / texture : 0;
}

void relit_sum_quotient(double to[3], const struct relit_sum *s, const struct relit_light *r,
                        const struct relit_photo *p, int x, int y)
{
    const int lamps = 1 + r->window_count, faces = lamps + r->lamp_count, things = faces + r->face_count;
    const int pixel = p->pixels[y * p->width + x];
    double light[3] = {0, 0, 0}, texture[3] = {0, 0, 0}, sun = 0;
    to[0] = to[1] = to[2] = 0;
    if (!pixel) return;
    if (pixel < lamps) {
        to[0] = to[1] = to[2] = s->windows[pixel - 1];
    } else if (pixel < faces) {
        to[0] = to[1] = to[2] = s->lamps[pixel - lamps];
    } else if (pixel < things) {
        const struct relit_face *f = &r->faces[pixel - faces];
        if (light_of_face(light, texture, s, f, p, x, y)) sun = sun_at(s, p, f->normal, x, y);
    } else {
        const int place = r->things + pixel - things;
        for (int c = 0; c < 3; c++) {
            light[c] = (double)s->light[3 * place + c];
            texture[c] = (double)s->texture[3 * place + c];
        }
        sun = sun_at(s, p, r->normals[pixel - things], x, y);
    }
    for (int c = 0; pixel >= faces && c < 3; c++) to[c] = texture[c] > 0 ? (light[c] + sun) / texture[c] : 0;
}

/* ---------------------------------------------------------------------------------------------------------- picture */

struct drawing {
    const struct relit_light *r;
    const struct relit_photo *p;
    const struct relit_sum *s;
    const unsigned char *photo;
    unsigned char *rgb;
    float linear[256], *values; /* values: of all pixels, linear, before exposure */
    unsigned char curve[CURVE + 1];
    double exposure, mean;
};

/* A lamp that is off, or dimmed, shows a white cover. */
static double cover_of(const struct drawing *d, int pixel)
{
    const int lamps = 1 + d->r->window_count;
    if (pixel < lamps || pixel >= lamps + d->r->lamp_count) return 0;
    return COVER * d->mean * fmax(0, 1 - d->s->lamps[pixel - lamps]);
}

static void value_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct drawing *d = ctx;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < d->p->width; x++) {
            const size_t at = y * (size_t)d->p->width + (size_t)x;
            const double cover = cover_of(d, d->p->pixels[at]);
            double by[3];
            relit_sum_quotient(by, d->s, d->r, d->p, x, (int)y);
            for (int c = 0; c < 3; c++)
                d->values[3 * at + (size_t)c] =
                    (float)(by[c] * (double)d->linear[d->photo[3 * at + (size_t)c]] + 0.5 * cover);
        }
}

static int compare_floats(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* The room's nearly brightest pixels become WELL_EXPOSED. */
static enum status choose_exposure(struct drawing *d, struct err *err)
{
    const int faces = 1 + d->r->window_count + d->r->lamp_count;
    const size_t most = (size_t)(d->p->width / SPARSE + 1) * (size_t)(d->p->height / SPARSE + 1);
    float *found = malloc((most + 1) * sizeof *found);
    size_t count = 0;
    if (!found) return err_nomem(err, "a picture", most * sizeof *found);
    for (int y = 0; y < d->p->height; y += SPARSE)
        for (int x = 0; x < d->p->width; x += SPARSE) {
            const int at = y * d->p->width + x;
            const float *v = d->values + 3 * at;
            if (d->p->pixels[at] >= faces)
                found[count++] =
                    (float)(LUMINANCE_R * (double)v[0] + LUMINANCE_G * (double)v[1] + LUMINANCE_B * (double)v[2]);
        }
    qsort(found, count, sizeof *found, compare_floats);
    const double bright = count ? (double)found[(size_t)(MOST_OF * (double)(count - 1))] : 0;
    d->exposure = bright > 0 ? WELL_EXPOSED / bright : 1;
    free(found);
    return ST_OK;
}

static void encode_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct drawing *d = ctx;
    const size_t row = 3 * (size_t)d->p->width;
    (void)thread;
    for (size_t i = begin * row; i < end * row; i++)
        d->rgb[i] =
            (unsigned char)(255 * srgb_from_linear((float)clamp(d->exposure * (double)d->values[i], 0, 1)) + 0.5f);
}

enum status relit_picture_draw(unsigned char *rgb, const struct relit_light *r, const struct relit_photo *p,
                               const struct relit_sum *s, double *exposure, struct err *err)
{
    const size_t samples = 3 * (size_t)p->width * (size_t)p->height;
    struct photo photo = {0};
    struct drawing d = {.r = r, .p = p, .s = s, .rgb = rgb, .exposure = *exposure, .mean = mean_quotient(s, r)};
    if (!p->jpeg || photo_decode_jpeg(&photo, p->jpeg, p->jpeg_size, p->name, err)) {
        if (!err->status) err_set(err, ST_DATA, "the picture of %s is missing.", p->name);
    } else if (photo.info.width != p->width || photo.info.height != p->height || !photo.bytes) {
        err_set(err, ST_DATA, "the picture of %s is %d x %d px; wanted %d x %d.", p->name, photo.info.width,
                photo.info.height, p->width, p->height);
    } else if (!(d.values = malloc(samples * sizeof *d.values))) {
        err_nomem(err, "a picture", samples * sizeof *d.values);
    } else {
        d.photo = photo.bytes;
        for (int i = 0; i < 256; i++) d.linear[i] = linear_from_srgb((float)i / 255);
        parallel_for((size_t)p->height, ROWS, value_rows, &d);
        if (*exposure > 0 || !choose_exposure(&d, err)) parallel_for((size_t)p->height, ROWS, encode_rows, &d);
        *exposure = d.exposure;
    }
    free(d.values);
    photo_release(&photo);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------- file */

static enum status find_photo(const struct relit_photo **photo, const struct relit_light *r, const char *name,
                              struct err *err)
{
    for (int i = 0; i < r->photo_count; i++)
        if (!strcmp(r->photos[i].name, name)) {
            *photo = &r->photos[i];
            return ST_OK;
        }
    if (!r->photo_count) return err_set(err, ST_DATA, "the light levels have no photographs; see LUX_PHOTOS.");
    return err_set(err, ST_DATA, "--photo %s: found none of that name among the light levels; they have %s%s%s%s.",
                   name, r->photos[0].name, r->photo_count > 1 ? ", " : "", r->photo_count > 1 ? r->photos[1].name : "",
                   r->photo_count > 2 ? " and others" : "");
}

static enum status draw_file(const struct relit_light *r, const struct light_state *state,
                             const struct relit_picture_files *f, struct err *err)
{
    const struct relit_photo *photo = NULL;
    struct relit_sum sum = {0};
    unsigned char *rgb = NULL;
    double exposure = f->exposure;
    if (!find_photo(&photo, r, f->photo, err) && !relit_sum_make(&sum, r, state, err)) {
        const size_t size = 3 * (size_t)photo->width * (size_t)photo->height;
        if (!(rgb = malloc(size))) err_nomem(err, "a picture", size);
    }
    if (rgb && !relit_picture_draw(rgb, r, photo, &sum, &exposure, err) &&
        !png_write(f->out, rgb, photo->width, photo->height, 3, err))
        log_note("%s: exposed %.3g times as the photograph", f->out, exposure);
    free(rgb);
    relit_sum_release(&sum);
    return err->status;
}

enum status relit_picture_make(const struct relit_picture_files *f, struct err *err)
{
    struct relit_light r = {0};
    struct state_list states = {0};
    char path[FILE_PATH];
    const struct light_state *state = NULL;
    if (!state_list_read(&states, f->states, NULL, err) && !(state = state_list_find(&states, f->state))) {
        state_list_release(&states);
        if (!state_list_read_words(&states, f->state, err)) state = &states.items[states.count - 1];
    }
    if (state && !product_path_in(path, f->from, PRODUCT_LIGHT_RELIT, &(struct product_key){0}, err) &&
        !relit_file_read(&r, path, err))
        draw_file(&r, state, f, err);
    relit_light_release(&r);
    state_list_release(&states);
    return err->status;
}
