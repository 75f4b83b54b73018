/* outdoors_sun.c - the sun in the picture of the outdoors.
 *
 * A lighting reference image that shows the sun has measured it, and nothing is added. Otherwise its direction comes
 * from its patches (sun_search.c), its light from how bright they are (sun_light.c), and a disk is painted where no
 * picture shows anything, or where a photograph does: photographs of rooms saturate at the sun. */
#include "stages/bake_outdoors/outdoors_sun.h"

#include <math.h>
#include <stdlib.h>

#include "common/image/luminance.h"
#include "common/math/numbers.h"
#include "common/math/weighted.h"

enum { FINE = 4, SAMPLED = 64 };     /* samples a side of a pixel; rows that a median is taken from */
static const double BRIGHT = 100;    /* of the median: what counts as the sun in a lighting reference image */
static const float BRIGHTEST = 6e4f; /* below the largest half float */

static struct vec3 direction_of(const struct outdoors *o, size_t at)
{
    return outdoors_direction(o, (double)(at % (size_t)o->width) + 0.5, (double)(at / (size_t)o->width) + 0.5);
}

/* The median luminance of what reference images show; 0: they show nothing. */
static enum status find_median(double *median, const struct outdoors *o, struct err *err)
{
    const int stride = o->height < 2 * SAMPLED ? 1 : o->height / SAMPLED;
    const size_t most = ((size_t)o->height / (size_t)stride + 1) * ((size_t)o->width / (size_t)stride + 1);
    struct weighted *values = malloc(most * sizeof *values);
    size_t count = 0;
    if (!values) return err_nomem(err, "luminances", most * sizeof *values);
    for (int y = stride / 2; y < o->height; y += stride)
        for (int x = stride / 2; x < o->width; x += stride) {
            const size_t at = (size_t)y * (size_t)o->width + (size_t)x;
            if (o->source[at] == OUTDOORS_REFERENCE)
                values[count++] = (struct weighted){(double)luminance_of(o->rgb + 3 * at), 1};
        }
    *median = count ? weighted_percentile(values, count, 0.5) : 0;
    free(values);
    return ST_OK;
}

/* Looks for the sun in what reference images show: the middle of the pixels that are nearly the brightest. */
static enum status see_sun(struct outdoors_sun *s, const struct outdoors *o, struct err *err)
{
    const size_t pixels = (size_t)o->width * (size_t)o->height;
    struct vec3 sum = {0, 0, 0};
    double median = 0, most = 0;
    if (find_median(&median, o, err) || !(median > 0)) return err->status;
    for (size_t i = 0; i < pixels; i++)
        if (o->source[i] == OUTDOORS_REFERENCE) most = fmax(most, (double)luminance_of(o->rgb + 3 * i));
    if (most < BRIGHT * median) return ST_OK;
    for (size_t i = 0; i < pixels; i++)
        if (o->source[i] == OUTDOORS_REFERENCE && (double)luminance_of(o->rgb + 3 * i) > most / 2)
            sum = vec3_add(sum, direction_of(o, i));
    s->source = SUN_SEEN;
    s->direction = vec3_normalize(sum);
    return ST_OK;
}

static enum status list_planes(struct face_plane **planes, const struct model_rays *m, struct err *err)
{
    *planes = calloc((size_t)m->ids, sizeof **planes);
    if (!*planes) return err_nomem(err, "faces", (size_t)m->ids * sizeof **planes);
    for (int i = 0; i < m->mesh.face_count; i++)
        (*planes)[solid_face_id(&m->mesh, i)] = (struct face_plane){m->mesh.faces[i].normal, m->mesh.faces[i].offset};
    return ST_OK;
}

static enum outdoors_source source_at(const struct outdoors *o, struct vec3 direction)
{
    float rgb[3];
    return outdoors_sample(rgb, o, direction);
}

static struct atlas_scene scene_of(const struct outdoors_sun *s)
{
    return (struct atlas_scene){&s->furnished, &s->atlas, s->planes};
}

static enum status read_rooms(struct outdoors_sun *s, const struct outdoors_sun_files *files, struct provenance *prov,
                              struct err *err)
{
    if (files->things && thing_surfaces_read(&s->things, files->things, prov, err)) return err->status;
    s->furniture = thing_surfaces_of_field(&s->things);
    return model_rays_read_with(&s->furnished, files->model, MODEL_WITHOUT_GLASS, &s->furniture.triangles, NULL, err);
}

static enum status find_patches(struct outdoors_sun *s, const struct outdoors *o, const struct outdoors_model *model,
                                const struct outdoors_sun_files *files, struct provenance *prov, struct err *err)
{
    if (field_atlas_read(&s->atlas, files->vita, model->rays.ids, prov, err) ||
        list_planes(&s->planes, &model->rays, err) || read_rooms(s, files, prov, err))
        return err->status;
    const struct atlas_scene scene = scene_of(s);
    if (sun_search(&s->search, &scene, err) || !s->search.found) return err->status;
    s->direction = s->search.fit.direction;
    s->source = source_at(o, s->direction) == OUTDOORS_REFERENCE ? SUN_HIDDEN : SUN_PATCHES;
    return ST_OK;
}

enum status outdoors_sun_find(struct outdoors_sun *s, const struct outdoors *o, const struct outdoors_model *model,
                              const struct outdoors_sun_files *files, struct provenance *prov, struct err *err)
{
    *s = (struct outdoors_sun){0};
    if (see_sun(s, o, err) || s->source == SUN_SEEN || !files->vita) return err->status;
    return find_patches(s, o, model, files, prov, err);
}

void outdoors_sun_release(struct outdoors_sun *s)
{
    sun_search_release(&s->search);
    field_atlas_release(&s->atlas);
    free(s->planes);
    model_rays_release(&s->furnished);
    thing_surfaces_release(&s->things);
    *s = (struct outdoors_sun){0};
}

/* ------------------------------------------------------------------------------------------------------------- disk */

/* The part of a pixel that a disk covers. */
static double coverage(const struct outdoors *o, int x, int y, struct vec3 direction, double cosine)
{
    int inside = 0;
    for (int k = 0; k < FINE * FINE; k++) {
        const double u = x + (k % FINE + 0.5) / FINE, v = y + (k / FINE + 0.5) / FINE;
        inside += vec3_dot(outdoors_direction(o, u, v), direction) >= cosine;
    }
    return inside / (double)(FINE * FINE);
}

/* Adds a radiance to the pixels of a disk, as far as it covers them. Returns the disk's solid angle in the picture. */
static double paint(struct outdoors *o, struct vec3 direction, double radius, const float add[3])
{
    const double cosine = cos(radius * DEGREE), wider = cos(radius * DEGREE + 2 * PI / o->height);
    double sum = 0;
    for (int y = 0; y < o->height; y++) {
        const double top = PI / 2 - PI * y / o->height;
        const double angle = (sin(top) - sin(top - PI / o->height)) * 2 * PI / o->width;
        for (int x = 0; x < o->width; x++) {
            if (vec3_dot(outdoors_direction(o, x + 0.5, y + 0.5), direction) < wider) continue;
            const size_t at = (size_t)y * (size_t)o->width + (size_t)x;
            const double share = coverage(o, x, y, direction, cosine);
            if (!(share > 0)) continue;
            sum += share * angle;
            if (!add) continue;
            for (size_t c = 0; c < 3; c++)
                o->rgb[3 * at + c] = fminf(o->rgb[3 * at + c] + (float)share * add[c], BRIGHTEST);
            o->source[at] = OUTDOORS_GUESSED;
        }
    }
    return sum;
}

double outdoors_paint_sun(struct outdoors *o, struct vec3 direction, double radius, struct rgb irradiance)
{
    const double pixel = 180.0 / o->height;
    const double least = asin(fmin(1, sqrt(1.1 * rgb_max(irradiance) / (PI * (double)BRIGHTEST)))) / DEGREE;
    radius = fmax(radius, fmax(least, pixel));
    const double solid_angle = paint(o, direction, radius, NULL);
    const float add[3] = {(float)(irradiance.r / solid_angle), (float)(irradiance.g / solid_angle),
                          (float)(irradiance.b / solid_angle)};
    paint(o, direction, radius, add);
    return radius;
}

enum status outdoors_sun_add(struct outdoors_sun *s, struct outdoors *o, const struct outdoors_model *model,
                             struct err *err)
{
    const struct atlas_scene scene = scene_of(s);
    const struct sun_indoors in = {&scene, o, &s->furniture, &model->rays};
    if (s->source != SUN_PATCHES) return ST_OK;
    if (sun_light_measure(&s->light, &in, &s->search.edges, s->direction, s->search.fit.radius, err))
        return err->status;
    if (s->light.places) s->radius = outdoors_paint_sun(o, s->direction, s->search.fit.radius, s->light.irradiance);
    return ST_OK;
}
