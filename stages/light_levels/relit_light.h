/* relit_light.h - the light of photographs in parts that add up: what each lamp, each window as photographed, and each
 * window under computed skies brings to the surfaces that photographs show, and to points of plans.
 *
 * A place is a patch that a photograph shows. Light is irradiance, in the unit of the photographs or, of planned lamps
 * and computed skies, in lx. */
#ifndef REMODEL_LEVELS_RELIT_LIGHT_H
#define REMODEL_LEVELS_RELIT_LIGHT_H

#include "stages/light_levels/level_days.h"
#include "stages/light_levels/level_views.h"

enum relit_kind {
    RELIT_TEXTURE, /* the light in which the photograph was taken */
    RELIT_LAMP,    /* `of`: of lamps, with what nothing explains and planned ones */
    RELIT_WINDOW,  /* sky and sun through a window, as photographed */
    RELIT_LEVEL,   /* of a window: what RELIT_PARTs are multiplied by (sky_basis.h) */
    RELIT_PART
};

struct relit_field {
    enum relit_kind kind;
    int of;        /* lamp or window */
    float *values; /* 3 of each place, then one of each point; owned */
};

enum relit_lamp_kind { RELIT_FITTED, RELIT_REST, RELIT_PLANNED };
struct relit_lamp {
    enum relit_lamp_kind kind;
    char *name; /* owned; "": the rest */
    bool on;    /* planned: it shines where lamps do, if there is a scale */
};

/* A computed sky. */
struct relit_sky {
    struct light_state state; /* its sky alone; it owns nothing */
    double horizontal, sun;   /* lx, of the unobstructed horizontal; of the sun behind the glass, facing it */
    struct vec3 to_sun;
    int shade;     /* number of the pictures of where it shines; -1: nowhere */
    double *mixes; /* of each part, in order of the fields; owned */
};

/* Cells of a face (patches.h), by places. */
struct relit_face {
    struct vec3 normal, u, v;
    double offset; /* normal . p of its plane */
    double low[2], step[2];
    int columns, rows;
    int *places; /* of each cell, -1: no photograph shows it; owned */
};

enum { RELIT_LENS = 8 }; /* px between the rays that are kept */
struct relit_photo {
    char *name; /* owned */
    int width, height;
    struct vec3 from;
    float *rays;         /* unit directions, 3 each; RELIT_LENS px apart, and at the far ends */
    int *pixels;         /* of each what it shows: enum relit_pixel, and numbers beyond */
    int **shades;        /* half as wide and high: 1 + the window that the sun comes through */
    unsigned char *jpeg; /* owned, as the others */
    size_t jpeg_size;
};
/* Numbers of pixels: 0 nothing, then 1 + window for the outdoors, then lamps, faces, places of furniture. */

/* {0} is the empty state; everything is owned. */
struct relit_light {
    int places, points;
    int things;           /* the first place of furniture */
    struct vec3 *normals; /* of furniture */
    struct relit_field *fields;
    struct relit_lamp *lamps;
    char **windows; /* the last one is WINDOW_ELSEWHERE */
    struct relit_sky *skies;
    struct relit_face *faces;
    struct relit_photo *photos;
    int field_count, lamp_count, window_count, sky_count, face_count, photo_count, part_count, shade_count;
    int **shades;      /* of points, as those of photos; owned */
    double scale;      /* lx of the photographs' unit; 0: unknown */
    double horizontal; /* of the photographed sky, in that unit */
};

/* Where its parts come from. */
struct relit_sources {
    const struct level_light *light;
    const struct level_views *views;
    const struct state_list *states;
    const struct levels_params *params;
    const struct level_days *days;
    const struct level_points *points;
    const int *chosen; /* points of plans */
    int chosen_count;
    double scale;
};

/* The caller releases r in each case. Same bits for any number of threads. ST_NOMEM. */
enum status relit_light_make(struct relit_light *r, const struct relit_sources *from, struct err *err);
void relit_light_release(struct relit_light *r);

/* The first part of a window among a sky's mixes. */
int relit_light_first_part(const struct relit_light *r, int window, int *count);
/* The sky of a state; -1: it was not computed. A CIE overcast sky is that of any illuminance. */
int relit_light_find_sky(const struct relit_light *r, const struct light_state *state);
int relit_light_lens_size(int pixels);

#endif
