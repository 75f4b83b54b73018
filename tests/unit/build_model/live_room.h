/* live_room.h - the files of a room of 4 x 3 x 2.5 m, as a page gives them to the module. */
#ifndef REMODEL_TESTS_LIVE_ROOM_H
#define REMODEL_TESTS_LIVE_ROOM_H

#include "stages/build_model/live/live.h"
#include "tests/unit/scratch.h"

#define LIVE_ROOM                                                         \
    "remodel-script 1\n"                                                  \
    "wall south from 4 0 to 0 0\nwall west from 0 0 to 0 3\n"             \
    "wall north from 0 3 to 4 3\nwall east from 4 3 to 4 0\n"             \
    "join south west north east south\nroom main south west north east\n" \
    "window sunny on south from 1 1 to 3 2\n"

/* Cameras look south: their rotation's rows are right -x, down -z, forward -y. */
#define LIVE_SOUTH "0 0 -0.70710678118654757 0.70710678118654757 "
#define LIVE_LENS  " PINHOLE 400 300 200 200 200 150 turn 1 0 0 0\n"

/* images, lenses: the lines of the cameras' files. */
static inline int live_room_make(void **state, const char *script, const char *images, const char *lenses)
{
    if (scratch_make(state)) return -1;
    mkdir(scratch_path("views"), 0777);
    mkdir(scratch_path("edits"), 0777);
    scratch_write("views/cameras.txt", "1 PINHOLE 400 300 200 200 200 150\n");
    scratch_write("views/images.txt", images);
    scratch_write("views/points3D.txt", "");
    scratch_write("views/lenses.txt", lenses);
    scratch_write("axes.txt", "remodel-axes 1\nrotation 1 0 0 0\ntranslation 0 0 0\nscale 1 metres\nceiling 2.5\n"
                              "thickness none\nerror tilt 0\nerror heading 0\nerror floor 0\nerror ceiling 0\n"
                              "error scale 0\n");
    scratch_write("model.txt", script);
    return 0;
}

static inline int live_room_end(void **state)
{
    live_end();
    return scratch_remove(state);
}

#endif
