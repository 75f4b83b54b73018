/* photo_match.h - which photograph a name in a structure-from-motion model means. */
#ifndef REMODEL_PHOTO_MATCH_H
#define REMODEL_PHOTO_MATCH_H

#include "common/capture/photo_list.h"

/* By exact file name, else by the name behind its last slash, else by the photo's id with or without an extension, else
 * by the file name of a view's middle exposure. Index into the list; -1: none. */
int photo_list_match(const struct photo_list *photos, const char *name);

#endif
