/* edit_lamps.c - see edit_lamps.h.
 *
 * Mathematics. A lamp of intensity I cd at d metres gives a surface I cos / d^2 lx [photometry.h], and lx divided by
 * the scene's scale (lux_scale.h) are irradiance of the photographs' unit. Light leaves all places of a luminous
 * opening alike, so PLACES of them stand for it. A glossy surface of reflectance f reflects f times the irradiance of
 * each place. An opening of area A that is seen under an angle t to its axis has the luminance I / (A cos t). */
#include "common/relight/edit_lamps.h"

#include <math.h>

#include "common/daylight/lux_scale.h"
#include "common/light/sobol.h"
#include "common/math/numbers.h"
#include "common/model/model_metre.h"
#include "common/texture/texture_map.h"

enum { PLACES = 64 };
static const double EDGE_ON = 1e-3;  /* cosine below which an opening is seen from its edge */
static const double SMALLEST = 1e-6; /* m2, of an opening that is seen */

void edit_lamps_release(struct edit_lamps *l)
{
    planned_lamps_release(&l->planned);
    *l = (struct edit_lamps){.scale = 0};
}

/* ---------------------------------------------------------------------------------------------------------- reading */

static enum status find_metre(struct edit_lamps *l, const char *path, const struct model_axes *axes,
                              struct provenance *prov, struct err *err)
{
    struct model_plan plan = {.room_count = 0};
    struct model_metre metre = {1, 1, 1, false};
    if (!axes->metric && !path)
        return err_set(err, ST_USAGE, "the scene has no scale, so lamps of an edit need --plan, the edited plan.txt.");
    if (!axes->metric && !model_plan_read(&plan, path, prov, err))
        model_metre_find(&metre, axes, &plan, MODEL_METRE_ROOM, err);
    l->metre = metre.units;
    model_plan_release(&plan);
    return err->status;
}

enum status edit_lamps_read(struct edit_lamps *l, const struct edit_lamp_files *files, const struct texture_map *map,
                            const struct model_axes *axes, struct provenance *prov, struct err *err)
{
    struct lux_scale scale = {.count = 0};
    *l = (struct edit_lamps){.scale = 0};
    if (!map->planned_count || !files->scale) return ST_OK;
    if (!lux_scale_read(&scale, files->scale, prov, err)) l->scale = scale.is.scale;
    lux_scale_release(&scale);
    if (err->status || !(l->scale > 0) || find_metre(l, files->plan, axes, prov, err)) return err->status;
    for (int i = 0; !err->status && i < map->planned_count; i++)
        planned_lamps_add(&l->planned, &map->planned[i], files->scene, prov, err);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------ light */

/* Places of a lamp's opening, one after another. */
struct places {
    const struct edit_lamps *of;
    const struct planned_lamp *lamp;
    const struct model_field *field;
    struct gather_point point;
    struct vec3 from;
    struct sobol numbers;
    int count;
};

static struct places places_of(const struct edit_lamps *l, int lamp, const struct model_field *f, struct gather_point p,
                               uint64_t key)
{
    const struct rng rng = rng_make(key, "planned lamps", "");
    struct places s = {.of = l, .lamp = &l->planned.list[lamp], .field = f, .point = p};
    s.count = planned_lamp_is_wide(s.lamp) ? PLACES : 1;
    s.numbers = sobol_make(&rng, (uint64_t)lamp, s.count);
    s.from = vec3_add(p.at, vec3_scale(p.normal, f->model.rays.epsilon));
    return s;
}

/* Irradiance from place k in the photographs' unit, without the lamp's colour, and the unit direction from the point
 * towards it; 0 where something hides it. A lamp may lie in the surface that it hangs from. */
static double light_of_place(struct vec3 *direction, struct places *s, int k)
{
    double u[4] = {0.5, 0.5, 0, 0};
    s->numbers.sample = (uint32_t)k;
    if (s->count > 1) sobol_group(&s->numbers, 0, u);
    const struct vec3 place = planned_lamp_place(s->lamp, u, s->of->metre), to = vec3_sub(place, s->from);
    const double lux = planned_lamp_illuminance(s->lamp, place, s->point.at, s->point.normal, s->of->metre);
    const double distance = vec3_length(to), reach = distance - s->field->reach;
    if (!(lux > 0) || !(distance > 0)) return 0;
    if (reach > 0 && ray_scene_blocked(&s->field->model.rays, s->from, vec3_scale(to, 1 / distance), reach)) return 0;
    *direction = vec3_normalize(vec3_sub(place, s->point.at));
    return lux / s->count / s->of->scale;
}

struct rgb edit_lamps_light(const struct edit_lamps *l, int lamp, const struct model_field *f, struct gather_point p,
                            uint64_t key)
{
    struct rgb sum = {0, 0, 0};
    const int first = lamp < 0 ? 0 : lamp, end = lamp < 0 ? l->planned.count : lamp + 1;
    for (int i = first; i < end; i++) {
        struct places s = places_of(l, i, f, p, key);
        struct vec3 direction;
        double light = 0;
        for (int k = 0; k < s.count; k++) light += light_of_place(&direction, &s, k);
        if (light > 0) sum = rgb_add(sum, rgb_scale(s.lamp->colour, light));
    }
    return sum;
}

struct rgb edit_lamps_gloss(const struct edit_lamps *l, const struct model_field *f, struct gather_point p,
                            const struct brdf *brdf, struct vec3 view, uint64_t key)
{
    struct rgb sum = {0, 0, 0};
    struct brdf lobe = *brdf;
    lobe.albedo = rgb_grey(0);
    for (int i = 0; brdf->gloss > 0 && i < l->planned.count; i++) {
        struct places s = places_of(l, i, f, p, key);
        for (int k = 0; k < s.count; k++) {
            struct vec3 direction;
            double pdf;
            const double light = light_of_place(&direction, &s, k), cosine = vec3_dot(direction, p.normal);
            if (!(light > 0)) continue;
            const struct rgb reflected = brdf_eval(&lobe, p.normal, view, direction, &pdf);
            sum = rgb_add(sum, rgb_multiply(s.lamp->colour, rgb_scale(reflected, light / cosine)));
        }
    }
    return sum;
}

/* --------------------------------------------------------------------------------------------------------- openings */

bool edit_lamps_meet(struct rgb *radiance, const struct edit_lamps *l, const struct model_field *f, struct vec3 from,
                     struct vec3 direction, double t)
{
    double nearest = INFINITY;
    bool found = false;
    for (int i = 0; i < l->planned.count; i++) {
        const struct planned_lamp *lamp = &l->planned.list[i];
        const double cosine = vec3_dot(lamp->down, direction);
        const double at = vec3_dot(vec3_sub(lamp->at, from), lamp->down) / cosine;
        if (!(planned_lamp_area(lamp) > SMALLEST) || !(fabs(cosine) > EDGE_ON) || !(at > 0 && at < nearest)) continue;
        if (!((at - t) * fabs(cosine) <= f->reach)) continue;
        const struct vec3 place = vec3_add(from, vec3_scale(direction, at));
        if (!planned_lamp_covers(lamp, place, l->metre)) continue;
        const double candela = photometry_candela(&lamp->web, vec3_scale(direction, -1), lamp->down, lamp->along);
        *radiance = rgb_scale(lamp->colour, candela / (planned_lamp_area(lamp) * fabs(cosine)) / l->scale);
        nearest = at;
        found = true;
    }
    return found;
}
