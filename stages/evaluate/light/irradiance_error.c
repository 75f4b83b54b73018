/* irradiance_error.c - errors of irradiance at points.
 *
 * A true point's partner is the nearest found point within POINT_DISTANCE that faces the same way: a product may hold
 * more points, fewer, and in another order. Errors are relative to the true irradiance of the points together (rms), so
 * that dark points do not dominate, and of each point (error50). */
#include "stages/evaluate/light/irradiance_error.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/sort.h"
#include "common/image/luminance.h"
#include "stages/evaluate/scene/evaluation_parts.h"

#define MIN_COSINE 0.98480775301220802 /* cos 10 degrees */

void irradiance_partners(int *partner, const struct irradiance_list *truth, const struct irradiance_list *found)
{
    for (int i = 0; i < truth->count; i++) {
        double nearest = POINT_DISTANCE;
        partner[i] = -1;
        for (int k = 0; k < found->count; k++) {
            const double d = vec3_length(vec3_sub(found->points[k].point, truth->points[i].point));
            if (!(d <= nearest) || (partner[i] >= 0 && d == nearest)) continue;
            if (!(vec3_dot(found->points[k].normal, truth->points[i].normal) >= MIN_COSINE)) continue;
            nearest = d;
            partner[i] = k;
        }
    }
}

enum status irradiance_errors(struct irradiance_errors *e, const struct irradiance_list *truth,
                              const struct irradiance_list *found, const int *partner, const bool *wanted, double scale,
                              struct err *err)
{
    double square = 0, reference = 0;
    double *errors = malloc(((size_t)truth->count + 1) * sizeof *errors);
    *e = (struct irradiance_errors){0};
    if (!errors) return err_nomem(err, "errors of irradiance", (size_t)truth->count * sizeof *errors);
    for (int i = 0; i < truth->count; i++) {
        const double *b = truth->points[i].rgb;
        if (partner[i] < 0 || !wanted[i] || !(luminance_of_doubles(b) > 0)) continue;
        const double *a = found->points[partner[i]].rgb;
        for (int c = 0; c < 3; c++) {
            square += (scale * a[c] - b[c]) * (scale * a[c] - b[c]);
            reference += b[c] * b[c];
        }
        errors[e->points++] = fabs(scale * luminance_of_doubles(a) - luminance_of_doubles(b)) / luminance_of_doubles(b);
    }
    if (e->points) {
        e->rms = sqrt(square / reference);
        e->error50 = sort_median(errors, (size_t)e->points);
        sort_doubles(errors, (size_t)e->points);
        e->error90 = errors[(9 * (e->points - 1) + 5) / 10];
    }
    free(errors);
    return ST_OK;
}

enum status irradiance_scale(double *scale, const struct irradiance_list *truth, const struct irradiance_list *found,
                             const int *partner, struct err *err)
{
    int count = 0;
    double *ratios = malloc(((size_t)truth->count + 1) * sizeof *ratios);
    if (!ratios) return err_nomem(err, "ratios of irradiance", (size_t)truth->count * sizeof *ratios);
    for (int i = 0; i < truth->count; i++) {
        const double b = luminance_of_doubles(truth->points[i].rgb);
        const double a = partner[i] < 0 ? 0 : luminance_of_doubles(found->points[partner[i]].rgb);
        if (a > 0 && b > 0) ratios[count++] = b / a;
    }
    *scale = count ? sort_median(ratios, (size_t)count) : 0;
    free(ratios);
    return ST_OK;
}
