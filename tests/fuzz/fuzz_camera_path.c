/* fuzz_camera_path.c - camera paths: any bytes give a path that can be rendered, or an error.
 *
 * The input is path.txt, path/cameras.txt and path/images.txt, separated by lines "%%"; missing parts are replaced by
 * those of a valid path of two frames. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/capture/camera_path.h"
#include "tests/fuzz/fuzz_scratch.h"

static char folder[FUZZ_PATH];
static const char *const names[] = {"path.txt", "path/cameras.txt", "path/images.txt", "path/points3D.txt"};
static const char *const valid[] = {
    "remodel-path 1\neffect e\nfps 30\nframes 2\nframe 0001 0 0 0\nframe 0002 0.5 0 0\n",
    "1 PINHOLE 64 48 60 60 32 24\n2 PINHOLE 64 48 60 60 32 24\n",
    "1 1 0 0 0 0 0 0 1 0001.exr\n\n2 1 0 0 0 1 0 0 2 0002.exr\n\n",
    "",
};

static void in_folder(char *path, size_t size, const char *name) { snprintf(path, size, "%s/%s", folder, name); }

static void write_part(int part, const void *bytes, size_t size)
{
    char path[FUZZ_PATH + 64];
    in_folder(path, sizeof path, names[part]);
    FILE *fp = fopen(path, "wb");
    if (!fp || fwrite(bytes, 1, size, fp) != size || fclose(fp)) abort();
}

static void remove_folder(void)
{
    char path[FUZZ_PATH + 64];
    for (int i = 0; i < 4; i++) {
        in_folder(path, sizeof path, names[i]);
        unlink(path);
    }
    in_folder(path, sizeof path, "path");
    rmdir(path);
    rmdir(folder);
}

static void make_folder(void)
{
    char path[FUZZ_PATH + 64];
    fuzz_folder(folder);
    in_folder(path, sizeof path, "path");
    if (mkdir(path, 0777) || atexit(remove_folder)) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static int made;
    struct camera_path p;
    struct err err = ERR_INIT;

    if (!made++) make_folder();
    int part = 0;
    for (size_t at = 0; part < 3 && at < size; part++) {
        const uint8_t *end = memmem(data + at, size - at, "%%\n", 3);
        size_t length = end ? (size_t)(end - data) - at : size - at;
        write_part(part, data + at, length);
        at += length + (end ? 3 : 0);
    }
    for (; part < 4; part++) write_part(part, valid[part], strlen(valid[part]));

    if (camera_path_read(&p, folder, NULL, &err)) {
        if (!err.text[0] || p.frames) abort();
        return 0;
    }
    if (p.frame_count < 1 || !(p.fps > 0)) abort();
    for (int i = 0; i < p.frame_count; i++) {
        const struct path_frame *f = &p.frames[i];
        if (!(f->camera.fx > 0 && f->camera.fy > 0) || f->camera.width % 2 || f->camera.height % 2 ||
            !(f->time >= 0 && f->aperture >= 0 && f->focus >= 0))
            abort();
    }
    camera_path_release(&p);
    return 0;
}
