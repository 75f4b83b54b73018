/* fuzz_bracket_list.c - brackets.txt: any bytes give unique views with safe names and photos, or an error. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/import_photos/bracket_list.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct bracket_list list;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (bracket_list_read(&list, path, &err)) {
        if (!strstr(err.text, path) || list.lines) abort();
    } else {
        if (list.count < 1) abort();
        for (int i = 0; i < list.count; i++) {
            const char *view = list.lines[i].view;
            if (!*view || *view == '-' || strpbrk(view, " /.\"\\#$%\t") || list.lines[i].count < 1) abort();
            for (int k = 0; k < i; k++)
                if (!strcmp(view, list.lines[k].view)) abort();
        }
        bracket_list_release(&list);
    }
    unlink(path);
    return 0;
}
