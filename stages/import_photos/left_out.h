/* left_out.h - files in a folder of photographs that are not used, with the reason. */
#ifndef REMODEL_LEFT_OUT_H
#define REMODEL_LEFT_OUT_H

#include <stdbool.h>

#include "common/base/err.h"

enum left_reason {
    LEFT_FOLDER,  /* a folder with photos in it */
    LEFT_VIDEO,   /* by its name, but of a kind that is not read */
    LEFT_CLIP,    /* a video where clips are not used */
    LEFT_LIVE,    /* a clip beside a photo of the same name */
    LEFT_ARCHIVE, /* by its name */
    LEFT_PICTURE, /* GIF, BMP and others, by their names */
    LEFT_DOUBLE,  /* a raw file, HEIC or AVIF beside a JPEG of the same name */
    LEFT_SAME,    /* the same bytes as another photo */
    LEFT_BACKUP,  /* a photo's content under the name of a backup, a thumbnail or an unfinished download */
    LEFT_HIDDEN,  /* a photo's name that begins with a dot */
    LEFT_OTHER,   /* no picture: texts, folders without photos */
    LEFT_REASONS,
};

struct left_file {
    char *file; /* owned */
    enum left_reason reason;
};

struct left_out {
    struct left_file *files; /* in order of reason, then of name */
    int count;
};

enum status left_out_add(struct left_out *l, const char *file, enum left_reason reason, struct err *err);
void left_out_sort(struct left_out *l);
/* LEFT_VIDEO, LEFT_ARCHIVE, LEFT_PICTURE or LEFT_OTHER. */
enum left_reason left_out_reason(const char *file);
/* Whether a video of this name is one that people film: no preview, and none of a camera that sees all around. */
bool left_out_is_film(const char *file);
bool left_out_is_backup(const char *file);
/* A line for each reason: the names, why they are not used, and what to do. What is likely a mistake is a warning. */
void left_out_report(const struct left_out *l, const char *folder);
void left_out_release(struct left_out *l);

#endif
