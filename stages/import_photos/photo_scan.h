/* photo_scan.h - the photographs of a folder: their ids, which are excluded, and which cannot be used.
 *
 * A photo is a file in the folder itself that holds one (photo_kind.h), whatever its name, unless that begins with a
 * dot or is that of a backup; or one that has a photo's name. Raw files and HEIC beside a JPEG of the same name are
 * left out. An id is the name without the extension, with every run of characters other than letters, digits, _ and -
 * replaced by one _; it does not begin with -. If photos would share an id, or have a reserved one, the extension is
 * added to each, as _jpg, and if that is taken -2, -3 in order of file name. Ids depend only on the set of names,
 * including those of excluded photos, so excluding one renames no other. */
#ifndef REMODEL_PHOTO_SCAN_H
#define REMODEL_PHOTO_SCAN_H

#include <stdbool.h>

#include "common/capture/photo_id.h"
#include "common/capture/photo_list.h"
#include "common/image/photo_kind.h"
#include "stages/import_photos/left_out.h"

struct scanned_photo {
    char *file, *id; /* owned */
    enum photo_kind kind;
    bool excluded;
    bool panorama;              /* it becomes several views (panorama.h) */
    struct photo_record record; /* filled by photo_scan_check() */
    double transparent;         /* share of its pixels; this and pages only if it is new */
    int pages;                  /* of a TIFF that has several; else 0 */
    struct err err;             /* the reason if it cannot be used */
};

struct scanned_clip {
    char *path, *id; /* owned; the id is the name without the extension, as that of photos */
    bool excluded;
    struct err err; /* the reason if it cannot be used */
};

struct photo_scan {
    char *folder;                 /* owned; NULL: clips that were given one by one */
    struct scanned_photo *photos; /* in order of id (strcmp) */
    int count;
    bool cut;        /* the photos are pictures cut out of others, ID_cXrY.png; set by the caller */
    bool references; /* the photos are lighting reference images; set by the caller */
    bool single;     /* one photo is enough: its depth is known; set by the caller */
    bool gain_maps;  /* gain maps are applied; set by the caller */
    struct left_out left;
    struct scanned_clip *clips; /* in order of file name */
    int clip_count;
};

/* ST_IO, ST_DATA: the folder is missing, not a folder, or unreadable. A folder without photos is not an error here. */
enum status photo_scan_folder(struct photo_scan *scan, const char *folder, struct err *err);

/* The same of clips in place of a folder. ST_IO, ST_DATA: one is missing or does not contain a video. */
enum status photo_scan_clips(struct photo_scan *scan, const char *const *paths, int count, struct err *err);

/* Excludes the photos and clips whose file name, with or without extension, or id is `name`. Returns their number. */
int photo_scan_exclude(struct photo_scan *scan, const char *name);

/* Fills the records of all photos that are not excluded: from `records` or its folder `members` if the file has not
 * changed, otherwise by decoding all its pixels. Photos that cannot be used have `err` set, which is not an error of
 * this function. */
enum status photo_scan_check(struct photo_scan *scan, const char *records, struct err *err);

/* Excludes photos with the same bytes as another one, and lists them as left out. Sets *dropped if there were such.
 * ST_NOMEM. */
enum status photo_scan_drop_same(struct photo_scan *scan, bool *dropped, struct err *err);
int photo_scan_bad(const struct photo_scan *scan);  /* number of unusable photos */
int photo_scan_used(const struct photo_scan *scan); /* number of photos that are not excluded */
/* ST_DATA, naming them, if there are unusable photos. */
enum status photo_scan_refuse_bad(const struct photo_scan *scan, struct err *err);

/* Writes the records of the usable photos and removes all others. ST_DATA: some photos are unusable (each has its own
 * `err`). */
enum status photo_scan_write_records(const struct photo_scan *scan, const char *records, struct err *err);

/* The same, then the list and photos.mk. ST_DATA also for fewer than two photos, or none if one is enough. */
enum status photo_scan_write(const struct photo_scan *scan, const char *records, struct err *err);

/* Removes all records in a folder except those of the ids. */
enum status photo_scan_remove_others(const char *records, const char *const *ids, int count, struct err *err);

size_t photo_stem(const char *file);    /* length of the name without its extension */
bool photo_id_reserved(const char *id); /* other files beside those named by ids: list, brackets, index, offsets */

void photo_scan_release(struct photo_scan *scan);

#endif
