/* solve.h - the lamps of a scene: what annotations give, what is fitted, what the views show of them. */
#ifndef REMODEL_FIT_LIGHTS_SOLVE_H
#define REMODEL_FIT_LIGHTS_SOLVE_H

#include "stages/fit_lights/light_fit.h"
#include "stages/fit_lights/solve_inputs.h"
#include "stages/fit_lights/unseen_lamps.h"

/* Where a lamp's radiance comes from. LAMP_UNKNOWN: from nothing, it is 0. */
enum lamp_source { LAMP_GIVEN, LAMP_FITTED, LAMP_MEASURED, LAMP_BOUND, LAMP_UNKNOWN };

/* Standard errors; 0: given. */
struct lamp_result {
    enum lamp_source source;
    double radiance_error[3], beta_error, exponent_error; /* beta: radians */
    double low[3], high[3];                               /* fitted: interval of 95 % of the radiance */
    /* what the views show of the lamp itself, towards its normal */
    double seen[3], seen_error[3];
    int measured_points;        /* lit, unlit and places that views measure */
    bool uses_places;           /* no view measures the lamp, so places that nobody marked count */
    bool disagrees;             /* the fit and what views show differ by more than the intervals */
    int unsaturated, saturated; /* numbers of views; with no unsaturated one, `seen` is a lower bound */
};

struct solved_lights {
    struct lamp_result *lamps;
    struct fit_material *materials; /* their names are owned */
    struct fit_mark *marks;         /* those of the scene */
    struct fit_point *points;       /* those of the fit */
    int *point_notes;               /* the annotation of each */
    int lamp_count, material_count, mark_count, point_count;
};

enum status solve_lights(struct solved_lights *s, const struct solve_inputs *in, struct err *err);
void solve_release(struct solved_lights *s);

/* fit.txt (docs/formats.md). unseen, model: lamps that nobody marked, and the model that they were found in. */
enum status solve_write(const struct solved_lights *s, const struct solve_inputs *in, const struct unseen_lamps *unseen,
                        const struct lit_model *model, const char *path, const struct provenance *prov,
                        struct err *err);

#endif
