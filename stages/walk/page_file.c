/* page_file.c - see page_file.h. */
#include "stages/walk/page_file.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/file_bytes.h"
#include "common/base/textfile.h"
#include "common/product/product.h"

/* The file that a line asks for, between `before` and `after`; false: it asks for none. */
static bool find_name(char name[FILE_PATH], const char *line, size_t length, const char *before, const char *after)
{
    const size_t n = strlen(before), m = strlen(after);
    if (length <= n + m || length - n - m >= FILE_PATH || strncmp(line, before, n) != 0 ||
        strncmp(line + length - m, after, m) != 0)
        return false;
    memcpy(name, line + n, length - n - m);
    name[length - n - m] = '\0';
    return true;
}

static enum status write_inside(FILE *to, const char *tag, const char *folder, const char *name, struct err *err)
{
    char path[FILE_PATH];
    struct file_bytes file = {0};
    if (file_path(path, folder, name, "", err) || file_bytes_read(&file, path, err)) return err->status;
    fprintf(to, "<%s>\n", tag);
    fwrite(file.bytes, 1, file.size, to);
    fprintf(to, "</%s>\n", tag);
    file_bytes_release(&file);
    return ST_OK;
}

static void write_line(FILE *to, const char *line, size_t length, const char *name)
{
    static const char mark[] = "@NAME@";
    const char *at = memmem(line, length, mark, sizeof mark - 1);
    if (at) {
        const size_t before = (size_t)(at - line);
        fwrite(line, 1, before, to);
        fputs(name, to);
        line = at + sizeof mark - 1;
        length -= before + sizeof mark - 1;
    }
    fwrite(line, 1, length, to);
    putc('\n', to);
}

enum status page_file_write(const char *folder, const char *out, const char *name, int64_t *bytes, struct err *err)
{
    char path[FILE_PATH], to[FILE_PATH], part[FILE_PATH];
    struct textfile t = {0};
    struct outfile f = {0};
    const char *line;
    size_t length;
    if (file_path(path, folder, "index.html", "", err) || product_path_in(to, out, PRODUCT_WALK_PAGE, NULL, err) ||
        textfile_open(&t, path, err))
        return err->status;
    outfile_open(&f, to, err);
    while (!err->status && (line = textfile_peek(&t, &length))) {
        if (find_name(part, line, length, "<script src=\"", "\"></script>"))
            write_inside(f.fp, "script", folder, part, err);
        else if (find_name(part, line, length, "<link rel=\"stylesheet\" href=\"", "\">"))
            write_inside(f.fp, "style", folder, part, err);
        else
            write_line(f.fp, line, length, name);
        textfile_next_raw(&t);
    }
    if (!err->status) {
        *bytes += ftell(f.fp);
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    textfile_release(&t);
    return err->status;
}
