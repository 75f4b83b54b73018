/* contents_rooms.h - photographs of the rooms before and after each change, in the old light and in the new one.
 *
 * One picture for each photo, as people took it, put together from its views (whole_photo.h); all of one exposure, so
 * that they can lie over each other. */
#ifndef REMODEL_CONTENTS_ROOMS_H
#define REMODEL_CONTENTS_ROOMS_H

#include "common/texture/model_picture.h"
#include "stages/report/page_pictures.h"

enum { ROOMS_SHOWN = 18 }; /* photographs, at most */

/* A photo after a change. Pictures are upright; each may be empty but for after and relit, of which there is one. */
struct room_look {
    int change;                  /* of the list of changes */
    struct picture after, relit; /* in the light of the day, in the light that the change makes */
    struct picture made, ratio;  /* where the parts of `after` come from; how the light changes */
    double changed;              /* % of the photo that the change alters */
    double shares[MADE_COUNT];   /* %, of what pixels come from */
    double light, bounded, kept; /* % of the photo: other light; of it, bounded; light that was left alone */
};

struct room_photo {
    char photo[256];
    struct picture before;
    struct room_look *looks; /* what changes most first; owned */
    int look_count;
};

struct room_change {
    char name[256];
    char *about;      /* the first comment of its script; "": none; owned */
    bool has_records; /* somebody drew it, or lit it */
    int photos;       /* that it changes, shown or not */
};

struct rooms {
    struct room_change *changes; /* in order of name; owned */
    int change_count;
    struct room_photo *photos;       /* owned */
    int photo_count, photos_changed; /* shown; changed in all */
    char (*notes)[1024];             /* what could not be read; owned */
    int note_count;
};

struct rooms_sources {
    const char *folder;  /* out/SCENE */
    const char *shared;  /* the folder of photo records and SfM */
    const char *photos;  /* the folder of the photographs; NULL: unknown */
    const char *scripts; /* scenes/SCENE/edits; NULL: none */
};

/* rooms is empty on entry; the caller releases it in each case. Changes are the folders of FOLDER/remodel that have a
 * model. What cannot be read becomes a note. ST_NOMEM. */
enum status rooms_read(struct rooms *rooms, const struct rooms_sources *from, struct err *err);
void rooms_release(struct rooms *rooms);

#endif
