/* rendered_frame.c - see rendered_frame.h. */
#include "common/layers/rendered_frame.h"

#include <stdlib.h>

void rendered_frame_release(struct rendered_frame *frame)
{
    if (!frame) return;
    free(frame->rgba);
    free(frame->z);
    free(frame->hole);
    *frame = (struct rendered_frame){0};
}

enum status rendered_frame_resize(struct rendered_frame *f, int width, int height, bool color, struct err *err)
{
    const size_t pixels = (size_t)width * (size_t)height;
    if (f->width != width || f->height != height || !f->hole || color != (f->rgba != NULL)) {
        rendered_frame_release(f);
        f->hole = malloc(pixels);
        if (color) {
            f->rgba = malloc(pixels * 4 * sizeof *f->rgba);
            f->z = malloc(pixels * sizeof *f->z);
        }
        if (!f->hole || (color && (!f->rgba || !f->z))) {
            rendered_frame_release(f);
            return err_nomem(err, "a frame", pixels * (color ? 21 : 1));
        }
        f->width = width;
        f->height = height;
    }
    f->hole_fraction = f->unfilled_fraction = 0;
    return ST_OK;
}
