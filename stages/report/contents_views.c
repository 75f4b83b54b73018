/* contents_views.c - the views, their depth maps, and the sparse points. */
#include "stages/report/contents_parts.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/base/sort.h"
#include "stages/report/passing.h"

/* Reprojection errors of the sparse points in the rectified views. */
static enum status measure_points(struct contents *c, struct err *err)
{
    const struct sfm_model *m = &c->views.model;
    size_t total = 0, n = 0;
    double squares = 0;
    for (int i = 0; i < m->point_count; i++) total += (size_t)m->points[i].track_count;
    double *errors = malloc((total + 1) * sizeof *errors);
    if (!errors) return err_nomem(err, "reprojection errors", total * sizeof *errors);
    for (int i = 0; i < m->point_count; i++)
        for (int k = 0; k < m->points[i].track_count; k++) {
            const struct sfm_track *t = &m->points[i].track[k];
            const struct sfm_observation *o = &m->images[t->image_idx].observations[t->observation_idx];
            double u, v;
            if (!(view_project(&c->views.views[t->image_idx], m->points[i].position, &u, &v) > 0)) continue;
            errors[n++] = hypot(u - o->u, v - o->v);
            squares += errors[n - 1] * errors[n - 1];
        }
    if (n) {
        sort_doubles(errors, n);
        c->error_median = errors[n / 2];
        c->error_rms = sqrt(squares / (double)n);
        c->track_mean = (double)total / m->point_count;
    }
    free(errors);
    return ST_OK;
}

struct view_job {
    struct contents *c;
    const char *folder;
};

static enum status read_depth(struct view_card *card, const char *path, int orientation, struct err *err)
{
    static const char *const NAMES[] = {"interior.Z", "interior.id", "boundary.id"};
    struct exr_image im = {0};
    if (!exr_read(&im, path, NAMES, 3, err)) {
        const struct exr_plane *z = exr_find(&im, NAMES[0]);
        for (int k = 1; k < 3; k++) { /* ids count from 1 */
            const struct exr_plane *id = exr_find(&im, NAMES[k]);
            for (size_t i = 0; id->u && i < (size_t)im.width * (size_t)im.height; i++)
                if (id->u[i] > card->segments) card->segments = id->u[i];
        }
        if (z->f)
            page_depth_thumb_make(&card->depth, z->f, im.width, im.height, orientation, PICTURE_HEIGHT, err);
        else
            err_set(err, ST_DATA, "%s: interior.Z holds no floats.", path);
        card->inherited = share_from_text(exr_attribute(&im, "remodel:inherited"));
    }
    exr_image_release(&im);
    return err->status;
}

static void read_truth(struct view_card *card, const char *path, int orientation, struct err *err)
{
    static const char *const NAMES[] = {"Z"};
    struct exr_image im = {0};
    if (!exr_read(&im, path, NAMES, 1, err)) {
        const struct exr_plane *z = exr_find(&im, NAMES[0]);
        if (z->f)
            page_depth_thumb_make(&card->truth, z->f, im.width, im.height, orientation, PICTURE_HEIGHT, err);
        else
            err_set(err, ST_DATA, "%s: Z holds no floats.", path);
    }
    exr_image_release(&im);
}

static void make_view_cards(void *ctx, size_t begin, size_t end, int thread)
{
    static const char *const NAMES[] = {"R", "G", "B"};
    const struct view_job *job = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct view_card *card = &job->c->view_cards[i];
        int orientation = card->photo ? card->photo->info.orientation : 1;
        struct exr_image im = {0};
        struct err errors[3] = {ERR_INIT, ERR_INIT, ERR_INIT}; /* one picture is shown where another cannot be read */
        const struct product_key key = {.view = card->view->name};
        char path[FILE_PATH];

        if (contents_product(path, job->folder, PRODUCT_VIEW, &key) && !exr_read(&im, path, NAMES, 3, &errors[0]))
            picture_from_exr(&card->picture, &im, orientation, PICTURE_HEIGHT, &errors[0]);
        exr_image_release(&im);

        if (contents_product(path, job->folder, PRODUCT_DEPTH, &key)) read_depth(card, path, orientation, &errors[1]);

        if (metric_rows_find(&job->c->view_metrics, card->view->name, "depth.occluded") &&
            contents_product(path, job->folder, PRODUCT_TRUTH_DEPTH, &key))
            read_truth(card, path, orientation, &errors[2]);
        for (int k = 0; k < 3 && !card->problem[0]; k++)
            snprintf(card->problem, sizeof card->problem, "%.*s", NOTE_SIZE - 1, errors[k].text);
    }
}

/* The photograph of each view, from lenses.txt. */
static void match_photos(struct contents *c)
{
    for (int i = 0; i < c->views.view_count; i++) {
        struct view_card *card = &c->view_cards[i];
        card->view = &c->views.views[i];
        int lens = lens_list_find(&c->lenses, card->view->name);
        int photo = lens < 0 ? -1 : photo_list_find_id(&c->photos, c->lenses.lenses[lens].photo);
        if (photo < 0) continue;
        card->photo = &c->photos.photos[photo];
        c->photo_cards[photo].views++;
    }
}

/* Also the means over all depth maps. A view's two depths share one colour range. */
static enum status colour_depths(struct contents *c, struct err *err)
{
    for (int i = 0; i < c->views.view_count; i++) {
        struct view_card *card = &c->view_cards[i];
        if (!card->depth.z) continue;
        c->depth_count++;
        c->known += card->depth.known;
        c->inherited = c->inherited < 0 || card->inherited < 0 ? -1 : c->inherited + card->inherited;
        c->segments += card->segments;
        bool known = (card->truth.z && page_depth_range(&card->truth, 0.02, &card->near, &card->far)) ||
                     page_depth_range(&card->depth, 0.02, &card->near, &card->far);
        if (known && picture_from_depth(&card->depth_picture, &card->depth, card->near, card->far, err))
            return err->status;
        if (known && card->truth.z &&
            picture_from_depth(&card->truth_picture, &card->truth, card->near, card->far, err))
            return err->status;
    }
    if (c->depth_count) c->known /= c->depth_count;
    if (c->depth_count && c->inherited > 0) c->inherited /= c->depth_count;
    return ST_OK;
}

enum status contents_read_views(struct contents *c, const char *folder, struct err *err)
{
    char path[PATH_SIZE];
    struct err problem = ERR_INIT;
    snprintf(path, sizeof path, "%s/views", folder);
    if (camera_set_read(&c->views, path, NULL, &problem))
        return contents_note(c, err, "There are no views yet. %s", problem.text);
    c->has_views = true;
    if ((product_path_below(path, folder, PRODUCT_LENSES, NULL, &problem) ||
         lens_list_read(&c->lenses, path, NULL, &problem)) &&
        contents_note(c, err, "The photographs of the views are unknown. %s", problem.text))
        return err->status;
    c->view_cards = calloc((size_t)c->views.view_count + 1, sizeof *c->view_cards);
    if (!c->view_cards) return err_nomem(err, "views", (size_t)c->views.view_count * sizeof *c->view_cards);
    match_photos(c);
    struct view_job job = {c, folder};
    parallel_for((size_t)c->views.view_count, 1, make_view_cards, &job);
    for (int i = 0; i < c->views.view_count; i++)
        if (passing_refuse(c->view_cards[i].problem, err)) return err->status;

    int pictures = 0;
    for (int i = 0; i < c->views.view_count; i++) pictures += c->view_cards[i].picture.rgb != NULL;
    if (colour_depths(c, err) || measure_points(c, err)) return err->status;
    if (pictures < c->views.view_count && contents_note(c, err, "%d of %d views have no rectified picture yet.",
                                                        c->views.view_count - pictures, c->views.view_count))
        return err->status;
    if (c->depth_count < c->views.view_count &&
        contents_note(c, err, "%d of %d views have no depth map yet.", c->views.view_count - c->depth_count,
                      c->views.view_count))
        return err->status;
    return ST_OK;
}
