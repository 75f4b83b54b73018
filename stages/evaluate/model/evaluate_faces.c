/* evaluate_faces.c - faces that the model and its edits show from the true cameras: model.faces, edited.E.faces. */
#include "stages/evaluate/model/model_metrics.h"

#include <stdlib.h>
#include <string.h>

#include "common/image/exr.h"
#include "stages/evaluate/model/face_agreement.h"
#include "stages/evaluate/scene/traced_model.h"
#include "stages/evaluate/truth/true_faces.h"
#include "stages/evaluate/truth/wall_plan.h"

struct faces_job { /* one model against one scene */
    const char *prefix;
    struct true_set set;
    struct true_faces truth;
    struct model_rays model;
    struct model_frame frame;
    struct face_agreement agreement;
    const char **names; /* of the pictures that were added */
};

static enum status read_ids(struct exr_image *im, const char *path, const struct camera *lens, struct err *err)
{
    static const char *const names[] = {"id"};
    if (exr_read(im, path, names, 1, err)) return err->status;
    if (!exr_find(im, "id")->u) return err_set(err, ST_DATA, "%s: channel id holds no integers, wanted uint.", path);
    if (im->width == lens->width && im->height == lens->height) return ST_OK;
    return err_set(err, ST_DATA, "%s is %d x %d px, but the truth's camera is %d x %d px.", path, im->width, im->height,
                   lens->width, lens->height);
}

static enum status add_input(struct evaluation *e, const char *path, struct err *err)
{
    char name[FILE_PATH];
    snprintf(name, sizeof name, "truth%s", path + strlen(e->truth_folder));
    return provenance_add_file(e->prov, name, path, err);
}

/* Adds one picture, if the truth has its ids and its depth. */
static enum status add_picture(struct evaluation *e, struct faces_job *job, const struct true_picture *p,
                               struct err *err)
{
    char ids_path[FILE_PATH], depth_path[FILE_PATH];
    if (!true_set_file(ids_path, &job->set, "ids", p->name)) return ST_OK;
    if (!true_set_file(depth_path, &job->set, "depth", p->name)) return ST_OK;
    const size_t pixels = (size_t)p->lens.width * (size_t)p->lens.height;
    struct true_photo photo = {.lens = p->lens, .pose = p->pose};
    struct exr_image im = {0};
    struct vec3 *points = malloc(pixels * sizeof *points);
    uint32_t *ids = malloc(pixels * sizeof *ids);
    float *distance = malloc(pixels * sizeof *distance);
    if (!points || !ids || !distance) err_nomem(err, "faces", pixels * sizeof *points);
    if (!err->status && !add_input(e, ids_path, err) && !add_input(e, depth_path, err) &&
        !read_ids(&im, ids_path, &p->lens, err) && !truth_photo_read_depth(&photo, depth_path, e->params->far, err)) {
        true_points(points, &photo);
        traced_model_faces(ids, distance, &job->model, &job->frame, p, points);
        const struct face_pixels pair = {exr_find(&im, "id")->u, ids, distance, p->lens.width, p->lens.height};
        struct err why = ERR_INIT;
        face_agreement_add(&job->agreement, &pair, &why);
        if (why.status) err_set(err, why.status, "%s: %s", ids_path, why.text);
    }
    if (!err->status) job->names[job->agreement.picture_count - 1] = p->name;
    exr_image_release(&im);
    free(photo.depth);
    free(points);
    free(ids);
    free(distance);
    return err->status;
}

/* Which true faces count: all of a shell; otherwise those of walls, openings and rooms. */
static enum status choose_faces(struct faces_job *job, bool shell, const char *scene, struct err *err)
{
    struct face_agreement *a = &job->agreement;
    struct measured_plan plan = {0};
    if (!shell) wall_plan_read(&plan, scene, PLAN_FROM_SCENE, err);
    a->counted[0] = true;
    for (int i = 0; !err->status && i < job->truth.count; i++) {
        const char *name = job->truth.faces[i].name;
        if (!name) continue;
        a->true_normals[i + 1] = job->truth.faces[i].normal;
        a->counted[i + 1] = shell || wall_plan_has(&plan.faces, name) || wall_plan_has(&plan.openings, name) ||
                            wall_plan_has(&plan.rooms, name);
    }
    wall_plan_release(&plan);
    const struct mat3 world_from_scene = job->frame.truth_from_scene.rotation;
    for (int i = 0; !err->status && i < job->model.mesh.face_count; i++)
        a->model_normals[solid_face_id(&job->model.mesh, i)] =
            mat3_apply(world_from_scene, world_from_model_direction(&job->frame.axes, job->model.mesh.faces[i].normal));
    return err->status;
}

static enum status add_shares(struct evaluation *e, const struct faces_job *job, struct err *err)
{
    const struct face_agreement *a = &job->agreement;
    for (int i = -1; i < a->picture_count; i++) {
        const struct face_shares s = face_shares_of(a, i);
        const char *view = i < 0 ? NULL : job->names[i];
        if (!s.counted) continue;
        if (evaluation_metric(e, view, job->prefix, "faces", 100 * (double)s.agreeing / (double)s.counted, err))
            return err->status;
        if (i >= 0) continue;
        if (evaluation_metric(e, NULL, job->prefix, "faces_measured", 100 * (double)s.counted / (double)s.all, err))
            return err->status;
        if (s.worst >= 0 && metric_note(&e->table, err, "note: most pixels that %s.faces misses are on %s", job->prefix,
                                        s.worst ? job->truth.faces[s.worst - 1].name : "the outdoors"))
            return err->status;
    }
    if (face_shares_of(a, -1).counted) return ST_OK;
    return metric_note(&e->table, err, "skipped faces of %s: the truth has no ids with depths of its pictures",
                       job->prefix);
}

static enum status run_job(struct evaluation *e, struct faces_job *job, const char *model, const char *faces,
                           const char *scene, bool shell, struct err *err)
{
    static const struct mat3 same = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    char path[FILE_PATH];
    if (!evaluation_path(path, e, PRODUCT_MODEL, &(struct product_key){.model = model}, err) &&
        !model_rays_read(&job->model, path, MODEL_WITHOUT_GLASS, e->prov, err))
        model_frame_read(&job->frame, e, same, vec3_make(0, 0, 0), err);
    if (!err->status && !add_input(e, faces, err) && !true_faces_read(&job->truth, faces, err) &&
        !face_agreement_init(&job->agreement, job->truth.count + 1, job->model.ids, err))
        choose_faces(job, shell, scene, err);
    if (!err->status && !(job->names = calloc((size_t)job->set.count + 1, sizeof *job->names)))
        err_nomem(err, "names", (size_t)job->set.count);
    for (int i = 0; !err->status && i < job->set.count; i++) add_picture(e, job, &job->set.pictures[i], err);
    if (!err->status) add_shares(e, job, err);
    free(job->names);
    face_agreement_release(&job->agreement);
    true_faces_release(&job->truth);
    model_rays_release(&job->model);
    return err->status;
}

/* model: "model" or "remodel/E"; where: the scene's folder in the truth, "" or "edited-E". */
static enum status compare(struct evaluation *e, const char *prefix, const char *model, const char *where,
                           struct err *err)
{
    struct faces_job job = {.prefix = prefix};
    char path[FILE_PATH], folder[80], faces[FILE_PATH], scene[FILE_PATH], shell[80];
    snprintf(folder, sizeof folder, "%s%s", where, *where ? "/" : "");
    if (evaluation_path(path, e, PRODUCT_MODEL, &(struct product_key){.model = model}, err) ||
        file_path(faces, e->truth_folder, folder, "faces.txt", err) ||
        file_path(scene, e->truth_folder, folder, "scene.txt", err))
        return err->status;
    if (!path_is_file(path))
        return metric_note(&e->table, err, "skipped faces of %s: %s/model.txt is missing", prefix, model);
    if (!e->aligned)
        return metric_note(&e->table, err, "skipped faces of %s: the cameras do not tell where the truth is", prefix);
    if (!path_is_file(faces) || !path_is_file(scene))
        return metric_note(&e->table, err, "skipped faces of %s: the truth has no faces.txt and scene.txt of it",
                           prefix);
    snprintf(shell, sizeof shell, "%s%sshell", where, *where ? "/" : "");
    if (file_path(path, e->truth_folder, shell, "/ids", err)) return err->status;
    const bool bare = path_is_folder(path);
    if (!true_set_read(&job.set, e->truth_folder, bare ? shell : where, e->prov, err))
        run_job(e, &job, model, faces, scene, bare, err);
    true_set_release(&job.set);
    return err->status;
}

enum status evaluate_faces(struct evaluation *e, struct err *err)
{
    struct true_edits edits = {0};
    char path[FILE_PATH];
    if (evaluation_path(path, e, PRODUCT_MODEL, NULL, err)) return err->status;
    if (path_is_file(path)) compare(e, "model", "model", "", err);
    if (!err->status) true_edits_find(&edits, e->truth_folder, err);
    for (int i = 0; !err->status && i < edits.count; i++) {
        char prefix[64], model[64], where[64];
        snprintf(prefix, sizeof prefix, "edited.%s", edits.names[i]);
        snprintf(model, sizeof model, "remodel/%s", edits.names[i]);
        snprintf(where, sizeof where, "edited-%s", edits.names[i]);
        compare(e, prefix, model, where, err);
    }
    true_edits_release(&edits);
    return err->status;
}
