/* photo_list.h - the photographs of a scene as `import_photos` recorded them: out/SCENE/photos/.
 *
 * list.txt, a line a photo in order of id: ID "FILE" - rewritten only when the set changes. ID.txt, a record a photo,
 * rewritten only when that photo's content changes:
 *   remodel-photo 1
 *   file "IMG 1.jpg"            as the folder PHOTOS names it
 *   hash 0123...                of its bytes (common/base/hash.h)
 *   size WIDTH HEIGHT
 *   bits 8                      a sample; 32: linear light (EXR, raw files), which hdr_merge makes a picture of
 *   orientation 1               EXIF, 1..8
 *   exif FOCAL_MM FOCAL35_MM SECONDS F_NUMBER ISO     0: not stated
 *   camera "MAKE" "MODEL"
 * The record of a view that was photographed in several exposures describes the middle one. Its file is ID.jpg, which
 * hdr_merge makes (out/SCENE/hdr); the hash is that of the photo in the folder PHOTOS. These lines follow:
 *   brackets COUNT MIDDLE WHITE       MIDDLE from 0; WHITE: the exposure that makes 1 in hdr/ID.exr white
 *   bracket "IMG 1.jpg" HASH EXPOSURE COUNT lines, from the shortest exposure on
 * An id is safe for Make, shells and file systems: letters, digits, _ and -, not - first; unique in the scene; the same
 * for the same set of file names. photos.mk holds the ids for Make. */
#ifndef REMODEL_PHOTO_LIST_H
#define REMODEL_PHOTO_LIST_H

#include "common/base/hash.h"
#include "common/image/photo.h"

struct bracket {
    char *file; /* in the folder PHOTOS; owned */
    char hash[HASH_TEXT];
    double exposure; /* stages/import_photos/exposure_list.h */
};

struct photo_record {
    char *id, *file; /* owned */
    char hash[HASH_TEXT];
    struct photo_info info;
    struct bracket *brackets; /* ascending in exposure; owned */
    int bracket_count;        /* 0: an ordinary photo */
    int middle;               /* index of the one that info and hash are of */
    double white;
};

struct photo_list {
    struct photo_record *photos; /* in order of id (strcmp) */
    int count;
};

/* list.txt and every record it names. folder: out/SCENE/photos. */
enum status photo_list_read(struct photo_list *list, const char *folder, struct err *err);
enum status photo_record_read(struct photo_record *r, const char *folder, const char *id, struct err *err);
/* Only if its text is new, so that its time tells Make when the photo last changed. */
enum status photo_record_write(const struct photo_record *r, const char *folder, struct err *err);
/* list.txt and photos.mk (PHOTO_IDS := the ids), each only if its text is new. If the photos are views of several
 * exposures photos.mk also says BRACKETED := yes, and brackets.txt tells which photos are a view's. */
enum status photo_list_write(const struct photo_list *list, const char *folder, struct err *err);
int photo_list_find_id(const struct photo_list *list, const char *id);     /* -1: not there */
int photo_list_find_file(const struct photo_list *list, const char *file); /* -1: not there */
void photo_record_release(struct photo_record *r);
void photo_list_release(struct photo_list *list);

#endif
