/* export_things.h - furniture as triangles of one colour each, where the edit has it. */
#ifndef REMODEL_EXPORT_THINGS_H
#define REMODEL_EXPORT_THINGS_H

#include "common/model/thing_mesh.h"
#include "common/texture/texture_map.h"

struct export_thing {
    char *name;             /* of the thing, or of the copy; unique; owned */
    struct thing_mesh mesh; /* at its place, model frame; has triangles; owned */
    double radiance[3];     /* the mean of its pixels */
};

/* {0} is the empty state; everything is owned. */
struct export_things {
    struct export_thing *things;
    int count;
};

struct export_thing_files {
    const char *folder; /* that find_things wrote; NULL: no things */
    const char *model;  /* model.txt of the model that is exported */
    const char *base;   /* of the unedited one; only an edit that changes a thing needs it */
    const char *map;    /* texture.txt of the edit, for messages */
};

/* map: of an edited model, NULL: all things stay. Cleared things are left out; moved ones and copies are at their new
 * places. A thing without any surface is left out, with a warning. The caller releases t in each case. ST_DATA also:
 * the edit names a thing that was not found, or puts one into a wall, or gives a copy another thing's name. */
enum status export_things_read(struct export_things *t, const struct export_thing_files *files,
                               const struct texture_map *map, struct provenance *prov, struct err *err);
void export_things_release(struct export_things *t);

/* Radiance times the exposure, at most 1: linear, as materials have it. */
void export_thing_colour(double colour[3], const struct export_thing *t, double exposure);

#endif
