/* flat_marks.c - see flat_marks.h. The picture is that of the view which shows the marked pixel farthest from its
 * border, of those that the marked photo was divided into. */
#include "stages/find_things/flat_marks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/capture/view_image.h"
#include "common/product/product.h"
#include "common/texture/view_ids.h"
#include "stages/find_things/flat_edges.h"

#define GRADE 0.6f /* of a pixel of clutter, from trace_ids */

static int marks_of(const struct thing_marks *marks, int name)
{
    int count = 0;
    for (int k = 0; k < marks->mark_count; k++) count += marks->marks[k].name == name;
    return count;
}

/* Whether a view is of the photo that a mark names. */
static bool is_of(const char *view, const char *photo)
{
    const size_t n = strlen(photo);
    return !strncmp(view, photo, n) && (!view[n] || view[n] == '@');
}

/* The view that shows a point best; -1: none. */
static int best_view(const struct flat_pictures *p, const char *photo, struct vec3 point, int pixel[2])
{
    double farthest = 0;
    int best = -1;
    for (int i = 0; i < p->in->set.view_count; i++) {
        const struct view camera = model_from_world_view(&p->in->axes, &p->in->set.views[i]);
        double u, v;
        if (!is_of(camera.name, photo) || !(view_project(&camera, point, &u, &v) > 0)) continue;
        const double inside = fmin(fmin(u, camera.width - u), fmin(v, camera.height - v));
        if (!(inside > farthest)) continue;
        farthest = inside;
        best = i;
        pixel[0] = (int)u;
        pixel[1] = (int)v;
    }
    return best;
}

/* Whether each pixel shows the face, normal . X = offset, with nothing before it. */
static void find_open(uint8_t *open, const struct view_ids *ids, const struct view *camera, double scale,
                      const struct ray_hit *face, double slack)
{
    for (int y = 0; y < camera->height; y++)
        for (int x = 0; x < camera->width; x++) {
            const size_t i = (size_t)y * (size_t)camera->width + (size_t)x;
            open[i] = 0;
            if (!(ids->z[i] > 0) || ids->clutter[i] > GRADE) continue;
            const struct vec3 p = view_unproject(camera, x + 0.5, y + 0.5, scale * (double)ids->z[i]);
            open[i] = fabs(vec3_dot(face->normal, vec3_sub(p, face->point))) <= slack;
        }
}

static enum status add(struct thing_marks *all, const struct thing_mark *mark, struct err *err)
{
    if (!array_append(&all->marks, (size_t)all->mark_count, sizeof *mark, "marks", err))
        all->marks[all->mark_count++] = *mark;
    return err->status;
}

/* Adds the corners around the one pixel of a flat thing. */
static enum status add_corners(struct thing_marks *all, const struct thing_mark *m, const char *name,
                               const struct flat_pictures *p, double slack, struct err *err)
{
    struct image photo = {0};
    struct view_ids ids = {0};
    struct flat_corner *corners = NULL;
    struct ray_hit hit;
    char path[FILE_PATH];
    int pixel[2], count = 0;
    if (!ray_scene_hit(&p->model->rays, model_from_world_point(&p->in->axes, m->origin),
                       model_from_world_direction(&p->in->axes, m->direction), &hit))
        return err_set(err, ST_DATA, "things.txt:%d: the pixel %.6g %.6g of %s in %s shows no face of the model.",
                       m->line, m->u, m->v, name, m->view);
    const int at = best_view(p, m->view, hit.point, pixel);
    if (at < 0)
        return err_set(err, ST_DATA, "things.txt:%d: no view of %s shows the pixel %.6g %.6g of %s. Mark another one.",
                       m->line, m->view, m->u, m->v, name);
    const struct view *view = &p->in->set.views[at], camera = model_from_world_view(&p->in->axes, view);
    uint8_t *open = malloc((size_t)view->width * (size_t)view->height + 1);
    if (!open) err_nomem(err, "the face in a view", (size_t)view->width * (size_t)view->height);
    if (!err->status && !view_image_read(&photo, p->views, view, p->prov, err) &&
        !product_path_in(path, p->ids, PRODUCT_IDS, &(struct product_key){.view = view->name}, err) &&
        !view_ids_read(&ids, view, path, p->prov, err)) {
        find_open(open, &ids, &camera, p->in->axes.scale, &hit, slack);
        flat_edges_find(&corners, &count, &photo, open, pixel[0], pixel[1], err);
    }
    if (!err->status && !count)
        err_set(err, ST_DATA,
                "things.txt:%d: no colour edge goes around the pixel %.6g %.6g of %s in %s. Mark a pixel of its main "
                "colour in a photo that shows all of it, or give three corners of its outline or more.",
                m->line, m->u, m->v, name, m->view);
    for (int k = 0; !err->status && k < count; k++) {
        struct thing_mark corner = *m;
        corner.origin = view->center;
        corner.direction = vec3_sub(view_unproject(view, corners[k].u, corners[k].v, 1), view->center);
        add(all, &corner, err);
    }
    free(corners);
    free(open);
    image_release(&photo);
    view_ids_release(&ids);
    return err->status;
}

void flat_marks_release(struct thing_marks *all)
{
    free(all->marks);
    *all = (struct thing_marks){0};
}

enum status flat_marks_complete(struct thing_marks *all, const struct thing_marks *marks,
                                const struct flat_pictures *pictures, double slack, struct err *err)
{
    *all = *marks;
    all->marks = NULL;
    all->mark_count = 0;
    for (int k = 0; !err->status && k < marks->mark_count; k++) {
        const struct thing_mark *m = &marks->marks[k];
        if (marks->flat[m->name] && marks_of(marks, m->name) == 1)
            add_corners(all, m, marks->names[m->name], pictures, slack, err);
        else
            add(all, m, err);
    }
    if (err->status) flat_marks_release(all);
    return err->status;
}
