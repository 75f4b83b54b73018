/* true_faces.h - reads faces.txt: the faces of a described scene (docs/scenes.md).
 *
 *   remodel-faces 1
 *   ID NAME AREA NX NY NZ      each id once, from 1 to 2^20; an edited scene may lack ids */
#ifndef REMODEL_TRUE_FACES_H
#define REMODEL_TRUE_FACES_H

#include "common/base/err.h"
#include "common/math/vec.h"

struct true_face {
    char *name;         /* owned; NULL: no face has this id */
    struct vec3 normal; /* 0 0 0 of a mesh */
};

struct true_faces {
    struct true_face *faces; /* that of id i is faces[i - 1] */
    int count;               /* the largest id */
};

/* faces is overwritten, and empty after an error. ST_DATA with file and line. */
enum status true_faces_read(struct true_faces *faces, const char *path, struct err *err);
void true_faces_release(struct true_faces *faces);

#endif
