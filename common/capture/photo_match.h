/* photo_match.h - finds the photograph that an image of a structure-from-motion model is. */
#ifndef REMODEL_PHOTO_MATCH_H
#define REMODEL_PHOTO_MATCH_H

#include "common/capture/photo_list.h"

/* Matches, in this order: the exact file name; the name after its last slash; the photo's id, with or without
 * extension; the file name of a view's middle exposure; the only file of the same name up to extensions.
 * Returns the index into the list; -1: none. */
int photo_list_match(const struct photo_list *photos, const char *name);

#endif
