/* contents_remodel.h - what the page of remodelled rooms shows: pictures before and after, plans, films, files. */
#ifndef REMODEL_CONTENTS_REMODEL_H
#define REMODEL_CONTENTS_REMODEL_H

#include "common/product/exports.h"
#include "stages/report/contents_relit.h"
#include "stages/report/contents_rooms.h"

struct edit_card {
    char *plan;                 /* file, owned; NULL: none */
    bool film;                  /* NAME/tour/video.mp4 exists */
    bool exports[EXPORT_COUNT]; /* the file in NAME/export exists */
    bool exported;              /* any of them does */
    struct relit_card relit;    /* how sure the light is that it makes; without pictures */
};

struct remodel_contents {
    const char *quality;     /* of the run, for commands that the page names; NULL: the default one */
    char *plan;              /* file of the unedited model's plan, owned; NULL: none */
    bool film;               /* ../model/tour/video.mp4 exists */
    struct rooms rooms;      /* its changes are the edits */
    struct edit_card *edits; /* rooms.change_count; owned */
};

struct remodel_sources {
    struct rooms_sources rooms;
    const char *quality; /* of the run; NULL: the default one */
};

/* c is empty on entry; the caller releases it in each case. A picture that cannot be read becomes a note. ST_NOMEM. */
enum status remodel_contents_read(struct remodel_contents *c, const struct remodel_sources *from, struct err *err);
void remodel_contents_release(struct remodel_contents *c);

#endif
