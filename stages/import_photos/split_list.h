/* split_list.h - split.txt: the pictures that were cut out of each photograph.
 *
 *   remodel-split 1
 *   grid COLUMNS ROWS BORDER GAP DARK           [import_photos] split_*
 *   photo "IMG 1.jpg" HASH WIDTH HEIGHT         file in the folder PHOTOS, hash of its bytes; size of its pictures
 *   cut IMG_1_c1r1.png HASH X Y                 COLUMNS x ROWS lines after each photo, row by row: file beside this
 *                                               one, its hash, its first column and row in the photo as stored */
#ifndef REMODEL_SPLIT_LIST_H
#define REMODEL_SPLIT_LIST_H

#include "common/base/hash.h"
#include "stages/import_photos/split_grid.h"

struct split_cut {
    char *file; /* owned */
    char hash[HASH_TEXT];
    int x, y;
};

struct split_photo {
    char *file; /* owned */
    char hash[HASH_TEXT];
    int width, height;      /* of each cut */
    struct split_cut *cuts; /* columns x rows; owned */
    int count;
};

struct split_list {
    struct split_grid grid;
    struct split_photo *photos;
    int count;
};

/* {0} is the empty list. ST_DATA with file and line. */
enum status split_list_read(struct split_list *list, const char *path, struct err *err);
enum status split_list_write(const struct split_list *list, const char *path, struct err *err);
void split_photo_release(struct split_photo *p);
void split_list_release(struct split_list *list);

#endif
