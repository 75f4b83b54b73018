/* holdout.c - the choice of held-out views, and the split of the model. */
#include "stages/sfm_import/holdout.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"

enum status holdout_choose(bool *held, const struct lens_list *lenses, int every, const char *names, struct err *err)
{
    const char *photo = "";
    int photos = 0, kept = 0, views = 0;
    for (int i = 0; i < lenses->count; i++) { /* views of a photo are consecutive: PHOTO, or PHOTO@k */
        photos += i == 0 || strcmp(photo, lenses->lenses[i].photo) != 0;
        photo = lenses->lenses[i].photo;
        held[i] = every > 0 && (photos - 1) % every == 0;
    }
    for (const char *at = names ? names : ""; *(at += strspn(at, " \t"));) {
        size_t size = strcspn(at, " \t");
        bool found = false;
        for (int i = 0; i < lenses->count; i++) {
            const struct lens *l = &lenses->lenses[i];
            if ((strlen(l->view) == size && !memcmp(l->view, at, size)) ||
                (strlen(l->photo) == size && !memcmp(l->photo, at, size)))
                found = held[i] = true;
        }
        if (!found)
            return err_set(
                err, ST_USAGE,
                "--holdout-views: there is no view or placed photo \"%.*s\"; wanted names like %s, without the "
                "file extension.",
                (int)(size < 80 ? size : 80), at, lenses->lenses[0].view);
        at += size;
    }
    photo = "";
    for (int i = 0; i < lenses->count; i++) {
        views += held[i];
        if (held[i] || !strcmp(photo, lenses->lenses[i].photo)) continue;
        photo = lenses->lenses[i].photo;
        kept++;
    }
    if (!views)
        return err_set(err, ST_USAGE, "--holdout-views names no view; omit it, or give names like %s.",
                       lenses->lenses[0].view);
    if (kept < 2)
        return err_set(err, ST_USAGE,
                       "%d of %d placed photos would be kept, but depth needs at least 2; hold out fewer.", kept,
                       photos);
    log_note("%d of %d views are held out", views, lenses->count);
    return ST_OK;
}

static enum status copy_views(struct imported *out, const struct imported *in, const bool *held, bool want,
                              struct err *err)
{
    size_t views = (size_t)in->lenses.count;
    struct sfm_model *m = &out->model;
    m->cameras = calloc(views, sizeof *m->cameras);
    m->images = calloc(views, sizeof *m->images);
    out->lenses.lenses = calloc(views, sizeof *out->lenses.lenses);
    if (!m->cameras || !m->images || !out->lenses.lenses) return err_nomem(err, "views", views * sizeof *m->images);
    for (size_t i = 0; i < views; i++) {
        const struct sfm_image *from = &in->model.images[i];
        const struct lens *lens = &in->lenses.lenses[i];
        if (held[i] != want) continue;
        struct sfm_image *im = &m->images[m->image_count];
        struct lens *l = &out->lenses.lenses[out->lenses.count++];
        size_t room = ((size_t)from->observation_count + 1) * sizeof *im->observations;
        *im = (struct sfm_image){m->image_count + 1, from->cam_from_world, m->image_count,
                                 strdup(from->name), malloc(room),         0};
        *l = (struct lens){strdup(lens->view), strdup(lens->photo), lens->camera, lens->view_from_photo};
        m->cameras[m->camera_count++] = (struct sfm_camera){m->image_count + 1, in->model.cameras[i].camera};
        m->image_count++;
        if (!im->name || !im->observations || !l->view || !l->photo) return err_nomem(err, "a view", room);
    }
    return ST_OK;
}

/* Number of entries of the track in the wanted views. *two_photos: whether they are in at least two photos. */
static int track_length(const struct sfm_point *p, const struct lens_list *lenses, const bool *held, bool want,
                        bool *two_photos)
{
    const char *first = NULL;
    int n = 0;
    *two_photos = false;
    for (int k = 0; k < p->track_count; k++) {
        const char *photo = lenses->lenses[p->track[k].image_idx].photo;
        if (held[p->track[k].image_idx] != want) continue;
        if (first && strcmp(first, photo)) *two_photos = true;
        first = photo;
        n++;
    }
    return n;
}

static enum status copy_points(struct imported *out, const struct imported *in, const bool *held, bool want,
                               const int *new_idx, struct err *err)
{
    struct sfm_model *m = &out->model;
    m->points = calloc((size_t)in->model.point_count + 1, sizeof *m->points);
    if (!m->points) return err_nomem(err, "points", (size_t)in->model.point_count * sizeof *m->points);
    for (int i = 0; i < in->model.point_count; i++) {
        const struct sfm_point *from = &in->model.points[i];
        bool two_photos;
        int length = track_length(from, &in->lenses, held, want, &two_photos);
        /* want: the held-out views, for which one observation is enough; without tracks points belong to all */
        if (from->track_count && (!length || (!want && !two_photos))) continue;
        struct sfm_point *p = &m->points[m->point_count];
        *p = *from;
        p->track_count = 0;
        p->track = length ? malloc((size_t)length * sizeof *p->track) : NULL;
        if (length && !p->track) return err_nomem(err, "a track", (size_t)length * sizeof *p->track);
        m->point_count++;
        for (int k = 0; k < from->track_count; k++) {
            const struct sfm_track *t = &from->track[k];
            if (held[t->image_idx] != want) continue;
            struct sfm_image *im = &m->images[new_idx[t->image_idx]];
            p->track[p->track_count++] = (struct sfm_track){new_idx[t->image_idx], im->observation_count};
            im->observations[im->observation_count++] = in->model.images[t->image_idx].observations[t->observation_idx];
        }
    }
    return ST_OK;
}

enum status holdout_split(struct imported *kept, struct imported *out, const struct imported *in, const bool *held,
                          struct err *err)
{
    int views = in->lenses.count, n[2] = {0};
    int *new_idx = calloc((size_t)views + 1, sizeof *new_idx);
    if (!new_idx) err_nomem(err, "views", (size_t)views * sizeof *new_idx);
    for (int i = 0; !err->status && i < views; i++) new_idx[i] = n[held[i]]++;
    if (!err->status && !copy_views(kept, in, held, false, err) && !copy_views(out, in, held, true, err) &&
        !copy_points(kept, in, held, false, new_idx, err))
        copy_points(out, in, held, true, new_idx, err);
    free(new_idx);
    if (err->status) {
        import_release(kept);
        import_release(out);
    }
    return err->status;
}
