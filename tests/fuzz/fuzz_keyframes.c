/* fuzz_keyframes.c - keyframed films: any bytes give a path of finite numbers and layers that can be written, or an
 * error message. A planned move "m" of three frames is available. (fuzz.sh compiles the sources that the headers
 * name.) */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "stages/plan_path/keyframed_film.h"
#include "stages/plan_path/keyframes.h"
#include "stages/plan_path/motion_curves.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static char folder[FUZZ_PATH];
static const char *const names[] = {"m/path.txt",    "m/path/cameras.txt", "m/path/images.txt", "m/path/points3D.txt",
                                    "m/effects.txt", "film.txt",           "layers.txt"};
static const char effects[] =
    "remodel-effects 1\nlayer a color\nregion all\nkey 0 1 1 1\nkey 9 2 2 0\n"
    "layer b brightness\nregion inside 0 0 0 1 1 1 0\nregion inside 2 0 0 4 1 1 3 axes 1 2 3 4 at 1\nkey 0 2\n";
static const char *const move[] = {
    "remodel-path 1\neffect m\nfps 2\nframes 3\nframe 0001 0 0 0\nframe 0002 0.5 0.1 3\nframe 0003 1 0.2 4\n",
    "1 PINHOLE 64 48 60 60 32 24\n2 PINHOLE 64 48 60 60 32 24\n3 PINHOLE 64 48 70 60 32 20\n",
    "1 1 0 0 0 0 0 0 1 0001.exr\n\n2 1 0 0 0 1 0 0 2 0002.exr\n\n3 0 1 0 0 2 0 1 3 0003.exr\n\n",
    "",
    effects,
};
enum { MOVE_FILES = 5, FILM = 5, LAYERS = 6, FILES = 7 };

static const char *path_of(const char *name)
{
    static char paths[2][FUZZ_PATH + 64];
    static int next;
    char *path = paths[next++ % 2];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

static void write_file(const char *name, const void *bytes, size_t size)
{
    FILE *fp = fopen(path_of(name), "wb");
    if (!fp || fwrite(bytes, 1, size, fp) != size || fclose(fp)) abort();
}

static void remove_folder(void)
{
    for (int i = 0; i < FILES; i++) unlink(path_of(names[i]));
    rmdir(path_of("m/path"));
    rmdir(path_of("m"));
    rmdir(folder);
}

static void make_folder(void)
{
    fuzz_folder(folder);
    if (mkdir(path_of("m"), 0777) || mkdir(path_of("m/path"), 0777) || atexit(remove_folder)) abort();
    for (int i = 0; i < MOVE_FILES; i++) write_file(names[i], move[i], strlen(move[i]));
}

static void check_frame(const struct path_frame *f)
{
    const struct view *v = &f->camera;
    if (!(v->fx > 0 && v->fy > 0 && isfinite(v->fx) && isfinite(v->fy)) || v->width != 64 || v->height != 48) abort();
    if (!(f->aperture >= 0 && f->focus >= 0 && isfinite(f->aperture) && isfinite(f->focus))) abort();
    if ((f->aperture > 0) != (f->focus > 0)) abort();
    if (!isfinite(vec3_length(v->center)) || !isfinite(vec3_length(v->translation))) abort();
    for (int i = 0; i < 3; i++) { /* a rotation */
        const double *r = v->cam_from_world.m[i];
        if (!(fabs(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] - 1) < 1e-9)) abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static int made;
    struct view views[2] = {{.name = "a", .width = 64, .height = 48, .fx = 60, .fy = 60, .cx = 32, .cy = 24},
                            {.name = "b", .width = 48, .height = 64, .fx = 70, .fy = 60, .cx = 24, .cy = 32}};
    const struct camera_set set = {.views = views, .view_count = 2};
    const struct vec3 ups[] = {{0, -1, 0}, {1, 0, 0}};
    struct film_settings film = {
        .name = "f", .set = &set, .ups = ups, .lens = views[0], .up = {0, -1, 0}, .moves = folder};
    struct camera_path path = {0};
    struct effects layers = {0};
    struct err err = ERR_INIT;

    if (!made++) make_folder();
    for (int i = 0; i < 2; i++) {
        views[i].cam_from_world = (struct mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        views[i].center = vec3_make(i, 0, 0);
        views[i].translation = vec3_make(-i, 0, 0);
    }
    film.fps = 0.5 + (size % 7); /* the last key falls between frames or on one */
    film.rest = size % 2;
    write_file("film.txt", data, size);
    if (keyframed_path(&path, &layers, path_of("film.txt"), &film, NULL, &err)) {
        if (!strstr(err.text, "film.txt") || path.frames || layers.layers) abort();
        return 0;
    }
    if (path.frame_count < 2) abort();
    for (int i = 0; i < path.frame_count; i++) check_frame(&path.frames[i]);
    if (effects_write(&layers, path_of("layers.txt"), NULL, &err)) abort();
    camera_path_release(&path);
    effects_release(&layers);
    return 0;
}
