/* mixture.c - rays of several strategies, weighted together.
 *
 * Overview. Each strategy (the cosine or a lobe, and every emitter that can light the point) sends its share of the
 * rays. A ray's weight depends on its direction and on the densities of all strategies there, so that light is counted
 * once whatever the rays see, an emitter that is hidden or misnamed included.
 *
 * Mathematics. A direction w that strategy s chose adds L(w) k(w) n_s p_s / sum_t (n_t p_t)^2, where k is the cosine or
 * the lobe times the cosine, n_t the number of rays of a strategy and p_t its density: the power heuristic with
 * exponent 2 [Veach 1995]. Its weights sum to 1 over the strategies, hence the mean is exact. The balance heuristic,
 * exponent 1, lets rays of the cosine that happen to hit a lamp keep a weight of about n_cosine F / n_lamp, with F the
 * lamp's form factor: their count varies like that of a lottery, and the error of a small lamp is several times larger.
 *
 * Directions come from Owen-scrambled Sobol' points [Burley 2020], a set for each strategy, whose size is a power of
 * two: on smooth light the error falls nearly as fast as n^-1.5, and across edges about as n^-0.75. Eight independent
 * scramblings make up an integral; their scatter gives the standard error.
 *
 * Shares. At first the cosine gets half of the rays, and emitters the other half by their unhidden light, each at least
 * a sixteenth of that. Where an integral is repeated with more rays, shares are proportional to the square root of
 * (variance times rays) of each strategy in the last one, the best shares for independent rays, again with a floor.
 *
 * Source: [Veach 1995] for weights, [Burley 2020] for points. Different here: the power heuristic; shares that
 * learn. */
#include "common/gather/mixture.h"

#include <math.h>
#include <string.h>

#include "common/light/sobol.h"
#include "common/math/numbers.h"

static const double MIN_SHARE = 1.0 / 32;
static const double RATE = 0.75; /* errors are expected to fall as n^-RATE */

/* ------------------------------------------------------------------------------------------------------- strategies */

static void scale_shares(struct mixture *m)
{
    double sum = 0, raised = 0;
    for (int i = 0; i < m->count; i++) sum += m->share[i];
    for (int i = 0; i < m->count; i++) {
        m->share[i] = sum > 0 ? m->share[i] / sum : 1.0 / m->count;
        m->share[i] = fmax(m->share[i], fmin(MIN_SHARE, 0.5 / m->count));
        raised += m->share[i];
    }
    for (int i = 0; i < m->count; i++) m->share[i] /= raised;
}

static void set_first_shares(struct mixture *m)
{
    const bool has_base = m->part == MIXTURE_ALL;
    double sum = 0;
    for (int i = has_base; i < m->count; i++) sum += m->share[i] = m->strategies[i].estimate;
    if (has_base) m->share[0] = sum > 0 ? sum : 1;
    scale_shares(m);
}

/* Adds an emitter, in place of the weakest if there is no room. */
static void add_emitter(struct mixture *m, const struct emitter *e)
{
    struct strategy s;
    if (!strategy_emitter(&s, m->point, e)) return;
    if (m->count < MIXTURE_MAX) {
        m->strategies[m->count++] = s;
        return;
    }
    int weakest = 1;
    for (int i = 2; i < m->count; i++)
        if (m->strategies[i].estimate < m->strategies[weakest].estimate) weakest = i;
    if (s.estimate > m->strategies[weakest].estimate) m->strategies[weakest] = s;
}

static void add_emitters(struct mixture *m)
{
    for (int i = 0; i < m->field->emitter_count; i++) add_emitter(m, &m->field->emitters[i]);
    if (m->count) set_first_shares(m);
}

static void start(struct mixture *m, const struct light_field *f, struct gather_point p, enum mixture_part part)
{
    m->field = f;
    m->point = p;
    m->part = part;
    m->lobe = (struct brdf){.kind = BRDF_LAMBERT};
    m->view = p.normal;
    m->count = 0;
    m->least = MIXTURE_MIN;
}

void mixture_init(struct mixture *m, const struct light_field *f, struct gather_point p, enum mixture_part part)
{
    start(m, f, p, part);
    if (part == MIXTURE_ALL) strategy_cosine(&m->strategies[m->count++], p);
    add_emitters(m);
}

void mixture_lobe_init(struct mixture *m, const struct light_field *f, struct gather_point p, const struct brdf *brdf,
                       struct vec3 view)
{
    start(m, f, p, MIXTURE_ALL);
    m->lobe = *brdf;
    m->lobe.albedo = rgb_grey(0);
    m->view = view;
    strategy_lobe(&m->strategies[m->count++], p, &m->lobe, view);
    add_emitters(m);
}

/* ------------------------------------------------------------------------------------------------------------- rays */

/* Rays that wait to be traced, and what all have added up. */
struct tally {
    const struct mixture *mixture;
    int rays[MIXTURE_MAX]; /* of a strategy in a replicate, a power of two */
    struct vec3 direction[RAY_PACKET];
    double weight[RAY_PACKET]; /* k(w) times the weight among strategies, over the density */
    int strategy[RAY_PACKET], replicate[RAY_PACKET], waiting;
    struct rgb sums[MIXTURE_REPLICATES];
    double luminance[MIXTURE_MAX][MIXTURE_REPLICATES];
    double from[LIGHT_SOURCES], nearest, inverse, weights;
    int traced;
};

static bool is_light(enum light_source s) { return s == LIGHT_LAMP || s == LIGHT_SKY || s == LIGHT_SKY_GUESSED; }

static void add_look(struct tally *t, int k, const struct light_look *seen)
{
    const double w = t->weight[k], luminance = w * rgb_luminance(seen->radiance);
    if (t->mixture->part == MIXTURE_LIGHTS && !is_light(seen->source)) return;
    t->sums[t->replicate[k]] = rgb_add(t->sums[t->replicate[k]], rgb_scale(seen->radiance, w));
    t->luminance[t->strategy[k]][t->replicate[k]] += luminance;
    t->from[seen->source] += luminance;
    t->weights += w;
    if (!(seen->distance > 0)) return;
    t->inverse += w / seen->distance;
    if (seen->distance < t->nearest) t->nearest = seen->distance;
}

static void trace(struct tally *t)
{
    struct light_look seen[RAY_PACKET];
    struct vec3 from[RAY_PACKET];
    if (!t->waiting) return;
    for (int k = 0; k < RAY_PACKET; k++) from[k] = t->mixture->point.at;
    t->mixture->field->look(t->mixture->field->ctx, from, t->mixture->point.normal, t->direction,
                            (1u << t->waiting) - 1, seen);
    for (int k = 0; k < t->waiting; k++) add_look(t, k, &seen[k]);
    t->traced += t->waiting;
    t->waiting = 0;
}

static f64x4 kernel(const struct mixture *m, const struct directions4 *d)
{
    const struct vec3 n = m->point.normal;
    f64x4 k = d->x * n.x + d->y * n.y + d->z * n.z;
    double density;
    if (m->lobe.kind == BRDF_LAMBERT) return k;
    for (int i = 0; i < 4; i++)
        k[i] = brdf_eval(&m->lobe, n, m->view, vec3_make(d->x[i], d->y[i], d->z[i]), &density).r;
    return k;
}

/* The first `count` of four rays. */
static void add_rays(struct tally *t, int strategy, int replicate, f64x4 u, f64x4 v, int count)
{
    const struct mixture *m = t->mixture;
    struct directions4 d;
    f64x4 own = {0}, squares = {0};
    const unsigned above = strategy_sample4(&m->strategies[strategy], u, v, &d);
    for (int i = 0; i < m->count; i++) {
        const f64x4 density = t->rays[i] * strategy_density4(&m->strategies[i], &d);
        squares += density * density;
        if (i == strategy) own = density;
    }
    const f64x4 weight = kernel(m, &d) * (own / squares);
    for (int k = 0; k < count; k++) {
        if (!(above >> k & 1) || !(own[k] > 0)) continue;
        t->direction[t->waiting] = vec3_make(d.x[k], d.y[k], d.z[k]);
        t->weight[t->waiting] = weight[k];
        t->strategy[t->waiting] = strategy;
        t->replicate[t->waiting++] = replicate;
        if (t->waiting == RAY_PACKET) trace(t);
    }
}

static void add_set(struct tally *t, int strategy, int replicate, const struct rng *rng)
{
    const int rays = t->rays[strategy];
    struct sobol points = sobol_make(rng, (uint64_t)replicate, rays);
    for (int i = 0; i < rays; i += SOBOL_BATCH) {
        double u[2][SOBOL_BATCH];
        points.sample = (uint32_t)i;
        sobol_pairs(&points, (uint32_t)strategy, u);
        for (int k = 0; k < SOBOL_BATCH && i + k < rays; k += 4)
            add_rays(t, strategy, replicate, f64x4_load(u[0] + k), f64x4_load(u[1] + k),
                     rays - i - k < 4 ? rays - i - k : 4);
    }
}

/* Powers of two, at least 1, that together exceed `rays` only if there are more strategies than that. */
static void count_rays(struct tally *t, const struct mixture *m, int rays)
{
    for (int i = 0; i < m->count; i++) {
        const double wanted = m->share[i] * rays / MIXTURE_REPLICATES;
        t->rays[i] = 1;
        while (2 * t->rays[i] <= wanted) t->rays[i] *= 2;
    }
}

/* Variance of the mean of the replicates, whose sum is the integral. */
static double variance(const double x[MIXTURE_REPLICATES])
{
    double sum = 0, squares = 0;
    for (int r = 0; r < MIXTURE_REPLICATES; r++) sum += x[r];
    for (int r = 0; r < MIXTURE_REPLICATES; r++) {
        const double d = x[r] - sum / MIXTURE_REPLICATES;
        squares += d * d;
    }
    return squares / (MIXTURE_REPLICATES * (MIXTURE_REPLICATES - 1.0));
}

static double standard_error(const struct tally *t, double channel(struct rgb))
{
    double x[MIXTURE_REPLICATES];
    for (int r = 0; r < MIXTURE_REPLICATES; r++) x[r] = channel(t->sums[r]);
    return sqrt(variance(x));
}

static double red(struct rgb a) { return a.r; }
static double green(struct rgb a) { return a.g; }
static double blue(struct rgb a) { return a.b; }

static void finish(struct irradiance *e, const struct tally *t)
{
    double luminance = 0;
    *e = (struct irradiance){.nearest = t->nearest, .rays = t->traced};
    for (int r = 0; r < MIXTURE_REPLICATES; r++) e->value = rgb_add(e->value, t->sums[r]);
    e->value = rgb_scale(e->value, 1.0 / MIXTURE_REPLICATES);
    e->error = rgb_make(standard_error(t, red), standard_error(t, green), standard_error(t, blue));
    e->mean_inverse = t->weights > 0 ? t->inverse / t->weights : 0;
    for (int s = 0; s < LIGHT_SOURCES; s++) luminance += t->from[s];
    for (int s = 0; s < LIGHT_SOURCES && luminance > 0; s++) e->from[s] = t->from[s] / luminance;
}

void mixture_gather(struct irradiance *e, struct mixture *m, int rays, uint64_t key, bool learn)
{
    struct tally t;
    const struct rng rng = rng_make(key, "gather", "rays");
    memset(&t, 0, sizeof t);
    t.mixture = m;
    t.nearest = INFINITY;
    count_rays(&t, m, rays < m->least ? m->least : rays);
    for (int i = 0; i < m->count; i++)
        for (int r = 0; r < MIXTURE_REPLICATES; r++) add_set(&t, i, r, &rng);
    trace(&t);
    finish(e, &t);
    memcpy(m->replicates, t.sums, sizeof m->replicates);
    if (!learn || !(rgb_luminance(e->error) > 0)) return;
    for (int i = 0; i < m->count; i++) m->share[i] = sqrt(variance(t.luminance[i]) * t.rays[i]);
    scale_shares(m);
}

void mixture_gather_to(struct irradiance *e, struct mixture *m, double target, double beside, int least, int most,
                       uint64_t key)
{
    int rays = least < most ? least : most, spent = 0;
    for (int round = 0;; round++) {
        mixture_gather(e, m, rays, key + (uint64_t)round * 0x9e3779b97f4a7c15u, true);
        e->rays = spent += e->rays;
        const double wanted = target * (beside + rgb_luminance(e->value)), found = rgb_luminance(e->error);
        const double left = (double)most - spent;
        if (!(found > wanted) || left < 2.0 * rays) break;
        const double growth = wanted > 0 ? pow(found / wanted, 1 / RATE) : INFINITY;
        rays = (int)fmin(rays * clamp(growth, 2, 16), left);
    }
}

bool mixture_is_light(const struct mixture *lights, struct vec3 direction, enum light_source seen)
{
    if (!is_light(seen)) return false;
    for (int i = 0; i < lights->count; i++)
        if (strategy_density(&lights->strategies[i], direction) > 0) return true;
    return false;
}
