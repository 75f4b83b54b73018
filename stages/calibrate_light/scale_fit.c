/* scale_fit.c - one scale for a scene.
 *
 * By exposure. [ISO 12232]: a sensor of speed S saturates at a focal plane exposure of 78 / S lx s, and a lens of
 * f-number N gives q L t / N^2 of a surface of L cd/m2 in t seconds, with q = 0.65 for usual transmission and
 * vignetting. So white, which is 1 in the photos of a scene, is 78 / 0.65 = 120 cd/m2 over the exposure t S / N^2.
 * Cameras differ from that. The standard's other speed, of pictures in sRGB, has 18 % at 10 / S lx s, and white at
 * 55.6 / S: 0.49 stops less. Raw files of cameras saturate 0.2 to 0.8 stops later than their stated speed says
 * [DxOMark 2011]. The number is in the middle of both, and the interval of 95 % is a stop to either side. Photos that
 * were not merged have their own exposures, and their own white: their median counts, and their spread widens the
 * interval.
 *
 * By measurement. Each gives a quotient, measured over found, with a standard error as a logarithm. Their mean is
 * robust: it begins at the weighted median, and is renewed with weights of Huber [Huber 1964] beyond TUNING
 * deviations, where a deviation is the measurement's own standard error times the spread of all, at least 1. One
 * beyond `off` deviations is named. The interval is the mean's standard error times 1.96, or if the spread is larger
 * than what was expected, times Student's quantile, joined with what all measurements share: textures and lamps of a
 * scene that are too bright as a whole give too small a scale at every place. On loft (draft) that was 5 %. With two
 * measurements that disagree nothing says which is wrong: both are named. */
#include "stages/calibrate_light/scale_fit.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/sort.h"
#include "common/math/student.h"
#include "common/math/weighted.h"

enum { ROUNDS = 50, FEW = 64 };
static const double TUNING = 1.5, NORMAL = 1.96, LEAST_ERROR = 1e-3;

double scale_exposure(const struct photo_record *r)
{
    const struct photo_info *i = &r->info;
    if (!(i->seconds > 0 && i->f_number > 0 && i->iso > 0)) return 0;
    /* views of one exposure may keep their own white: then both numbers are 1 in their records */
    const bool own_white =
        !r->bracket_count || (r->bracket_count == 1 && r->brackets[0].exposure == 1 && r->white == 1);
    return own_white ? i->seconds * i->iso / (i->f_number * i->f_number) : r->white;
}

static struct lux_interval around(double level, double half)
{
    return (struct lux_interval){exp(level), exp(level - half), exp(level + half)};
}

struct lux_interval scale_of_exposures(double *exposures, int count, const struct calibrate_params *p)
{
    double sum = 0, squares = 0;
    if (count < 1) return (struct lux_interval){0, 0, 0};
    sort_doubles(exposures, (size_t)count);
    const double level = 0.5 * (log(exposures[(count - 1) / 2]) + log(exposures[count / 2]));
    for (int i = 0; i < count; i++) {
        sum += log(exposures[i]) - level;
        squares += (log(exposures[i]) - level) * (log(exposures[i]) - level);
    }
    const double variance = fmax(squares / count - sum / count * sum / count, 0);
    return around(log(p->constant) - level, sqrt(p->stops * log(2) * p->stops * log(2) + NORMAL * NORMAL * variance));
}

static double level_of(const struct lux_measurement *m) { return log(m->value / m->light); }
static double error_of(const struct lux_measurement *m) { return fmax(m->expected, LEAST_ERROR); }

/* The weighted median of the levels; sets each deviation. */
static double median_level(struct lux_measurement *m, int count)
{
    struct weighted few[FEW], *list = count > FEW ? malloc((size_t)count * sizeof *list) : few;
    double level = level_of(&m[0]);
    for (int i = 0; list && i < count; i++)
        list[i] = (struct weighted){level_of(&m[i]), 1 / (error_of(&m[i]) * error_of(&m[i]))};
    if (list) level = weighted_percentile(list, (size_t)count, 0.5);
    if (list != few) free(list);
    return level;
}

/* How many times larger deviations are than expected: 1.4826 times their median, at least 1. */
static double spread_of(const struct lux_measurement *m, int count, double level)
{
    double few[FEW], *list = count > FEW ? malloc((size_t)count * sizeof *list) : few, spread = 1;
    for (int i = 0; list && i < count; i++) list[i] = fabs(level_of(&m[i]) - level) / error_of(&m[i]);
    if (list) {
        sort_doubles(list, (size_t)count);
        spread = fmax(1, 1.4826 * list[count / 2]);
    }
    if (list != few) free(list);
    return spread;
}

struct lux_interval scale_of_measurements(struct lux_measurement *m, int count, const struct calibrate_params *p)
{
    double level = median_level(m, count), weights = 0;
    const double spread = spread_of(m, count, level);
    for (int round = 0; round < ROUNDS; round++) {
        double sum = 0;
        weights = 0;
        for (int i = 0; i < count; i++) {
            const double error = error_of(&m[i]), r = fabs(level_of(&m[i]) - level) / (error * spread);
            const double weight = (r > TUNING ? TUNING / r : 1) / (error * error);
            sum += weight * level_of(&m[i]);
            weights += weight;
        }
        level = sum / weights;
    }
    for (int i = 0; i < count; i++) {
        m[i].deviation = level_of(&m[i]) - level;
        m[i].off = fabs(m[i].deviation) > p->off * spread * error_of(&m[i]);
    }
    if (count == 2) { /* the mean lies between them */
        const double apart = fabs(level_of(&m[0]) - level_of(&m[1]));
        m[0].off = m[1].off = apart > p->off * hypot(error_of(&m[0]), error_of(&m[1]));
    }
    const double quantile = spread > 1 ? student_quantile(count - 1) : NORMAL;
    return around(level, hypot(quantile * spread / sqrt(weights), NORMAL * p->common_error));
}
