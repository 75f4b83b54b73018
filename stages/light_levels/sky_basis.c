/* sky_basis.c - see sky_basis.h.
 *
 * Mathematics. Values are divided by the mean of their sky and by the mean of their place, so that they are near 1.
 * What is left of the sky with the largest relative error becomes the next part, and all skies lose their share of it
 * (modified Gram-Schmidt with pivots). Light of skies changes slowly with the hour, so that few parts suffice. Parts
 * are orthogonal and of mean square 1: sums of them do not cancel, and 16 bits hold them. */
#include "stages/light_levels/sky_basis.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double FLOOR = 0.05;

void sky_basis_release(struct sky_basis *b)
{
    free(b->level);
    free(b->parts);
    free(b->mixes);
    *b = (struct sky_basis){.count = 0};
}

/* What is left of the values, and the means of the skies. */
struct remainder {
    float *left, *wanted; /* of values that were divided */
    double *means;
    size_t places;
};

static void divide(struct remainder *r, struct sky_basis *b, const float *values)
{
    for (int s = 0; s < b->skies; s++) {
        const float *v = values + (size_t)s * r->places;
        double sum = 0;
        for (size_t i = 0; i < r->places; i++) sum += (double)v[i];
        r->means[s] = sum / (double)r->places;
        for (size_t i = 0; r->means[s] > 0 && i < r->places; i++)
            b->level[i] += (float)((double)v[i] / r->means[s] / b->skies);
    }
    for (int s = 0; s < b->skies; s++)
        for (size_t i = 0; i < r->places; i++) {
            const size_t at = (size_t)s * r->places + i;
            if (r->means[s] > 0 && b->level[i] > 0)
                r->wanted[at] = (float)((double)values[at] / r->means[s] / (double)b->level[i]);
            r->left[at] = r->wanted[at];
        }
}

/* The largest relative error of a sky. */
static double error_of(const struct remainder *r, int sky)
{
    const float *left = r->left + (size_t)sky * r->places, *wanted = r->wanted + (size_t)sky * r->places;
    float worst = 0;
    for (size_t i = 0; i < r->places; i++) {
        const float e = fabsf(left[i]) / fmaxf(wanted[i], (float)FLOOR);
        worst = e > worst ? e : worst;
    }
    return (double)worst;
}

static void add_part(struct sky_basis *b, const struct remainder *r, int sky)
{
    float *part = b->parts + (size_t)b->count * r->places;
    const float *from = r->left + (size_t)sky * r->places;
    double square = 0;
    for (size_t i = 0; i < r->places; i++) square += (double)from[i] * (double)from[i];
    const double by = 1 / sqrt(square / (double)r->places);
    for (size_t i = 0; i < r->places; i++) part[i] = (float)((double)from[i] * by);
    for (int s = 0; s < b->skies; s++) {
        float *left = r->left + (size_t)s * r->places;
        double share = 0;
        for (size_t i = 0; i < r->places; i++) share += (double)part[i] * (double)left[i];
        share /= (double)r->places;
        for (size_t i = 0; i < r->places; i++) left[i] -= (float)share * part[i];
        b->mixes[(size_t)s * SKY_PARTS + (size_t)b->count] = share * r->means[s];
    }
    b->count++;
}

/* From SKY_PARTS a sky to as many as there are. */
static void pack_mixes(struct sky_basis *b)
{
    for (int s = 0; s < b->skies; s++)
        for (int k = 0; k < b->count; k++) b->mixes[s * b->count + k] = b->mixes[s * SKY_PARTS + k];
}

enum status sky_basis_make(struct sky_basis *b, const float *values, int places, int skies, double tolerance,
                           struct err *err)
{
    const size_t size = (size_t)places * (size_t)skies;
    struct remainder r = {calloc(size + 1, sizeof *r.left), calloc(size + 1, sizeof *r.wanted),
                          calloc((size_t)skies + 1, sizeof *r.means), (size_t)places};
    *b = (struct sky_basis){calloc((size_t)places + 1, sizeof *b->level),
                            calloc((size_t)places * SKY_PARTS + 1, sizeof *b->parts),
                            calloc((size_t)skies * SKY_PARTS + 1, sizeof *b->mixes),
                            places,
                            skies,
                            0};
    if (!r.left || !r.wanted || !r.means || !b->level || !b->parts || !b->mixes)
        err_nomem(err, "light of skies", size * sizeof *r.left);
    if (!err->status && places) divide(&r, b, values);
    while (!err->status && places && b->count < SKY_PARTS) {
        double worst = tolerance;
        int sky = -1;
        for (int s = 0; s < skies; s++) {
            const double error = error_of(&r, s);
            if (error > worst) worst = error, sky = s;
        }
        if (sky < 0) break;
        add_part(b, &r, sky);
    }
    if (!err->status) pack_mixes(b);
    free(r.left);
    free(r.wanted);
    free(r.means);
    return err->status;
}
