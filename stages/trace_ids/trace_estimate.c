/* trace_estimate.c - see trace_estimate.h. All is linear in the pixels of the view, and what edits reveal takes a
 * picture of each model. What a process pays once, 0.01 s for each thousand views with their share of the model, is
 * left out. Measured on nine views of loft (853 x 853 px): ids took 0.13 to 0.21 core-seconds and 2.0 MB, and what six
 * edits reveal 0.15 to 0.29 and 0.4 MB, at 108 MiB. */
#include "stages/trace_ids/trace_estimate.h"

#include <string.h>

#include "common/base/textfile.h"

static const double IDS_SECONDS = 0.22, MODEL_SECONDS = 0.04; /* of a million pixels; of each model */
static const double MIB = 15, VIEW_MIB = 130;                 /* of a process; of a million pixels */
static const double IDS_BYTES = 2.9e6, REVEAL_BYTES = 0.55e6; /* of a million pixels */

void estimate_view(struct work_estimate *w, const struct view *view, enum trace_kind kind, int edits)
{
    const double megapixels = 1e-6 * view->width * view->height;
    const bool ids = kind == TRACE_IDS;
    work_estimate_add(w, (ids ? IDS_SECONDS : MODEL_SECONDS * (1 + edits)) * megapixels, MIB + VIEW_MIB * megapixels,
                      (ids ? IDS_BYTES : REVEAL_BYTES) * megapixels);
}

static enum status add_line(struct work_estimate *w, struct textfile *t, const struct camera_set *set,
                            const char *views, int edits, struct err *err)
{
    char *name = NULL, *kind = NULL;
    if (textfile_word(t, "view", &name, err) || textfile_word(t, "ids or reveal", &kind, err) || textfile_end(t, err))
        return err->status;
    const int at = camera_set_find(set, name);
    if (at < 0) return err_set(err, ST_USAGE, "there is no view %s in %s/images.txt.", name, views);
    const bool ids = !strcmp(kind, "ids");
    if (!ids && strcmp(kind, "reveal")) return textfile_error(t, err, kind, "ids or reveal");
    estimate_view(w, &set->views[at], ids ? TRACE_IDS : TRACE_REVEAL, edits);
    return ST_OK;
}

enum status estimate_print(FILE *to, const char *list, const struct camera_set *set, const char *views, int edits,
                           struct err *err)
{
    struct work_estimate work = {0};
    struct textfile t = {0};
    textfile_open(&t, list, err);
    while (!err->status && textfile_next(&t)) add_line(&work, &t, set, views, edits, err);
    textfile_release(&t);
    if (err->status || !work.items) return err->status;
    fprintf(to, "ids: %d piece%s of work: about %.0f s of one core in all, up to %.0f MiB a process, %.0f MB\n",
            work.items, work.items == 1 ? "" : "s", work.seconds, work.mib, 1e-6 * work.bytes);
    work_estimate_print(to, &work);
    return ST_OK;
}
