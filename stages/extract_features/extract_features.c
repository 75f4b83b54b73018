/* extract_features.c - finds the local features of a photograph.
 *
 * reads   PHOTOS/FILE                        the photo
 *         RECORDS/ID.txt                     its record
 *         MASKS/ID.png                       black where no features may be found
 * writes  OUT                                its features
 *
 * Features are found in a grey picture, in the stored orientation. An unreadable photo gets no features and a warning,
 * so that the run goes on with the others. */
#include <stdlib.h>

#include "common/base/cli.h"
#include "common/base/log.h"
#include "common/capture/opencv_sift.h"
#include "common/capture/photo_mask.h"
#include "common/image/luma.h"
#include "stages/extract_features/features_params.h"

#define PARAM_STRUCT struct features_params
static const struct param features_param_table[] = {FEATURES_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

struct extraction {
    const char *photos, *records, *masks, *id, *out;
    struct features_params params;
};

static unsigned char *grey_of_spaced(const struct photo *p, struct err *err)
{
    const size_t pixels = (size_t)p->info.width * (size_t)p->info.height;
    unsigned char *grey = malloc(pixels), *rgb = malloc(3 * pixels);
    struct image linear = {0};
    if (!grey || !rgb)
        err_nomem(err, "a grey picture", 4 * pixels);
    else if (!photo_to_linear(&linear, p, err))
        image_to_srgb8(&linear, rgb);
    for (size_t i = 0; !err->status && i < pixels; i++) grey[i] = luma_of(rgb + 3 * i);
    image_release(&linear);
    free(rgb);
    if (err->status) {
        free(grey);
        grey = NULL;
    }
    return grey;
}

/* Rec. 709 luma of the stored values, or of those in sRGB if the photo is in another space. */
static unsigned char *grey_of(const struct photo *p, struct err *err)
{
    const size_t pixels = (size_t)p->info.width * (size_t)p->info.height;
    const unsigned shift = p->info.bits == 16 ? 8 : 0;
    if (p->space) return grey_of_spaced(p, err);
    unsigned char *grey = malloc(pixels);
    if (!grey) err_nomem(err, "a grey picture", pixels);
    for (size_t i = 0; grey && i < pixels; i++) grey[i] = luma_of_samples(p->samples + 3 * i, shift);
    return grey;
}

/* Keeps the first features that no mask covers. */
static void keep(struct feature_list *list, const struct photo_mask *mask, int most)
{
    int kept = 0;
    for (int i = 0; i < list->count && kept < most; i++) {
        const struct feature *f = &list->features[i];
        const int x = (int)f->x, y = (int)f->y;
        if (mask->masked && x >= 0 && y >= 0 && x < mask->width && y < mask->height &&
            mask->masked[(size_t)y * (size_t)mask->width + (size_t)x])
            continue;
        list->features[kept++] = *f;
    }
    list->count = kept;
}

static enum status find(struct feature_list *list, const struct extraction *e, const struct photo_record *record,
                        struct provenance *prov, struct err *err)
{
    struct photo photo = {0};
    struct photo_mask mask = {0};
    struct err unreadable = ERR_INIT;
    char path[FILE_PATH];
    unsigned char *grey = NULL;
    if (file_path(path, e->photos, record->file, "", err)) return err->status;
    if (photo_read_input(&photo, path, record->file, prov, &unreadable)) {
        if (unreadable.status != ST_DATA) return err_set(err, unreadable.status, "%s", unreadable.text);
        log_warn("%s It has no features; the other photos are used.", unreadable.text);
        return ST_OK;
    }
    const struct sift_limits limits = {
        .longest = e->params.max_image_size, .contrast = e->params.min_contrast, .edge = e->params.max_edge};
    if (!photo_mask_read(&mask, e->masks, e->records, record, prov, err) && (grey = grey_of(&photo, err)) &&
        !sift_find(list, grey, photo.info.width, photo.info.height, &limits, err))
        keep(list, &mask, e->params.max_features);
    free(grey);
    photo_mask_release(&mask);
    photo_release(&photo);
    return err->status;
}

static enum status extract_features(const struct extraction *e, struct provenance *prov, struct err *err)
{
    struct photo_record record = {0};
    struct feature_list list = {0};
    if (!photo_record_read(&record, e->records, e->id, NULL, err) && !find(&list, e, &record, prov, err) &&
        !feature_list_write(&list, e->out, prov, err))
        log_note("%s: %d features", e->id, list.count);
    feature_list_release(&list);
    photo_record_release(&record);
    return err->status;
}

int main(int argc, char **argv)
{
    struct extraction e = {.params = FEATURES_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Finds the local features of a photograph."),
        CLI_STR("photos", &e.photos, CLI_REQUIRED, "folder of photographs"),
        CLI_STR("records", &e.records, CLI_REQUIRED, "folder of the photos' records"),
        CLI_STR("masks", &e.masks, CLI_OPTIONAL, "folder of masks ID.png, black where no features may be found"),
        CLI_STR("photo", &e.id, CLI_REQUIRED, "id of the photo"),
        CLI_STR("out", &e.out, CLI_REQUIRED, "text file to write"),
        CLI_PARAMS(features_param_table, &e.params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "extract_features", opts, &prov, &err) != CLI_RUN || extract_features(&e, &prov, &err))
        err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
