/* contents_light.h - what the page shows of the light: lamps, fitted materials, irradiance. */
#ifndef REMODEL_CONTENTS_LIGHT_H
#define REMODEL_CONTENTS_LIGHT_H

#include "common/gather/light_list.h"
#include "common/gather/light_record.h"
#include "common/gather/materials.h"
#include "stages/report/page_pictures.h"

/* A marked point: luminance of its radiance in the photographs, and as the fit explains it. */
struct light_point {
    bool lit;
    double seen, explained;
};

struct lamp_card {
    const struct lamp *lamp;           /* of the list of lights */
    char source[16];                   /* given, fitted, measured or bound; "": fit.txt does not name the lamp */
    double radiance_error[3];          /* half widths of 95 % intervals; 0: given */
    double beta_error, exponent_error; /* degrees; 1 */
    double seen[3], seen_error[3];     /* of the lamp itself; */
    int unsaturated, saturated;        /* in so many views */
    bool disagrees;                    /* with the fit, by more than the intervals */
    struct light_point *points;
    int point_count;
    struct picture picture; /* its cone and its marks; empty: none */
};

struct material_card {
    const struct material *material; /* of the list of materials */
    struct picture residuals;        /* empty: none */
};

/* Irradiance of a view, or at a list of points. */
struct gather_card {
    char name[256]; /* of the view, or of the list */
    bool is_view;
    struct light_record record;
    struct picture photo, white, level, unknown; /* of a view; each may be empty */
    struct picture hemicubes[LIGHT_EXAMPLES_MAX];
};

/* {0} is the empty state; everything is owned. */
struct light_contents {
    struct light_list lights;
    struct lamp_card *lamps; /* lights.lamp_count */
    struct material_list materials;
    struct material_card *material_cards; /* materials.count */
    struct gather_card *gathers;
    int gather_count;
};

void light_contents_release(struct light_contents *l);

/* Whether the page has a section about light. */
bool light_contents_any(const struct light_contents *l);

#endif
