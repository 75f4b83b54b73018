/* colours.c - see colours.h.
 *
 * Mathematics. In the photographs a patch has radiance L and irradiance E = D + pi sum_j F_j L_j, D what arrives from
 * all lamps, the sky and the sun. A matt patch reflects rho = pi L / E. With the same rays for E and for the solve, the
 * solution of the photographed state is L itself.
 *
 * Bounds. A lamp that nobody marked, a screen, a highlight or a window's reflection gives a rho above 1. Beyond MOST in
 * a channel, or in the dark, where E is noise, the patch takes the median of its face (by luminance, of patches that
 * are known), and what is left of its radiance, L - rho E / pi, is the group `rest`: light of the photographs that
 * nothing else explains. Patches that no photograph shows take the face's median as well, without a rest; where none
 * shows anything of a face, its synthesised texture counts as if one did. Furniture has one radiance a side in the
 * field, so one reflectance a piece: pi sum(A L) / sum(A E).
 *
 * Edits. A place of an edited face has the texel of a place in the photographs (light_change.h), and reflects what the
 * patch there does, times the quotient of the texel's radiance and the patch's. */
#include "stages/light_levels/colours.h"

#include <math.h>
#include <stdlib.h>

#include "common/math/numbers.h"
#include "common/math/weighted.h"

static const double MOST = 0.95, DARK = 0.02; /* DARK: of the mean irradiance */
static const double UNKNOWN = 0.5;            /* a model of which no patch is known */
static const double SAME_PLACE = 1e-6;

static struct rgb irradiance_before(const struct light_patches *p, const struct light_rows *rows,
                                    const struct light_groups *g, int patch)
{
    const struct light_row *row = &rows->rows[patch];
    struct rgb e = {0, 0, 0};
    for (int k = 0; k < g->patch; k++) {
        const float *d = rows->direct + 3 * ((size_t)rows->groups * (size_t)patch + (size_t)k);
        e = rgb_add(e, rgb_make((double)d[0], (double)d[1], (double)d[2]));
    }
    for (int i = 0; i < row->count; i++)
        e = rgb_add(e, rgb_scale(p->list[row->entries[i].patch].radiance, PI * (double)row->entries[i].share));
    return e;
}

static double divided(double a, double b) { return b > 0 ? PI * a / b : a > 0 ? INFINITY : 0; }

static struct rgb reflectance_of(struct rgb radiance, struct rgb e)
{
    return rgb_make(divided(radiance.r, e.r), divided(radiance.g, e.g), divided(radiance.b, e.b));
}

static struct rgb bounded(struct rgb rho) { return rgb_make(fmin(rho.r, MOST), fmin(rho.g, MOST), fmin(rho.b, MOST)); }

static double left(double radiance, double rho, double e) { return fmax(0, radiance - rho * e / PI); }

/* ---------------------------------------------------------------------------------------------------------- medians */

/* The median by channel of known patches from `begin` to `end`; false: there are none. */
static bool median_of(struct rgb *median, const struct photographed_patch *found, const struct light_patches *p,
                      int begin, int end, struct weighted *room)
{
    double channel[3];
    for (int c = 0; c < 3; c++) {
        size_t n = 0;
        for (int i = begin; i < end; i++) {
            const struct rgb *rho = &found[i].colour.reflectance;
            if (found[i].known)
                room[n++] = (struct weighted){c == 0 ? rho->r : c == 1 ? rho->g : rho->b, p->list[i].area};
        }
        if (!n) return false;
        channel[c] = weighted_percentile(room, n, 0.5);
    }
    *median = rgb_make(channel[0], channel[1], channel[2]);
    return true;
}

/* The texture is synthesised, and all that is known of the light there. */
static void trust_texture(struct photographed_patch *f, struct rgb l)
{
    const struct rgb rho = bounded(reflectance_of(l, f->before));
    f->colour.reflectance = rho;
    f->colour.rest =
        rgb_make(left(l.r, rho.r, f->before.r), left(l.g, rho.g, f->before.g), left(l.b, rho.b, f->before.b));
}

/* Patches of a face take its median where they are unknown; of a face that no photograph shows, what its texture says.
 */
static void complete_face(struct photographed_patch *found, const struct light_patches *p, int begin, int end,
                          struct rgb whole, double dark, struct weighted *room)
{
    struct rgb median = whole;
    const bool is_shown = median_of(&median, found, p, begin, end, room);
    for (int i = begin; i < end; i++) {
        struct photographed_patch *f = &found[i];
        if (f->known) continue;
        if (!is_shown && rgb_luminance(f->before) > dark) {
            trust_texture(f, p->list[i].radiance);
            continue;
        }
        const struct rgb l = p->list[i].radiance;
        f->colour.reflectance = median;
        if (p->list[i].photographed >= 0.5)
            f->colour.rest = rgb_make(left(l.r, median.r, f->before.r), left(l.g, median.g, f->before.g),
                                      left(l.b, median.b, f->before.b));
    }
}

/* -------------------------------------------------------------------------------------------------------- furniture */

/* Patches of one owner are contiguous. */
static void complete_owner(struct photographed_patch *found, const struct light_patches *p, int begin, int end)
{
    struct rgb l = {0, 0, 0}, e = {0, 0, 0};
    for (int i = begin; i < end; i++) {
        l = rgb_add(l, rgb_scale(p->list[i].radiance, p->list[i].area));
        e = rgb_add(e, rgb_scale(found[i].before, p->list[i].area));
    }
    for (int i = begin; i < end; i++) found[i].colour.reflectance = bounded(reflectance_of(l, e));
}

static void complete_owners(struct photographed_patch *found, const struct light_patches *p)
{
    for (int i = p->face_patches, next; i < p->count; i = next) {
        for (next = i + 1; next < p->count && p->list[next].owner == p->list[i].owner;) next++;
        complete_owner(found, p, i, next);
    }
}

enum status colours_of_photographs(struct photographed_patch *found, const struct light_patches *p,
                                   const struct light_rows *rows, const struct light_groups *g, struct err *err)
{
    struct weighted *room = malloc(((size_t)p->count + 1) * sizeof *room);
    struct rgb whole = rgb_grey(UNKNOWN);
    double sum = 0, area = 0;
    if (!room) return err_nomem(err, "patches", (size_t)p->count * sizeof *room);
    for (int i = 0; i < p->count; i++) {
        found[i] = (struct photographed_patch){.before = irradiance_before(p, rows, g, i)};
        sum += p->list[i].area * rgb_luminance(found[i].before);
        area += p->list[i].area;
    }
    for (int i = 0; i < p->face_patches; i++) {
        const struct rgb rho = reflectance_of(p->list[i].radiance, found[i].before);
        found[i].known = p->list[i].photographed >= 0.5 && rgb_max(rho) <= MOST &&
                         rgb_luminance(found[i].before) > DARK * sum / area;
        if (found[i].known) found[i].colour.reflectance = rho;
    }
    median_of(&whole, found, p, 0, p->face_patches, room);
    for (int i = 0, next; i < p->face_patches; i = next) {
        for (next = i + 1; next < p->face_patches && p->list[next].face == p->list[i].face;) next++;
        complete_face(found, p, i, next, whole, DARK * sum / area, room);
    }
    complete_owners(found, p);
    free(room);
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------ edits */

static double quotient(double texel, double mean) { return mean > 0 ? texel / mean : 1; }

/* What a place of an edited face reflects and adds; false: nothing is known of it. */
static bool colour_at(struct patch_colour *at, const struct light_change *c, int face, struct vec3 place,
                      const struct light_patches *was, const struct photographed_patch *photographed)
{
    struct light_place now;
    struct vec3 nearest;
    int old;
    bool on;
    light_change_place(&now, c, face, place);
    *at = (struct patch_colour){.reflectance = bounded(now.colour)};
    if (now.kind != LIGHT_PLACE_TEXTURE) return now.kind == LIGHT_PLACE_COLOUR;
    if (!face_areas_nearest(&c->old, now.face, now.before.at, &nearest, &old, &on)) return false;
    const int patch = patches_at(was, old, now.before.at);
    if (patch < 0) return false;
    const struct photographed_patch *from = &photographed[patch];
    const struct rgb mean = was->list[patch].radiance, rho = from->colour.reflectance;
    *at = from->colour;
    if (now.is_new || vec3_length(vec3_sub(now.texel, place)) > SAME_PLACE) at->rest = rgb_grey(0);
    if (from->known)
        at->reflectance =
            bounded(rgb_make(rho.r * quotient(now.colour.r, mean.r), rho.g * quotient(now.colour.g, mean.g),
                             rho.b * quotient(now.colour.b, mean.b)));
    return true;
}

static struct patch_colour colour_of_patch(const struct light_patches *p, int i, const struct light_change *c,
                                           const struct light_patches *was,
                                           const struct photographed_patch *photographed)
{
    const struct light_patch *patch = &p->list[i];
    struct patch_colour sum = {{0, 0, 0}, {0, 0, 0}}, at;
    int known = 0;
    for (int k = 0; k < patch->sample_count; k++) {
        if (!colour_at(&at, c, patch->face, p->samples[patch->sample + k], was, photographed)) continue;
        sum.reflectance = rgb_add(sum.reflectance, at.reflectance);
        sum.rest = rgb_add(sum.rest, at.rest);
        known++;
    }
    if (!known) return (struct patch_colour){rgb_grey(UNKNOWN), {0, 0, 0}};
    sum.reflectance = rgb_scale(sum.reflectance, 1.0 / known);
    sum.rest = rgb_scale(sum.rest, 1.0 / patch->sample_count);
    return sum;
}

/* That of a thing in the photographs. */
static struct rgb thing_reflectance(const struct light_patches *was, const struct photographed_patch *photographed,
                                    int owner)
{
    for (int i = was->face_patches; i < was->count; i++)
        if (was->list[i].owner == owner) return photographed[i].colour.reflectance;
    return rgb_grey(UNKNOWN);
}

void colours_of_edit(struct patch_colour *found, const struct light_patches *p, const struct light_change *change,
                     const struct light_patches *was, const struct photographed_patch *photographed)
{
    for (int i = 0; i < p->face_patches; i++) found[i] = colour_of_patch(p, i, change, was, photographed);
    for (int i = p->face_patches; i < p->count; i++) {
        const int owner = p->list[i].owner;
        found[i] =
            (struct patch_colour){.reflectance = owner < OWNER_THING ? change->objects.list.items[owner].brdf.albedo
                                                                     : thing_reflectance(was, photographed, owner)};
    }
}
