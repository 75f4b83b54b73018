/* evaluate_shell.c - pictures of the room without its furniture against TRUTH/shell: shell.*, apart for what the
 * furniture hides from the camera and what it does not. */
#include "stages/evaluate/render/render_metrics.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/sort.h"
#include "stages/evaluate/render/shell_error.h"
#include "stages/evaluate/scene/renders.h"
#include "stages/evaluate/scene/true_planes.h"
#include "stages/evaluate/truth/true_faces.h"

static const char *const suffixes[SHELL_PARTS] = {"_seen", "_hidden"};

static enum status measure(struct evaluation *e, const struct renders *list, struct render *r,
                           struct shell_error *errors, int *measured, struct err *err)
{
    char shell_path[FILE_PATH], whole_path[FILE_PATH];
    struct image truth = {0};
    if (!true_set_file(shell_path, list->set, "ids", r->of->name) ||
        !true_plain_file(whole_path, e, "ids", r->of->name))
        return metric_note(&e->table, err, "skipped %s of shell: the truth has no ids of it with and without furniture",
                           r->name);
    const size_t pixels = (size_t)r->map.lens.width * (size_t)r->map.lens.height;
    uint32_t *ids = malloc(2 * pixels * sizeof *ids);
    if (!ids) err_nomem(err, "ids", 2 * pixels * sizeof *ids);
    if (!err->status && !render_read(e, list, r, &truth, err) && !true_ids_seen(ids, e, shell_path, &r->map, err) &&
        !true_ids_seen(ids + pixels, e, whole_path, &r->map, err)) {
        const struct shell_pixels p = {
            {r->picture.rgb.data, truth.data, NULL, pixels, r->scale, r->picture.encoded ? e->white : 0},
            ids,
            ids + pixels};
        *measured += !shell_error_add(errors, &p, err);
    }
    image_release(&truth);
    linear_picture_release(&r->picture);
    free(ids);
    return err->status;
}

/* Rows of the faces, and the median and the maximum over them. */
static enum status add_faces(struct evaluation *e, struct shell_error *errors, const struct true_faces *faces, int part,
                             struct err *err)
{
    char name[64], view[300], worst[256] = "";
    int count = 0;
    double *medians = malloc(((size_t)errors->face_count + 1) * sizeof *medians), most = -1;
    if (!medians) err_nomem(err, "medians", (size_t)errors->face_count * sizeof *medians);
    snprintf(name, sizeof name, "error50%s", suffixes[part]);
    for (int i = 1; !err->status && i < errors->face_count; i++) {
        if (!shell_face_median(errors, i, part, &medians[count])) continue;
        const double middle = medians[count++];
        if (i <= faces->count && faces->faces[i - 1].name)
            snprintf(view, sizeof view, "face/%.250s", faces->faces[i - 1].name);
        else
            snprintf(view, sizeof view, "face/%d", i);
        evaluation_metric(e, view, "shell", name, 100 * middle, err);
        if (!(middle > most)) continue;
        most = middle;
        snprintf(worst, sizeof worst, "%.250s", view + 5);
    }
    snprintf(name, sizeof name, "faces%s", suffixes[part]);
    if (!err->status && count)
        evaluation_metric(e, NULL, "shell", name, 100 * sort_median(medians, (size_t)count), err);
    snprintf(name, sizeof name, "faces_max%s", suffixes[part]);
    if (!err->status && count) evaluation_metric(e, NULL, "shell", name, 100 * most, err);
    if (!err->status && count) metric_note(&e->table, err, "note: shell.%s is that of %s", name, worst);
    free(medians);
    return err->status;
}

static enum status add_all(struct evaluation *e, struct shell_error *errors, int pictures, struct err *err)
{
    struct true_faces faces = {0};
    char path[FILE_PATH], name[64];
    uint64_t pixels = 0;
    double rms;
    file_path(path, e->truth_folder, "faces.txt", "", err);
    if (!err->status && path_is_file(path)) true_faces_read(&faces, path, err);
    if (!err->status) evaluation_metric(e, NULL, "shell", "pictures", pictures, err);
    for (int k = 0; k < SHELL_PARTS; k++) pixels += errors->all[k].pixels;
    if (!err->status && pixels)
        evaluation_metric(e, NULL, "shell", "hidden", 100 * (double)errors->all[SHELL_HIDDEN].pixels / (double)pixels,
                          err);
    for (int k = 0; !err->status && k < SHELL_PARTS; k++) {
        struct radiance_error *r = &errors->all[k];
        snprintf(name, sizeof name, "rms%s", suffixes[k]);
        if (radiance_error_rms(r, &rms)) evaluation_metric(e, NULL, "shell", name, 100 * rms, err);
        snprintf(name, sizeof name, "error50%s", suffixes[k]);
        if (!err->status && r->errors.count)
            evaluation_metric(e, NULL, "shell", name, 100 * quantiles_get(&r->errors, 0.5), err);
        if (!err->status) add_faces(e, errors, &faces, k, err);
    }
    true_faces_release(&faces);
    return err->status;
}

enum status evaluate_shell(struct evaluation *e, struct err *err)
{
    struct true_set set = {0};
    struct renders list = {0};
    struct shell_error errors = {0};
    int measured = 0;
    true_set_read(&set, e->truth_folder, "shell", e->prov, err);
    if (!err->status && !set.count)
        return metric_note(&e->table, err, "skipped texture errors: the truth has no shell");
    if (!err->status) renders_find(&list, e, &set, err);
    if (!err->status && list.count) renders_scale(e, &list, err);
    if (!err->status && list.count && e->white > 0) {
        shell_error_init(&errors, err);
        for (int i = 0; !err->status && i < list.count; i++) measure(e, &list, &list.list[i], &errors, &measured, err);
        if (!err->status && measured) add_all(e, &errors, measured, err);
    }
    shell_error_release(&errors);
    renders_release(&list);
    true_set_release(&set);
    return err->status;
}
