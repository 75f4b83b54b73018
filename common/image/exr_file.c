/* exr_file.c - errors of reading and writing OpenEXR files. */
#include "common/image/exr_file.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const exr_provenance_names[EXR_PROVENANCE_COUNT] = {"remodel:stage", "remodel:version",
                                                                "remodel:parameters", "remodel:inputs"};

/* The library reports an error to the thread that met it; the first message of a call is the most precise one. */
static _Thread_local char library_message[512];

static void keep_message(exr_const_context_t ctxt, exr_result_t code, const char *message)
{
    (void)ctxt, (void)code;
    if (!library_message[0]) snprintf(library_message, sizeof library_message, "%s", message);
}

static atomic_int refused;

static void *take(size_t size)
{
    void *p = malloc(size);
    if (!p) atomic_fetch_add(&refused, 1);
    return p;
}

int exr_library_refused(void) { return atomic_load(&refused); }

exr_context_initializer_t exr_library_init(void)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = keep_message;
    init.alloc_fn = take;
    init.free_fn = free;
    library_message[0] = 0;
    return init;
}

enum status exr_library_error(struct err *err, enum status status, const char *verb, const char *path,
                              exr_result_t code)
{
    const char *why = library_message[0] ? library_message : exr_get_default_error_message(code);
    size_t length = strlen(why);
    while (length && strchr(".\n ", why[length - 1])) length--;
    if (code == EXR_ERR_OUT_OF_MEMORY) status = ST_NOMEM;
    return err_set(err, status, "cannot %s %s: %.*s%s.", verb, path, (int)length, why,
                   status == ST_DATA ? "; the file is damaged or not OpenEXR: make it again" : "");
}

enum status exr_first_fault(struct err *err, const char *verb, const char *path, const char *advice,
                            const struct exr_image *im, const struct exr_chunk_fault *faults, size_t chunks)
{
    for (size_t i = 0; i < chunks; i++) {
        const struct exr_chunk_fault *f = &faults[i];
        if (!f->code) continue;
        if (f->plane >= 0)
            return err_set(
                err, ST_DATA,
                "cannot %s %s: channel %s holds NaN or infinity at pixel (%d, %d); every sample must be finite.", verb,
                path, im->planes[f->plane].name, f->x, f->y);
        if (f->code == EXR_ERR_OUT_OF_MEMORY)
            return err_set(err, ST_NOMEM, "cannot %s %s: not enough memory for a chunk.", verb, path);
        return err_set(err, ST_DATA, "cannot %s %s: chunk %zu of %zu failed (%s)%s.", verb, path, i + 1, chunks,
                       exr_get_default_error_message(f->code), advice);
    }
    return ST_OK;
}
