/* triangulate.c - points for a model that has only cameras.
 *
 * Features and matches are those of a full reconstruction; COLMAP's point_triangulator then finds the points
 * with poses and lenses held fixed. The images written for it must have the names and ids of the database.
 *
 * Before that, the verified matches are compared with the given poses. Poses of another convention than COLMAP's still
 * give some points by chance, and a film of them. */
#include "stages/sfm/triangulate.h"

#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/clock.h"
#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/capture/photo_match.h"
#include "stages/sfm/colmap_database.h"
#include "stages/sfm/colmap_log.h"
#include "stages/sfm/colmap_matches.h"
#include "stages/sfm/given_cameras.h"
#include "stages/sfm/pose_agreement.h"

#define AGREE_ROOM    4.0 /* px */
#define SIMILAR_FOCAL 0.1 /* relative; lenses that differ less are one for verifying matches */

/* The lens for verifying matches: the model's, if it has only one, or all are similar. */
static void params_of_model(struct sfm_params *params, const struct sfm_model *known)
{
    const struct camera *c = &known->cameras[0].camera;
    bool similar = true;
    double own[4], other[4];
    camera_focal(c, &own[0], &own[1], &own[2], &own[3]);
    for (int i = 1; i < known->camera_count; i++) {
        const struct camera *d = &known->cameras[i].camera;
        camera_focal(d, &other[0], &other[1], &other[2], &other[3]);
        similar = similar && d->model == c->model && d->width == c->width && d->height == c->height &&
                  fabs(other[0] / own[0] - 1) < SIMILAR_FOCAL;
    }
    if (!similar) {
        if (!sfm_is_equisolid(params)) return;
        strcpy(params->camera_model, "OPENCV_FISHEYE"); /* the model's lenses are used: no start is needed */
        *params->camera_params = '\0';
        return;
    }
    char text[PARAM_TEXT_SIZE] = "";
    size_t used = 0;
    for (int i = 0; i < camera_model_params(c->model) && used < sizeof text; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%.12g", i ? "," : "", c->params[i]);
    if (used >= sizeof text) return;
    snprintf(params->camera_model, sizeof params->camera_model, "%s", camera_model_name(c->model));
    memcpy(params->camera_params, text, sizeof text);
}

/* The images of the model that are photos of the scene, with each different lens once, at the photos' size; images keep
 * the names of the model, which `known` borrows. *fits: false if the photos are of another shape. */
static enum status known_cameras(struct sfm_model *known, bool *fits, const struct sfm_model *m,
                                 const struct photo_list *photos, struct err *err)
{
    const size_t count = (size_t)m->image_count + 1;
    *fits = true;
    known->cameras = calloc(count, sizeof *known->cameras);
    known->images = calloc(count, sizeof *known->images);
    if (!known->cameras || !known->images) return err_nomem(err, "images", count * sizeof *known->images);
    for (int i = 0; i < m->image_count; i++) {
        const int photo = photo_list_match(photos, m->images[i].name);
        struct camera c = m->cameras[m->images[i].camera_idx].camera;
        if (photo < 0) continue;
        if (!camera_resize(&c, photos->photos[photo].info.width, photos->photos[photo].info.height)) *fits = false;
        int at = given_cameras_find(known, &c);
        if (at < 0) {
            at = known->camera_count++;
            known->cameras[at] = (struct sfm_camera){at + 1, c};
        }
        known->images[known->image_count++] = (struct sfm_image){
            .cam_from_world = m->images[i].cam_from_world, .camera_idx = at, .name = m->images[i].name};
    }
    return ST_OK;
}

static bool is_connected(int id, const struct verified_pair *pairs, int count)
{
    for (int i = 0; i < count; i++)
        if (pairs[i].images[0] == id || pairs[i].images[1] == id) return true;
    return false;
}

/* Gives an image the places of its photo's features, as they are in the database. COLMAP 3.8 takes them from there, but
 * 3.10 ends in an error if it has to. */
static enum status set_places(struct sfm_image *image, const struct colmap_job *job, int photo, struct err *err)
{
    struct feature_list list = {0};
    if (colmap_matches_features(&list, job, photo, err)) return err->status;
    image->observations = malloc(((size_t)list.count + 1) * sizeof *image->observations);
    if (!image->observations) err_nomem(err, "places of features", (size_t)list.count * sizeof *image->observations);
    for (int i = 0; !err->status && i < list.count; i++)
        image->observations[i] = (struct sfm_observation){list.features[i].x, list.features[i].y, -1};
    if (!err->status) image->observation_count = list.count;
    feature_list_release(&list);
    return err->status;
}

/* Known images as the database has them. */
struct known_images {
    struct sfm_image *connected, *alone; /* those that match another one, and the others; names and places are owned */
    int connected_count, alone_count;
};

static void release_images(struct sfm_image *images, int count)
{
    for (int i = 0; images && i < count; i++) {
        free(images[i].observations);
        free(images[i].name);
    }
    free(images);
}

/* Finds the images of known cameras that COLMAP took, with their names and ids in the database. */
static enum status find_images(struct known_images *k, const struct colmap_job *job, const struct sfm_model *known,
                               struct err *err)
{
    const size_t count = (size_t)known->image_count + 1;
    struct colmap_database *db = NULL;
    struct verified_pair *pairs = NULL;
    int pair_count = 0;
    k->connected = calloc(count, sizeof *k->connected);
    k->alone = calloc(count, sizeof *k->alone);
    if (!k->connected || !k->alone) err_nomem(err, "images", count * sizeof *k->alone);
    if (!err->status && !colmap_database_open(&db, job->database, err))
        colmap_database_pairs(&pairs, &pair_count, db, err);
    for (int i = 0; !err->status && i < known->image_count; i++) {
        const int photo = photo_list_match(job->photos, known->images[i].name);
        const struct photo_record *p = &job->photos->photos[photo];
        struct sfm_image image = known->images[i];
        int id = 0;
        image.name = sfm_text_format(err, "%s%s", p->id, colmap_extension(p->file));
        if (!image.name || colmap_database_image_id(&id, db, image.name, err) || !id) {
            free(image.name);
            continue;
        }
        image.id = id;
        const bool connected = is_connected(id, pairs, pair_count);
        struct sfm_image *to = connected ? &k->connected[k->connected_count++] : &k->alone[k->alone_count++];
        *to = image;
        if (connected) set_places(to, job, photo, err);
    }
    free(pairs);
    colmap_database_close(db);
    if (!err->status && k->connected_count + k->alone_count < 2)
        err_set(err, ST_DATA,
                "the model has no points, and none can be triangulated: only %d of its %d images are readable photos "
                "of the scene. Use the model of these photos.",
                k->connected_count + k->alone_count, known->image_count);
    return err->status;
}

/* Reads the model that COLMAP's triangulator made. */
static enum status read_made(struct sfm_model *found, const struct colmap_job *job, const char *made, struct err *err)
{
    char *text = sfm_text_format(err, "%s-text", made);
    const char *args[] = {"model_converter", "--input_path", made, "--output_path", text, "--output_type", "TXT", NULL};
    sfm_model_release(found);
    if (text && !outfile_make_folders(text, err) && !colmap_run(job->logs[3], args, 0, err))
        sfm_model_read_text(found, text, NULL, err);
    free(text);
    return err->status;
}

/* Runs COLMAP's triangulator on the cameras in `known`; `found` has no points if it found none. Version 3.8 then aborts
 * in its bundle adjustment; that is not an error here. Later versions write a model without points. Tracks of two
 * photos, which are more often wrong, are used only if there are no longer ones. */
static enum status find_points(struct sfm_model *found, const struct colmap_job *job, const char *known,
                               const char *made, struct err *err)
{
    for (int pass = 0; !err->status && !found->point_count && pass < 2; pass++) {
        const char *args[] = {"point_triangulator",
                              "--database_path",
                              job->database,
                              "--image_path",
                              job->images,
                              "--input_path",
                              known,
                              "--output_path",
                              made,
                              "--Mapper.num_threads",
                              "1", /* as in colmap_map() */
                              "--Mapper.tri_ignore_two_view_tracks",
                              pass ? "0" : "1",
                              NULL};
        const int aborted = 128 + SIGABRT;
        char line[512];
        int status = 0;
        if (colmap_exit_status(&status, job->logs[2], args, err)) break;
        colmap_log_last_line(line, sizeof line, job->logs[2]);
        if (!status)
            read_made(found, job, made, err);
        else if (status != aborted || !strstr(line, "bundle_adjuster.Solve"))
            colmap_failed(job->logs[2], args[0], status, err);
    }
    return err->status;
}

/* Adds the images that match no other one, which COLMAP was not given, with their cameras. Their names are taken. */
static enum status add_alone(struct sfm_model *found, struct known_images *k, const struct sfm_model *known,
                             struct err *err)
{
    struct sfm_image *images =
        realloc(found->images, ((size_t)found->image_count + (size_t)k->alone_count + 1) * sizeof *images);
    if (!images) return err_nomem(err, "images", (size_t)k->alone_count * sizeof *images);
    found->images = images;
    for (int i = 0; i < k->alone_count; i++) {
        int at = given_cameras_find(found, &known->cameras[k->alone[i].camera_idx].camera);
        if (at < 0) {
            struct sfm_camera *cameras = realloc(found->cameras, ((size_t)found->camera_count + 1) * sizeof *cameras);
            if (!cameras) return err_nomem(err, "cameras", ((size_t)found->camera_count + 1) * sizeof *cameras);
            found->cameras = cameras;
            at = found->camera_count++;
            cameras[at] = known->cameras[k->alone[i].camera_idx];
        }
        struct sfm_image *image = &images[found->image_count++];
        *image = k->alone[i];
        image->camera_idx = at;
        k->alone[i].name = NULL;
    }
    return ST_OK;
}

/* The matches of the pair, as rays. matches: room for them. */
static void add_rays(struct pose_match *matches, int *count, const struct sfm_model *known,
                     const struct sfm_image *images, const int at[2], const struct index_match *inliers,
                     int inlier_count)
{
    const struct camera *c[2];
    double f[2], ignored;
    for (int k = 0; k < 2; k++) {
        c[k] = &known->cameras[images[at[k]].camera_idx].camera;
        camera_focal(c[k], &f[k], &ignored, &ignored, &ignored);
    }
    for (int i = 0; i < inlier_count; i++) {
        struct pose_match *m = &matches[*count];
        const int feature[2] = {inliers[i].first, inliers[i].second};
        bool good = true;
        *m = (struct pose_match){.first = at[0], .second = at[1], .room = AGREE_ROOM / fmin(f[0], f[1])};
        for (int k = 0; good && k < 2; k++) {
            const struct sfm_image *im = &images[at[k]];
            good = feature[k] >= 0 && feature[k] < im->observation_count &&
                   camera_unproject(c[k], im->observations[feature[k]].u, im->observations[feature[k]].v, &m->rays[k]);
        }
        *count += good;
    }
}

static int place_of(const struct known_images *k, int id)
{
    for (int i = 0; i < k->connected_count; i++)
        if (k->connected[i].id == id) return i;
    return -1;
}

/* All verified matches between the images. The caller frees *matches, also after an error. */
static enum status take_rays(struct pose_match **matches, int *count, const struct known_images *k,
                             const struct sfm_model *known, const char *database, struct err *err)
{
    struct colmap_database *db = NULL;
    struct verified_pair *pairs = NULL;
    int pair_count = 0;
    size_t room = 0;
    *matches = NULL;
    *count = 0;
    if (colmap_database_open(&db, database, err)) return err->status;
    colmap_database_pairs(&pairs, &pair_count, db, err);
    for (int i = 0; i < pair_count; i++) room += (size_t)pairs[i].matches;
    if (!err->status && !(*matches = malloc((room + 1) * sizeof **matches)))
        err_nomem(err, "matches", room * sizeof **matches);
    for (int i = 0; !err->status && i < pair_count; i++) {
        const int at[2] = {place_of(k, pairs[i].images[0]), place_of(k, pairs[i].images[1])};
        struct index_match *inliers = NULL;
        int inlier_count = 0;
        if (at[0] >= 0 && at[1] >= 0 && !colmap_database_inliers(&inliers, &inlier_count, db, &pairs[i], err) &&
            inlier_count <= pairs[i].matches)
            add_rays(*matches, count, known, k->connected, at, inliers, inlier_count);
        free(inliers);
    }
    free(pairs);
    colmap_database_close(db);
    return err->status;
}

/* ST_DATA: the poses contradict the photos, and another way to read them does not. */
static enum status compare_poses(const struct known_images *k, const struct sfm_model *known, const char *database,
                                 struct err *err)
{
    enum { ENOUGH = 100 };
    struct pose_match *matches = NULL;
    struct pose_agreement a = {0};
    struct pose *poses = malloc(((size_t)k->connected_count + 1) * sizeof *poses);
    int count = 0;
    if (!poses) err_nomem(err, "poses", (size_t)k->connected_count * sizeof *poses);
    for (int i = 0; !err->status && i < k->connected_count; i++) poses[i] = k->connected[i].cam_from_world;
    if (!err->status && !take_rays(&matches, &count, k, known, database, err))
        pose_agreement_measure(&a, poses, k->connected_count, matches, count, err);
    free(matches);
    free(poses);
    if (err->status || count < ENOUGH || a.share >= AGREE_LEAST) return err->status;
    if (a.best >= AGREE_SURELY)
        return err_set(err, ST_DATA,
                       "the given cameras contradict their photos: of %d matches between photos, %.0f %% are where the "
                       "cameras see them, but %.0f %% would be if their poses, in COLMAP's convention, were read %s. "
                       "Convert the poses, or export them anew.",
                       count, 100 * a.share, 100 * a.best, a.reading);
    log_warn(
        "the given cameras hardly agree with their photos: of %d matches between photos, %.0f %% are within %g px of "
        "where the cameras see them. Are these the poses of these photos, for lenses of this model?",
        count, 100 * a.share, AGREE_ROOM);
    return ST_OK;
}

/* Triangulates points for known cameras. *features: number of the photos' features. */
static enum status triangulate_known(struct sfm_model *found, long long *features, const struct sfm_model *known,
                                     const struct sfm_folder *f, const struct sfm_input *in, struct err *err)
{
    struct colmap_job job = {0};
    struct known_images images = {0};
    struct sfm_params params = *in->params;
    params_of_model(&params, known);
    char *of_known = sfm_text_format(err, "%s/known-%d", f->work, f->models);
    char *made = sfm_text_format(err, "%s/triangulated-%d", f->work, f->models);
    if (of_known && made) colmap_prepare(&job, f, in, &params, err);
    if (!err->status && !outfile_make_folders(made, err) && !colmap_take_matches(features, &job, err))
        find_images(&images, &job, known, err);
    if (!err->status && images.connected_count) compare_poses(&images, known, job.database, err);
    if (!err->status && images.connected_count) {
        const struct sfm_model given = {.cameras = known->cameras,
                                        .camera_count = known->camera_count,
                                        .images = images.connected,
                                        .image_count = images.connected_count};
        log_note("step 3 of %d: points (%.1f s so far)", COLMAP_STEPS, clock_seconds() - job.started);
        if (!sfm_model_write_text(&given, of_known, NULL, err)) find_points(found, &job, of_known, made, err);
    }
    if (!err->status && found->point_count && !add_alone(found, &images, known, err))
        colmap_name_images(found, in->list, err);
    if (!err->status) colmap_keep_logs(&job, err);
    release_images(images.connected, images.connected_count);
    release_images(images.alone, images.alone_count);
    colmap_job_release(&job);
    free(of_known);
    free(made);
    return err->status;
}

enum status triangulate(struct sfm_model *found, const struct sfm_model *m, const struct sfm_folder *f,
                        const struct sfm_input *in, struct err *err)
{
    struct sfm_model known = {0};
    long long features = 0;
    bool fits = false;
    const char *why = NULL;
    *found = (struct sfm_model){0};
    if (!in->features || !in->matches)
        why = "features and matches of the photos were not given";
    else if (!known_cameras(&known, &fits, m, in->list, err) && !fits)
        why = "its cameras differ from the photos in shape";
    if (!err->status && !why) triangulate_known(found, &features, &known, f, in, err);
    if (!err->status && found->point_count)
        log_note("triangulated %d points from the model's cameras", found->point_count);
    else if (!err->status && !why)
        why = features ? "no two photos show the same features where its cameras see them"
                       : "the photos have no features";
    if (!err->status && why)
        log_warn("the model has no points that its photos share, and none can be found: %s. Its cameras are used as "
                 "they are; depths are searched between [segment_depth] near and far or, if these are not set, where "
                 "%s",
                 why, m->point_count ? "its points are" : "the baselines allow it");
    free(known.cameras);
    free(known.images);
    if (err->status) sfm_model_release(found);
    return err->status;
}
