/* match_photos.c - matches the features of a photo with those of photos that come after it.
 *
 * reads   PAIRS                              the pairs of photos that are compared
 *         FEATURES/ID.txt                    their features
 *         OUT                                the matches of an earlier run, if there are any
 * writes  OUT                                the matches
 *
 * Pairs from an earlier run are kept if their features have not changed, and if this program is not newer: a photo that
 * is added or changed costs only its own pairs, and the result is the same as without an earlier run. */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "common/base/cli.h"
#include "common/base/log.h"
#include "common/base/parallel.h"
#include "common/capture/mutual_matches.h"
#include "common/capture/pair_list.h"
#include "common/product/product.h"
#include "stages/match_photos/matching_params.h"

#define PARAM_STRUCT struct matching_params
static const struct param matching_param_table[] = {MATCHING_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

struct matching {
    const char *pairs, *features, *id, *out;
    struct matching_params params;
};

/* What threads share; each pair is one piece of work. */
struct pair_work {
    const struct matching *options;
    const struct nearest_descriptors *own;
    struct matched_pair **pairs; /* to match; not owned */
    struct err *errs;            /* of each of them */
};

static enum status read_features(struct feature_list *list, const struct matching *m, const char *id, bool whole,
                                 struct err *err)
{
    char path[FILE_PATH];
    if (product_path_in(path, m->features, PRODUCT_FEATURES, &(struct product_key){.photo = id}, err))
        return err->status;
    return whole ? feature_list_read(list, path, NULL, err) : feature_list_read_head(list, path, err);
}

static void match_some(void *ctx, size_t begin, size_t end, int thread)
{
    struct pair_work *w = ctx;
    const struct match_limits limits = {w->options->params.max_ratio, w->options->params.max_angle};
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct feature_list list = {0};
        struct nearest_descriptors other = {0};
        if (!read_features(&list, w->options, w->pairs[i]->other, true, &w->errs[i]) &&
            !nearest_descriptors_init(&other, &list, &w->errs[i]))
            mutual_matches_find(w->pairs[i], w->own, &other, &limits, &w->errs[i]);
        nearest_descriptors_release(&other);
        feature_list_release(&list);
    }
}

/* Matches the pairs that have no matches yet. */
static enum status match_new(struct match_list *list, const struct feature_list *own, const struct matching *m,
                             int *count, struct err *err)
{
    struct nearest_descriptors blocks = {0};
    struct pair_work w = {.options = m, .own = &blocks};
    w.pairs = malloc(((size_t)list->count + 1) * sizeof(struct matched_pair *));
    w.errs = malloc(((size_t)list->count + 1) * sizeof *w.errs);
    *count = 0;
    if (!w.pairs || !w.errs)
        err_nomem(err, "pairs of photos", (size_t)list->count * sizeof *w.errs);
    else if (!nearest_descriptors_init(&blocks, own, err)) {
        for (int i = 0; i < list->count; i++)
            if (!list->pairs[i].matches) {
                w.errs[*count] = (struct err)ERR_INIT;
                w.pairs[(*count)++] = &list->pairs[i];
            }
        parallel_for((size_t)*count, 1, match_some, &w);
        for (int i = 0; i < *count && !err->status; i++)
            if (w.errs[i].status) err_set(err, w.errs[i].status, "%s", w.errs[i].text);
    }
    nearest_descriptors_release(&blocks);
    free(w.pairs);
    free(w.errs);
    return err->status;
}

/* The pairs that the photo is in as the first, with the matches of an earlier run where their features are the same. */
static enum status list_pairs(struct match_list *list, const struct pair_list *pairs, const struct matching *m,
                              const struct match_list *earlier, struct err *err)
{
    const bool same = !strcmp(list->hash, earlier->hash) && list->max_ratio == earlier->max_ratio &&
                      list->max_angle == earlier->max_angle;
    for (int i = 0; i < pairs->count && !err->status; i++) {
        struct feature_list head = {0};
        const char *other = pairs->pairs[i].second;
        if (strcmp(pairs->pairs[i].first, m->id) || read_features(&head, m, other, false, err)) continue;
        struct matched_pair *pair = match_list_add(list, other, head.hash, err);
        const struct matched_pair *old = same ? match_list_find(earlier, other) : NULL;
        if (!pair || !old || strcmp(old->hash, head.hash)) continue;
        pair->matches = malloc(((size_t)old->count + 1) * sizeof *pair->matches);
        if (!pair->matches) return err_nomem(err, "matches", (size_t)old->count * sizeof *pair->matches);
        memcpy(pair->matches, old->matches, (size_t)old->count * sizeof *pair->matches);
        pair->count = old->count;
    }
    return err->status;
}

/* Whether a file is newer than this program. An older one may come from other code. */
static bool is_newer_than_program(const char *path)
{
    struct stat file, program;
    if (stat(path, &file) || stat("/proc/self/exe", &program)) return false;
    return file.st_mtim.tv_sec > program.st_mtim.tv_sec;
}

static enum status match_photos(const struct matching *m, struct provenance *prov, struct err *err)
{
    struct pair_list pairs = {0};
    struct feature_list own = {0};
    struct match_list list = {0}, earlier = {0};
    struct err ignored = ERR_INIT;
    int matched = 0;
    if (is_newer_than_program(m->out))
        match_list_read(&earlier, m->out, NULL, &ignored); /* a damaged one is made anew */
    if (!pair_list_read(&pairs, m->pairs, NULL, err) && !read_features(&own, m, m->id, true, err)) {
        memcpy(list.hash, own.hash, sizeof list.hash);
        list.max_ratio = m->params.max_ratio;
        list.max_angle = m->params.max_angle;
        if (!list_pairs(&list, &pairs, m, &earlier, err) && !match_new(&list, &own, m, &matched, err) &&
            !match_list_write(&list, m->out, prov, err))
            log_note("%s: matched with %d photos, kept %d", m->id, matched, list.count - matched);
    }
    match_list_release(&list);
    match_list_release(&earlier);
    feature_list_release(&own);
    pair_list_release(&pairs);
    return err->status;
}

int main(int argc, char **argv)
{
    struct matching m = {.params = MATCHING_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Matches the features of a photo with those of photos that come after it."),
        CLI_STR("pairs", &m.pairs, CLI_REQUIRED, "text file of the pairs of photos"),
        CLI_STR("features", &m.features, CLI_REQUIRED, "folder of the photos' features"),
        CLI_STR("photo", &m.id, CLI_REQUIRED, "id of the photo"),
        CLI_STR("out", &m.out, CLI_REQUIRED, "text file to write"),
        CLI_PARAMS(matching_param_table, &m.params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "match_photos", opts, &prov, &err) != CLI_RUN || match_photos(&m, &prov, &err))
        err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
