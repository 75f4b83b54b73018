/* gather_irradiance.c - the irradiance at points, over a face, or of the surfaces that a view shows.
 *
 * reads   MODEL, AXES                         the unedited model and its frame
 *         VITA/atlas.txt, page0.exr, ...      the radiance of its faces
 *         OUTDOORS                            what lies outside, by direction
 *         LIGHTS                              its lamps and openings
 *         REFERENCES/ID.exr                   lighting reference images that openings name
 *         THINGS/things.txt, volume.exr       its furniture, which throws shadows and reflects
 *         MATERIALS                           fitted materials, which need VIEWS/lenses.txt, too
 *         POINTS                              points and normals, in the frame of VIEWS
 *         VIEWS/cameras.txt, images.txt       the cameras
 * writes  OUT/irradiance-parts.txt, irradiance.txt   of POINTS, in the frame of VIEWS
 *         OUT/irradiance/face-ID.txt          the same of points of a face
 *         OUT/irradiance/VIEW.exr             of each pixel of a view
 *         and for people, beside each of these:
 *         NAME.light.txt, NAME.hemicubeN.jpg  where the light comes from, and what some of the points see
 *         VIEW.white.jpg, VIEW.level.jpg, VIEW.unknown.jpg   a view's irradiance in colours */
#include "common/base/cli.h"
#include "common/base/log.h"
#include "common/gather/light_record.h"
#include "stages/gather_irradiance/field_view.h"
#include "stages/gather_irradiance/point_lists.h"

#define PARAM_STRUCT struct gather_params
static const struct param gather_param_table[] = {GATHER_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

enum { HEMICUBES = 3 };

static enum status check_params(const void *values, struct err *err) { return gather_params_check(values, err); }

struct options {
    struct model_field_files files;
    const char *axes, *references, *materials, *things, *points, *view, *views, *step;
    int face;
    bool specular;
};

/* Exactly one of the three, with what it needs. */
static enum status check_options(const struct gather_job *j, const struct options *o, struct err *err)
{
    if ((o->points != NULL) + (o->view != NULL) + (o->face > 0) != 1)
        return err_set(err, ST_USAGE, "give one of --points FILE, --view NAME and --face ID.");
    if (o->view && !o->views)
        return err_set(err, ST_USAGE, "--view %s needs --views, the folder of its camera.", o->view);
    if (o->face > 0 && !o->step)
        return err_set(err, ST_USAGE, "--face %d needs --step, the distance of its points in units of the model.",
                       o->face);
    if (j->hemicubes < 0 || j->hemicubes > LIGHT_EXAMPLES_MAX)
        return err_set(err, ST_USAGE, "--hemicubes %d: wanted a number from 0 to %d.", j->hemicubes,
                       LIGHT_EXAMPLES_MAX);
    if (o->materials && !o->views)
        return err_set(err, ST_USAGE, "--materials needs --views, the folder of the cameras in which they are marked.");
    if (o->specular && !(o->view && o->materials))
        return err_set(err, ST_USAGE, "--specular needs --view and --materials.");
    return ST_OK;
}

/* What the field knows besides its own files, all of which need the axes. */
static enum status complete_field(struct gather_job *j, const struct options *o, struct err *err)
{
    if (o->references && model_field_read_references(&j->field, o->references, &j->axes, &j->prov, err))
        return err->status;
    if (!o->materials) return ST_OK;
    if (model_field_read_materials(&j->field, o->materials, o->views, &j->axes, &j->prov, err)) return err->status;
    for (int i = 0; i < j->field.materials.list.count; i++)
        log_note("material %s: %zu texels", j->field.materials.list.items[i].name, j->field.materials.texels[i]);
    return ST_OK;
}

static enum status gather(struct gather_job *j, const struct options *o, struct err *err)
{
    double step;
    struct model_field_files files = o->files;
    if (check_options(j, o, err)) return err->status;
    if (o->things) {
        if (thing_surfaces_read(&j->things, o->things, &j->prov, err)) return err->status;
        j->furniture = thing_surfaces_of_field(&j->things);
        if (j->things.count) files.surfaces = &j->furniture;
    }
    if (model_field_read(&j->field, &files, &j->prov, err) || model_axes_read(&j->axes, o->axes, &j->prov, err) ||
        gatherer_make(&j->gatherer, &j->params, err) || complete_field(j, o, err))
        return err->status;
    if (o->points) return gather_points_of_file(j, o->points, err);
    if (o->view) return gather_view(j, o->views, o->view, o->specular, err);
    return gather_read_step(&step, o->step, err) || gather_points_of_face(j, o->face, step, err) ? err->status : ST_OK;
}

int main(int argc, char **argv)
{
    struct gather_job job = {.params = GATHER_PARAMS_DEFAULT, .hemicubes = HEMICUBES};
    struct options o = {0};
    const struct cli_opt opts[] = {
        CLI_ABOUT("The light that arrives at points, over a face, or at the surfaces that a view shows."),
        CLI_STR("model", &o.files.model, CLI_REQUIRED, "the unedited model, model.txt"),
        CLI_STR("axes", &o.axes, CLI_REQUIRED, "the model's frame, axes.txt"),
        CLI_STR("vita", &o.files.vita, CLI_REQUIRED, "folder of the view-independent atlas"),
        CLI_STR("outdoors", &o.files.outdoors, CLI_OPTIONAL, "what lies outside, by direction; without it, it is dark"),
        CLI_STR("lights", &o.files.lights, CLI_OPTIONAL, "lamps and openings, lights.txt"),
        CLI_STR("references", &o.references, CLI_OPTIONAL,
                "folder of the lighting reference images that openings name; without it, outdoors.exr alone counts"),
        CLI_STR("materials", &o.materials, CLI_OPTIONAL,
                "fitted materials, materials.txt; without it, surfaces look alike from everywhere"),
        CLI_STR("things", &o.things, CLI_OPTIONAL, "folder of the things, furniture that throws shadows and reflects"),
        CLI_STR("points", &o.points, CLI_OPTIONAL, "points and normals, X Y Z NX NY NZ a line, in the views' frame"),
        CLI_STR("view", &o.view, CLI_OPTIONAL, "view, each pixel of which gets the irradiance of its surface"),
        CLI_FLAG("specular", &o.specular,
                 "with --view and --materials: also what glossy materials reflect to the view"),
        CLI_STR("views", &o.views, CLI_OPTIONAL, "folder of cameras"),
        CLI_INT("face", &o.face, CLI_OPTIONAL, "id of a face, over which points are spread"),
        CLI_STR("step", &o.step, CLI_OPTIONAL, "distance of the points of a face, in units of the model"),
        CLI_INT("hemicubes", &job.hemicubes, CLI_OPTIONAL,
                "number of points, 0 to 9, for which a picture shows what they see (default 3)"),
        CLI_STR("out", &job.out, CLI_REQUIRED, "folder to write to"),
        CLI_PARAMS(gather_param_table, &job.params, check_params),
        CLI_END,
    };
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "gather_irradiance", opts, &job.prov, &err) == CLI_RUN) gather(&job, &o, &err);
    err_report(&err);
    gather_job_release(&job);
    return err_exit_code(&err);
}
