/* light_rounds.c - see light_rounds.h.
 *
 * Mathematics. Round k computes the irradiance E_k of all samples from what they send out under E_(k-1): a texture its
 * texels times E_(k-1) / E_0, a colour albedo / pi times E_(k-1), beginning with the light as it was. E_0 is the
 * irradiance of the unedited model. Each round adds one more reflection of what the edit has changed. With c_k = |E_k -
 * E_(k-1)| the changes shrink by q = c_k / c_(k-1), and what later rounds would add is at most c_k q / (1 - q). Rounds
 * end when that is below the tolerance of max(E_k, 1e-4 E_0) at every sample; E_0 is at least the mean over all
 * samples, since colours and objects have none, and where lights go out their light would shrink for ever. That the
 * quotient is within the tolerance of 1 would not do: with q = 0.7 more than twice as much is still to come. Nor would
 * one quotient: the first change is that of direct light, largest near a lamp, and the next one, spread over the room,
 * is much smaller whatever the room reflects. So q is the larger one of the last two.
 *
 * Where next to no lamp or window is known, all light of a texel would come from other texels, each round would
 * multiply all light by what the edit changed, and the room would go dark, or burst. What texels send out then follows
 * their light in part only: f E_(k-1) / E_0 + 1 - f.
 *
 * Source: [Colburn 2014, 5.5]. Different here: rays are traced once (transport.h); the rule of the end. */
#include "stages/update_vita/light_rounds.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/parallel.h"
#include "common/relight/light_quotient.h"

static const double DARK = 1e-4; /* of the irradiance before */

struct round_job {
    const struct transport *t;
    double reflecting;
    const struct rgb *old;
    struct rgb *now;
    double *change; /* of each sample, a part of its irradiance */
    double mean;    /* irradiance before, over all samples that have one */
};

static struct rgb quotient_of(const struct transport *t, double reflecting, int i, struct rgb after)
{
    const struct transport_sample *s = &t->samples[i];
    if (s->place.kind != LIGHT_PLACE_TEXTURE) return rgb_grey(1);
    const struct rgb q = light_quotient(t->rows[i].before, after, s->place.colour, NULL);
    return reflecting < 1 ? rgb_add(rgb_scale(q, reflecting), rgb_grey(1 - reflecting)) : q;
}

static void run_some(void *ctx, size_t begin, size_t end, int thread)
{
    struct round_job *j = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        const struct rgb e = transport_gather(&j->t->rows[i], j->old), was = j->old[2 * i + 1];
        const struct rgb d = rgb_make(fabs(e.r - was.r), fabs(e.g - was.g), fabs(e.b - was.b));
        const double whole = fmax(rgb_max(e), DARK * fmax(rgb_max(j->t->rows[i].before), j->mean));
        j->change[i] = whole > 0 ? rgb_max(d) / whole : 0;
        j->now[2 * i] = quotient_of(j->t, j->reflecting, (int)i, e);
        j->now[2 * i + 1] = e;
    }
}

/* Light as it was: quotients of 1, and colours in the dark. */
static void begin(struct rgb *values, const struct transport *t)
{
    for (int i = 0; i < t->count; i++) {
        values[2 * i] = rgb_grey(1);
        values[2 * i + 1] = t->rows[i].before;
    }
}

static double mean_before(const struct transport *t)
{
    double sum = 0;
    int count = 0;
    for (int i = 0; i < t->count; i++) {
        if (t->samples[i].place.kind != LIGHT_PLACE_TEXTURE) continue;
        sum += rgb_max(t->rows[i].before);
        count++;
    }
    return count ? sum / count : 0;
}

static double largest(const double *x, int count)
{
    double most = 0;
    for (int i = 0; i < count; i++) most = fmax(most, x[i]);
    return most;
}

static int count_bounded(const struct transport *t, const struct rgb *values)
{
    int count = 0;
    for (int i = 0; i < t->count; i++) {
        bool is_bounded = false;
        if (t->samples[i].place.kind != LIGHT_PLACE_TEXTURE) continue;
        light_quotient(t->rows[i].before, values[2 * i + 1], t->samples[i].place.colour, &is_bounded);
        count += is_bounded;
    }
    return count;
}

/* By how much changes shrink, from the rounds before and this one's; INFINITY: too few of them tell. */
static double shrinking(const struct rounds *r, double change)
{
    if (r->count < 2) return INFINITY;
    const double last = r->list[r->count - 1].change;
    return fmax(change / last, last / r->list[r->count - 2].change);
}

enum status rounds_run(struct rounds *r, const struct transport *t, double reflecting, int most, double tolerance,
                       struct err *err)
{
    const size_t values = 2 * (size_t)t->count + 2;
    struct rgb *next = calloc(values, sizeof *next);
    double *change = calloc(values, sizeof *change);
    const double mean = mean_before(t);
    *r = (struct rounds){.values = calloc(values, sizeof *r->values)};
    if (!r->values || !next || !change) err_nomem(err, "rounds", values * sizeof *next);
    if (!err->status) begin(r->values, t);
    for (int k = 0; !err->status && k < most && !r->settled; k++) {
        struct round_job j = {t, reflecting, r->values, next, change, mean};
        parallel_for((size_t)t->count, 64, run_some, &j);
        struct rgb *old = r->values;
        r->values = next;
        next = old;
        struct round round = {.change = largest(change, t->count), .left = INFINITY};
        const double q = shrinking(r, round.change);
        if (round.change == 0)
            round.left = 0;
        else if (q < 1)
            round.left = round.change * q / (1 - q);
        if (!array_append(&r->list, (size_t)r->count, sizeof *r->list, "rounds", err)) r->list[r->count++] = round;
        r->settled = round.left < tolerance;
    }
    if (!err->status) r->bounded = count_bounded(t, r->values);
    free(next);
    free(change);
    return err->status;
}

void rounds_release(struct rounds *r)
{
    if (!r) return;
    free(r->values);
    free(r->list);
    *r = (struct rounds){0};
}
