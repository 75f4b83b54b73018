/* fuzz_sfm_lists.c - text written by other programs: Bundler's list of images and COLMAP's log. Any bytes give names,
 * a count and a line, or an error. Every input is read as both. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

/* files of a stage, which are not in the library */
#include "stages/sfm/colmap_database.c"
#include "stages/sfm/colmap_job.c"
#include "stages/sfm/colmap_log.c"
#include "stages/sfm/colmap_matches.c"
#include "stages/sfm/sfm_folder.c"
#include "stages/sfm/sfm_params.c"
#include "stages/sfm/start_lens.c"
#include "stages/sfm/triangulate.c"
#include "stages/sfm/user_model.c"

static void check_list(const char *path)
{
    char text[4][8] = {"a", "a.jpg", "b", "b.jpg"};
    struct photo_record records[2] = {{.id = text[0], .file = text[1], .info = {.width = 64, .height = 48}},
                                      {.id = text[2], .file = text[3], .info = {.width = 48, .height = 64}}};
    const struct photo_list photos = {records, 2};
    struct image_names names = {0};
    struct err err = ERR_INIT;
    int known = 0;

    enum status st = read_list(&names, path, &photos, &err);
    if (st && (st != err.status || !strstr(err.text, path))) abort();
    for (int i = 0; i < names.count; i++) {
        int at = photo_list_match(&photos, names.names[i]);
        known += at >= 0;
        if (names.sizes[i][0] != (at < 0 ? 0 : records[at].info.width)) abort();
    }
    if (!st && !known) abort();
    image_names_release(&names);
}

static void check_log(const char *path)
{
    char line[100];

    colmap_log_connected(path);
    colmap_log_last_line(line, sizeof line, path);
    if (strlen(line) >= sizeof line || strchr(line, '\n')) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];

    fuzz_file(path, data, size);
    check_list(path);
    check_log(path);
    unlink(path);
    return 0;
}
