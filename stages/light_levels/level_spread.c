/* level_spread.c - see level_spread.h.
 *
 * Lamps are fitted to the same photographs over the same reflected light, so their errors go together and add up, as do
 * those of the sky, and of the sun, in all windows. Errors of lamps, sky, sun and the rest are independent of each
 * other. Nothing is averaged over the points of an area: they share all of these errors. */
#include "stages/light_levels/level_spread.h"

#include <math.h>
#include <stdlib.h>

enum status level_spread_init(struct level_spread *s, const struct light_errors *e, struct err *err)
{
    *s = (struct level_spread){.by = calloc((size_t)e->count + 1, sizeof *s->by), .count = e->count};
    return s->by ? ST_OK : err_nomem(err, "groups of light", (size_t)e->count * sizeof *s->by);
}

void level_spread_release(struct level_spread *s)
{
    free(s->by);
    *s = (struct level_spread){0};
}

void level_spread_clear(struct level_spread *s)
{
    for (int k = 0; k < s->count; k++) s->by[k] = 0;
    s->known = 0;
}

void level_spread_add(struct level_spread *s, const struct spread_place *at, const struct state_weights *w,
                      double factor, double weight)
{
    double photographed = 0;
    for (int k = 0; k < s->count; k++) photographed += fmax(0, (double)(at->whole[k] - at->direct[k]));
    for (int k = 0; k < s->count; k++) {
        const double own = factor * w->relative[k] * (double)at->whole[k];
        const double share = photographed > 0 ? fmax(0, (double)(at->whole[k] - at->direct[k])) / photographed : 0;
        s->by[k] += weight * (own - share * at->reflected);
        s->known += weight * own;
    }
}

void level_spread_add_point(struct level_spread *s, const struct level_points *p, int point,
                            const struct light_groups *g, const struct state_weights *w, const double factors[2],
                            double weight)
{
    const size_t first = (size_t)point * (size_t)p->groups;
    struct spread_place at = {p->whole + first, p->direct + first, 0};
    for (int k = 0; k < p->groups; k++) {
        const bool beam = k >= g->beam && k < g->planned; /* of them `whole` is what they reflect */
        const double reflected = fmax(0, (double)(at.whole[k] - (beam ? 0 : at.direct[k])));
        at.reflected += (factors[0] * w->relative[k] + factors[1] * w->absolute[k]) * reflected;
    }
    level_spread_add(s, &at, w, factors[0], weight);
}

/* By how much groups of a kind can make the value darker and brighter. */
static void add_kind(double variance[2], const struct level_spread *s, const struct light_errors *e, int first, int end)
{
    double change[2] = {0, 0};
    for (int k = first; k < end; k++) {
        const struct group_error *of = &e->of[k];
        change[0] += s->by[k] > 0 ? s->by[k] * of->dark : -s->by[k] * of->bright;
        change[1] += s->by[k] > 0 ? s->by[k] * of->bright : -s->by[k] * of->dark;
    }
    for (int k = 0; k < 2; k++) variance[k] += change[k] * change[k];
}

static bool has_other_sky(const struct state_weights *w, const struct light_groups *g)
{
    for (int k = g->patch; k < g->planned; k++)
        if (w->absolute[k] > 0) return true;
    return w->sun > 0;
}

void level_spread_ends(double ends[2], const struct level_spread *s, double value, const struct light_errors *e,
                       const struct light_groups *g, const struct state_weights *w, const struct levels_params *params,
                       const double variance[2])
{
    const double other = has_other_sky(w, g) ? fmax(0, value - s->known) * params->sky_error : 0;
    double sum[2] = {other * other, other * other};
    add_kind(sum, s, e, 0, g->rest);
    add_kind(sum, s, e, g->sky, g->sun);
    add_kind(sum, s, e, g->sun, g->patch);
    for (int k = 0; k < 2; k++) {
        sum[k] = (value > 0 ? sum[k] / (value * value) : 0) + params->error * params->error + variance[k];
        ends[k] = exp((k ? 1 : -1) * LIGHT_NORMAL_95 * sqrt(sum[k]));
    }
}
