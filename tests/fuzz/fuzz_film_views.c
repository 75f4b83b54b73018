/* fuzz_film_views.c - the views of films: any bytes give names that can be used, or an error message. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/film/film_views.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct film_views v;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (film_views_read(&v, path, NULL, &err)) {
        if (!strstr(err.text, path) || v.names || v.count || v.all) abort();
    } else {
        if (v.all == (v.count > 0)) abort();
        for (int i = 0; i < v.count; i++)
            if (!v.names[i] || (i && strcmp(v.names[i - 1], v.names[i]) >= 0)) abort();
        film_views_release(&v);
    }
    unlink(path);
    return 0;
}
