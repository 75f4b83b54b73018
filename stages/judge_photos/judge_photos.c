/* judge_photos.c - tells whether photographs are good enough, and what suits them.
 *
 * reads   PHOTOS/FILE                        the photos
 *         RECORDS/list.txt, ID.txt           their records
 *         FEATURES/ID.txt, MATCHES/ID.txt    by which they overlap
 * writes  OUT                                a row for each photo, warnings and advice; they are printed too
 *
 * It judges sharpness by the width of edges, exposure by white and black pixels, overlap by the number of features that
 * look alike, and the lens by EXIF and by black corners. */
#include <stdlib.h>

#include "common/base/cli.h"
#include "common/base/log.h"
#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "common/capture/feature_list.h"
#include "common/capture/match_list.h"
#include "common/image/photo.h"
#include "common/product/product.h"
#include "stages/judge_photos/judgement.h"

#define PARAM_STRUCT struct judge_params
static const struct param judge_param_table[] = {JUDGE_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

struct judging {
    const char *photos, *records, *features, *matches, *out;
    struct judge_params params;
    struct judgement judgement;
    struct progress progress;
    struct err *errs; /* of each photo */
};

/* Measures a photo; one that cannot be read stays unreadable. */
static void measure(struct judging *j, int photo)
{
    struct judged_photo *p = &j->judgement.photos[photo];
    struct err *err = &j->errs[photo], unreadable = ERR_INIT;
    const size_t pixels = (size_t)p->record->info.width * (size_t)p->record->info.height;
    char path[FILE_PATH];
    struct photo picture = {0};
    struct image linear = {0};
    unsigned char *rgb = NULL;
    if (file_path(path, j->photos, p->record->file, "", err)) return;
    if (photo_read_any(&picture, path, &unreadable)) {
        if (unreadable.status != ST_DATA) err_set(err, unreadable.status, "%s", unreadable.text);
        return;
    }
    rgb = malloc(4 * pixels);
    if (!rgb)
        err_nomem(err, "a picture", 4 * pixels);
    else if (!photo_to_linear(&linear, &picture, err)) {
        image_to_srgb8(&linear, rgb);
        photo_measures_take(&p->measures, rgb, linear.width, linear.height, rgb + 3 * pixels);
        p->readable = true;
    }
    image_release(&linear);
    free(rgb);
    photo_release(&picture);
}

static void measure_photos(void *ctx, size_t begin, size_t end, int thread)
{
    struct judging *j = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        measure(j, (int)i);
        progress_add(&j->progress, 1);
    }
}

static enum status read_overlaps(struct judging *j, const struct photo_list *list, struct provenance *prov,
                                 struct err *err)
{
    char path[FILE_PATH];
    for (int i = 0; !err->status && i < list->count; i++) {
        const struct product_key key = {.photo = list->photos[i].id};
        struct feature_list features = {0};
        struct match_list matches = {0};
        if (!product_path_in(path, j->features, PRODUCT_FEATURES, &key, err) &&
            !feature_list_read(&features, path, prov, err) &&
            !product_path_in(path, j->matches, PRODUCT_MATCHES, &key, err))
            match_list_read(&matches, path, prov, err);
        if (!err->status) provenance_add_hash(prov, list->photos[i].file, list->photos[i].hash, err);
        j->judgement.photos[i].features = features.count;
        for (int k = 0; !err->status && k < matches.count; k++) {
            const int other = photo_list_find_id(list, matches.pairs[k].other);
            if (other >= 0 && matches.pairs[k].count >= j->params.min_matches) judgement_link(&j->judgement, i, other);
        }
        feature_list_release(&features);
        match_list_release(&matches);
    }
    return err->status;
}

static enum status judge(struct judging *j, struct provenance *prov, struct err *err)
{
    struct photo_list list = {0};
    if (photo_list_read(&list, j->records, err)) return err->status;
    const size_t count = (size_t)list.count;
    j->judgement = (struct judgement){calloc(count + 1, sizeof *j->judgement.photos), list.count, &j->params};
    j->errs = calloc(count + 1, sizeof *j->errs);
    if (!j->judgement.photos || !j->errs) {
        err_nomem(err, "photos", count * sizeof *j->judgement.photos);
    } else {
        for (size_t i = 0; i < count; i++)
            j->judgement.photos[i] = (struct judged_photo){.record = &list.photos[i], .group = (int)i};
        progress_start(&j->progress, "looking at", list.count, "photos");
        parallel_for(count, 1, measure_photos, j);
        progress_end(&j->progress);
        for (size_t i = 0; !err->status && i < count; i++)
            if (j->errs[i].status) *err = j->errs[i];
        if (!err->status && !read_overlaps(j, &list, prov, err)) judgement_join_panoramas(&j->judgement);
        if (!err->status) judgement_write(&j->judgement, j->out, prov, err);
    }
    free(j->judgement.photos);
    free(j->errs);
    photo_list_release(&list);
    return err->status;
}

int main(int argc, char **argv)
{
    struct judging j = {.params = JUDGE_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Tells whether photographs are good enough, and what suits them."),
        CLI_STR("photos", &j.photos, CLI_REQUIRED, "folder of the photos"),
        CLI_STR("records", &j.records, CLI_REQUIRED, "folder of the photos' records"),
        CLI_STR("features", &j.features, CLI_REQUIRED, "folder of the photos' features"),
        CLI_STR("matches", &j.matches, CLI_REQUIRED, "folder of the photos' matches"),
        CLI_STR("out", &j.out, CLI_REQUIRED, "text file to write"),
        CLI_PARAMS(judge_param_table, &j.params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "judge_photos", opts, &prov, &err) != CLI_RUN || judge(&j, &prov, &err)) err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
