/* light_list.h - lights.txt: the lamps of a scene, and the openings that let daylight in.
 *
 * O/lights/lights.txt, written by fit_lights, holds what scenes/NAME/lights.txt declares with everything resolved: in
 * the model's frame, scene-linear radiance. */
#ifndef REMODEL_LIGHT_LIST_H
#define REMODEL_LIGHT_LIST_H

#include "common/base/provenance.h"
#include "common/gather/lamp.h"

/* An opening through which the sky is seen. Its references are the ids of the lighting reference images that show what
 * lies behind it, nearest first; none: outdoors.exr alone. */
struct daylight {
    char *name;                       /* owned */
    struct vec3 centre, x, y, normal; /* half edges; the normal points indoors */
    char **references;                /* owned */
    int reference_count;
};

/* {0} is the empty state; everything is owned. */
struct light_list {
    struct lamp *lamps;
    struct daylight *openings;
    int lamp_count, opening_count;
};

/* ST_DATA with file and line: a damaged line, a name twice, a normal that is not of unit length, a beta beyond 90
 * degrees, a negative radiance. */
enum status light_list_read(struct light_list *l, const char *path, struct provenance *prov, struct err *err);
enum status light_list_write(const struct light_list *l, const char *path, const struct provenance *prov,
                             struct err *err);
void light_list_release(struct light_list *l);

/* The name of a lamp as that of a file, without an extension: bytes other than letters, digits, - and _ become %XX; a
 * name that is too long for a file becomes lampN, N its number in the list from 1. */
enum { LAMP_FILE_NAME = 208 };
void light_list_lamp_file(char to[LAMP_FILE_NAME], const struct light_list *l, int lamp);

#endif
