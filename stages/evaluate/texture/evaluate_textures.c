/* evaluate_textures.c - texture atlases against what is true of the scene without its furniture: texture.* (those of
 * all viewpoints together) and texture.vita.*.
 *
 * Overview. An atlas should show the room's surfaces as they look without furniture, while the photographs show them
 * with it. The truth has both: pictures and depths of the photographed room, and of its empty shell
 * (shell_points.h). Atlases are read page by page; for each texel of a tile
 *   1. its place on the face is found from the tile's matrix (texel_places.h) and brought into the truth
 *      (model_frame.h)
 *   2. the truth says what radiance the shell has there, and for each photo whether it shows the shell or furniture
 *      in front of it (texel_facts.h)
 *   3. the texel's error goes into its face's sum, by origin (texture_error.h)
 *
 * The metrics of an origin are the median over the faces of their PSNR, so that one large wall does not decide.
 * clutter_avoided: of the texels whose own photo shows clutter of another colour, the share that does not show it.
 * clutter_baked: of the compared texels of known sources, the share that shows clutter. unknown_clean: of the texels
 * that some photo shows clean, the share that was filled all the same.
 *
 * Seams need no truth: gradients across the boundaries of sources against those beside them (texture_seams.h).
 *
 * Without a truth, or where the scale of radiance or the place of the model in the truth is unknown, a note says so. */
#include "stages/evaluate/texture/texture_metrics.h"

#include <stdlib.h>
#include <string.h>

#include "stages/evaluate/texture/texel_facts.h"
#include "stages/evaluate/texture/texture_seams.h"
#include "stages/evaluate/texture/textures.h"

struct texture_job {
    struct textures textures;
    struct model_rays model;
    struct shell_points shell;
    struct model_frame frame;
    struct photo_view *views;
    int view_count;
    bool compared; /* the truth and the scale of radiance are known */
};

struct texture_result { /* of the atlases of a kind */
    const char *prefix;
    struct texture_error error;
    struct texture_seams seams;
    int atlases, unknown_tiles; /* tiles of faces that the unedited model lacks */
    uint64_t texels;
};

static int shell_of_photo(const struct shell_points *s, int photo)
{
    for (int i = 0; photo >= 0 && i < s->count; i++)
        if (s->views[i].photo == photo) return i;
    return -1;
}

/* ------------------------------------------------------------------------------------------------- views of photos */

static enum status read_known(struct photo_view *v, struct evaluation *e, struct err *err)
{
    struct linear_picture picture = {0};
    char path[FILE_PATH];
    if (evaluation_path(path, e, PRODUCT_VIEW, &(struct product_key){.view = v->view->name}, err)) return err->status;
    if (!path_is_file(path)) return ST_OK;
    if (!provenance_add_file(e->prov, product_name(PRODUCT_VIEW, path), path, err))
        linear_picture_read(&picture, path, err);
    if (!err->status && (picture.rgb.width != v->view->width || picture.rgb.height != v->view->height))
        err_set(err, ST_DATA, "%s is %d x %d px, but its camera %d x %d; make it again.", path, picture.rgb.width,
                picture.rgb.height, v->view->width, v->view->height);
    if (!err->status) {
        v->known = picture.known;
        picture.known = NULL;
    }
    linear_picture_release(&picture);
    return err->status;
}

static enum status read_views(struct texture_job *job, struct evaluation *e, struct err *err)
{
    const struct camera_set *cameras = &e->views.cameras;
    job->views = calloc((size_t)cameras->view_count + 1, sizeof *job->views);
    if (!job->views) err_nomem(err, "views", (size_t)cameras->view_count * sizeof *job->views);
    for (int i = 0; !err->status && i < cameras->view_count; i++) {
        const int shell = shell_of_photo(&job->shell, evaluation_photo(e, &e->views, i));
        if (shell < 0 || !job->shell.views[shell].clutter) continue;
        struct photo_view *v = &job->views[job->view_count++];
        *v = (struct photo_view){&cameras->views[i], shell, NULL};
        read_known(v, e, err);
    }
    return err->status;
}

static void job_release(struct texture_job *job)
{
    for (int i = 0; i < job->view_count; i++) free(job->views[i].known);
    free(job->views);
    shell_points_release(&job->shell);
    model_rays_release(&job->model);
    textures_release(&job->textures);
}

/* ------------------------------------------------------------------------------------------------------ one atlas */

struct atlas_truth { /* what an atlas needs of the truth */
    int *source_shell;
    bool *source_own;
    struct image own_photo;
    int own;
};

static void atlas_truth_release(struct atlas_truth *t)
{
    free(t->source_shell);
    free(t->source_own);
    image_release(&t->own_photo);
}

/* TRUTH/hdr of the viewpoint's photo, if it exists. */
static enum status read_own_photo(struct atlas_truth *t, const struct texture_job *job, struct evaluation *e,
                                  struct err *err)
{
    struct linear_picture picture = {0};
    char folder[FILE_PATH], path[FILE_PATH], as[FILE_PATH];
    if (t->own < 0) return ST_OK;
    const struct shell_view *own = &job->shell.views[t->own];
    if (!file_path(folder, e->truth_folder, "hdr", "", err)) file_path(path, folder, own->name, ".exr", err);
    if (err->status || !path_is_file(path)) return err->status;
    if (!file_path(as, "truth/hdr", own->name, ".exr", err) && !provenance_add_file(e->prov, as, path, err))
        linear_picture_read(&picture, path, err);
    if (!err->status && (picture.rgb.width != own->lens.width || picture.rgb.height != own->lens.height))
        err_set(err, ST_DATA, "%s is %d x %d px, but the truth's camera is %d x %d px.", path, picture.rgb.width,
                picture.rgb.height, own->lens.width, own->lens.height);
    if (!err->status) {
        t->own_photo = picture.rgb;
        picture.rgb = (struct image){0};
    }
    linear_picture_release(&picture);
    return err->status;
}

static bool is_own(const struct atlas *a, const char *source)
{
    for (int i = 0; i < a->view_count; i++)
        if (!strcmp(a->views[i], source)) return true;
    return false;
}

static enum status find_sources(struct atlas_truth *t, const struct atlas *a, const struct texture_job *job,
                                struct evaluation *e, struct err *err)
{
    const size_t count = (size_t)a->source_count + 1;
    t->own = a->viewpoint ? shell_of_photo(&job->shell, photo_list_find_id(&e->photos, a->viewpoint)) : -1;
    t->source_shell = malloc(count * sizeof *t->source_shell);
    t->source_own = malloc(count * sizeof *t->source_own);
    if (!t->source_shell || !t->source_own) return err_nomem(err, "sources", count * sizeof *t->source_shell);
    for (int i = 0; i < a->source_count; i++) {
        const int view = camera_set_find(&e->views.cameras, a->sources[i]);
        if (view < 0)
            return err_set(err, ST_DATA, "%s: source %s is none of the scene's views; bake it again.",
                           a->viewpoint ? a->viewpoint : "vita", a->sources[i]);
        t->source_shell[i] = shell_of_photo(&job->shell, evaluation_photo(e, &e->views, view));
        t->source_own[i] = is_own(a, a->sources[i]);
    }
    return read_own_photo(t, job, e, err);
}

static uint64_t texels_in(const struct atlas_page *page, const struct atlas_tile *tile)
{
    uint64_t count = 0;
    for (int y = tile->y; y < tile->y + tile->height; y++)
        for (int x = tile->x; x < tile->x + tile->width; x++)
            count += page->source[(size_t)y * (size_t)page->width + (size_t)x] != ATLAS_NONE;
    return count;
}

static enum status add_tile(struct texture_result *r, const struct texture_job *job, const struct texel_truth *truth,
                            const struct atlas_page *page, const struct atlas_tile *tile, struct err *err)
{
    const int face = textures_face(&job->textures, tile->face);
    r->texels += texels_in(page, tile);
    const size_t count = (size_t)tile->width * (size_t)tile->height;
    texture_seams_add(&r->seams, page, tile, job->compared ? truth->white / truth->scale : 1);
    if (face < 0) r->unknown_tiles++;
    if (face < 0 || !job->compared || solid_face_is_pane(&job->textures.mesh, face)) return ST_OK;
    struct texel_facts *facts = malloc(count * sizeof *facts);
    if (!facts) return err_nomem(err, "texels", count * sizeof *facts);
    const struct solid_face *f = &job->textures.mesh.faces[face];
    texel_facts_of_tile(facts, truth, page, tile, f->normal, f->offset);
    texture_error_add(&r->error, tile->face, facts, count);
    free(facts);
    return ST_OK;
}

/* name: a viewpoint; NULL: the VITA. */
static enum status add_atlas(struct texture_result *r, const struct texture_job *job, struct evaluation *e,
                             const char *name, struct err *err)
{
    struct atlas a = {0};
    struct atlas_truth own = {.own = -1};
    char folder[FILE_PATH];
    if (!textures_read(&a, e, name, err) && !textures_folder(folder, e, name, err)) find_sources(&own, &a, job, e, err);
    const struct texel_truth truth = {&job->frame,   &job->shell, job->views,       job->view_count, e->radiance_scale,
                                      e->white,      &a,          own.source_shell, own.source_own,  own.own,
                                      &own.own_photo};
    for (int i = 0; !err->status && i < a.page_count; i++) {
        struct atlas_page page = {0};
        atlas_page_read(&page, &a, i, folder, NULL, err);
        for (int k = 0; !err->status && k < a.tile_count; k++)
            if (a.tiles[k].page == i) add_tile(r, job, &truth, &page, &a.tiles[k], err);
        atlas_page_release(&page);
    }
    r->atlases += !err->status;
    atlas_truth_release(&own);
    atlas_release(&a);
    return err->status;
}

/* -------------------------------------------------------------------------------------------------------- the table */

static const char *const part_names[TEXTURE_PARTS] = {"psnr_original", "psnr_warped", "psnr_seen", "psnr_synthesised"};

static enum status add_faces(struct evaluation *e, const struct texture_result *r, const struct texture_job *job,
                             struct err *err)
{
    for (int id = 1; id < r->error.face_count; id++)
        for (int k = 0; k < TEXTURE_PARTS; k++) {
            char view[300];
            double db;
            if (!texture_face_psnr(&r->error, id, (enum texture_part)k, &db)) continue;
            snprintf(view, sizeof view, "face/%.250s",
                     solid_face_name(&job->textures.mesh, textures_face(&job->textures, id)));
            if (evaluation_metric(e, view, r->prefix, part_names[k], db, err)) return err->status;
        }
    return ST_OK;
}

static enum status add_share(struct evaluation *e, const struct texture_result *r, const char *name, uint64_t part,
                             uint64_t of, const char *none, struct err *err)
{
    if (!of) return metric_note(&e->table, err, "skipped %s.%s: %s", r->prefix, name, none);
    return evaluation_metric(e, NULL, r->prefix, name, 100 * (double)part / (double)of, err);
}

/* No view is a VITA's own. */
static bool is_vita(const struct texture_result *r) { return !strcmp(r->prefix, "texture.vita"); }

static enum status add_errors(struct evaluation *e, const struct texture_result *r, const struct texture_job *job,
                              struct err *err)
{
    const struct texture_error *t = &r->error;
    for (int k = is_vita(r) ? TEXTURE_WARPED : TEXTURE_ORIGINAL; !err->status && k < TEXTURE_PARTS; k++) {
        double db = 0;
        bool found = false;
        texture_median_psnr(t, (enum texture_part)k, &db, &found, err);
        if (!err->status && found) evaluation_metric(e, NULL, r->prefix, part_names[k], db, err);
        if (!err->status && !found)
            metric_note(&e->table, err, "skipped %s.%s: no face has %d of these texels with a true radiance", r->prefix,
                        part_names[k], MIN_FACE_TEXELS);
    }
    if (!err->status) add_share(e, r, "compared", t->compared, t->texels, "no texel belongs to a known face", err);
    if (!err->status && !is_vita(r))
        add_share(e, r, "clutter_avoided", t->avoided, t->clutter,
                  "no texel's own photo is known to show clutter of another colour", err);
    if (!err->status)
        add_share(e, r, "clutter_baked", t->baked, t->from_views,
                  "no texel has both a true radiance and a source whose clutter is known", err);
    if (!err->status && !add_share(e, r, "unknown_clean", t->clean_unknown, t->clean,
                                   "no photo is known to show any texel's surface", err))
        add_faces(e, r, job, err);
    return err->status;
}

static enum status add_result(struct evaluation *e, const struct texture_result *r, const struct texture_job *job,
                              struct err *err)
{
    double ratio;
    if (!evaluation_metric(e, NULL, r->prefix, "atlases", r->atlases, err))
        evaluation_metric(e, NULL, r->prefix, "megapixels", 1e-6 * (double)r->texels, err);
    if (!err->status && texture_seams_ratio(&r->seams, &ratio))
        evaluation_metric(e, NULL, r->prefix, "seam_energy", ratio, err);
    else if (!err->status)
        metric_note(&e->table, err, "skipped %s.seam_energy: no two views meet in a tile", r->prefix);
    if (!err->status && r->unknown_tiles)
        metric_note(&e->table, err, "skipped %d tiles of %s: the model before edits lacks their faces",
                    r->unknown_tiles, r->prefix);
    return err->status || !job->compared ? err->status : add_errors(e, r, job, err);
}

/* Reads the truth and the model that it is compared with. */
static enum status read_truth(struct texture_job *job, struct evaluation *e, struct err *err)
{
    static const struct mat3 same = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    char path[FILE_PATH];
    return model_frame_read(&job->frame, e, same, vec3_make(0, 0, 0), err) ||
                   evaluation_path(path, e, PRODUCT_MODEL, NULL, err) ||
                   model_rays_read(&job->model, path, MODEL_WITHOUT_GLASS, e->prov, err) ||
                   shell_points_read(&job->shell, e, &job->model, &job->frame, err) || read_views(job, e, err)
               ? err->status
               : ST_OK;
}

/* Whether texels can be compared with the truth; a note says why not. */
static enum status prepare(struct texture_job *job, struct evaluation *e, struct err *err)
{
    const char *why = NULL;
    evaluation_set_white(e);
    if (!e->truth_folder)
        why = "no TRUTH is given";
    else if (!e->aligned)
        why = "the cameras do not tell where the truth is";
    else if (!(e->radiance_scale > 0))
        why = "the scale of radiance is unknown, because no view of a photo with a true radiance gives it";
    else if (!read_truth(job, e, err) && !job->shell.count)
        why = "the truth has no shell with depths";
    job->compared = !err->status && !why;
    if (why) metric_note(&e->table, err, "skipped errors of textures: %s", why);
    return err->status;
}

static enum status measure(struct texture_job *job, struct evaluation *e, const char *prefix, bool vita,
                           struct err *err)
{
    struct texture_result r = {.prefix = prefix};
    const int count = vita ? job->textures.vita : job->textures.viewpoint_count;
    if (!count) return ST_OK;
    texture_error_init(&r.error, job->textures.ids, err);
    for (int i = 0; !err->status && i < count; i++)
        add_atlas(&r, job, e, vita ? NULL : job->textures.viewpoints[i], err);
    if (!err->status) add_result(e, &r, job, err);
    texture_error_release(&r.error);
    return err->status;
}

enum status evaluate_textures(struct evaluation *e, struct err *err)
{
    struct texture_job job = {0};
    textures_find(&job.textures, e, err);
    if (!err->status && !job.textures.viewpoint_count && !job.textures.vita)
        metric_note(&e->table, err, "skipped textures: both vdta and vita are missing");
    else if (!err->status)
        prepare(&job, e, err);
    if (!err->status && !measure(&job, e, "texture", false, err)) measure(&job, e, "texture.vita", true, err);
    job_release(&job);
    return err->status;
}
