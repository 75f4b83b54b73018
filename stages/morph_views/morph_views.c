/* morph_views.c - a film that goes from one photograph to another: everything moves straight to its place there.
 *
 * reads   RECORDS/ID.txt, PHOTOS/FILE                 two photos; of several exposures PHOTOS/ID.exr, merged
 *         VIEWS/cameras.txt, images.txt, points3D.txt, lenses.txt    with --views: their cameras
 * writes  OUT/first.exr, second.exr                   the photos as the film shows them, and the flow between them
 *         OUT/path/NAME.txt, path.txt, frames.mk      frames and their times
 * or, with --morph and --frames
 * reads   MORPH/first.exr, second.exr, path.txt, path/
 * writes  OUT/NNNN.exr                                R G B A, a file a frame */
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
        CLI_ABOUT(
            "Makes the frames of a film that goes from one photograph to another, or first what they are made from."),
        CLI_STR("photos", &job.photos, CLI_OPTIONAL, "folder of photographs, or of merged exposures"),
        CLI_STR("records", &job.records, CLI_OPTIONAL, "folder of the photos' records"),
        CLI_STR("first", &job.first, CLI_OPTIONAL, "id of the photo to begin with"),
        CLI_STR("second", &job.second, CLI_OPTIONAL, "id of the photo to end with"),
        CLI_STR("views", &job.views, CLI_OPTIONAL, "folder of cameras and lenses, if there are any"),
        CLI_STR("morph", &morph, CLI_OPTIONAL, "in place of photos: folder of what was made from them"),
        CLI_STR("frames", &frames, CLI_OPTIONAL, "frames to make of it: 1:30 or 1:30,45"),
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
