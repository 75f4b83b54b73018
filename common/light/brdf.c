/* brdf.c - evaluation and importance sampling of the reflectance models.
 *
 * A sample first chooses the diffuse part or the lobe. The lobe is chosen with probability gloss / (gloss + luminance
 * of the albedo), its share of the reflected light; the density is that of the mixture. Then:
 *   diffuse  cosine-weighted: density cos / pi
 *   Phong    about the mirror image of the view, density (n + 1) / (2 pi) cos^n
 *   Ward     the half vector, tan(N,H) = alpha sqrt(-ln u) [Ward 1992]; the density of L is
 *            D / (cos^3(N,H) (H.L)), D = exp(-tan^2(N,H) / alpha^2) / (4 pi alpha^2)
 * Phong is the form of [Colburn 2014, A.1.10], with the cosine cancelled: f cos = albedo cos / pi + ks (R.V)^n,
 * finite at grazing light; the diffuse part is albedo / pi in place of the source's k_d. Ward is the isotropic model
 * of [Ward 1992], as in [Colburn 2014, A.1.11]. */
#include "common/light/brdf.h"

#include <math.h>

#include "common/light/frame.h"
#include "common/math/numbers.h"

static double gloss_share(const struct brdf *b)
{
    if (b->kind == BRDF_LAMBERT || !(b->gloss > 0)) return 0;
    return b->gloss / (b->gloss + rgb_luminance(b->albedo));
}

static struct vec3 mirrored(struct vec3 n, struct vec3 v) { return vec3_sub(vec3_scale(n, 2 * vec3_dot(n, v)), v); }

struct rgb brdf_eval(const struct brdf *b, struct vec3 n, struct vec3 view, struct vec3 light, double *pdf)
{
    const double cos_l = vec3_dot(n, light), cos_v = vec3_dot(n, view), share = gloss_share(b);
    *pdf = 0;
    if (!(cos_l > 0) || !(cos_v > 0)) return rgb_grey(0);
    double gloss = 0, gloss_pdf = 0;
    if (b->kind == BRDF_PHONG && share > 0) {
        const double c = vec3_dot(mirrored(n, view), light), lobe = c > 0 ? pow(c, b->shape) : 0;
        gloss = b->ks * lobe;
        gloss_pdf = (b->shape + 1) / (2 * PI) * lobe;
    } else if (b->kind == BRDF_WARD && share > 0) {
        const struct vec3 h = vec3_normalize(vec3_add(view, light));
        const double cos_h = vec3_dot(n, h), cos2 = cos_h * cos_h, alpha2 = b->shape * b->shape;
        const double lobe = cos_h > 0 ? exp((cos2 - 1) / (cos2 * alpha2)) / (4 * PI * alpha2) : 0;
        gloss = b->ks * lobe * sqrt(cos_l / cos_v);
        gloss_pdf = lobe > 0 ? lobe / (cos2 * cos_h * vec3_dot(h, light)) : 0;
    }
    *pdf = (1 - share) * cos_l / PI + share * gloss_pdf;
    return rgb_add(rgb_scale(b->albedo, cos_l / PI), rgb_grey(gloss));
}

bool brdf_sample(const struct brdf *b, struct vec3 n, struct vec3 view, const double u[3], struct vec3 *light)
{
    const double share = gloss_share(b);
    if (u[0] >= share) {
        *light = frame_direction(n, sqrt(u[1]), sqrt(1 - u[1]), u[2]);
    } else if (b->kind == BRDF_PHONG) {
        const double cos_t = pow(1 - u[1], 1 / (b->shape + 1));
        *light = frame_direction(mirrored(n, view), sqrt(fast_max(0, 1 - cos_t * cos_t)), cos_t, u[2]);
    } else {
        const double tan_h = b->shape * sqrt(-log(1 - u[1])), cos_h = 1 / sqrt(1 + tan_h * tan_h);
        *light = mirrored(frame_direction(n, tan_h * cos_h, cos_h, u[2]), view);
    }
    return vec3_dot(n, *light) > 0;
}

/* Reflectance of Ward's lobe with ks = 1 towards a viewer at cos_v: the mean of f cos / density over a grid of the unit
 * square that directions are sampled from. */
static double ward_albedo(double alpha, double cos_v)
{
    enum { STEPS = 96 };
    const struct brdf b = {BRDF_WARD, {0, 0, 0}, 1, alpha, 1};
    const struct vec3 n = {0, 0, 1}, view = {sqrt(1 - cos_v * cos_v), 0, cos_v};
    double sum = 0;
    for (int i = 0; i < STEPS; i++)
        for (int j = 0; j < STEPS; j++) {
            const double u[3] = {0, (i + 0.5) / STEPS, (j + 0.5) / STEPS};
            struct vec3 light;
            double pdf;
            if (!brdf_sample(&b, n, view, u, &light)) continue;
            const double value = brdf_eval(&b, n, view, light, &pdf).r;
            if (pdf > 0) sum += value / pdf;
        }
    return sum / (STEPS * STEPS);
}

double brdf_gloss_albedo(enum brdf_kind kind, double ks, double shape)
{
    double max = 0;
    if (kind == BRDF_PHONG) return 2 * PI * ks / (shape + 1);
    if (kind == BRDF_WARD)
        for (int i = 1; i <= 20; i++) max = fmax(max, ward_albedo(shape, i / 20.0));
    return ks * max;
}
