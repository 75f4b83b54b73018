/* fuzz_matches.c - lists of features, of matches and of pairs: any bytes give a list that is written and read back the
 * same, or an error. Every input is read as each. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/capture/feature_list.h"
#include "common/capture/match_list.h"
#include "common/capture/pair_list.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void check_features(const char *path, const char *copy)
{
    struct feature_list list, again;
    struct err err = ERR_INIT;
    if (feature_list_read(&list, path, NULL, &err)) {
        if (list.features || !strstr(err.text, path)) abort();
        return;
    }
    if (feature_list_write(&list, copy, NULL, &err) || feature_list_read(&again, copy, NULL, &err)) abort();
    if (again.count != list.count || strcmp(again.hash, list.hash)) abort();
    if (memcmp(again.features, list.features, (size_t)list.count * sizeof *list.features)) abort();
    feature_list_release(&again);
    feature_list_release(&list);
    unlink(copy);
}

static void check_matches(const char *path, const char *copy)
{
    struct match_list list, again;
    struct err err = ERR_INIT;
    if (match_list_read(&list, path, NULL, &err)) {
        if (list.pairs || !strstr(err.text, path)) abort();
        return;
    }
    for (int i = 0; i < list.count; i++)
        for (int k = 1; k < list.pairs[i].count; k++)
            if (list.pairs[i].matches[k].first <= list.pairs[i].matches[k - 1].first) abort();
    if (match_list_write(&list, copy, NULL, &err)) abort();
    /* names of photos have no blanks where photos are imported; here they may */
    if (!match_list_read(&again, copy, NULL, &err)) {
        if (again.count != list.count) abort();
        match_list_release(&again);
    }
    match_list_release(&list);
    unlink(copy);
}

static void check_pairs(const char *path)
{
    struct pair_list list;
    struct err err = ERR_INIT;
    if (pair_list_read(&list, path, NULL, &err) && (list.pairs || !strstr(err.text, path))) abort();
    for (int i = 0; i < list.count; i++)
        if (!list.pairs[i].first || !list.pairs[i].second) abort();
    pair_list_release(&list);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH], copy[FUZZ_PATH + 8];

    fuzz_file(path, data, size);
    snprintf(copy, sizeof copy, "%s.copy", path);
    check_features(path, copy);
    check_matches(path, copy);
    check_pairs(path);
    unlink(path);
    return 0;
}
