/* contents_relit.h - what the pages show of the light that an edit makes (docs/formats.md, O/relight/E). */
#ifndef REMODEL_CONTENTS_RELIT_H
#define REMODEL_CONTENTS_RELIT_H

#include "common/capture/lens_list.h"
#include "stages/report/page_pictures.h"

enum { RELIT_SIDE_HEIGHT = 360 }; /* px */

/* What an original view shows; all pictures are upright. */
struct relit_sight {
    char view[256], photo[256];
    double changed, bounded, kept; /* % of the pixels: other light; of them, bounded; light that was left alone */
    struct picture before, unlit, relit, ratio;
    struct picture truth; /* empty: none */
};

struct relit_card {
    char name[256];
    struct relit_sight *sights; /* most that changed and is sure first, each of another photo; owned */
    int sight_count, views;     /* shown; with a record */
    int rounds;                 /* of light from face to face; 0: unknown */
    bool settled;
    double missing;      /* part of a place's light that later rounds may add, at most; -1: unknown */
    char (*notes)[1024]; /* what could not be read; owned */
    int note_count;
};

struct relit_sources {
    const char *folder;  /* out/SCENE */
    const char *records; /* of the photos */
    const struct lens_list *lenses;
};

/* VIEW.txt of a relit view. */
struct relit_record {
    double exposure, changed, bounded, kept; /* %, as above */
};
enum status relit_record_read(struct relit_record *r, const char *path, struct err *err);

/* At most `most` views of FOLDER/relight/EDIT. views is 0 if there are none. card is empty on entry; the caller
 * releases it in each case. What cannot be read becomes a note. ST_NOMEM. */
enum status relit_card_read(struct relit_card *card, const struct relit_sources *from, const char *edit, int most,
                            struct err *err);
/* The rounds of light alone. */
enum status relit_rounds_read(struct relit_card *card, const struct relit_sources *from, const char *edit,
                              struct err *err);
void relit_card_release(struct relit_card *card);

/* EXIF's orientation of a photo, 1 if its record cannot be read. */
int relit_photo_orientation(const char *records, const char *photo);

/* A product below the scene's folder, a JPEG or PNG, turned and shrunk. ST_IO, ST_DATA. */
enum status relit_read_picture(struct picture *p, const char *folder, enum product_id id, const struct product_key *key,
                               int orientation, int height, struct err *err);
/* The same of radiance, times the exposure. */
enum status relit_read_radiance(struct picture *p, const char *folder, enum product_id id,
                                const struct product_key *key, double exposure, int orientation, int height,
                                struct err *err);

#endif
