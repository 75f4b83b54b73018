/* outdoors_error.c - how far the outdoors that were found are from those of a described scene.
 *
 *   outdoors_error --scene FILE --truth DIR --views DIR --model FILE --axes FILE --outdoors FILE
 *
 * --scene has lines `sun ...` and `panorama ...` of scene.txt (docs/scenes.md), others are ignored. --truth has the
 * true cameras of the photos, --views those of the products, of which each photo's first view counts; their centres
 * align the frames. Radiances are compared as they are.
 *
 * Prints, in luminance:
 *   seen D      error of the mean radiance that leaves through the openings, without sun, as seen from a grid of points
 *               at half the height of each room; a fraction of the truth
 *   sky D       error of the irradiance that floors get from outdoors, without sun, summed over a grid; a fraction
 *   floor D     the same with the sun
 *   sun_off D   degrees between the suns; sun D: error of the irradiance of what faces the sun, a fraction. A sun that
 *               is not found: sun -1, without sun_off; of a scene without any, one that is found: sun_false 1 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/cli.h"
#include "common/capture/camera_alignment.h"
#include "common/gather/field_sky.h"
#include "common/image/luminance.h"
#include "common/light/model_rays.h"
#include "common/light/sky.h"
#include "common/math/numbers.h"
#include "common/model/model_axes.h"
#include "common/texture/outdoors.h"

enum { STEPS = 40, DIRECTIONS = 1024, STOREYS = 16 }; /* of the grid, along the longer side; of a point */
static const double ROOM = 0.4;                       /* of the model's height: lower spaces are no rooms */

struct job {
    const char *scene, *truth, *views, *model_path, *axes_path, *outdoors_path;
    struct sky_params params;
    struct sky sky; /* the true one, without sun */
    struct vec3 to_sun;
    double sun; /* irradiance of what faces it; 0: none */
    struct model_axes axes;
    struct similarity truth_from_scene;
    struct model_rays model;
    struct outdoors found; /* without suns */
    struct vec3 found_to_sun;
    double found_sun;
    struct camera_set views_set;
};

/* ---------------------------------------------------------------------------------------------------------- reading */

static enum status read_scene(struct job *j, struct err *err)
{
    char line[1024];
    FILE *fp = fopen(j->scene, "r");
    if (!fp) return err_set(err, ST_IO, "cannot read %s.", j->scene);
    while (fgets(line, sizeof line, fp)) {
        struct sun *s = &j->params.sun;
        struct panorama *p = &j->params.panorama;
        if (sscanf(line, " sun %lf %lf %lf %lf %lf %lf", &s->azimuth, &s->elevation, &s->angular_radius, &s->radiance.r,
                   &s->radiance.g, &s->radiance.b) == 6)
            j->params.has_sun = true;
        if (sscanf(line, " panorama %u %lf %lf %lf %lf %lf %lf", &p->seed, &p->sky.r, &p->sky.g, &p->sky.b,
                   &p->ground.r, &p->ground.g, &p->ground.b) == 7)
            j->params.has_panorama = true;
    }
    fclose(fp);
    sky_init(&j->sky, &j->params);
    j->to_sun = j->sky.to_sun;
    const double sine = sin(j->params.sun.angular_radius * DEGREE);
    j->sun = j->params.has_sun ? rgb_luminance(j->params.sun.radiance) * PI * sine * sine : 0;
    j->sky.has_sun = false;
    return ST_OK;
}

/* The first view of a photo; -1: none. */
static int view_of(const struct camera_set *set, const char *photo)
{
    const size_t length = strlen(photo);
    for (int i = 0; i < set->view_count; i++) {
        const char *name = set->views[i].name;
        if (!strncmp(name, photo, length) && (name[length] == '@' || name[length] == 0)) return i;
    }
    return -1;
}

/* A line of a photo in images.txt; false: it is another line. The centre becomes that of a camera without rotation. */
static bool read_pose(struct pose *p, char photo[128], const char *line)
{
    struct pose truth;
    struct quat *q = &truth.rotation;
    struct vec3 *t = &truth.translation;
    if (sscanf(line, "%*d %lf %lf %lf %lf %lf %lf %lf %*d %127s", &q->w, &q->x, &q->y, &q->z, &t->x, &t->y, &t->z,
               photo) != 8)
        return false;
    photo[strcspn(photo, ".")] = 0;
    *p = (struct pose){{1, 0, 0, 0}, vec3_scale(pose_center(&truth), -1)};
    return true;
}

static enum status read_poses(struct job *j, struct pose **truth, struct pose **found, int *count, struct err *err)
{
    char path[4096], line[4096], photo[128];
    snprintf(path, sizeof path, "%s/images.txt", j->truth);
    FILE *fp = fopen(path, "r");
    if (!fp) return err_set(err, ST_IO, "cannot read %s.", path);
    while (!err->status && fgets(line, sizeof line, fp)) {
        struct pose p;
        if (!read_pose(&p, photo, line)) continue;
        const int k = view_of(&j->views_set, photo);
        if (k < 0) continue;
        if (array_append(truth, (size_t)*count, sizeof **truth, "cameras", err) ||
            array_append(found, (size_t)*count, sizeof **found, "cameras", err))
            break;
        (*truth)[*count] = p;
        (*found)[(*count)++] = (struct pose){{1, 0, 0, 0}, vec3_scale(j->views_set.views[k].center, -1)};
    }
    fclose(fp);
    return err->status;
}

static enum status align(struct job *j, struct err *err)
{
    struct pose *truth = NULL, *found = NULL;
    int count = 0;
    if (!camera_set_read_cameras(&j->views_set, j->views, NULL, err) && !read_poses(j, &truth, &found, &count, err))
        camera_alignment_find(&j->truth_from_scene, found, truth, count, err);
    free(truth);
    free(found);
    return err->status;
}

/* Takes the brightest sun out of the picture: its pixels become as dark as the brightest of what counts as sky. */
static enum status take_out_sun(struct job *j, struct err *err)
{
    struct outdoors *o = &j->found;
    struct field_sky sky;
    if (field_sky_find(&sky, o, err) || !sky.sun_count) return err->status;
    j->found_to_sun = vec3_scale(sky.suns[0].normal, -1);
    if (vec3_dot(j->found_to_sun, vec3_make(0, 0, 1)) < 0) j->found_to_sun = vec3_scale(j->found_to_sun, -1);
    for (int y = 0; y < o->height; y++) {
        const double top = PI / 2 - PI * y / o->height;
        const double angle = (sin(top) - sin(top - PI / o->height)) * 2 * PI / o->width;
        for (int x = 0; x < o->width; x++) {
            float *rgb = o->rgb + 3 * ((size_t)y * (size_t)o->width + (size_t)x);
            const double luminance = (double)luminance_of(rgb);
            if (!(luminance > sky.bright)) continue;
            if (vec3_dot(outdoors_direction(o, x + 0.5, y + 0.5), j->found_to_sun) > cos(10 * DEGREE))
                j->found_sun += (luminance - sky.median) * angle;
            for (int c = 0; c < 3; c++) rgb[c] *= (float)(sky.median / luminance);
        }
    }
    return ST_OK;
}

/* ----------------------------------------------------------------------------------------------------------- frames */

static struct vec3 to_truth(const struct job *j, struct vec3 d)
{
    return mat3_apply(j->truth_from_scene.rotation, world_from_model_direction(&j->axes, d));
}

static struct vec3 to_model(const struct job *j, struct vec3 d)
{
    return model_from_world_direction(&j->axes, mat3_apply(mat3_transpose(j->truth_from_scene.rotation), d));
}

/* ------------------------------------------------------------------------------------------------------------- sums */

struct sums {
    double found, truth;
};

struct totals {
    struct sums seen, sky, sun;
};

/* Low-discrepancy directions about z: of the hemisphere by the cosine, or of the sphere. */
static struct vec3 direction_of(int k, bool sphere)
{
    const double u = fmod(k * 0.7548776662466927, 1), v = fmod(k * 0.5698402909980532, 1);
    const double z = sphere ? 2 * u - 1 : sqrt(1 - u), r = sqrt(fmax(0, 1 - z * z));
    return vec3_make(r * cos(2 * PI * v), r * sin(2 * PI * v), z);
}

static void add_point(struct sums *s, const struct job *j, struct vec3 from, bool sphere)
{
    for (int k = 0; k < DIRECTIONS; k++) {
        const struct vec3 d = direction_of(k + 1, sphere);
        float rgb[3];
        if (ray_scene_blocked(&j->model.rays, from, d, INFINITY)) continue;
        outdoors_sample(rgb, &j->found, d);
        s->found += (double)luminance_of(rgb) / DIRECTIONS;
        s->truth += rgb_luminance(sky_radiance(&j->sky, to_truth(j, d))) / DIRECTIONS;
    }
}

static double sun_at(const struct job *j, struct vec3 from, struct vec3 to_sun, double irradiance)
{
    if (!(irradiance > 0) || ray_scene_blocked(&j->model.rays, from, to_sun, INFINITY)) return 0;
    return irradiance * to_sun.z / PI; /* in units of a mean radiance, as add_point() counts */
}

/* The rooms above each other at a place. */
static void add_column(struct totals *t, const struct job *j, double x, double y, double bottom)
{
    struct vec3 from = vec3_make(x, y, bottom);
    double floor = INFINITY;
    for (int k = 0; k < STOREYS; k++) {
        struct ray_hit hit;
        if (!ray_scene_hit(&j->model.rays, from, vec3_make(0, 0, 1), &hit)) return;
        const double height = hit.point.z - floor, epsilon = 4 * j->model.rays.epsilon;
        if (hit.front && height >= ROOM * model_rays_height(&j->model)) {
            const struct vec3 low = vec3_make(x, y, floor + epsilon);
            add_point(&t->sky, j, low, false);
            add_point(&t->seen, j, vec3_make(x, y, floor + height / 2), true);
            t->sun.found += sun_at(j, low, j->found_to_sun, j->found_sun);
            t->sun.truth += sun_at(j, low, to_model(j, j->to_sun), j->sun);
        }
        floor = hit.front ? INFINITY : hit.point.z;
        from.z = hit.point.z + epsilon;
    }
}

static double error_of(double found, double truth) { return truth > 0 ? found / truth - 1 : 0; }

static void print_sun(const struct job *j)
{
    if (!(j->sun > 0)) {
        if (j->found_sun > 0) printf("sun_false 1\n");
        return;
    }
    if (j->found_sun > 0) {
        const struct vec3 truth = to_model(j, j->to_sun);
        printf("sun_off %.4g\n",
               atan2(vec3_length(vec3_cross(truth, j->found_to_sun)), vec3_dot(truth, j->found_to_sun)) / DEGREE);
    }
    printf("sun %.4g\n", error_of(j->found_sun, j->sun));
}

static void compare(const struct job *j)
{
    struct vec3 low, high;
    struct totals t = {{0, 0}, {0, 0}, {0, 0}};
    model_rays_bounds(&j->model, &low, &high);
    const double spacing = fmax(high.x - low.x, high.y - low.y) / STEPS;
    for (double y = low.y + spacing / 2; y < high.y; y += spacing)
        for (double x = low.x + spacing / 2; x < high.x; x += spacing) add_column(&t, j, x, y, low.z - spacing);
    printf("seen %.4g\nsky %.4g\nfloor %.4g\n", error_of(t.seen.found, t.seen.truth),
           error_of(t.sky.found, t.sky.truth), error_of(t.sky.found + t.sun.found, t.sky.truth + t.sun.truth));
    print_sun(j);
}

int main(int argc, char **argv)
{
    static struct job j;
    struct provenance prov = {0};
    const struct cli_opt opts[] = {
        CLI_ABOUT("How far the outdoors that were found are from those of a described scene."),
        CLI_STR("scene", &j.scene, CLI_REQUIRED, "sun and panorama in the frame of the truth, scene.txt"),
        CLI_STR("truth", &j.truth, CLI_REQUIRED, "folder of the true cameras"),
        CLI_STR("views", &j.views, CLI_REQUIRED, "folder of the cameras of the products"),
        CLI_STR("model", &j.model_path, CLI_REQUIRED, "the unedited model, model.txt"),
        CLI_STR("axes", &j.axes_path, CLI_REQUIRED, "the model's frame, axes.txt"),
        CLI_STR("outdoors", &j.outdoors_path, CLI_REQUIRED, "outdoors.exr that was found"),
        CLI_END,
    };
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "outdoors_error", opts, &prov, &err) == CLI_RUN) {
        if (!read_scene(&j, &err) && !align(&j, &err) && !model_axes_read(&j.axes, j.axes_path, NULL, &err) &&
            !model_rays_read(&j.model, j.model_path, MODEL_WITHOUT_GLASS, NULL, &err) &&
            !outdoors_read(&j.found, j.outdoors_path, NULL, &err) && !take_out_sun(&j, &err))
            compare(&j);
    }
    err_report(&err);
    outdoors_release(&j.found);
    model_rays_release(&j.model);
    camera_set_release(&j.views_set);
    provenance_release(&prov);
    return err_exit_code(&err);
}
