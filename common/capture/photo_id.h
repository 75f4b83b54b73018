/* photo_id.h - the id of a photo: its file's name without extension, of letters, digits, _ and - alone. */
#ifndef REMODEL_PHOTO_ID_H
#define REMODEL_PHOTO_ID_H

#include <stddef.h>

enum { MAX_PHOTO_ID = 100 }; /* file names may have 255 bytes: leaves room for @k, extensions, temporary names */

/* Replaces other characters by _, several in a row by a single one. Two names can get the same id: the import of photos
 * then makes them different. */
void photo_id_from_stem(char id[MAX_PHOTO_ID + 1], const char *stem, size_t length);

#endif
