/* verify.c - says whether products are whole.
 *
 * reads  FILE...   EXR, JPEG and PLY files (decoded to the last pixel or point) and text products (not empty, ending in a line break)
 * writes nothing; exit 1 with a sentence for the first file that is missing or not whole. */
#include <stdio.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/capture/point_cloud.h"
#include "common/image/exr.h"
#include "common/image/photo.h"

static enum status verify_text(const char *path, struct err *err)
{
    FILE *f = fopen(path, "rb");
    if (!f) return err_errno(err, "open", path);
    int last = fseek(f, -1, SEEK_END) ? EOF : fgetc(f);
    fclose(f);
    return last == '\n' ? ST_OK
                        : err_set(err, ST_DATA, "%s: found %s, wanted lines of text; make it again.", path,
                                  last == EOF ? "nothing" : "no line break at the end");
}

static enum status verify_photo(const char *path, struct err *err)
{
    struct photo photo = {0};
    enum status st = photo_read(&photo, path, err);
    photo_release(&photo);
    return st;
}

static enum status verify_points(const char *path, struct err *err)
{
    struct point_cloud cloud = {0};
    enum status st = point_cloud_read(&cloud, path, err);
    point_cloud_release(&cloud);
    return st;
}

static enum status verify_file(const char *path, struct err *err)
{
    size_t n = strlen(path);
    if (n >= 4 && !strcmp(path + n - 4, ".jpg")) return verify_photo(path, err);
    if (n >= 4 && !strcmp(path + n - 4, ".ply")) return verify_points(path, err);
    if (n < 4 || strcmp(path + n - 4, ".exr")) return verify_text(path, err);
    struct exr_image im = {0};
    enum status st = exr_read(&im, path, NULL, 0, err);
    exr_image_release(&im);
    return st;
}

int main(int argc, char **argv)
{
    struct cli_list files = {0};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Says whether products are whole."),
        CLI_LIST("file", &files, CLI_REQUIRED, "a product; may be given several times"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    enum cli_verdict verdict = cli_parse(argc, argv, "verify", opts, &prov, &err);

    for (int i = 0; verdict == CLI_RUN && !err.status && i < files.count; i++) verify_file(files.items[i], &err);
    err_report(&err);
    cli_list_release(&files);
    provenance_release(&prov);
    return err_exit_code(&err);
}
