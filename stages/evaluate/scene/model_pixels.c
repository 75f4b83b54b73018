/* model_pixels.c - see model_pixels.h. */
#include "stages/evaluate/scene/model_pixels.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const picture_part_suffixes[PICTURE_PARTS] = {"", "_model", "_other"};

enum status model_pixels_read(struct model_pixels *m, struct evaluation *e, const char *where, const char *what,
                              struct err *err)
{
    static const struct mat3 same = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    char path[FILE_PATH];
    *m = (struct model_pixels){.known = false};
    if (evaluation_path(path, e, PRODUCT_MODEL, &(struct product_key){.model = where}, err)) return err->status;
    if (!e->aligned)
        return metric_note(&e->table, err,
                           "skipped %s on surfaces of the model: the cameras do not tell where the truth is", what);
    if (!path_is_file(path))
        return metric_note(&e->table, err, "skipped %s on surfaces of the model: %s/model.txt is missing", what, where);
    if (!model_rays_read(&m->model, path, MODEL_WITHOUT_GLASS, e->prov, err))
        model_frame_read(&m->frame, e, same, vec3_make(0, 0, 0), err);
    m->known = !err->status;
    return err->status;
}

void model_pixels_release(struct model_pixels *m)
{
    model_rays_release(&m->model);
    *m = (struct model_pixels){.known = false};
}

static enum status add_true_input(struct evaluation *e, const char *path, struct err *err)
{
    char name[FILE_PATH];
    snprintf(name, sizeof name, "truth%.4000s", path + strlen(e->truth_folder));
    return provenance_add_file(e->prov, name, path, err);
}

enum status model_pixels_find(uint8_t *part[PICTURE_PARTS], const struct model_pixels *m, struct evaluation *e,
                              const struct true_picture *of, const char *depth, const int32_t *index, size_t count,
                              struct err *err)
{
    const size_t pixels = (size_t)of->lens.width * (size_t)of->lens.height;
    struct true_photo photo = {.lens = of->lens, .pose = of->pose};
    struct vec3 *points = malloc(pixels * sizeof *points);
    uint32_t *ids = malloc(pixels * sizeof *ids);
    float *distance = malloc(pixels * sizeof *distance);
    for (int k = PART_MODEL; k < PICTURE_PARTS; k++) part[k] = calloc(count, 1);
    if (!points || !ids || !distance || !part[PART_MODEL] || !part[PART_OTHER])
        err_nomem(err, "surfaces of the model", pixels * sizeof *points);
    if (!err->status && !add_true_input(e, depth, err)) truth_photo_read_depth(&photo, depth, e->params->far, err);
    if (!err->status) {
        true_points(points, &photo);
        traced_model_faces(ids, distance, &m->model, &m->frame, of, points);
        for (size_t i = 0; i < count; i++) {
            if (index[i] < 0 || !(vec3_length(points[index[i]]) > 0)) continue;
            const bool on = ids[index[i]] && distance[index[i]] <= e->params->surface_distance;
            part[on ? PART_MODEL : PART_OTHER][i] = part[PART_ALL][i];
        }
    }
    free(photo.depth);
    free(points);
    free(ids);
    free(distance);
    return err->status;
}
