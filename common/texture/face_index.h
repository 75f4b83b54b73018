/* face_index.h - which views show a face of the solid model, best first: out/SCENE/ids/index.txt, made by trace_ids.
 *
 *   remodel-face-index 1
 *   faces COUNT                                 that some view shows
 *   at ID OFFSET BYTES VIEWS LINE               COUNT lines of FACE_INDEX_ROW bytes each, in order of ID: where the
 *   ...                                         face's list begins in the file, its bytes, lines, first line
 *   view NAME PIXELS CLEAN DISTANCE COSINE      the lists: the numbers are those of ids/VIEW.txt; best first, that is
 *   ...                                         in descending order of CLEAN x COSINE, PIXELS x COSINE, then of name
 *
 * The rows of the table have a fixed width, so that a face is found by bisection: a reader holds one list at a time and
 * reads a few hundred bytes and that list, however many faces and views there are. */
#ifndef REMODEL_FACE_INDEX_H
#define REMODEL_FACE_INDEX_H

#include <stdint.h>

#include "common/base/err.h"
#include "common/base/provenance.h"

#define FACE_INDEX_ROW 64 /* bytes of a row of the table, with its line break */

struct face_view {
    char *name;        /* of the view; owned by the list */
    int pixels, clean; /* that show the face; of these, without clutter and away from depth jumps */
    double distance;   /* median of these, scene units */
    double cosine;     /* mean of these, between the ray and the face's normal */
};

struct face_views {
    struct face_view *views; /* owned */
    int count;
};
void face_views_release(struct face_views *list);

/* {0} is the empty state. */
struct face_index {
    char *path; /* owned */
    int file;   /* its descriptor, while path is set */
    int faces;  /* that some view shows */
    int64_t table, size;
    int64_t bytes_read; /* so far */
};

enum status face_index_open(struct face_index *index, const char *path, struct provenance *prov, struct err *err);
void face_index_close(struct face_index *index);
/* The views that show a face, best first; none if no view does. list is empty on entry; the caller releases it.
 * ST_DATA: a damaged file. */
enum status face_index_load(struct face_views *list, struct face_index *index, int face, struct err *err);

/* lists: of the faces ids[0] < ids[1] < ..., each with a view or more, best first. */
enum status face_index_write(const char *path, const int *ids, const struct face_views *lists, int count,
                             const struct provenance *prov, struct err *err);

#endif
