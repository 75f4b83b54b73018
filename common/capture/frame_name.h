/* frame_name.h - the names of photos that are frames of a clip: CLIP_fN.png, N being the frame's number from 0, with
 * six digits or more. */
#ifndef REMODEL_FRAME_NAME_H
#define REMODEL_FRAME_NAME_H

#include <stddef.h>

/* The file name of a frame; the caller frees it. NULL: out of memory. clip: the clip's id. */
char *frame_name_make(const char *clip, int number);

/* Length of the clip's id in the name of a frame, with or without its extension; 0: it is not like that of a frame. */
size_t frame_name_clip(const char *name);

#endif
