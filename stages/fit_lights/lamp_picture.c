/* lamp_picture.c - see lamp_picture.h. */
#include "stages/fit_lights/lamp_picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/capture/view_image.h"
#include "common/image/photo.h"
#include "common/product/product.h"

enum { QUALITY = 90, GAP = 8 /* px between two views */ };
static const double MIN_OUTLINE = 0.01; /* of a view's width: less does not show a lamp */
static const unsigned char DARK[3] = {0, 0, 0}, OUTLINE[3] = {90, 255, 120}, EDGE[3] = {255, 140, 0},
                           LIT[3] = {255, 235, 60}, UNLIT[3] = {70, 130, 255}, LINE[3] = {225, 90, 255};

struct job {
    const struct lit_scene *scene;
    const struct lit_model *model;
    struct view *views; /* in the model's frame */
    const char *folder; /* of their pictures */
};

/* ----------------------------------------------------------------------------------------------------------- seeing */

static bool sees(const struct view *v, const struct model_rays *model, struct vec3 at, struct vec3 normal, double *x,
                 double *y)
{
    if (!(view_project(v, at, x, y) > 0)) return false;
    if (*x < 0 || *y < 0 || *x > v->width || *y > v->height) return false;
    if (!(vec3_dot(normal, vec3_sub(v->center, at)) > 0)) return false;
    const struct vec3 from = vec3_add(at, vec3_scale(normal, 4 * model->rays.epsilon));
    return !ray_scene_blocked(&model->rays, from, vec3_sub(v->center, from), 1);
}

double lamp_curve_draw(const struct canvas *k, const struct curve *c, const struct view *view,
                       const struct model_rays *model, double half, const unsigned char colour[3])
{
    double length = 0, x0 = 0, y0 = 0, x1, y1;
    bool last = c->count && sees(view, model, c->points[0].at, c->points[0].normal, &x0, &y0);
    for (int i = 0; i < c->count; i++) {
        const struct curve_point *next = &c->points[(i + 1) % c->count];
        const bool now = sees(view, model, next->at, next->normal, &x1, &y1);
        if (last && now && c->points[i].joins) {
            length += hypot(x1 - x0, y1 - y0);
            if (k) draw_line(k, x0, y0, x1, y1, half, colour);
        }
        last = now, x0 = x1, y0 = y1;
    }
    return length / view->width;
}

/* The share of a lamp's marked points that a view shows. */
static double marks_seen(const struct job *j, int lamp, const struct view *view)
{
    int seen = 0, all = 0;
    for (int i = 0; i < j->scene->point_count; i++) {
        const struct lit_point *p = &j->scene->points[i];
        double x, y;
        if (p->lamp != lamp) continue;
        all++;
        seen += sees(view, &j->model->rays, p->at, p->normal, &x, &y);
    }
    return all ? (double)seen / all : 0;
}

/* -------------------------------------------------------------------------------------------------------- drawing */

static void draw_curve(const struct canvas *k, const struct curve *c, const struct view *v,
                       const struct model_rays *model, double half, const unsigned char colour[3])
{
    lamp_curve_draw(k, c, v, model, half + 1, DARK);
    lamp_curve_draw(k, c, v, model, half, colour);
}

static void draw_marks(const struct canvas *k, const struct job *j, int lamp, const struct view *v, double half)
{
    double x0 = 0, y0 = 0, x1, y1;
    bool last = false;
    for (int i = 0; i < j->scene->point_count; i++) {
        const struct lit_point *p = &j->scene->points[i];
        const bool now = p->lamp == lamp && sees(v, &j->model->rays, p->at, p->normal, &x1, &y1);
        if (now && p->kind != NOTE_LINE) draw_dot(k, x1, y1, 2 * half + 1.5, p->kind == NOTE_LIT ? LIT : UNLIT);
        if (now && last && p->kind == NOTE_LINE && p->along > 0) draw_line(k, x0, y0, x1, y1, half, LINE);
        last = now && p->kind == NOTE_LINE;
        if (now) x0 = x1, y0 = y1;
    }
}

/* The view with everything drawn on it; the caller frees *rgb. */
static enum status draw_view(unsigned char **rgb, const struct job *j, int lamp, int view, const struct curve *outline,
                             const struct curve *edge, struct err *err)
{
    const struct view *v = &j->views[view];
    const double half = fmax(1, hypot(v->width, v->height) / 900);
    struct image im = {0};
    if (!view_image_read(&im, j->folder, v, NULL, err)) image_expose(&im, 0.9, 0.5, err);
    *rgb = err->status ? NULL : malloc(3 * (size_t)im.width * (size_t)im.height);
    if (!err->status && !*rgb) err_nomem(err, "a picture", 3 * (size_t)im.width * (size_t)im.height);
    if (!err->status) {
        const struct canvas k = {*rgb, im.width, im.height};
        image_to_srgb8(&im, *rgb);
        draw_marks(&k, j, lamp, v, half);
        draw_curve(&k, edge, v, &j->model->rays, half, EDGE);
        draw_curve(&k, outline, v, &j->model->rays, half, OUTLINE);
    }
    image_release(&im);
    return err->status;
}

/* Copies a picture into a wider one. */
static void paste(unsigned char *to, int to_width, int left, const unsigned char *rgb, const struct view *v)
{
    for (int y = 0; y < v->height; y++)
        memcpy(to + 3 * ((size_t)y * (size_t)to_width + (size_t)left), rgb + 3 * (size_t)y * (size_t)v->width,
               3 * (size_t)v->width);
}

/* One view, or two side by side. */
static enum status write_views(const struct job *j, int lamp, const int views[2], const struct curve *outline,
                               const struct curve *edge, const char *path, struct err *err)
{
    const struct view *a = &j->views[views[0]], *b = views[1] < 0 ? NULL : &j->views[views[1]];
    const int width = a->width + (b ? GAP + b->width : 0);
    const int height = b && b->height > a->height ? b->height : a->height;
    unsigned char *rgb[2] = {NULL, NULL}, *both = malloc(3 * (size_t)width * (size_t)height);
    if (!both) err_nomem(err, "a picture", 3 * (size_t)width * (size_t)height);
    for (int i = 0; !err->status && i < 2 && views[i] >= 0; i++)
        draw_view(&rgb[i], j, lamp, views[i], outline, edge, err);
    if (!err->status) {
        memset(both, 255, 3 * (size_t)width * (size_t)height);
        paste(both, width, 0, rgb[0], a);
        if (b) paste(both, width, a->width + GAP, rgb[1], b);
        jpeg_write(path, both, width, height, QUALITY, err);
    }
    free(rgb[0]);
    free(rgb[1]);
    free(both);
    return err->status;
}

/* -------------------------------------------------------------------------------------------------------- choosing */

/* views[0]: most of the cone's edge, the marks and the outline; views[1]: the lamp, if the first one does not show it;
 * -1: none. */
static void choose_views(int views[2], const struct job *j, int lamp, const struct curve *outline,
                         const struct curve *edge)
{
    double best = 0, best_outline = MIN_OUTLINE, outline_of_best = 0;
    views[0] = views[1] = -1;
    for (int i = 0; i < j->model->in.set.view_count; i++) {
        const struct view *v = &j->views[i];
        const double around = lamp_curve_draw(NULL, outline, v, &j->model->rays, 0, DARK);
        const double score = around + lamp_curve_draw(NULL, edge, v, &j->model->rays, 0, DARK) + marks_seen(j, lamp, v);
        if (score > best) best = score, views[0] = i, outline_of_best = around;
        if (around > best_outline) best_outline = around, views[1] = i;
    }
    if (outline_of_best >= MIN_OUTLINE) views[1] = -1;
}

static enum status write_lamp(const struct job *j, int lamp, struct curve *outline, struct curve *edge,
                              const char *folder, struct err *err)
{
    const struct lamp *l = &j->scene->lights.lamps[lamp];
    char name[LAMP_FILE_NAME], path[FILE_PATH];
    int views[2];
    light_list_lamp_file(name, &j->scene->lights, lamp);
    if (product_path_in(path, folder, PRODUCT_LAMP_PICTURE, &(struct product_key){.name = name}, err))
        return err->status;
    cone_edge_find(edge, l, &j->model->rays);
    cone_outline(outline, l);
    choose_views(views, j, lamp, outline, edge);
    if (views[0] >= 0) return write_views(j, lamp, views, outline, edge, path, err);
    unlink(path); /* of an earlier run */
    return ST_OK;
}

enum status lamp_pictures_write(const struct lit_scene *scene, const struct lit_model *model, const char *views,
                                const char *folder, struct err *err)
{
    const int count = model->in.set.view_count;
    struct job j = {scene, model, calloc((size_t)count + 1, sizeof *j.views), views};
    struct curve *curves = malloc(2 * sizeof *curves);
    if (!j.views || !curves) err_nomem(err, "views", (size_t)count * sizeof *j.views);
    for (int i = 0; !err->status && i < count; i++)
        j.views[i] = model_from_world_view(&model->in.axes, &model->in.set.views[i]);
    for (int i = 0; !err->status && i < scene->lights.lamp_count; i++)
        write_lamp(&j, i, &curves[0], &curves[1], folder, err);
    free(j.views);
    free(curves);
    return err->status;
}
