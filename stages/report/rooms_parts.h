/* rooms_parts.h - what is known of the changes while rooms are read: contents_rooms.c reads it, rooms_choice.c chooses
 * the photos, rooms_pictures.c makes their pictures. */
#ifndef REMODEL_ROOMS_PARTS_H
#define REMODEL_ROOMS_PARTS_H

#include "common/capture/camera_set.h"
#include "common/capture/lens_list.h"
#include "common/texture/picture_record.h"
#include "stages/report/contents_relit.h"
#include "stages/report/contents_rooms.h"

struct view_change { /* of a view after a change */
    bool drawn, lit;
    bool unlit;                 /* drawn by relight alone, among its own pictures */
    struct picture_record file; /* of drawn */
    struct relit_record light;  /* of lit */
};

struct source_photo {
    char photo[256];
    const struct lens *lenses; /* of its views, which follow each other */
    int first, count;          /* of the list of lenses */
    bool chosen;
};

struct rooms_reading {
    struct rooms *rooms;
    const struct rooms_sources *from;
    struct lens_list lenses;
    struct view *views; /* the cameras of the lenses' views; owned */
    struct camera_set cameras;
    struct source_photo *photos; /* owned */
    int photo_count;
    double spread;             /* the median distance of two photos */
    struct view_change *table; /* change_count rows of lenses.count; owned */
};

/* A note of what could not be read; only ST_NOMEM is an error. */
enum status rooms_note(struct rooms *rooms, const char *what, const struct err *problem, struct err *err);

struct view_change *rooms_change_of(const struct rooms_reading *r, int change, int lens);

void rooms_look_release(struct room_look *look);

/* Fills rooms->photos, without pictures, and counts the photos that changes alter. ST_NOMEM. */
enum status rooms_choose(struct rooms_reading *r, struct err *err);

/* Fills in the pictures. Photos and changes whose pictures cannot be read go, with a note. ST_NOMEM. */
enum status rooms_make_pictures(struct rooms_reading *r, struct err *err);

#endif
