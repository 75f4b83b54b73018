/* clip_list.h - frames.txt: the frames that were taken from each clip.
 *
 *   remodel-frames 1
 *   rule FRAMES                                 [import_photos] frames
 *   clip "MOV 1.mov" ID HASH WIDTH HEIGHT COUNT the file's name and id, hash of its bytes; size of its frames
 *   frame ID_f000012.png HASH NUMBER SECONDS SHARPNESS PARALLAX OVERLAP
 *                                               COUNT lines after each clip: file beside this one, its hash; its number
 *                                               in the clip from 0, its time since the clip began; frame_choice.h */
#ifndef REMODEL_CLIP_LIST_H
#define REMODEL_CLIP_LIST_H

#include "common/base/hash.h"
#include "stages/import_photos/frame_choice.h"

struct clip_picture {
    char *file; /* owned */
    char hash[HASH_TEXT];
    struct chosen_frame frame;
};

struct clip {
    char *file, *id; /* owned */
    char hash[HASH_TEXT];
    int width, height;
    struct clip_picture *pictures; /* in order; owned */
    int count;
};

struct clip_list {
    int most; /* [import_photos] frames */
    struct clip *clips;
    int count;
};

/* {0} is the empty list. ST_DATA with file and line. */
enum status clip_list_read(struct clip_list *list, const char *path, struct err *err);
/* Rewrites the file only if its text changes. */
enum status clip_list_write(const struct clip_list *list, const char *path, struct err *err);
void clip_release(struct clip *c);
void clip_list_release(struct clip_list *list);

#endif
