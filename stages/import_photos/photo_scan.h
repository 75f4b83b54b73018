/* photo_scan.h - the photographs of a folder: their ids, what is left out, and which of them cannot be used.
 *
 * A photo is a file straight in the folder whose name ends as those of JPEG, PNG, TIFF, EXR or raw files do (any case)
 * and does not begin with a dot; a raw file beside a JPEG of the same name is none. An id is the name without that
 * ending, every run of characters but letters, digits, _ and - made one _; it does not begin with -. Where two photos
 * would share an id (or take one of the scene's own names) the ending is added to each, _jpg, and if that is taken -2,
 * -3 in order of file name. Ids depend on the set of names alone, photos that are left out included, so leaving one out
 * renames no other. */
#ifndef REMODEL_PHOTO_SCAN_H
#define REMODEL_PHOTO_SCAN_H

#include <stdbool.h>

#include "common/capture/photo_list.h"

struct scanned_photo {
    char *file, *id; /* owned */
    bool excluded;
    struct photo_record record; /* filled by photo_scan_check() */
    struct err err;             /* why it cannot be used */
};

struct photo_scan {
    char *folder;                 /* owned */
    struct scanned_photo *photos; /* in order of id (strcmp) */
    int count;
    bool cut;        /* the photos are pictures cut out of others, ID_cXrY.png; set by who knows */
    bool references; /* the photos are lighting reference images; set by the caller */
    int doubled;     /* raw files beside a JPEG of the same name */
    int ignored;     /* other files and folders in there; hidden ones, exposures.txt and split.txt are not counted */
};

/* ST_IO, ST_DATA: the folder is missing, no folder, or unreadable. No photo at all is no error yet. */
enum status photo_scan_folder(struct photo_scan *scan, const char *folder, struct err *err);

/* Leaves out the photos whose file name, id or name without its ending is `name`; how many these are. */
int photo_scan_exclude(struct photo_scan *scan, const char *name);

/* Every photo that is not left out: its record, taken from `records` or its folder `members` if the file has not
 * changed since, otherwise after decoding it to the last pixel. Photos that cannot be used have `err` set; they are no
 * error of this function. */
enum status photo_scan_check(struct photo_scan *scan, const char *records, struct err *err);
int photo_scan_bad(const struct photo_scan *scan);  /* how many these are */
int photo_scan_used(const struct photo_scan *scan); /* how many are not left out */
/* ST_DATA, naming them, if there are any. */
enum status photo_scan_refuse_bad(const struct photo_scan *scan, struct err *err);

/* Writes the records of the good photos and removes those of all others. ST_DATA: bad photos (each has its own
 * `err`). */
enum status photo_scan_write_records(const struct photo_scan *scan, const char *records, struct err *err);

/* The same, and then the list and photos.mk. ST_DATA also for fewer than two photos. */
enum status photo_scan_write(const struct photo_scan *scan, const char *records, struct err *err);

/* Removes the records in a folder but for those of the ids. */
enum status photo_scan_remove_others(const char *records, const char *const *ids, int count, struct err *err);

/* What ids are made of. */
enum { PHOTO_ID_MOST = 100 };        /* of 255 bytes in a file name: leaves room for @k, endings and a temporary name */
size_t photo_stem(const char *file); /* length of the name without its ending; 0 if that is no photo's */
bool photo_id_reserved(const char *id); /* a name of the scene's own: list, brackets */
void photo_id_from_stem(char id[PHOTO_ID_MOST + 1], const char *stem, size_t length);

void photo_scan_release(struct photo_scan *scan);

#endif
