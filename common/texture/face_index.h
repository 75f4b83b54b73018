/* face_index.h - which views show a face of the model: O/ids/index.txt (docs/formats.md). */
#ifndef REMODEL_FACE_INDEX_H
#define REMODEL_FACE_INDEX_H

#include "common/base/provenance.h"

struct face_view {
    char *view;    /* owned by its list */
    int pixels;    /* of the face */
    int clean;     /* with nothing in front, as far as depth tells */
    double z;      /* mean depth, scene units */
    double cosine; /* mean, of the rays' angle with the face's normal */
};

struct face_views {
    int id;
    struct face_view *views; /* best first: by clean pixels times cosine; owned */
    int count;
};

struct face_index {
    struct face_views *faces; /* in order of id; owned */
    int count;
};

/* Reads the lists of some faces. ids: ascending; NULL: of all faces. ST_DATA with file and line. */
enum status face_index_read(struct face_index *index, const char *path, const int *ids, int id_count, struct err *err);
const struct face_views *face_index_find(const struct face_index *index, int id); /* NULL: no view shows it */
void face_index_release(struct face_index *index);

/* The record of a view, O/ids/VIEW.txt: its faces in order of id. records[i].view is not used. */
struct face_record {
    int id;
    struct face_view seen;
};
enum status face_records_write(const struct face_record *records, int count, const char *path,
                               const struct provenance *prov, struct err *err);

/* Makes the index from the records of all views. */
enum status face_index_write(const char *folder, const char *const *views, int view_count, const char *path,
                             struct provenance *prov, struct err *err);

#endif
