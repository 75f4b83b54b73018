/* encode_video.c - encodes the frames of a camera move as a film, with ffmpeg.
 *
 * reads   PATH/path.txt, path/NAME.txt   frames, their order and rate
 *         FRAMES/NNNN.exr               linear colour; with --right: of the left eye
 *         RIGHT/NNNN.exr                with --right: of the right eye
 * writes  OUT                           MP4 or QuickTime */
#include "common/base/cli.h"
#include "stages/encode_video/encode.h"

struct job { /* the command line */
    const char *path, *frames, *right, *eyes, *film, *out;
    struct encode_params params;
};

static enum status run(const struct job *job, struct err *err)
{
    struct camera_path path = {0};
    struct encode_source source = {job->frames, job->right, FILM_ONE_EYE, NULL};
    if (!job->eyes != !job->right) return err_set(err, ST_USAGE, "wanted both --eyes and --right, or neither.");
    if (job->eyes) source.eyes = eyes_find(job->eyes);
    if (job->eyes && (source.eyes == FILM_EYES || source.eyes == FILM_ONE_EYE))
        return err_set(err, ST_USAGE, "--eyes %s: wanted side_by_side, top_bottom, anaglyph or vr180.", job->eyes);
    if (job->film && !(source.format = film_format_find(job->film)))
        return err_set(err, ST_USAGE, "--film %s: wanted one of %s.", job->film, film_format_names());
    if (!camera_path_read(&path, job->path, NULL, err)) encode_frames(&path, &source, job->out, &job->params, err);
    camera_path_release(&path);
    return err->status;
}

int main(int argc, char **argv)
{
    struct job job = {.params = ENCODE_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Encodes the frames of a camera move as a film."),
        CLI_STR("path", &job.path, CLI_REQUIRED, "folder of the move: path.txt and path/"),
        CLI_STR("frames", &job.frames, CLI_REQUIRED, "folder of the frames, NNNN.exr"),
        CLI_STR("right", &job.right, CLI_OPTIONAL, "folder of the right eye's frames; --frames are the left one's"),
        CLI_STR("eyes", &job.eyes, CLI_OPTIONAL,
                "how two eyes become one picture: side_by_side, top_bottom, anaglyph or vr180"),
        CLI_STR("film", &job.film, CLI_OPTIONAL,
                "format: h264 (default), av1, prores, or of high dynamic range hlg or pq"),
        CLI_STR("out", &job.out, CLI_REQUIRED, "file to write: MP4, of prores QuickTime"),
        CLI_PARAMS(encode_param_table, &job.params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;

    if (cli_parse(argc, argv, "encode_video", opts, &prov, &err) == CLI_RUN) run(&job, &err);
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
