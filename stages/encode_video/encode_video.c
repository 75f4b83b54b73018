/* encode_video.c - encodes the frames of a camera move as a video, with ffmpeg.
 *
 * reads   PATH/path.txt, path/NAME.txt   frames, their order and rate
 *         FRAMES/NNNN.exr               linear colour
 * writes  OUT                           MP4, H.264 */
#include "common/base/cli.h"
#include "stages/encode_video/encode.h"

int main(int argc, char **argv)
{
    const char *path_folder = NULL, *frames = NULL, *out = NULL;
    struct encode_params params = ENCODE_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Encodes the frames of a camera move as an H.264 video."),
        CLI_STR("path", &path_folder, CLI_REQUIRED, "folder of the move: path.txt and path/"),
        CLI_STR("frames", &frames, CLI_REQUIRED, "folder of the frames, NNNN.exr"),
        CLI_STR("out", &out, CLI_REQUIRED, "MP4 file to write"),
        CLI_PARAMS(encode_param_table, &params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct camera_path path = {0};
    struct err err = ERR_INIT;

    if (cli_parse(argc, argv, "encode_video", opts, &prov, &err) != CLI_RUN ||
        camera_path_read(&path, path_folder, NULL, &err) || encode_frames(&path, frames, out, &params, &err))
        err_report(&err);
    camera_path_release(&path);
    provenance_release(&prov);
    return err_exit_code(&err);
}
