/* exr_file.h - what exr_read.c and exr_write.c share: limits, OpenEXRCore's errors, faults of chunks. */
#ifndef REMODEL_EXR_FILE_H
#define REMODEL_EXR_FILE_H

#include <openexr.h>

#include "common/image/exr.h"

#define EXR_MAX_PIXELS (INT64_C(1) << 28)

enum { EXR_PROVENANCE_COUNT = 4 };
extern const char
    *const exr_provenance_names[EXR_PROVENANCE_COUNT]; /* attributes: stage, version, parameters, inputs */

/* Defaults for a new OpenEXRCore context that records the library's first error message of the calling thread. */
exr_context_initializer_t exr_library_init(void);
/* How many allocations the library was refused so far. It may leave out an attribute then and still succeed. */
int exr_library_refused(void);

/* "cannot VERB PATH: REASON.", with the recorded message or, without one, the text of `code`. Returns ST_NOMEM if the
 * library is out of memory, otherwise `status`. */
enum status exr_library_error(struct err *err, enum status status, const char *verb, const char *path,
                              exr_result_t code);

/* What failed in a chunk. Kept per chunk, so that the first one in the file is reported for any number of threads. */
struct exr_chunk_fault {
    exr_result_t code; /* 0: no fault */
    int plane, x, y;   /* plane >= 0: its sample at (x, y) is not finite */
};

/* Reports the first fault; `advice` ends the error. ST_OK if there is none. */
enum status exr_first_fault(struct err *err, const char *verb, const char *path, const char *advice,
                            const struct exr_image *im, const struct exr_chunk_fault *faults, size_t chunks);

#endif
