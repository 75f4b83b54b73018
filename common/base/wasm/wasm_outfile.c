/* wasm_outfile.c - output files in the memory of a page: written in place, as nothing else reads them meanwhile. The
 * build of a WebAssembly module takes this file in place of common/base/outfile.c. */
#include "common/base/outfile.h"

#include <stdlib.h>
#include <string.h>

enum status outfile_open(struct outfile *f, const char *path, struct err *err)
{
    *f = (struct outfile){.fp = fopen(path, "wb"), .path = strdup(path)};
    if (f->fp && f->path) return ST_OK;
    if (f->fp) fclose(f->fp);
    free(f->path);
    *f = (struct outfile){0};
    return err_errno(err, "write", path);
}

enum status outfile_commit(struct outfile *f, struct err *err)
{
    const int failed = ferror(f->fp), unwritten = fclose(f->fp);
    f->fp = NULL;
    if (failed || unwritten) err_set(err, ST_IO, "cannot write %s: a write failed.", f->path);
    outfile_discard(f);
    return err->status;
}

void outfile_discard(struct outfile *f)
{
    if (!f) return;
    if (f->fp) fclose(f->fp);
    free(f->path);
    *f = (struct outfile){0};
}
