/* picture_estimate.c - see picture_estimate.h. */
#include "common/capture/picture_estimate.h"

#include "common/base/textfile.h"
#include "common/base/work_estimate.h"
#include "common/capture/camera_set.h"

struct pixel_sum {
    double all, largest; /* millions of pixels of a process */
};

static void count_picture(struct pixel_sum *sum, double megapixels)
{
    sum->all += megapixels;
    if (megapixels > sum->largest) sum->largest = megapixels;
}

static double megapixels_of(const struct view *v) { return 1e-6 * v->width * v->height; }

static double mean_size(const struct camera_set *set)
{
    double sum = 0;
    for (int i = 0; i < set->view_count; i++) sum += megapixels_of(&set->views[i]);
    return set->view_count ? sum / set->view_count : 0;
}

/* Adds a process: the pictures on a line. */
static enum status add_line(struct work_estimate *w, struct textfile *t, const struct camera_set *set, double mean,
                            const struct picture_cost *cost, struct err *err)
{
    struct pixel_sum sum = {0};
    char *name = NULL;
    if (textfile_word(t, "process", &name, err)) return err->status;
    while (!err->status && textfile_more(t) && !textfile_word(t, "a picture", &name, err)) {
        const int at = camera_set_find(set, name);
        count_picture(&sum, at < 0 ? mean : megapixels_of(&set->views[at]));
    }
    if (sum.all == 0) count_picture(&sum, mean);
    if (!err->status)
        work_estimate_add(w, cost->process_seconds + cost->seconds * sum.all,
                          cost->process_mib + cost->mib * sum.largest, cost->bytes * sum.all);
    return err->status;
}

enum status picture_estimate_print(FILE *to, const char *list, const char *views, const struct picture_cost *cost,
                                   struct err *err)
{
    struct work_estimate work = {0};
    struct camera_set set = {0};
    struct textfile t = {0};
    if (!camera_set_read_cameras(&set, views, NULL, err) && !textfile_open(&t, list, err)) {
        const double mean = mean_size(&set);
        while (!err->status && textfile_next(&t)) add_line(&work, &t, &set, mean, cost, err);
    }
    textfile_release(&t);
    camera_set_release(&set);
    if (!err->status) work_estimate_print(to, &work);
    return err->status;
}
