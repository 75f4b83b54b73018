/* stereo_pair.c - makes a scene of a rectified pair with known disparities (Middlebury layouts): photos, poses, truth.
 *
 * reads   PAIR/im2.png im6.png disp2.png disp6.png                 disparities times 4, or 8 in a folder named venus
 *      or PAIR/view1.png view5.png disp1.png disp5.png             full-size disparities of a third-size pair
 *      or PAIR/NAME_left.png NAME_right.png NAME_disp.npz          float disparities of the left one; infinity: unknown
 * writes  OUT/photos/left.png right.png
 *         OUT/model/{cameras,images,points3D}.txt                  without points
 *         OUT/truth/{cameras,images}.txt, depth/{left,right}.exr   Z = PAIR_FOCAL PAIR_BASELINE / disparity, 0 unknown
 * prints  "disparities N": the smallest multiple of 16 above all true disparities; "near Z": the depth of N */
#include <errno.h>
#include <glob.h>
#include <libdeflate.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "common/base/cli.h"
#include "common/base/outfile.h"
#include "common/image/exr.h"
#include "common/image/photo.h"
#include "tests/bench/stereo_pair.h"

struct pair {
    char pictures[2][1000], disparities[2][1000]; /* left, right; "": missing */
    double unit;                                  /* px per step of an 8-bit disparity */
    int width, height;
    float *disparity[2]; /* px, 0 unknown */
};

static bool find_file(char to[1000], const char *folder, const char *pattern)
{
    char path[900];
    glob_t found;
    snprintf(path, sizeof path, "%s/%s", folder, pattern);
    bool any = glob(path, 0, NULL, &found) == 0;
    if (any) snprintf(to, 1000, "%s", found.gl_pathv[0]);
    globfree(&found);
    return any;
}

static enum status find_pair(struct pair *p, const char *folder, struct err *err)
{
    /* the last of each is the disparities of the right picture, which are optional */
    static const char *const names[3][4] = {{"im2.png", "im6.png", "disp2.png", "disp6.png"},
                                            {"view1.png", "view5.png", "disp1.png", "disp5.png"},
                                            {"*_left.png", "*_right.png", "*_disp.npz", NULL}};
    const char *slash = strrchr(folder, '/'), *name = slash ? slash + 1 : folder;
    for (int k = 0; k < 3; k++) {
        if (!find_file(p->pictures[0], folder, names[k][0]) || !find_file(p->pictures[1], folder, names[k][1]) ||
            !find_file(p->disparities[0], folder, names[k][2]))
            continue;
        if (!names[k][3] || !find_file(p->disparities[1], folder, names[k][3])) p->disparities[1][0] = 0;
        p->unit = k == 1 ? 1 / 3.0 : !strcmp(name, "venus") ? 1 / 8.0 : 1 / 4.0;
        return ST_OK;
    }
    return err_set(
        err, ST_IO,
        "%s holds no rectified pair: wanted im2.png, im6.png, disp2.png, or view1.png, view5.png, disp1.png, "
        "or NAME_left.png, NAME_right.png, NAME_disp.npz.",
        folder);
}

static enum status read_bytes(unsigned char **bytes, size_t *size, const char *path, struct err *err)
{
    struct stat info;
    FILE *f = fopen(path, "rb");
    if (!f || fstat(fileno(f), &info)) {
        err_errno(err, "read", path);
    } else if (!(*bytes = malloc((size_t)info.st_size + 1))) {
        err_nomem(err, path, (size_t)info.st_size);
    } else {
        *size = fread(*bytes, 1, (size_t)info.st_size, f);
        if (ferror(f)) err_errno(err, "read", path);
    }
    if (f) fclose(f);
    return err->status;
}

static uint32_t little(const unsigned char *p, int bytes)
{
    uint32_t v = 0;
    for (int i = bytes - 1; i >= 0; i--) v = v << 8 | p[i];
    return v;
}

/* Inflates the first file of a zip archive; 0: not an archive, or not deflated. */
static size_t first_file(unsigned char *to, size_t room, const unsigned char *zip, size_t size)
{
    size_t got = 0;
    if (size < 30 || little(zip, 4) != 0x04034b50 || little(zip + 8, 2) != 8) return 0;
    const size_t at = 30 + little(zip + 26, 2) + little(zip + 28, 2);
    struct libdeflate_decompressor *d = libdeflate_alloc_decompressor();
    if (!d || at >= size ||
        libdeflate_deflate_decompress_ex(d, zip + at, size - at, to, room, NULL, &got) != LIBDEFLATE_SUCCESS)
        got = 0;
    libdeflate_free_decompressor(d);
    return got;
}

/* The first array of an .npz archive: little-endian float32, C order, the size of the pictures. */
static enum status read_npz(float *to, const char *path, int width, int height, struct err *err)
{
    const size_t wanted = (size_t)width * (size_t)height * sizeof(float), room = wanted + 65536;
    unsigned char *zip = NULL, *npy = malloc(room);
    size_t size = 0, got = 0;
    if (npy)
        read_bytes(&zip, &size, path, err);
    else
        err_nomem(err, path, room);
    if (!err->status) got = first_file(npy, room, zip, size);
    const size_t header = got > 10 ? 10 + little(npy + 8, 2) : 0;
    char says[65536] = "";
    if (header > 10 && header <= got) memcpy(says, npy + 10, header - 10);
    if (!err->status && (!header || memcmp(npy, "\x93NUMPY", 6) || got != header + wanted || !strstr(says, "'<f4'")))
        err_set(err, ST_DATA, "%s: wanted an archive whose first array is deflated and has %d x %d floats.", path,
                width, height);
    if (!err->status) memcpy(to, npy + header, wanted);
    for (size_t i = 0; !err->status && i < wanted / sizeof(float); i++)
        if (!isfinite(to[i]) || to[i] < 0) to[i] = 0;
    free(zip);
    free(npy);
    return err->status;
}

static enum status read_disparities(struct pair *p, int side, struct err *err)
{
    const char *path = p->disparities[side];
    const size_t pixels = (size_t)p->width * (size_t)p->height;
    struct photo photo = {0};
    if (!(p->disparity[side] = malloc(pixels * sizeof(float)))) return err_nomem(err, "disparities", pixels * 4);
    if (strstr(path, ".npz")) return read_npz(p->disparity[side], path, p->width, p->height, err);
    photo_read(&photo, path, err);
    if (!err->status && (photo.info.width != p->width || photo.info.height != p->height || photo.info.bits != 8))
        err_set(err, ST_DATA, "%s: found %d x %d samples of %d bits, wanted %d x %d of 8.", path, photo.info.width,
                photo.info.height, photo.info.bits, p->width, p->height);
    for (size_t i = 0; !err->status && i < pixels; i++) p->disparity[side][i] = (float)(photo.samples[3 * i] * p->unit);
    photo_release(&photo);
    return err->status;
}

static enum status write_truth(const struct pair *p, int side, const char *out, const struct provenance *prov,
                               struct err *err)
{
    struct exr_image im = {0};
    struct exr_plane *z;
    char path[1000];
    snprintf(path, sizeof path, "%s/truth/depth/%s.exr", out, side ? "right" : "left");
    if (!exr_image_init(&im, p->width, p->height, err)) exr_add_plane(&im, "Z", EXR_FLOAT, &z, err);
    for (size_t i = 0; !err->status && i < (size_t)p->width * (size_t)p->height; i++)
        z->f[i] = p->disparity[side][i] > 0 ? (float)(PAIR_FOCAL * PAIR_BASELINE / (double)p->disparity[side][i]) : 0;
    if (!err->status && !exr_set_attribute(&im, "remodel:depth", "z", err)) exr_write(&im, path, prov, err);
    exr_image_release(&im);
    return err->status;
}

static enum status write_text(const char *folder, const char *name, const char *text, struct err *err)
{
    char path[1000];
    struct outfile f = {0};
    snprintf(path, sizeof path, "%s/%s", folder, name);
    outfile_open(&f, path, err);
    if (!err->status) {
        fputs(text, f.fp);
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
}

static enum status write_cameras(const struct pair *p, const char *out, const char *folder, struct err *err)
{
    char text[1000], to[900];
    snprintf(to, sizeof to, "%s/%s", out, folder);
    snprintf(text, sizeof text, "1 PINHOLE %d %d %.17g %.17g %.17g %.17g\n", p->width, p->height, PAIR_FOCAL,
             PAIR_FOCAL, p->width / 2.0, p->height / 2.0);
    write_text(to, "cameras.txt", text, err);
    snprintf(text, sizeof text, "1 1 0 0 0 0 0 0 1 left.png\n\n2 1 0 0 0 %.17g 0 0 1 right.png\n\n", -PAIR_BASELINE);
    if (!err->status && !write_text(to, "images.txt", text, err)) write_text(to, "points3D.txt", "", err);
    return err->status;
}

static enum status copy_picture(const struct pair *p, int side, const char *out, struct err *err)
{
    unsigned char *bytes = NULL;
    size_t size = 0;
    char path[1000];
    struct outfile f = {0};
    snprintf(path, sizeof path, "%s/photos/%s.png", out, side ? "right" : "left");
    if (!read_bytes(&bytes, &size, p->pictures[side], err)) outfile_open(&f, path, err);
    if (!err->status) {
        fwrite(bytes, 1, size, f.fp);
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    free(bytes);
    return err->status;
}

static enum status make_scene(const char *folder, const char *out, const struct provenance *prov, struct err *err)
{
    static const char *const folders[] = {"", "/photos", "/model", "/truth", "/truth/depth"};
    struct pair p = {.unit = 1};
    struct photo_info info;
    float max = 0;
    char path[1000];
    find_pair(&p, folder, err);
    for (int i = 0; !err->status && i < 5; i++) {
        snprintf(path, sizeof path, "%s%s", out, folders[i]);
        if (mkdir(path, 0777) && errno != EEXIST) err_errno(err, "make", path);
    }
    if (!err->status && !photo_read_info(&info, p.pictures[0], err)) p.width = info.width, p.height = info.height;
    for (int side = 0; !err->status && side < 2; side++) {
        copy_picture(&p, side, out, err);
        if (err->status || !p.disparities[side][0]) continue;
        if (!read_disparities(&p, side, err)) write_truth(&p, side, out, prov, err);
        for (int i = 0; !err->status && i < p.width * p.height; i++) max = fmaxf(max, p.disparity[side][i]);
    }
    if (!err->status && !write_cameras(&p, out, "model", err)) write_cameras(&p, out, "truth", err);
    if (!err->status) {
        const int disparities = (int)max / 16 * 16 + 16;
        printf("disparities %d\nnear %.17g\n", disparities, PAIR_FOCAL * PAIR_BASELINE / disparities);
    }
    free(p.disparity[0]);
    free(p.disparity[1]);
    return err->status;
}

int main(int argc, char **argv)
{
    const char *pair = NULL, *out = NULL;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Makes a scene of a rectified pair with known disparities: photos, poses, truth."),
        CLI_STR("pair", &pair, CLI_REQUIRED, "folder of the pair"),
        CLI_STR("out", &out, CLI_REQUIRED, "folder to make"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "stereo_pair", opts, &prov, &err) != CLI_RUN || make_scene(pair, out, &prov, &err))
        err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
