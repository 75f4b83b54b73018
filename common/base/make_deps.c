/* make_deps.c - see make_deps.h. */
#include "common/base/make_deps.h"

#include "common/base/outfile.h"

static void print_escaped(FILE *to, const char *path)
{
    for (; *path; path++) {
        if (*path == ' ' || *path == '#' || *path == '\\') fputc('\\', to);
        if (*path == '$') fputc('$', to);
        fputc(*path, to);
    }
}

enum status make_deps_write(const char *path, const char *target, const char *const *files, int count, struct err *err)
{
    struct outfile file = {0};
    if (!outfile_open(&file, path, err)) {
        print_escaped(file.fp, target);
        fputc(':', file.fp);
        for (int i = 0; i < count; i++) {
            fputc(' ', file.fp);
            print_escaped(file.fp, files[i]);
        }
        fputc('\n', file.fp);
        for (int i = 0; i < count; i++) {
            print_escaped(file.fp, files[i]);
            fputs(":\n", file.fp);
        }
        outfile_commit(&file, err);
    }
    outfile_discard(&file);
    return err->status;
}
