/* morph_views.c - morphs one photograph into another: a film in which every point moves straight to its match.
 *
 * reads   RECORDS/ID.txt, PHOTOS/FILE                 two photos; merged exposures from PHOTOS/ID.exr
 *         VIEWS/cameras.txt, images.txt, points3D.txt, lenses.txt    with --views: their cameras
 * writes  OUT/first.exr, second.exr                   the photos in the film's format, and the flow between them
 *         OUT/path/NAME.txt, path.txt, frames.mk      the frames and their cameras
 * or, with --morph and --frames
 * reads   MORPH/first.exr, second.exr, path.txt, path/
 * writes  OUT/NNNN.exr                                one file per frame: R G B A */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "stages/morph_views/morph_frames.h"
#include "stages/morph_views/prepare.h"

int main(int argc, char **argv)
{
    struct morph_job job = {0};
    const char *morph = NULL, *frames = NULL, *out = NULL;
    struct morph_params params = MORPH_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Morphs one photograph into another: matches two photos, or renders frames from a finished match."),
        CLI_STR("photos", &job.photos, CLI_OPTIONAL, "folder of photographs, or of merged exposures"),
        CLI_STR("records", &job.records, CLI_OPTIONAL, "folder of the photos' records"),
        CLI_STR("first", &job.first, CLI_OPTIONAL, "id of the first photo"),
        CLI_STR("second", &job.second, CLI_OPTIONAL, "id of the second photo"),
        CLI_STR("views", &job.views, CLI_OPTIONAL, "folder of the photos' cameras and lenses, if known"),
        CLI_STR("morph", &morph, CLI_OPTIONAL, "instead of photos: folder of the match made from them"),
        CLI_STR("frames", &frames, CLI_OPTIONAL, "with --morph: frames to render, such as 1:30 or 1:30,45"),
        CLI_STR("out", &out, CLI_REQUIRED, "folder to write into"),
        CLI_PARAMS(morph_param_table, &params, morph_params_check),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "morph_views", opts, &prov, &err) == CLI_RUN) {
        const bool any = job.photos || job.records || job.first || job.second || job.views;
        const bool all = job.photos && job.records && job.first && job.second;
        if (morph ? any || !frames : !all || frames)
            err_set(&err, ST_USAGE,
                    "wanted either --photos, --records, --first and --second, or --morph and --frames.");
        else if (morph)
            morph_frames(morph, frames, out, &params, &prov, &err);
        else
            morph_prepare(&job, out, &params, &prov, &err);
    }
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
