/* mark_light.c - the light of measured places.
 *
 * Luminance. A grid of points over the patch, or over a pixel and its neighbours, is looked up in the views of the
 * photo; its mean counts. White that is clipped is only a lower bound, so that a patch with more than CLIPPED of it is
 * refused.
 *
 * Illuminance. The surface at a pixel is the first one of the model or of its furniture on the pixel's ray. A meter
 * lies on it, on the side of the photo, so that it has the surface's normal; furniture is rough, so that one that
 * looks more up than aside counts as level. Over a face the mean of a grid counts. Irradiance is that of the textured
 * model with its lamps and windows, as gather_irradiance finds it.
 *
 * The expected error of the quotient, as a logarithm, joins the meter's, the gather's own and that of photographs or of
 * irradiance as such (parameters). */
#include "stages/calibrate_light/mark_light.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/scan.h"
#include "common/capture/photo_camera.h"
#include "common/capture/view_image.h"
#include "common/light/frame.h"

enum { GRID = 12, AROUND = 3 }; /* points along a side: of a patch or a face; of the neighbourhood of a pixel */
static const double NORMAL = 1.96, CLIPPED = 0.02, LIFT = 0.02, ABOVE = 0.002; /* LIFT, ABOVE: of the model's size */

static enum status pixel_ray(struct vec3 *ray, struct photo_camera *camera, const struct lux_mark *m, double x,
                             double y, const struct lux_marks *marks, const struct mark_inputs *in, struct err *err)
{
    if (photo_camera_find(camera, m->view, &in->in->set, &in->in->lenses, marks->path, m->line, err))
        return err->status;
    if (photo_camera_ray(camera, x, y, ray)) return ST_OK;
    return err_set(err, ST_DATA, "%s:%d: pixel %g %g is not inside the photo %s, which has %d x %d pixels.",
                   marks->path, m->line, x, y, m->view, camera->lens.width, camera->lens.height);
}

/* -------------------------------------------------------------------------------------------------------- luminance */

/* The views of a photo, one after the other. */
struct looked_up {
    double sum;
    int count, clipped;
    bool done[GRID * GRID];
};

static void look_up(struct looked_up *l, const struct view *view, const struct view_planes *p, const struct vec3 *world,
                    int count)
{
    for (int k = 0; k < count; k++) {
        double u, v;
        if (l->done[k] || !(view_project(view, world[k], &u, &v) > 0)) continue;
        const int x = (int)floor(u), y = (int)floor(v);
        if (x < 0 || y < 0 || x >= view->width || y >= view->height) continue;
        const size_t at = (size_t)y * (size_t)view->width + (size_t)x;
        if (!(p->channel[VIEW_A][at] > 0.999f)) continue;
        const float rgb[3] = {p->channel[VIEW_R][at], p->channel[VIEW_G][at], p->channel[VIEW_B][at]};
        l->done[k] = true;
        l->sum += luminance_precise(rgb);
        l->count++;
        l->clipped += ((int)p->channel[VIEW_CLIPPED][at] & PHOTO_BRIGHT) != 0;
    }
}

static enum status find_luminance(struct lux_measurement *to, const struct lux_mark *m, const struct lux_marks *marks,
                                  const struct mark_inputs *in, struct err *err)
{
    const struct camera_set *set = &in->in->set;
    const int side = m->pixels == 2 ? GRID : AROUND, count = side * side;
    struct looked_up l = {0};
    struct photo_camera camera;
    struct vec3 world[GRID * GRID];
    for (int k = 0; k < count; k++) {
        const double u = (k % side + 0.5) / side, v = (k / side + 0.5) / side;
        const double x =
            m->pixels == 2 ? m->pixel[0] + u * (m->pixel[2] - m->pixel[0]) : m->pixel[0] + AROUND * (u - 0.5);
        const double y =
            m->pixels == 2 ? m->pixel[1] + v * (m->pixel[3] - m->pixel[1]) : m->pixel[1] + AROUND * (v - 0.5);
        struct vec3 ray;
        if (pixel_ray(&ray, &camera, m, x, y, marks, in, err)) return err->status;
        world[k] = vec3_add(camera.center, ray);
    }
    const int photo = photo_of_view(set, &in->in->lenses, camera.view_idx);
    for (int v = 0; !err->status && v < set->view_count && l.count < count; v++) {
        struct view_planes planes = {0};
        if (photo_of_view(set, &in->in->lenses, v) != photo) continue;
        if (!view_planes_read(&planes, in->views, &set->views[v], VIEW_CHANNELS, in->prov, err))
            look_up(&l, &set->views[v], &planes, world, count);
        view_planes_release(&planes);
    }
    if (err->status) return err->status;
    if (!l.count)
        return err_set(err, ST_DATA, "%s:%d: no view shows the place of %s in %s; mark it in another photo.",
                       marks->path, m->line, m->name, m->view);
    if (l.clipped > CLIPPED * l.count)
        return err_set(
            err, ST_DATA,
            "%s:%d: %.0f %% of the patch %s are saturated in %s, so that its luminance is unknown; measure a "
            "darker place.",
            marks->path, m->line, 100.0 * l.clipped / l.count, m->name, m->view);
    to->light = l.sum / l.count;
    to->expected = in->params->luminance_error;
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------ illuminance */

static enum status point_at_pixel(struct gather_point *p, const struct lux_mark *m, const struct lux_marks *marks,
                                  const struct mark_inputs *in, struct err *err)
{
    const struct model_rays *model = &in->field->model;
    const struct model_axes *axes = &in->in->axes;
    struct photo_camera camera;
    struct vec3 ray;
    struct ray_hit hit;
    if (pixel_ray(&ray, &camera, m, m->pixel[0], m->pixel[1], marks, in, err)) return err->status;
    const struct vec3 from = model_from_world_point(axes, camera.center);
    if (!ray_scene_hit(&model->rays, from, model_from_world_direction(axes, ray), &hit))
        return err_set(err, ST_DATA, "%s:%d: the ray through pixel %g %g of %s hits no surface of the model.",
                       marks->path, m->line, m->pixel[0], m->pixel[1], m->view);
    *p = (struct gather_point){hit.point, hit.normal};
    if ((int)hit.id >= model->mesh.face_count) { /* furniture */
        if (p->normal.z > sqrt(0.5)) p->normal = vec3_make(0, 0, 1);
        p->at = vec3_add(p->at, vec3_scale(p->normal, ABOVE * model_rays_size(model)));
    }
    return ST_OK;
}

static bool is_on_face(const struct model_rays *model, int face, struct vec3 p, struct vec3 normal)
{
    const double off = 8 * model->rays.epsilon;
    struct ray_hit hit;
    return ray_scene_hit(&model->rays, vec3_add(p, vec3_scale(normal, off)), vec3_scale(normal, -1), &hit) &&
           (int)hit.id == face && hit.front && hit.t < 2 * off;
}

/* A grid over the faces of a name, with about GRID x GRID points each; at most `most` points. */
static int points_of_face(struct gather_point *p, int most, const char *name, const struct model_rays *model,
                          bool *known)
{
    const struct solid_mesh *mesh = &model->mesh;
    int count = 0;
    for (int face = 0; face < mesh->face_count; face++) {
        if (strcmp(solid_face_name(mesh, face), name) != 0) continue;
        const struct solid_face *f = &mesh->faces[face];
        struct vec3 u, v;
        double low[2], high[2];
        *known = true;
        frame_from_normal(f->normal, &u, &v);
        solid_face_box(mesh, face, u, v, low, high);
        for (int k = 0; k < GRID * GRID && count < most; k++) {
            const double a = low[0] + (high[0] - low[0]) * (k % GRID + 0.5) / GRID;
            const double b = low[1] + (high[1] - low[1]) * (k / GRID + 0.5) / GRID;
            const struct vec3 at =
                vec3_add(vec3_add(vec3_scale(u, a), vec3_scale(v, b)), vec3_scale(f->normal, f->offset));
            if (is_on_face(model, face, at, f->normal)) p[count++] = (struct gather_point){at, f->normal};
        }
    }
    return count;
}

static const char *face_name(const void *ctx, int i)
{
    const struct solid_mesh *mesh = ctx;
    return i < mesh->name_count ? mesh->names[i].name : NULL;
}

static enum status no_points(const struct lux_mark *m, const struct lux_marks *marks, const struct mark_inputs *in,
                             bool known, struct err *err)
{
    if (known)
        return err_set(err, ST_DATA, "%s:%d: the face %s is hidden by furniture or too small; mark a pixel instead.",
                       marks->path, m->line, m->face);
    const char *near = scan_nearest(m->face, face_name, &in->field->model.mesh);
    return err_set(err, ST_DATA, "%s:%d: the model has no face %s%s%s; O/model/model.txt has their names.", marks->path,
                   m->line, m->face, near ? "; did you mean " : "", near ? near : "");
}

static enum status find_illuminance(struct lux_measurement *to, const struct lux_mark *m, const struct lux_marks *marks,
                                    const struct mark_inputs *in, struct err *err)
{
    enum { MOST = 4 * GRID * GRID };
    struct gather_point points[MOST];
    double sum = 0, variance = 0;
    int count = 1;
    bool known = false;
    if (!in->field)
        return err_set(
            err, ST_DATA,
            "%s:%d: the illuminance %s needs a model with its textures (--vita); measure luminances instead.",
            marks->path, m->line, m->name);
    if (m->view) {
        if (point_at_pixel(&points[0], m, marks, in, err)) return err->status;
    } else {
        count = points_of_face(points, MOST, m->face, &in->field->model, &known);
        if (!count) return no_points(m, marks, in, known, err);
    }
    const double lift = LIFT * model_rays_size(&in->field->model);
    for (int i = 0; i < count; i++) {
        struct irradiance e;
        model_field_lift(in->field, &points[i], lift);
        gatherer_irradiance(&e, in->gatherer, &in->field->field, points[i], (uint64_t)m->line << 32 | (uint64_t)i);
        sum += rgb_luminance(e.value) / count;
        variance += rgb_luminance(e.error) * rgb_luminance(e.error) / count / count;
    }
    to->light = sum;
    to->expected = hypot(in->params->irradiance_error, sum > 0 ? sqrt(variance) / sum : 0);
    return ST_OK;
}

/* -------------------------------------------------------------------------------------------------------------- all */

enum status mark_light_find(struct lux_measurement *list, const struct lux_marks *marks, const struct mark_inputs *in,
                            struct err *err)
{
    memset(list, 0, (size_t)marks->count * sizeof *list);
    for (int i = 0; !err->status && i < marks->count; i++) {
        const struct lux_mark *m = &marks->items[i];
        struct lux_measurement *to = &list[i];
        to->kind = m->kind;
        to->value = m->value;
        if (!(to->name = strdup(m->name))) return err_nomem(err, "a name", strlen(m->name) + 1);
        if (m->kind == LUX_LUMINANCE ? find_luminance(to, m, marks, in, err) : find_illuminance(to, m, marks, in, err))
            break;
        to->expected = hypot(to->expected, (m->within < 0 ? in->params->meter_error : m->within) / NORMAL);
        if (!(to->light > 0 && isfinite(to->light)))
            err_set(err, ST_DATA, "%s:%d: no light is found at %s; mark a place that photos show.", marks->path,
                    m->line, m->name);
    }
    return err->status;
}
