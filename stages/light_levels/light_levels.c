/* light_levels.c - how bright rooms and places are: the light of lamps, windows, sky and sun in groups.
 *
 * reads   MODEL, PLAN                         the unedited model, and its rooms or those of the edit
 *         VITA/atlas.txt, page0.exr, ...      the radiance of its faces
 *         OUTDOORS, LIGHTS, REFERENCES/ID.exr what lies outside; lamps and openings
 *         FIT, SKY                            how far lamps, sky and sun may be off
 *         THINGS/things.txt, volume.exr       furniture
 *         EDITED, MAP, OBJECTS, SCENE/FILE.obj of an edit: its model, textures and objects
 *         VIEWS/, PICTURES/VIEW.jpg           photographs, or pictures of the edit, to draw over
 *         PLACES, STATES, WEATHER             named places; states of lamps and sky; an EPW file
 *         FILE.ies beside STATES              photometry of planned lamps
 *         SCALE                               how many cd/m2 a radiance of 1 is
 *         BEFORE, FACTORS                     the sheet of the unedited room; what was measured there of lamps
 * writes  OUT/levels.txt, levels.exr          illuminance at each point from each group of light
 *         OUT/factors.txt                     of the unedited room: how bright lamps and windows were measured
 *         OUT/quantities.csv, openings.csv    areas of faces; openings with their sizes
 *         OUT/STATE.svg                       illuminance of the work planes on the floor plan
 *         OUT/STATE.PHOTO.svg                 illuminance of what a photograph shows, over the photograph
 *         OUT/DATE.mp4                        the day DATE as a film
 *         OUT/levels.js                       light by groups and hours, for the page of light levels
 *         OUT/relit.js                        the same of what photographs show; with --from it is read
 *         OUT/sheet.tsv                       illuminance of rooms, faces and places in each state */
#include "common/base/cli.h"
#include "common/base/scan.h"
#include "stages/light_levels/levels.h"
#include "stages/light_levels/relit_picture.h"

#define PARAM_STRUCT struct levels_params
static const struct param levels_param_table[] = {LEVELS_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

static enum status check_usage(const struct levels_job *job, struct relit_picture_files *p, const char *exposure,
                               struct err *err)
{
    const struct light_change_files *light = &job->files.light;
    p->states = job->files.states;
    p->out = job->out;
    p->photo = job->files.shown.names.count ? job->files.shown.names.items[0] : NULL;
    if (p->from && (!p->state || job->files.shown.names.count != 1))
        return err_set(err, ST_USAGE, "--from needs --state and one --photo.");
    if (exposure && (!scan_double(exposure, &p->exposure) || !(p->exposure > 0)))
        return err_set(err, ST_USAGE, "--exposure %s: wanted a number above 0.", exposure);
    if (!p->from && (p->state || exposure)) return err_set(err, ST_USAGE, "--state and --exposure go with --from.");
    if (!p->from && (!light->base || !job->files.plan || !light->axes || !light->vita))
        return err_set(err, ST_USAGE, "wanted --model, --plan, --axes and --vita, or --from. See --help.");
    if (light->edited && !light->map)
        return err_set(err, ST_USAGE, "--edited needs --map, the texture.txt of the edit.");
    return ST_OK;
}

int main(int argc, char **argv)
{
    struct levels_job job = {.params = LEVELS_PARAMS_DEFAULT};
    struct light_change_files *light = &job.files.light;
    struct relit_picture_files picture = {.from = NULL};
    const char *exposure = NULL;
    const struct cli_opt opts[] = {
        CLI_ABOUT("How bright rooms and places are, by groups of light."),
        CLI_STR("model", &light->base, CLI_OPTIONAL, "the unedited model, model.txt"),
        CLI_STR("plan", &job.files.plan, CLI_OPTIONAL, "rooms of the model, or of the edited one, plan.txt"),
        CLI_STR("axes", &light->axes, CLI_OPTIONAL, "the models' frame, axes.txt"),
        CLI_STR("vita", &light->vita, CLI_OPTIONAL, "folder of the unedited view-independent atlas"),
        CLI_STR("outdoors", &light->outdoors, CLI_OPTIONAL, "what lies outside, by direction; without it, it is dark"),
        CLI_STR("lights", &light->lights, CLI_OPTIONAL, "lamps and openings, lights.txt"),
        CLI_STR("fit", &job.files.fit, CLI_OPTIONAL,
                "how far the lamps may be off, fit.txt; without it, not at all, but for lower bounds"),
        CLI_STR("sky", &job.files.sky, CLI_OPTIONAL, "how far sky and sun may be off, sky.txt; without it, not at all"),
        CLI_STR("references", &light->references, CLI_OPTIONAL,
                "folder of the lighting reference images that openings name"),
        CLI_STR("things", &light->things, CLI_OPTIONAL,
                "folder of the things, furniture that throws shadows and reflects"),
        CLI_STR("edited", &light->edited, CLI_OPTIONAL, "the edited model, model.txt; without it, the unedited room"),
        CLI_STR("map", &light->map, CLI_OPTIONAL, "with --edited: where its faces take their texture, texture.txt"),
        CLI_STR("objects", &light->objects, CLI_OPTIONAL, "synthetic objects of the edit, objects.txt"),
        CLI_STR("scene", &light->scene, CLI_OPTIONAL, "folder of the objects' meshes"),
        CLI_STR("places", &job.files.places, CLI_OPTIONAL, "named places, places.txt"),
        CLI_STR("states", &job.files.states, CLI_OPTIONAL, "states of lamps and sky, states.txt"),
        CLI_STR("weather", &job.files.weather, CLI_OPTIONAL, "weather of a year, an EPW file, for annual figures"),
        CLI_STR("day", &job.files.day, CLI_OPTIONAL, "date, YYYY-MM-DD: a film of that day, and its hours on the page"),
        CLI_STR("scale", &job.files.scale, CLI_OPTIONAL,
                "cd/m2 of a radiance of 1, scale.txt; without it, light of the photographs is in their own unit"),
        CLI_STR("factors", &job.files.factors, CLI_OPTIONAL,
                "with --edited: factors.txt of the unedited room, by measurements in states of switches"),
        CLI_STR("before", &job.files.before, CLI_OPTIONAL, "sheet.tsv of the unedited room, to compare with"),
        CLI_STR("points", &job.files.points, CLI_OPTIONAL,
                "instead: print the photographed irradiance at points, X Y Z NX NY NZ a line, in the views' frame, and "
                "the ends of its interval of 95 % as factors"),
        CLI_FLAG("table", &job.files.table, "with --points: print their illuminance in each state instead"),
        CLI_STR("views", &job.files.shown.views, CLI_OPTIONAL, "folder of cameras and views, for pictures"),
        CLI_STR("held-views", &job.files.other.views, CLI_OPTIONAL,
                "folder of cameras and views of photos that states.txt says were taken in other light"),
        CLI_LIST("photo", &job.files.shown.names, CLI_OPTIONAL,
                 "with --views: photo to draw illuminance over; repeat for several"),
        CLI_STR("pictures", &job.files.shown.pictures, CLI_OPTIONAL,
                "folder of pictures of the edit, which are drawn over where they exist"),
        CLI_STR("relit", &job.files.shown.relit, CLI_OPTIONAL,
                "folder of its relit pictures, which count before those where all views of a photo have one"),
        CLI_STR("from", &picture.from, CLI_OPTIONAL,
                "instead: draw one photo in a state, of a folder that was written before; OUT is a PNG"),
        CLI_STR(
            "state", &picture.state, CLI_OPTIONAL,
            "with --from: name of a state, or what follows it in states.txt, such as \"lamps off sky photographed\""),
        CLI_STR("exposure", &exposure, CLI_OPTIONAL,
                "with --from: exposure, times that of the photograph; without it the room is well exposed"),
        CLI_STR("out", &job.out, CLI_REQUIRED, "folder to write to"),
        CLI_PARAMS(levels_param_table, &job.params, NULL),
        CLI_END,
    };
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "light_levels", opts, &job.prov, &err) == CLI_RUN) {
        if (!check_usage(&job, &picture, exposure, &err)) {
            if (picture.from)
                relit_picture_make(&picture, &err);
            else
                levels_run(&job, &err);
        }
    }
    err_report(&err);
    levels_release(&job);
    return err_exit_code(&err);
}
