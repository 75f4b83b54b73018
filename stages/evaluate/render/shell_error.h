/* shell_error.h - errors of the textures of a room without its furniture, apart for what the furniture hides in the
 * truth's own picture and what it does not.
 *
 * A pixel is hidden if the shell's true id there differs from the ordinary one, else seen. Its error is
 * |Y - Y_true| / Y_true of luminance; pixels of the outdoors (id 0) or without true light do not count. */
#ifndef REMODEL_SHELL_ERROR_H
#define REMODEL_SHELL_ERROR_H

#include "stages/evaluate/measure/radiance_error.h"

#define MIN_FACE_PIXELS 50 /* of a face, hidden or seen, for a median of its own */

enum { SHELL_SEEN, SHELL_HIDDEN, SHELL_PARTS };

struct shell_samples { /* errors of a face's pixels */
    float *errors;     /* owned */
    size_t count, capacity;
};

struct shell_error {
    struct radiance_error all[SHELL_PARTS];
    struct shell_samples (*faces)[SHELL_PARTS]; /* by id; owned */
    int face_count;
};

enum status shell_error_init(struct shell_error *e, struct err *err);

struct shell_pixels {
    struct radiance_pixels radiance; /* of the picture; its mask is not used */
    const uint32_t *shell, *whole;   /* true ids without and with furniture */
};
enum status shell_error_add(struct shell_error *e, const struct shell_pixels *p, struct err *err);

/* The median error of a face; false: it has fewer than MIN_FACE_PIXELS pixels. Sorts the face's errors. */
bool shell_face_median(struct shell_error *e, int face, int part, double *middle);
void shell_error_release(struct shell_error *e);

#endif
