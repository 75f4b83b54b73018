/* user_model.c - models that the user already has.
 *
 * What is looked for, in this order: a COLMAP model in the folder; COLMAP models in its subfolders 0, 1, ... until
 * one is missing; the same in its folder sparse; models of other programs in the folder. Rigs and frames that COLMAP
 * writes since 3.12 repeat the poses of images.txt and are not read.
 *
 * All models take one way, whatever their format. The reader of the format makes a model whose images are named as in
 * the user's files; its errors name these. Then the points are judged by the photos (given_points.c). Where they do not
 * serve, points are triangulated with the given cameras (triangulate.c), and the points that serve more photos are
 * kept; points that no photo observes stay in the model and say where the scene is (sfm_import). Poses of panoramas
 * become those of their views before that (panorama_poses.c).
 *
 * All models end as COLMAP text in one form (sfm_folder.c), so that no later stage knows where a model came from.
 * The hashes of the files that were read go into the provenance. */
#include "stages/sfm/user_model.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "common/base/file_path.h"
#include "common/base/log.h"
#include "stages/sfm/bundler_model.h"
#include "stages/sfm/csv_model.h"
#include "stages/sfm/given_points.h"
#include "stages/sfm/metashape_model.h"
#include "stages/sfm/panorama_poses.h"
#include "stages/sfm/transforms_model.h"
#include "stages/sfm/triangulate.h"

/* What is done with each model that is found. The visitor may change the model. */
struct model_visitor {
    enum status (*visit)(void *ctx, struct sfm_model *m, struct err *err);
    void *ctx;
    int count; /* models so far */
};

/* Where models are looked for. */
struct model_search {
    const struct photo_list *photos;
    struct provenance *prov; /* NULL: the files are not recorded */
    struct model_visitor *visitor;
};

static enum status take_model(const struct model_search *s, struct sfm_model *m, struct err *err)
{
    int panoramas = 0;
    if (!err->status) panorama_poses_expand(&panoramas, m, s->photos, err);
    if (!err->status && panoramas && s->prov) log_note("the poses of %d panoramas are those of their views", panoramas);
    if (!err->status && !s->visitor->visit(s->visitor->ctx, m, err)) s->visitor->count++;
    sfm_model_release(m);
    return err->status;
}

/* --------------------------------------------------------------------------------------------------------- COLMAP */

static bool has_file(const char *folder, const char *file, const char *ending)
{
    struct err ignored = ERR_INIT;
    char path[FILE_PATH];
    return !file_path(path, folder, file, ending, &ignored) && path_is_file(path);
}

/* Adds the hashes of the files that exist. */
static enum status add_inputs(const struct model_search *s, const char *folder, const char *ending, struct err *err)
{
    static const char *const files[] = {"cameras", "images", "points3D"};
    char path[FILE_PATH], name[64];
    for (size_t i = 0; s->prov && !err->status && i < sizeof files / sizeof *files; i++) {
        if (!has_file(folder, files[i], ending)) continue;
        snprintf(name, sizeof name, "model/%d/%s%s", s->visitor->count, files[i], ending);
        if (!file_path(path, folder, files[i], ending, err)) provenance_add_file(s->prov, name, path, err);
    }
    return err->status;
}

static bool has_parts(const char *folder, const char *ending)
{
    return has_file(folder, "cameras", ending) && has_file(folder, "images", ending);
}

/* *ending: of the files of the model in a folder; NULL: there is none. ST_DATA: there are only images. */
static enum status find_parts(const char **ending, const char *folder, struct err *err)
{
    static const char *const endings[] = {".txt", ".bin"};
    *ending = NULL;
    for (int i = 0; i < 2 && !*ending; i++)
        if (has_parts(folder, endings[i])) *ending = endings[i];
    for (int i = 0; i < 2 && !*ending; i++)
        if (has_file(folder, "images", endings[i]))
            return err_set(err, ST_DATA, "%s has images%s but no cameras%s; put both files of the model there.", folder,
                           endings[i], endings[i]);
    return ST_OK;
}

/* *found: whether the folder itself contains a COLMAP model. */
static enum status try_colmap(const struct model_search *s, const char *folder, bool *found, struct err *err)
{
    struct sfm_model m = {0};
    long long loose = 0;
    const char *ending = NULL;
    *found = !find_parts(&ending, folder, err) && ending;
    if (!*found || add_inputs(s, folder, ending, err)) return err->status;
    if (!strcmp(ending, ".txt"))
        sfm_model_read_given_text(&m, folder, &loose, err);
    else
        sfm_model_read_given_binary(&m, folder, &loose, err);
    if (!err->status && loose)
        log_note("%s: %lld entries of tracks refer to no observation of their point and are left out", folder, loose);
    return take_model(s, &m, err);
}

/* Models in the folder, or in its subfolders 0, 1, ... */
static enum status find_colmap(const struct model_search *s, const char *folder, struct err *err)
{
    bool found = false, next = true;
    try_colmap(s, folder, &found, err);
    for (int k = 0; !err->status && !found && next; k++) {
        char name[16], path[FILE_PATH];
        snprintf(name, sizeof name, "%d", k);
        next = false;
        if (!file_path(path, folder, name, "", err)) try_colmap(s, path, &next, err);
    }
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------ all */

/* Readers of models that are one of their kind in a folder. */
static enum status (*const readers[])(struct sfm_model *m, bool *found, const char *folder,
                                      const struct photo_list *photos, struct provenance *prov, struct err *err) = {
    transforms_model_read,
    metashape_model_read,
    csv_model_read,
    bundler_model_read,
};

static enum status find_models(const struct model_search *s, const char *from, struct err *err)
{
    char sparse[FILE_PATH];
    if (access(from, R_OK | X_OK)) return err_errno(err, "open", from);
    if (find_colmap(s, from, err) || file_path(sparse, from, "sparse", "", err)) return err->status;
    if (!s->visitor->count) find_colmap(s, sparse, err);
    for (size_t i = 0; !err->status && !s->visitor->count && i < sizeof readers / sizeof *readers; i++) {
        struct sfm_model m = {0};
        bool found = false;
        readers[i](&m, &found, from, s->photos, s->prov, err);
        if (found) take_model(s, &m, err);
    }
    if (!err->status && !s->visitor->count)
        err_set(err, ST_DATA,
                "%s contains no structure-from-motion model; wanted COLMAP's cameras, images and points3D (.txt or "
                ".bin), in it or in its subfolders 0, 1, ...; transforms.json; Metashape's .xml; RealityScan's .csv of "
                "internal and external camera parameters; or a Bundler file (.out, beginning with \"# Bundle file\") "
                "with its list of images.",
                from);
    return err->status;
}

struct adding {
    struct sfm_folder *folder;
    const struct sfm_input *in;
    const struct provenance *prov;
};

/* Triangulates points for a model whose own do not serve; keeps what serves more photos. */
static enum status find_points(struct sfm_model *m, const struct point_support *own, const struct adding *a,
                               struct err *err)
{
    struct sfm_model found = {0};
    struct point_support s = {0};
    if (triangulate(&found, m, a->folder, a->in, err) || !found.point_count ||
        given_points_count(&s, &found, a->in->list, err)) {
        sfm_model_release(&found);
        return err->status;
    }
    const bool better = s.supported > own->supported || (s.supported == own->supported && s.shared > own->shared);
    struct sfm_model *worse = better ? m : &found;
    sfm_model_release(worse);
    if (better) *m = found;
    return ST_OK;
}

static enum status add_model(void *ctx, struct sfm_model *m, struct err *err)
{
    const struct adding *a = ctx;
    struct point_support own = {0};
    log_note("model %d: %d images, %d points", a->folder->models, m->image_count, m->point_count);
    if (given_points_count(&own, m, a->in->list, err)) return err->status;
    if (!given_points_suffice(&own)) {
        if (m->point_count)
            log_note("of its points, %lld are seen by two photos or more, and %d of %d photos see %d of them: too few",
                     own.shared, own.supported, own.placed, MIN_SHARED_POINTS);
        find_points(m, &own, a, err);
    }
    if (!err->status) sfm_folder_add(a->folder, m, a->prov, err);
    return err->status;
}

enum status user_model_add(struct sfm_folder *f, const char *from, const struct sfm_input *in, struct provenance *prov,
                           struct err *err)
{
    struct adding a = {f, in, prov};
    struct model_visitor v = {add_model, &a, 0};
    f->given = "model";
    return find_models(&(struct model_search){in->list, prov, &v}, from, err);
}

struct judging {
    const struct photo_list *photos;
    bool suffice;
};

static enum status judge_model(void *ctx, struct sfm_model *m, struct err *err)
{
    struct judging *j = ctx;
    struct point_support s = {0};
    if (!given_points_count(&s, m, j->photos, err)) j->suffice = j->suffice && given_points_suffice(&s);
    return err->status;
}

enum status user_model_judge(bool *suffice, const char *from, const struct photo_list *photos, struct err *err)
{
    struct judging j = {photos, true};
    struct model_visitor v = {judge_model, &j, 0};
    find_models(&(struct model_search){photos, NULL, &v}, from, err);
    *suffice = j.suffice;
    return err->status;
}
