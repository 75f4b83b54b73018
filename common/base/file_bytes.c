/* file_bytes.c - reads a whole file. */
#include "common/base/file_bytes.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

static enum status read_all(struct file_bytes *f, FILE *fp, const char *path, struct err *err)
{
    struct stat info;
    size_t room = 1 << 16, n;

    /* one byte more than the file's size, so that fread() meets the end without growing the buffer */
    if (!fstat(fileno(fp), &info) && S_ISREG(info.st_mode) && info.st_size > 0) room = (size_t)info.st_size + 1;
    for (;;) {
        char *grown = realloc(f->bytes, room + 1); /* one more for the final NUL */
        if (!grown) {
            err_nomem(err, "a file", room + 1);
            return err_context(err, "%s", path);
        }
        f->bytes = grown;
        while (f->size < room && (n = fread(f->bytes + f->size, 1, room - f->size, fp)) > 0) f->size += n;
        if (ferror(fp)) return err_errno(err, "read", path);
        if (f->size < room) break;
        room *= 2;
    }
    f->bytes[f->size] = '\0';
    return ST_OK;
}

enum status file_bytes_read(struct file_bytes *f, const char *path, struct err *err)
{
    FILE *fp = fopen(path, "rbe");

    *f = (struct file_bytes){0};
    if (!fp) return err_errno(err, "open", path);
    read_all(f, fp, path, err);
    fclose(fp);
    if (err->status) file_bytes_release(f);
    return err->status;
}

void file_bytes_release(struct file_bytes *f)
{
    if (!f) return;
    free(f->bytes);
    *f = (struct file_bytes){0};
}
