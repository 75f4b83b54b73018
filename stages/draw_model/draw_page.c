/* draw_page.c - one HTML file of a page's sources.
 *
 *  * In page.html a line "<!-- script NAME.js -->" or "<!-- style NAME.css -->" stands for that file, beside it.
 * Modules of scripts would be simpler, but a browser loads none from a disk. */
#include <stdio.h>
#include <string.h>

#include "common/base/file_bytes.h"
#include "common/base/file_path.h"
#include "common/base/outfile.h"
#include "stages/draw_model/draw_data.h"

static enum status write_part(FILE *to, const char *kind, const char *folder, const char *name, int length,
                              struct err *err)
{
    struct file_bytes part = {0};
    char file[FILE_PATH], path[FILE_PATH];
    snprintf(file, sizeof file, "%.*s", length, name);
    if (file_path(path, folder, file, "", err) || file_bytes_read(&part, path, err)) return err->status;
    fprintf(to, "<%s>\n", kind);
    fwrite(part.bytes, 1, part.size, to);
    fprintf(to, "</%s>\n", kind);
    file_bytes_release(&part);
    return ST_OK;
}

enum status draw_page_write(const char *path, const struct draw_sources *from, struct err *err)
{
    static const char *const kinds[] = {"script", "style"};
    struct file_bytes page = {0};
    struct outfile out = {0};
    char source[FILE_PATH];
    if (file_path(source, from->page, "page.html", "", err) || file_bytes_read(&page, source, err)) return err->status;
    outfile_open(&out, path, err);
    for (char *line = page.bytes, *next; !err->status && line && *line; line = next) {
        char *end = strchr(line, '\n');
        bool is_part = false;
        next = end ? end + 1 : NULL;
        for (int k = 0; k < 2 && !is_part; k++) {
            char begin[32];
            const int n = snprintf(begin, sizeof begin, "<!-- %s ", kinds[k]);
            is_part = !strncmp(line, begin, (size_t)n);
            if (is_part) write_part(out.fp, kinds[k], from->page, line + n, (int)strcspn(line + n, " \n"), err);
        }
        if (!is_part) fwrite(line, 1, next ? (size_t)(next - line) : strlen(line), out.fp);
    }
    if (!err->status) outfile_commit(&out, err);
    outfile_discard(&out);
    file_bytes_release(&page);
    return err->status;
}
