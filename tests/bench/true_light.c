/* true_light.c - the true lamps and the true outdoors of a scene, in the frame and the unit of its model.
 *
 *   true_light --scene FILE --truth-points FILE --points FILE --axes FILE --scale S --lights FILE [--lights-out FILE]
 *              [--outdoors FILE --outdoors-out FILE] [--list FILE --list-out FILE]
 *
 * --scene has lines `lamp NAME disk|quad ...`, `sun ...` and `panorama ...` of scene.txt (docs/scenes.md) in the frame
 * of the truth, others are ignored. Line for line, --truth-points and --points have the same points in that frame and
 * in that of the views; --axes is the model's axes.txt. True radiance is S times found radiance. --lights is what
 * fit_lights found: its lamps are compared with the nearest true ones, and replaced by them in --lights-out.
 * --outdoors-out is --outdoors with the true radiance in each direction. --list has lines X Y Z NX NY NZ in the frame
 * of the views, --list-out has them in that of the truth, a centimetre before their surfaces: the true surface may lie
 * before that of the model.
 *
 * Prints for each found lamp "lamp NAME radiance P beta D centre M": the error of the luminance, a fraction; that of
 * beta, degrees; the distance of the centres, model units. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/cli.h"
#include "common/base/outfile.h"
#include "common/capture/camera_alignment.h"
#include "common/gather/light_list.h"
#include "common/light/sky.h"
#include "common/light/surface_points.h"
#include "common/math/numbers.h"
#include "common/model/model_axes.h"
#include "common/texture/outdoors.h"

enum { MAX_LAMPS = 64, SUN_SAMPLES = 16 }; /* along each side of a pixel at the sun; elsewhere one */
static const double BEFORE = 0.01;         /* m */

struct truth {
    struct lamp lamps[MAX_LAMPS];
    char names[MAX_LAMPS][64];
    int lamp_count;
    struct sky_params sky;
};

struct job {
    const char *scene, *truth_points, *points, *axes_path, *scale, *lights, *lights_out, *outdoors, *outdoors_out,
        *list, *list_out;
    struct truth truth;
    struct model_axes axes;
    struct similarity truth_from_scene;
    double unit; /* --scale */
    struct light_list found;
    struct provenance prov;
};

/* ---------------------------------------------------------------------------------------------------------- reading */

static void read_disk(struct truth *t, const char *line, struct lamp *l)
{
    double degrees = 90;
    l->shape = LAMP_DISK;
    const int count =
        sscanf(line, " lamp %63s disk %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf", t->names[t->lamp_count],
               &l->centre.x, &l->centre.y, &l->centre.z, &l->normal.x, &l->normal.y, &l->normal.z, &l->radius,
               &l->radiance.r, &l->radiance.g, &l->radiance.b, &degrees, &l->exponent);
    if (count < 11) return;
    l->beta = degrees * DEGREE;
    t->lamp_count++;
}

/* A corner and two edges; it shines to the side of their cross product. */
static void read_quad(struct truth *t, const char *line, struct lamp *l)
{
    struct vec3 corner, x, y;
    double degrees = 90;
    const int count = sscanf(line, " lamp %63s quad %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf",
                             t->names[t->lamp_count], &corner.x, &corner.y, &corner.z, &x.x, &x.y, &x.z, &y.x, &y.y,
                             &y.z, &l->radiance.r, &l->radiance.g, &l->radiance.b, &degrees, &l->exponent);
    if (count < 13) return;
    l->shape = LAMP_QUAD;
    l->x = vec3_scale(x, 0.5);
    l->y = vec3_scale(y, 0.5);
    l->centre = vec3_add(corner, vec3_add(l->x, l->y));
    l->normal = vec3_normalize(vec3_cross(x, y));
    l->beta = degrees * DEGREE;
    t->lamp_count++;
}

static void read_line(struct truth *t, const char *line)
{
    struct sun *s = &t->sky.sun;
    struct panorama *p = &t->sky.panorama;
    if (t->lamp_count < MAX_LAMPS) {
        struct lamp *l = &t->lamps[t->lamp_count];
        *l = (struct lamp){0};
        const int before = t->lamp_count;
        read_disk(t, line, l);
        if (t->lamp_count == before) read_quad(t, line, l);
    }
    if (sscanf(line, " sun %lf %lf %lf %lf %lf %lf", &s->azimuth, &s->elevation, &s->angular_radius, &s->radiance.r,
               &s->radiance.g, &s->radiance.b) == 6)
        t->sky.has_sun = true;
    if (sscanf(line, " panorama %u %lf %lf %lf %lf %lf %lf", &p->seed, &p->sky.r, &p->sky.g, &p->sky.b, &p->ground.r,
               &p->ground.g, &p->ground.b) == 7)
        t->sky.has_panorama = true;
}

static enum status read_truth(struct truth *t, const char *path, struct err *err)
{
    char line[1024];
    FILE *fp = fopen(path, "r");
    if (!fp) return err_set(err, ST_IO, "cannot read %s.", path);
    while (fgets(line, sizeof line, fp)) read_line(t, line);
    fclose(fp);
    return ST_OK;
}

/* Without the irradiance that follows a point and its normal. */
static enum status read_points(struct pose **poses, int *count, const char *path, struct err *err)
{
    char line[1024];
    FILE *fp = fopen(path, "r");
    if (!fp) return err_set(err, ST_IO, "cannot read %s.", path);
    while (!err->status && fgets(line, sizeof line, fp)) {
        struct vec3 p;
        if (sscanf(line, "%lf %lf %lf", &p.x, &p.y, &p.z) != 3) continue;
        if (!array_append(poses, (size_t)*count, sizeof **poses, "points", err))
            (*poses)[(*count)++] = (struct pose){{1, 0, 0, 0}, vec3_scale(p, -1)};
    }
    fclose(fp);
    return err->status;
}

/* Points are the centres of cameras without rotation. */
static enum status align(struct job *j, struct err *err)
{
    struct pose *truth = NULL, *found = NULL;
    int truth_count = 0, count = 0;
    if (!read_points(&truth, &truth_count, j->truth_points, err)) read_points(&found, &count, j->points, err);
    if (!err->status && count != truth_count)
        err_set(err, ST_DATA, "%s has %d points and %s has %d, wanted the same.", j->points, count, j->truth_points,
                truth_count);
    if (!err->status) camera_alignment_find(&j->truth_from_scene, found, truth, count, err);
    free(truth);
    free(found);
    return err->status;
}

/* ----------------------------------------------------------------------------------------------------------- frames */

static struct vec3 direction_to_model(const struct job *j, struct vec3 d)
{
    return model_from_world_direction(&j->axes, mat3_apply(mat3_transpose(j->truth_from_scene.rotation), d));
}

static struct vec3 direction_to_truth(const struct job *j, struct vec3 d)
{
    return mat3_apply(j->truth_from_scene.rotation, world_from_model_direction(&j->axes, d));
}

static struct vec3 point_to_model(const struct job *j, struct vec3 p)
{
    const struct similarity *s = &j->truth_from_scene;
    const struct vec3 q = mat3_apply(mat3_transpose(s->rotation), vec3_sub(p, s->translation));
    return model_from_world_point(&j->axes, vec3_scale(q, 1 / s->scale));
}

static double length_to_model(const struct job *j) { return j->axes.scale / j->truth_from_scene.scale; }

static struct lamp lamp_to_model(const struct job *j, const struct lamp *truth)
{
    struct lamp l = *truth;
    const double unit = length_to_model(j);
    l.centre = point_to_model(j, truth->centre);
    l.normal = direction_to_model(j, truth->normal);
    l.x = vec3_scale(direction_to_model(j, truth->x), unit);
    l.y = vec3_scale(direction_to_model(j, truth->y), unit);
    l.radius = truth->radius * unit;
    l.radiance = rgb_scale(truth->radiance, 1 / j->unit);
    return l;
}

/* ------------------------------------------------------------------------------------------------------------ lamps */

static void compare_lamp(const struct lamp *found, const struct lamp *truth)
{
    printf("lamp %s radiance %.4f beta %.3f centre %.4f true %.6g %.6g %.6g%s\n", found->name,
           rgb_luminance(found->radiance) / rgb_luminance(truth->radiance) - 1, (found->beta - truth->beta) / DEGREE,
           vec3_length(vec3_sub(found->centre, truth->centre)), truth->radiance.r, truth->radiance.g, truth->radiance.b,
           found->bound ? " bound" : "");
}

/* A disk's half axes are made when the list is written and read again. */
static void replace_lamp(struct lamp *found, const struct lamp *truth)
{
    char *name = found->name;
    const struct vec3 x = found->x, y = found->y;
    const double radius = found->radius;
    *found = *truth;
    found->name = name;
    if (truth->shape != LAMP_DISK) return;
    found->x = vec3_scale(x, truth->radius / radius);
    found->y = vec3_scale(y, truth->radius / radius);
}

static enum status replace_lamps(struct job *j, struct err *err)
{
    if (light_list_read(&j->found, j->lights, NULL, err)) return err->status;
    for (int i = 0; i < j->found.lamp_count; i++) {
        struct lamp nearest = {0};
        double distance = INFINITY;
        for (int k = 0; k < j->truth.lamp_count; k++) {
            const struct lamp l = lamp_to_model(j, &j->truth.lamps[k]);
            const double d = vec3_length(vec3_sub(l.centre, j->found.lamps[i].centre));
            if (l.shape != j->found.lamps[i].shape || d >= distance) continue;
            nearest = l;
            distance = d;
        }
        if (!isfinite(distance))
            return err_set(err, ST_DATA, "%s has no lamp like %s.", j->scene, j->found.lamps[i].name);
        compare_lamp(&j->found.lamps[i], &nearest);
        replace_lamp(&j->found.lamps[i], &nearest);
    }
    return j->lights_out ? light_list_write(&j->found, j->lights_out, &j->prov, err) : ST_OK;
}

/* --------------------------------------------------------------------------------------------------------- outdoors */

/* The mean over a pixel. */
static struct rgb true_pixel(const struct job *j, const struct sky *sky, const struct outdoors *o, int x, int y)
{
    const struct vec3 middle = direction_to_truth(j, outdoors_direction(o, x + 0.5, y + 0.5));
    const double near_sun = cos(fmin(j->truth.sky.sun.angular_radius * DEGREE + 2 * PI / o->height, PI));
    const bool at_sun = sky->has_sun && vec3_dot(middle, sky->to_sun) > near_sun;
    const int n = at_sun ? SUN_SAMPLES : 1;
    struct rgb sum = {0, 0, 0};
    for (int i = 0; i < n * n; i++) {
        const struct vec3 d = outdoors_direction(o, x + (i % n + 0.5) / n, y + (i / n + 0.5) / n);
        sum = rgb_add(sum, sky_radiance(sky, direction_to_truth(j, d)));
    }
    return rgb_scale(sum, 1 / (n * n * j->unit));
}

static enum status replace_outdoors(const struct job *j, struct err *err)
{
    struct outdoors o = {0};
    struct sky sky;
    sky_init(&sky, &j->truth.sky);
    outdoors_read(&o, j->outdoors, NULL, err);
    for (int i = 0; !err->status && i < o.width * o.height; i++) {
        const struct rgb c = true_pixel(j, &sky, &o, i % o.width, i / o.width);
        o.rgb[3 * i] = (float)c.r, o.rgb[3 * i + 1] = (float)c.g, o.rgb[3 * i + 2] = (float)c.b;
        o.source[i] = OUTDOORS_REFERENCE;
    }
    if (!err->status) outdoors_write(&o, j->outdoors_out, &j->prov, err);
    outdoors_release(&o);
    return err->status;
}

/* ----------------------------------------------------------------------------------------------------------- points */

static enum status bring_points(const struct job *j, struct err *err)
{
    const struct similarity *s = &j->truth_from_scene;
    struct surface_points points = {0};
    struct outfile f = {0};
    if (!surface_points_read(&points, j->list, err)) outfile_open(&f, j->list_out, err);
    for (int i = 0; !err->status && i < points.count; i++) {
        const struct vec3 n = mat3_apply(s->rotation, points.list[i].normal);
        const struct vec3 p =
            vec3_add(vec3_add(vec3_scale(mat3_apply(s->rotation, points.list[i].at), s->scale), s->translation),
                     vec3_scale(n, BEFORE));
        fprintf(f.fp, "%.9g %.9g %.9g %.9g %.9g %.9g\n", p.x, p.y, p.z, n.x, n.y, n.z);
    }
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    surface_points_release(&points);
    return err->status;
}

static enum status run(struct job *j, struct err *err)
{
    j->unit = atof(j->scale);
    if (!(j->unit > 0)) return err_set(err, ST_USAGE, "--scale %s: must be a number above 0.", j->scale);
    if (read_truth(&j->truth, j->scene, err) || align(j, err) || model_axes_read(&j->axes, j->axes_path, NULL, err) ||
        replace_lamps(j, err))
        return err->status;
    if (j->outdoors_out && replace_outdoors(j, err)) return err->status;
    return j->list_out ? bring_points(j, err) : ST_OK;
}

int main(int argc, char **argv)
{
    static struct job j;
    const struct cli_opt opts[] = {
        CLI_ABOUT("The true lamps and outdoors of a scene, in the frame and the unit of its model."),
        CLI_STR("scene", &j.scene, CLI_REQUIRED, "lamps, sun and panorama in the frame of the truth"),
        CLI_STR("truth-points", &j.truth_points, CLI_REQUIRED, "points in the frame of the truth"),
        CLI_STR("points", &j.points, CLI_REQUIRED, "the same points in the frame of the views"),
        CLI_STR("axes", &j.axes_path, CLI_REQUIRED, "the model's frame, axes.txt"),
        CLI_STR("scale", &j.scale, CLI_REQUIRED, "true over found radiance"),
        CLI_STR("lights", &j.lights, CLI_REQUIRED, "lights.txt that was found"),
        CLI_STR("lights-out", &j.lights_out, CLI_OPTIONAL, "lights.txt with the true lamps, to write"),
        CLI_STR("outdoors", &j.outdoors, CLI_OPTIONAL, "outdoors.exr that was found"),
        CLI_STR("outdoors-out", &j.outdoors_out, CLI_OPTIONAL, "outdoors.exr with the true radiance, to write"),
        CLI_STR("list", &j.list, CLI_OPTIONAL, "points and normals in the frame of the views"),
        CLI_STR("list-out", &j.list_out, CLI_OPTIONAL, "the same in the frame of the truth, to write"),
        CLI_END,
    };
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "true_light", opts, &j.prov, &err) == CLI_RUN) run(&j, &err);
    err_report(&err);
    light_list_release(&j.found);
    provenance_release(&j.prov);
    return err_exit_code(&err);
}
