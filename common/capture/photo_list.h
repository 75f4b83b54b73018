/* photo_list.h - the photographs of a scene as recorded by `import_photos`: out/SCENE/photos/.
 *
 * list.txt has one line ID "FILE" per photo in order of id, and is rewritten only if the set changes. ID.txt is the
 * record of a photo, rewritten only if that photo's content changes:
 *   remodel-photo 2
 *   file "IMG 1.jpg"            in the folder PHOTOS
 *   hash 0123...                of its bytes (common/base/hash.h)
 *   size WIDTH HEIGHT
 *   bits 8                      per sample; 32: linear light (EXR, raw files, gain maps), of which hdr_merge makes a
 *                               picture
 *   orientation 1               EXIF, 1..8
 *   exif FOCAL_MM FOCAL35_MM SECONDS F_NUMBER ISO     0: unknown
 *   camera "MAKE" "MODEL"
 *   taken 1714564922.35         seconds since 1970 by the camera's clock; 0: unknown
 * The record of a view with several exposures describes the middle one. Its file is ID.jpg, made by hdr_merge
 * (out/SCENE/hdr); the hash is that of the middle photo in the folder PHOTOS. These lines follow:
 *   brackets COUNT MIDDLE WHITE       MIDDLE from 0; WHITE: the exposure at which 1 in hdr/ID.exr is white
 *   bracket "IMG 1.jpg" HASH EXPOSURE COUNT lines, shortest exposure first; some may be equal
 * An id is safe for Make, shells and file systems: letters, digits, _ and -, not - first. It is unique in the scene and
 * depends only on the set of file names. photos.mk has the ids for Make. */
#ifndef REMODEL_PHOTO_LIST_H
#define REMODEL_PHOTO_LIST_H

#include "common/base/provenance.h"
#include "common/image/photo.h"

struct bracket {
    char *file; /* in the folder PHOTOS; owned */
    char hash[HASH_TEXT];
    double exposure; /* seconds x ISO / (f-number^2 x filter) */
};

struct photo_record {
    char *id, *file; /* owned */
    char hash[HASH_TEXT];
    struct photo_info info;
    struct bracket *brackets; /* ascending in exposure; owned */
    int bracket_count;        /* 0: an ordinary photo */
    int middle;               /* index of the bracket that info and hash describe */
    double white;
};

struct photo_list {
    struct photo_record *photos; /* in order of id (strcmp) */
    int count;
};

/* Reads list.txt and the records of its photos. folder: out/SCENE/photos. */
enum status photo_list_read(struct photo_list *list, const char *folder, struct err *err);
enum status photo_record_read(struct photo_record *r, const char *folder, const char *id, struct provenance *prov,
                              struct err *err);
/* Writes the record only if its text changes, so that Make sees when the photo changed. */
enum status photo_record_write(const struct photo_record *r, const char *folder, struct err *err);
/* Writes list.txt and photos.mk (PHOTO_IDS := the ids), each only if its text changes. For views of several exposures
 * photos.mk also has BRACKETED := yes, and brackets.txt lists the photos of each view. */
enum status photo_list_write(const struct photo_list *list, const char *folder, struct err *err);
int photo_list_find_id(const struct photo_list *list, const char *id);     /* -1: not found */
int photo_list_find_file(const struct photo_list *list, const char *file); /* -1: not found */
void photo_record_release(struct photo_record *r);
void photo_list_release(struct photo_list *list);

#endif
