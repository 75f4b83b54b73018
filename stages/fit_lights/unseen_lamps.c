/* unseen_lamps.c - see unseen_lamps.h.
 *
 * Overview. The light of each square of the textured faces is gathered from the field with its lamps off: other
 * surfaces, the sky, furniture. The fitted lamps' own light comes on top. From what a square's photograph shows beyond
 * that, unseen_fit.c finds lamps. It looks only at places on ceilings that photographs do not show, or show as bright,
 * and that have no marked lamp beside them. A lamp that no photograph shows is a square of the usual size. The light of
 * all lamps that are found is added to that of the marked points, in which the marked lamps are then fitted. */
#include "stages/fit_lights/unseen_lamps.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/log.h"
#include "common/base/parallel.h"
#include "common/capture/photo_camera.h"
#include "common/math/numbers.h"
#include "common/math/weighted.h"
#include "stages/fit_lights/direct.h"

enum { SQUARES = 2000, MOST_RAYS = 8192, PROBES = 5 };
static const double TARGET = 0.03;    /* relative error of the known light */
static const double SIDE = 0.2;       /* of the model's height: of a lamp */
static const double BESIDE = 0.2;     /* of the model's height: so close to a marked lamp none is looked for */
static const double BRIGHT = 8;       /* times the median: what photographs show as a lamp */
static const double PLAIN = 3;        /* times the median: photographed texels below it are no lamp */
static const double MOST_PLAIN = 0.4; /* of a lamp's place */
static const double CONFIDENCE = 1.96;

void unseen_lamps_release(struct unseen_lamps *u)
{
    atlas_squares_release(&u->squares);
    free(u->without_lamps);
    *u = (struct unseen_lamps){0};
}

/* ------------------------------------------------------------------------------------------------------------ light */

struct gathering {
    struct unseen_lamps *u;
    const struct light_field *field;
};

static void gather_range(void *ctx, size_t begin, size_t end, int thread)
{
    const struct gathering *g = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        const struct atlas_square *s = &g->u->squares.list[i];
        struct irradiance e;
        ray_irradiance_to(&e, g->field, (struct gather_point){s->at, s->normal}, TARGET, MOST_RAYS, i);
        double *to = g->u->without_lamps[i];
        to[0] = e.value.r, to[1] = e.value.g, to[2] = e.value.b;
    }
}

enum status unseen_lamps_gather(struct unseen_lamps *u, const struct model_field *field, struct err *err)
{
    const struct atlas_scene scene = {&field->model, &field->atlas, field->planes};
    const double side = atlas_squares_side(&scene, SQUARES);
    if (!(side > 0) || atlas_squares_list(&u->squares, &scene, side, 1, NULL, err)) return err->status;
    u->without_lamps = calloc((size_t)u->squares.count + 1, sizeof *u->without_lamps);
    if (!u->without_lamps) return err_nomem(err, "squares", (size_t)u->squares.count * sizeof *u->without_lamps);
    struct gathering g = {u, &field->field};
    parallel_for((size_t)u->squares.count, 8, gather_range, &g);
    return ST_OK;
}

/* Adds the light of the fitted lamps. */
static enum status add_lamps(double (*known)[3], const struct unseen_lamps *u, const struct lit_scene *scene,
                             const struct model_rays *furnished, struct err *err)
{
    struct lit_scene probe = {.lights = scene->lights, .point_count = u->squares.count};
    struct direct_light direct = {0};
    probe.points = calloc((size_t)u->squares.count + 1, sizeof *probe.points);
    if (!probe.points) return err_nomem(err, "squares", (size_t)u->squares.count * sizeof *probe.points);
    for (int i = 0; i < u->squares.count; i++)
        probe.points[i] = (struct lit_point){.at = u->squares.list[i].at, .normal = u->squares.list[i].normal};
    if (!direct_light_make(&direct, &probe, furnished, err))
        for (int i = 0; i < u->squares.count; i++)
            for (int k = 0; k < scene->lights.lamp_count; k++) {
                const struct lamp *l = &scene->lights.lamps[k];
                const double d = direct_light_at(&direct, k, i, l->beta, l->exponent);
                known[i][0] += d * l->radiance.r;
                known[i][1] += d * l->radiance.g;
                known[i][2] += d * l->radiance.b;
            }
    direct_light_release(&direct);
    free(probe.points);
    return err->status;
}

/* ----------------------------------------------------------------------------------------------------------- places */

struct places {
    const struct model_field *field;
    const struct model_rays *rays; /* the bare model */
    const struct light_list *lights;
    double side, beside, plain;
};

/* Whether a photograph shows the ceiling above a place, and no lamp there. */
static bool is_plain(const struct places *p, struct vec3 at)
{
    struct ray_hit hit;
    if (!ray_scene_hit(&p->rays->rays, at, vec3_make(0, 0, 1), &hit)) return true;
    const int id = solid_face_id(&p->rays->mesh, (int)hit.id);
    const struct field_texel t = field_atlas_look(&p->field->atlas, id, hit.point);
    return t.source == LIGHT_TEXTURE && rgb_luminance(t.radiance) < p->plain;
}

static bool is_marked(const struct light_list *lights, struct vec3 at, double beside)
{
    for (int i = 0; i < lights->lamp_count; i++) {
        const struct lamp *l = &lights->lamps[i];
        const double reach = beside + fmax(vec3_length(l->x), vec3_length(l->y));
        if (hypot(at.x - l->centre.x, at.y - l->centre.y) < reach) return true;
    }
    return false;
}

static void leave_out_marked(struct bright_places *b, const struct light_list *lights)
{
    int kept = 0;
    for (int i = 0; i < b->count; i++) {
        if (!is_marked(lights, b->list[i].at, 0)) b->list[kept++] = b->list[i];
    }
    b->count = kept;
}

static bool may_be(const void *ctx, struct vec3 at)
{
    const struct places *p = ctx;
    int plain = 0;
    if (is_marked(p->lights, at, p->beside)) return false;
    for (int k = 0; k < PROBES * PROBES; k++) {
        const double x = ((k % PROBES + 0.5) / PROBES - 0.5) * p->side,
                     y = ((k / PROBES + 0.5) / PROBES - 0.5) * p->side;
        plain += is_plain(p, vec3_add(at, vec3_make(x, y, 0)));
    }
    return plain < MOST_PLAIN * PROBES * PROBES;
}

static enum status find_plain(double *plain, const struct atlas_squares *s, struct err *err)
{
    struct weighted *values = calloc((size_t)s->count + 1, sizeof *values);
    if (!values) return err_nomem(err, "squares", (size_t)s->count * sizeof *values);
    for (int i = 0; i < s->count; i++) {
        const float *l = s->list[i].level;
        values[i] =
            (struct weighted){rgb_luminance(rgb_make(exp((double)l[0]), exp((double)l[1]), exp((double)l[2]))), 1};
    }
    *plain = PLAIN * weighted_percentile(values, (size_t)s->count, 0.5);
    free(values);
    return ST_OK;
}

enum status unseen_lamps_find(struct unseen_lamps *u, const struct model_field *field, const struct lit_scene *scene,
                              const struct lit_model *model, const struct model_rays *furnished, const char *views,
                              const struct fit_lights_params *params, struct provenance *prov, struct err *err)
{
    const double height = model_rays_height(&model->rays);
    struct places places = {field, &model->rays, &scene->lights, SIDE * height, BESIDE * height, 0};
    struct unseen_light light = {&u->squares, NULL, &model->rays, furnished, may_be, &places, NULL, 0};
    struct bright_places bright = {0};
    const size_t count = (size_t)u->squares.count;
    u->are_used = !strcmp(params->unseen, "use");
    u->side = places.side;
    u->count = 0;
    if (!count || find_plain(&places.plain, &u->squares, err)) return err->status;
    light.known = malloc(count * sizeof *light.known);
    if (!light.known) return err_nomem(err, "squares", count * sizeof *light.known);
    memcpy(light.known, u->without_lamps, count * sizeof *light.known);
    if (!bright_ceilings_find(&bright, field, model, views, BRIGHT / PLAIN * places.plain, prov, err)) {
        leave_out_marked(&bright, &scene->lights);
        light.bright = bright.list;
        light.bright_count = bright.count;
        if (!add_lamps(light.known, u, scene, furnished, err) && !unseen_fit(u->lamps, &u->count, &light, err))
            unseen_fit_standing(&u->standing, &u->stands, &light, err);
    }
    bright_ceilings_release(&bright);
    free(light.known);
    return err->status;
}

void unseen_lamps_light(const struct unseen_lamps *u, double (*indirect)[3], const struct lit_scene *scene,
                        const struct model_rays *furnished)
{
    for (int k = 0; k < u->count; k++)
        for (int i = 0; i < scene->point_count; i++) {
            const struct lit_point *p = &scene->points[i];
            const double factor = unseen_lamp_factor(furnished, &u->lamps[k].place, p->at, p->normal);
            for (int c = 0; c < 3; c++) indirect[i][c] += factor * u->lamps[k].intensity[c];
        }
}

/* ---------------------------------------------------------------------------------------------------------- reports */

/* The photo that shows a point best, with its pixel there: near, and not aslant. NULL: none shows it. */
static const char *best_photo(double pixel[2], const struct lit_model *model, struct vec3 at, struct vec3 normal)
{
    const char *best = NULL;
    double most = 0;
    for (int v = 0; v < model->in.set.view_count; v++) {
        const struct lens *lens = photo_lens_of_view(&model->in.set, &model->in.lenses, v);
        const char *name = lens ? lens->photo : model->in.set.views[v].name;
        struct photo_camera camera;
        struct err ignored = ERR_INIT;
        double u, w;
        if (photo_of_view(&model->in.set, &model->in.lenses, v) != v) continue;
        if (photo_camera_find(&camera, name, &model->in.set, &model->in.lenses, "", 0, &ignored)) continue;
        if (!photo_camera_project(&camera, world_from_model_point(&model->in.axes, at), &u, &w)) continue;
        if (u < 0 || w < 0 || u >= camera.lens.width || w >= camera.lens.height) continue;
        const struct vec3 from = vec3_add(at, vec3_scale(normal, 4 * model->rays.rays.epsilon));
        const struct vec3 way = vec3_sub(model_from_world_point(&model->in.axes, camera.center), from);
        const double size = vec3_dot(way, normal) / pow(vec3_length(way), 3);
        if (size <= most || ray_scene_blocked(&model->rays.rays, from, way, 1)) continue;
        most = size;
        best = name;
        pixel[0] = u, pixel[1] = w;
    }
    return best;
}

static struct vec3 normal_of(const struct unseen_lamps *u, const struct unseen_lamp *l)
{
    for (int i = 0; i < u->squares.count; i++)
        if (u->squares.list[i].tile == l->tile) return u->squares.list[i].normal;
    return vec3_make(0, 0, 1);
}

/* The face at a point. */
static const char *face_at(const struct lit_model *model, struct vec3 at, struct vec3 normal)
{
    const double off = 1e-3 * model_rays_height(&model->rays);
    struct ray_hit hit;
    if (!ray_scene_hit(&model->rays.rays, vec3_add(at, vec3_scale(normal, off)), vec3_scale(normal, -1), &hit))
        return "a face";
    return solid_face_name(&model->rays.mesh, (int)hit.id);
}

static void report_standing(const struct unseen_lamps *u, const struct lit_model *model)
{
    const struct unseen_lamp *l = &u->standing;
    const struct vec3 normal = normal_of(u, l);
    double pixel[2];
    const char *photo = best_photo(pixel, model, l->brightest, normal);
    char seen[200] = "";
    if (photo) snprintf(seen, sizeof seen, " (pixel %.0f %.0f of %s)", pixel[0], pixel[1], photo);
    log_warn(
        "%s at %.2f %.2f %.2f%s is %.0f %% brighter than all lamps and windows make it, and no lamp below a ceiling "
        "explains that; a lamp on a stand or a wall near %.2f %.2f %.2f would. It is not used. If a lamp on a wall "
        "is there, mark its corners in lights.txt: area NAME in PHOTO U V U V U V U V. If not, a mark of another "
        "lamp may be off, or the sun shines in",
        face_at(model, l->brightest, normal), l->brightest.x, l->brightest.y, l->brightest.z, seen, 100 * l->excess,
        l->place.at.x, l->place.at.y, l->place.at.z);
}

void unseen_lamps_report(const struct unseen_lamps *u, const struct lit_model *model)
{
    if (u->stands) report_standing(u, model);
    for (int k = 0; k < u->count; k++) {
        const struct unseen_lamp *l = &u->lamps[k];
        const struct vec3 normal = normal_of(u, l);
        double pixel[2], place[2];
        const char *photo = best_photo(pixel, model, l->brightest, normal);
        const char *shown = best_photo(place, model, l->place.at, vec3_make(0, 0, -1));
        char where[200] = "which no photo shows", seen[200] = "";
        if (photo) snprintf(seen, sizeof seen, " (pixel %.0f %.0f of %s)", pixel[0], pixel[1], photo);
        if (shown) snprintf(where, sizeof where, "pixel %.0f %.0f of %s", place[0], place[1], shown);
        log_warn("%s at %.2f %.2f %.2f%s is %.0f %% brighter than marked lamps and windows make it; a lamp %s at "
                 "%.2f %.2f %.2f (%s) explains that. %s Better: mark it in lights.txt, in a photo that shows its "
                 "corners: area NAME in PHOTO U V U V U V U V",
                 face_at(model, l->brightest, normal), l->brightest.x, l->brightest.y, l->brightest.z, seen,
                 100 * l->excess, l->place.x > 0 ? "that photos show, but nobody marked," : "that no photo shows",
                 l->place.at.x, l->place.at.y, l->place.at.z, where,
                 u->are_used ? "It is used as unseen1, unseen2, ... ([fit_lights] unseen = say: it is not)."
                             : "It is not used ([fit_lights] unseen = use: it is).");
    }
}

/* The name of the k-th: of unseen1, unseen2, ... that no lamp of the list has. */
static void name_lamp(char *name, size_t size, const struct light_list *lights, int k)
{
    for (int n = 1; k >= 0; n++) {
        bool is_new = true;
        snprintf(name, size, "unseen%d", n);
        for (int i = 0; i < lights->lamp_count; i++) is_new &= strcmp(name, lights->lamps[i].name) != 0;
        k -= is_new;
    }
}

static double area_of(const struct unseen_lamps *u, const struct unseen_lamp *l)
{
    return l->place.x > 0 ? 4 * l->place.x * l->place.y : u->side * u->side;
}

/* The line of a lamp that is used, as those of other lamps. */
static void print_lamp(const struct unseen_lamps *u, int k, const struct light_list *lights, FILE *to)
{
    const struct unseen_lamp *l = &u->lamps[k];
    char name[32];
    name_lamp(name, sizeof name, lights, k);
    fprintf(to, "lamp %s unseen", name);
    for (int c = 0; c < 3; c++) fprintf(to, " %.9g", l->intensity[c] / area_of(u, l));
    for (int c = 0; c < 3; c++) fprintf(to, " %.4g", CONFIDENCE * l->error[c] * l->intensity[c] / area_of(u, l));
    fprintf(to, " beta 90 0 exponent 0 0\n");
}

void unseen_lamps_print(const struct unseen_lamps *u, const struct lit_model *model, const struct light_list *lights,
                        FILE *to)
{
    for (int k = 0; k < u->count; k++) {
        const struct unseen_lamp *l = &u->lamps[k];
        double pixel[2] = {0, 0};
        const struct vec3 normal = normal_of(u, l);
        const char *photo = best_photo(pixel, model, l->brightest, normal);
        if (u->are_used) print_lamp(u, k, lights, to);
        fprintf(
            to,
            "unseen %d at %.6g %.6g %.6g intensity %.6g %.6g %.6g %.3g %.3g %.3g gain %.3g on %s at %.6g %.6g %.6g by "
            "%.3g in %s %.1f %.1f\n",
            k + 1, l->place.at.x, l->place.at.y, l->place.at.z, l->intensity[0], l->intensity[1], l->intensity[2],
            CONFIDENCE * l->error[0] * l->intensity[0], CONFIDENCE * l->error[1] * l->intensity[1],
            CONFIDENCE * l->error[2] * l->intensity[2], l->gain, face_at(model, l->brightest, normal), l->brightest.x,
            l->brightest.y, l->brightest.z, l->excess, photo ? photo : "-", pixel[0], pixel[1]);
    }
}

enum status unseen_lamps_add(const struct unseen_lamps *u, struct light_list *lights, struct err *err)
{
    for (int k = 0; u->are_used && k < u->count; k++) {
        const struct unseen_lamp *l = &u->lamps[k];
        const double x = l->place.x > 0 ? l->place.x : u->side / 2, y = l->place.x > 0 ? l->place.y : x;
        const double area = area_of(u, l);
        char name[32];
        name_lamp(name, sizeof name, lights, 0);
        if (array_append(&lights->lamps, (size_t)lights->lamp_count, sizeof *lights->lamps, "lamps", err))
            return err->status;
        lights->lamps[lights->lamp_count] =
            (struct lamp){.name = strdup(name),
                          .shape = LAMP_QUAD,
                          .centre = l->place.at,
                          .normal = vec3_make(0, 0, -1),
                          .x = vec3_make(0, y, 0),
                          .y = vec3_make(x, 0, 0),
                          .radiance = rgb_make(l->intensity[0] / area, l->intensity[1] / area, l->intensity[2] / area),
                          .beta = PI / 2};
        if (!lights->lamps[lights->lamp_count++].name) return err_nomem(err, "a name", sizeof name);
    }
    return ST_OK;
}
