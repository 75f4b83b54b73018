/* bake_estimate.c - see bake_estimate.h. The time is linear in the pixels of the viewpoint's own views, whose texels
 * are composed, and in those of its sources, which are read and projected; memory and bytes are linear in the former.
 * Measured on three viewpoints of loft (draft): own views of 2.2 million pixels and 35 views in all took 4.7 to 5.5
 * core-seconds and 450 to 560 MiB, with one source in place of 32 1.8 to 2.5, and wrote 8 MB. With `reveal = all` they
 * took 1.05 times as long. */
#include "stages/bake_vdta/bake_estimate.h"

#include <string.h>

#include "common/base/textfile.h"

static const double OWN_SECONDS = 1.0, SOURCE_SECONDS = 0.15; /* of a million pixels */
static const double MIB = 60, OWN_MIB = 240;                  /* of a process; of a million pixels */
static const double OWN_BYTES = 4.2e6;                        /* of a million pixels */

static double megapixels(const struct view *v) { return 1e-6 * v->width * v->height; }

enum status estimate_viewpoint(struct work_estimate *w, const struct bake_scene *scene, const char *photo,
                               struct err *err)
{
    const struct camera_set *set = &scene->in.set;
    double own = 0, all = 0;
    for (int i = 0; i < set->view_count; i++) all += megapixels(&set->views[i]);
    /* views of a photo are called PHOTO or PHOTO@k */
    const size_t length = strlen(photo);
    for (int i = 0; i < set->view_count; i++) {
        const char *name = set->views[i].name;
        if (!strncmp(name, photo, length) && (!name[length] || name[length] == '@')) own += megapixels(&set->views[i]);
    }
    if (!(own > 0)) return err_set(err, ST_USAGE, "%s/images.txt has no photo %s.", scene->from.views, photo);
    const double mean = all / set->view_count, sources = scene->params->texture.max_sources;
    const double read = own + (sources < set->view_count ? sources : set->view_count) * mean;
    work_estimate_add(w, OWN_SECONDS * own + SOURCE_SECONDS * read, MIB + OWN_MIB * own, OWN_BYTES * own);
    return ST_OK;
}

enum status estimate_print(FILE *to, const char *list, const struct bake_scene *scene, struct err *err)
{
    struct work_estimate work = {0};
    struct textfile t = {0};
    textfile_open(&t, list, err);
    while (!err->status && textfile_next(&t)) {
        char *photo = NULL;
        if (!textfile_word(&t, "photo", &photo, err) && !textfile_end(&t, err))
            estimate_viewpoint(&work, scene, photo, err);
    }
    textfile_release(&t);
    if (err->status || !work.items) return err->status;
    fprintf(to, "textures: %d viewpoint%s: about %.0f s of one core in all, up to %.0f MiB a viewpoint, %.0f MB\n",
            work.items, work.items == 1 ? "" : "s", work.seconds, work.mib, 1e-6 * work.bytes);
    work_estimate_print(to, &work);
    return ST_OK;
}
