/* contents_remodel.h - what the page of remodelled rooms shows: pictures of each edit, before and after. */
#ifndef REMODEL_CONTENTS_REMODEL_H
#define REMODEL_CONTENTS_REMODEL_H

#include "common/product/exports.h"
#include "common/texture/model_picture.h"
#include "stages/report/contents_relit.h"
#include "stages/report/page_pictures.h"

enum { SIGHTS_SHOWN = 4, SIGHT_SIDE_HEIGHT = 560 }; /* of an edit; px */

/* What an original view shows before and after an edit; all upright. */
struct edit_sight {
    char view[256], photo[256];
    double changed;            /* % of the view's pixels */
    double shares[MADE_COUNT]; /* %, of what pixels come from */
    struct picture before, after, sources;
};

struct edit_card {
    char name[256];
    char *about;                     /* the first comment of its script; "": none; owned */
    char *plan;                      /* file, owned; NULL: none */
    bool film;                       /* NAME/tour/video.mp4 exists */
    bool exports[EXPORT_COUNT];      /* the file in NAME/export exists */
    bool exported;                   /* any of them does */
    struct edit_sight *sights;       /* most that is new and known first, each of another photo; owned */
    int sight_count, changed, views; /* shown; views that the edit changes; views with a record: 0: no pictures yet */
    struct relit_card relit;         /* under the light that the edit makes */
};

struct remodel_contents {
    const char *quality; /* of the run, for commands that the page names; NULL: the default one */
    char *plan;          /* of the unedited model; owned; NULL: none */
    bool film;           /* ../model/tour/video.mp4 exists */
    struct edit_card *edits;
    int edit_count;
    char (*notes)[1024]; /* what could not be read */
    int note_count;
};

struct remodel_sources {
    const char *folder;  /* out/SCENE */
    const char *records; /* of the photos */
    const char *scripts; /* scenes/SCENE/edits; NULL: none */
    const char *quality; /* of the run; NULL: the default one */
};

/* c is empty on entry; the caller releases it in each case. A picture that cannot be read becomes a note. ST_NOMEM. */
enum status remodel_contents_read(struct remodel_contents *c, const struct remodel_sources *from, struct err *err);
void remodel_contents_release(struct remodel_contents *c);

#endif
