/* lamps_on_faces.c - see lamps_on_faces.h. */
#include "stages/fit_lights/lamps_on_faces.h"

#include <stdlib.h>
#include <string.h>

#include "stages/fit_lights/direct.h"

struct room {
    double (*known)[3], *factors;
    struct lit_point *points; /* the squares */
    struct face_lamp *found;  /* the free lamps, then those that nobody marked */
};

static enum status reserve(struct room *r, const struct unseen_lamps *u, int lamps, struct err *err)
{
    const size_t squares = (size_t)u->squares.count, all = (size_t)(lamps + u->count);
    r->known = malloc(squares * sizeof *r->known + 1);
    r->factors = calloc(squares * all + 1, sizeof *r->factors);
    r->points = calloc(squares + 1, sizeof *r->points);
    r->found = calloc(all + 1, sizeof *r->found);
    if (!r->known || !r->factors || !r->points || !r->found)
        return err_nomem(err, "squares of faces", squares * all * sizeof *r->factors);
    if (squares) memcpy(r->known, u->without_lamps, squares * sizeof *r->known);
    for (size_t i = 0; i < squares; i++)
        r->points[i] = (struct lit_point){.at = u->squares.list[i].at, .normal = u->squares.list[i].normal};
    return ST_OK;
}

/* The light of a lamp of the scene: known, or a row of factors. */
static void take_lamp(struct room *r, double *row, const struct direct_light *d, const struct lit_scene *scene,
                      int lamp, int squares)
{
    const struct lamp *l = &scene->lights.lamps[lamp];
    for (int i = 0; i < squares; i++) {
        const double e = direct_light_at(d, lamp, i, l->beta, l->exponent);
        if (row) {
            row[i] = e;
            continue;
        }
        r->known[i][0] += e * l->radiance.r;
        r->known[i][1] += e * l->radiance.g;
        r->known[i][2] += e * l->radiance.b;
    }
}

static void set_found(struct face_lamp *lamps, const bool *is_free, int count, struct unseen_lamps *u,
                      const struct face_lamp *found)
{
    int n = 0;
    for (int k = 0; k < count; k++) lamps[k] = is_free[k] ? found[n++] : (struct face_lamp){0};
    for (int k = 0; k < u->count; k++, n++) {
        if (!found[n].is_known) continue;
        memcpy(u->lamps[k].intensity, found[n].radiance, sizeof u->lamps[k].intensity);
        memcpy(u->lamps[k].error, found[n].error, sizeof u->lamps[k].error);
    }
}

enum status lamps_on_faces_fit(struct face_lamp *lamps, const bool *is_free, struct unseen_lamps *u,
                               const struct lit_scene *scene, const struct model_rays *furnished, struct err *err)
{
    const int squares = u->squares.count, count = scene->lights.lamp_count;
    struct room r = {0};
    struct direct_light direct = {0};
    reserve(&r, u, count, err);
    const struct lit_scene probe = {.lights = scene->lights, .points = r.points, .point_count = squares};
    if (!err->status && !direct_light_make(&direct, &probe, furnished, err)) {
        struct face_light light = {.squares = &u->squares, .known = (const double(*)[3])r.known, .factors = r.factors};
        for (int k = 0; k < count; k++) {
            double *row = is_free[k] ? r.factors + (size_t)light.lamp_count * (size_t)squares : NULL;
            take_lamp(&r, row, &direct, scene, k, squares);
            light.lamp_count += is_free[k];
        }
        for (int k = 0; k < u->count; k++, light.lamp_count++)
            for (int i = 0; i < squares; i++)
                r.factors[(size_t)light.lamp_count * (size_t)squares + (size_t)i] =
                    unseen_lamp_factor(furnished, &u->lamps[k].place, r.points[i].at, r.points[i].normal);
        if (!face_light_fit(r.found, &light, err)) set_found(lamps, is_free, count, u, r.found);
    }
    direct_light_release(&direct);
    free(r.known);
    free(r.factors);
    free(r.points);
    free(r.found);
    return err->status;
}
