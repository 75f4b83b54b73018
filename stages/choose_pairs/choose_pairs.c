/* choose_pairs.c - chooses the pairs of photographs whose features are matched.
 *
 * reads   RECORDS/list.txt, ID.txt           the photos
 *         FEATURES/ID.txt                    their features, where there are many photos
 * writes  OUT                                the pairs
 *
 * A small set is compared in all pairs. In a larger one, a photo is compared with its neighbours by name, and with
 * photos whose largest features match its own, so that a walk that returns to a place is closed. */
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/log.h"
#include "common/capture/pair_list.h"
#include "common/capture/panorama_name.h"
#include "common/capture/photo_list.h"
#include "common/product/product.h"
#include "stages/choose_pairs/pairs_params.h"
#include "stages/choose_pairs/similar_photos.h"

#define PARAM_STRUCT struct pairs_params
static const struct param pairs_param_table[] = {PAIRS_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

enum { MAX_EXHAUSTIVE = 60 };

struct pair_choice {
    const char *records, *features, *out;
    struct pairs_params params;
};

/* Reads the features of each photo and keeps the first compared_features: files list the largest first. */
static enum status read_largest(struct feature_list *lists, const struct pair_choice *c,
                                const struct photo_list *photos, struct provenance *prov, struct err *err)
{
    for (int i = 0; !err->status && i < photos->count; i++) {
        char path[FILE_PATH];
        const struct product_key key = {.photo = photos->photos[i].id};
        struct feature_list *list = &lists[i];
        if (product_path_in(path, c->features, PRODUCT_FEATURES, &key, err) ||
            feature_list_read(list, path, prov, err) || list->count <= c->params.compared_features)
            continue;
        list->count = c->params.compared_features;
        struct feature *fewer = realloc(list->features, (size_t)list->count * sizeof *fewer);
        if (fewer) list->features = fewer;
    }
    return err->status;
}

static enum status find_similar(bool *similar, const struct pair_choice *c, const struct photo_list *photos,
                                struct provenance *prov, struct err *err)
{
    const size_t count = (size_t)photos->count;
    struct feature_list *lists = calloc(count + 1, sizeof *lists);
    int *shared = calloc(count * count + 1, sizeof *shared);
    if (!lists || !shared)
        err_nomem(err, "features", count * count * sizeof *shared);
    else if (!read_largest(lists, c, photos, prov, err) && !similar_count_matches(shared, lists, photos->count, err))
        similar_choose(similar, shared, photos->count, c->params.min_matches, c->params.max_similar, err);
    for (size_t i = 0; lists && i < count; i++) feature_list_release(&lists[i]);
    free(lists);
    free(shared);
    return err->status;
}

static enum status choose_pairs(const struct pair_choice *c, struct provenance *prov, struct err *err)
{
    struct photo_list photos = {0};
    struct pair_list list = {0};
    bool *similar = NULL;
    if (photo_list_read(&photos, c->records, err)) return err->status;
    const size_t count = (size_t)photos.count;
    const char *matcher = c->params.matcher;
    const bool all = !strcmp(matcher, "exhaustive") || (!strcmp(matcher, "auto") && count <= MAX_EXHAUSTIVE);
    const bool by_features = !all && strcmp(matcher, "sequential") != 0;
    if (by_features) {
        similar = calloc(count * count + 1, sizeof *similar);
        if (!similar)
            err_nomem(err, "pairs of photos", count * count);
        else
            find_similar(similar, c, &photos, prov, err);
    }
    for (size_t i = 0; i < count; i++)
        for (size_t j = i + 1; j < count && !err->status; j++)
            if (panorama_name_same(photos.photos[i].file, photos.photos[j].file))
                continue; /* from one place: their matches show no depth */
            else if (all || similar_by_name((int)i, (int)j) || (by_features && similar[i * count + j]))
                pair_list_add(&list, photos.photos[i].id, photos.photos[j].id, err);
    if (!err->status && !pair_list_write(&list, c->out, prov, err))
        log_note("%d of %zu pairs of photos are compared", list.count, count * (count - (count > 0)) / 2);
    free(similar);
    pair_list_release(&list);
    photo_list_release(&photos);
    return err->status;
}

int main(int argc, char **argv)
{
    struct pair_choice c = {.params = PAIRS_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Chooses the pairs of photographs whose features are matched."),
        CLI_STR("records", &c.records, CLI_REQUIRED, "folder of the photos' records"),
        CLI_STR("features", &c.features, CLI_REQUIRED, "folder of the photos' features"),
        CLI_STR("out", &c.out, CLI_REQUIRED, "text file to write"),
        CLI_PARAMS(pairs_param_table, &c.params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "choose_pairs", opts, &prov, &err) != CLI_RUN || choose_pairs(&c, &prov, &err))
        err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
