/* annotations.h - scenes/NAME/lights.txt: lamps, windows and lit points that a person marks in photographs.
 *
 * The first line is `remodel-lamps 1`. VIEW is a photo's id or a view's name; pixels are those of the photograph as it
 * is stored, as in docs/model-script.md:
 *   window NAME [reference ID ...]        an opening of the model that lets daylight in
 *   shut NAME                             a window that does not
 *   disk NAME in VIEW X Y rim X Y [OPTIONS] [normal NX NY NZ] [beta DEGREES|fit] [exponent E|fit]
 *   area NAME in VIEW X Y X Y X Y X Y [OPTIONS]   four corners in order
 *       OPTIONS: [off D] in front of the model's surface; [radiance R G B]
 *   lit NAME in VIEW X Y [X1 Y1] [of MATERIAL]     a point, or a rectangle of points, that the lamp NAME lights
 *   unlit NAME in VIEW X Y [X1 Y1] [of MATERIAL]   not lit by it
 *   line NAME in VIEW X Y X Y [of MATERIAL]        across the edge of the lamp's cone */
#ifndef REMODEL_ANNOTATIONS_H
#define REMODEL_ANNOTATIONS_H

#include <stdbool.h>

#include "common/base/provenance.h"
#include "common/math/vec.h"

enum annotation_kind { NOTE_WINDOW, NOTE_SHUT, NOTE_DISK, NOTE_AREA, NOTE_LIT, NOTE_UNLIT, NOTE_LINE, NOTE_KINDS };

enum quantity { QUANTITY_DEFAULT, QUANTITY_GIVEN, QUANTITY_FIT };

struct annotation {
    enum annotation_kind kind;
    int line;          /* of the file */
    char *name, *view; /* owned; view is NULL for windows */
    double pixel[8];   /* x y of each pixel */
    int pixels;        /* 1, 2 or 4 */
    char **references; /* owned */
    int reference_count;
    double off; /* model units */
    bool has_normal;
    struct vec3 normal; /* unit; model frame */
    enum quantity has_beta, has_exponent, has_radiance;
    double beta, exponent; /* degrees */
    double radiance[3];
    char *material; /* lit, unlit, line: owned; NULL: not said */
    int lamp;       /* lit, unlit, line: index of their lamp's annotation */
};

struct annotation_list {
    struct annotation *items;
    int count;
    char *path; /* owned; for errors */
};

const char *annotation_word(enum annotation_kind kind);

/* The caller releases the list, which a failure leaves empty. ST_DATA with file and line: an unknown word, a name
 * twice, a point of a lamp that the file does not have, a cone of 0 degrees, a number out of range. */
enum status annotation_list_read(struct annotation_list *list, const char *path, struct provenance *prov,
                                 struct err *err);
void annotation_list_release(struct annotation_list *list);

#endif
