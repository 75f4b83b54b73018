/* true_room.c - see true_room.h. */
#include "stages/evaluate/truth/true_room.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"

enum { NUMBERS = 6 };

/* Reads the numbers that follow on the line, at most NUMBERS, and returns their number; -1: an error. *all: nothing
 * else follows. */
static int read_numbers(struct textfile *t, double values[NUMBERS], bool *all, struct err *err)
{
    int count = 0;
    char *word;
    *all = true;
    while (textfile_more(t)) {
        double value;
        if (textfile_word(t, "a number", &word, err)) return -1;
        if (count == NUMBERS || !scan_double(word, &value)) {
            *all = false;
            return count;
        }
        values[count++] = value;
    }
    return count;
}

static enum status add_room(struct true_room *room, const struct textfile *t, double floor, double ceiling,
                            struct err *err)
{
    char text[64];
    snprintf(text, sizeof text, "heights from %.9g to %.9g", floor, ceiling);
    if (!(ceiling > floor)) return textfile_error(t, err, text, "a ceiling above the floor");
    room->known = true;
    for (int i = 0; i < room->count; i++)
        if (room->heights[i].floor == floor && room->heights[i].ceiling == ceiling) return ST_OK;
    if (array_append(&room->heights, (size_t)room->count, sizeof *room->heights, "heights of rooms", err))
        return err->status;
    room->heights[room->count++] = (struct true_heights){floor, ceiling};
    return ST_OK;
}

/* The line after "room": NAME X0 Y0 X1 Y1 Z0 Z1 ... */
static enum status described_room(struct true_room *room, struct textfile *t, struct err *err)
{
    static const char *const fields[NUMBERS] = {"x0", "y0", "x1", "y1", "z0", "z1"};
    double v[NUMBERS];
    char *name;
    if (textfile_word(t, "a room's name", &name, err)) return err->status;
    for (int i = 0; i < NUMBERS; i++)
        if (textfile_double(t, fields[i], &v[i], err)) return err->status;
    return add_room(room, t, v[4], v[5], err);
}

static enum status framed_line(struct true_room *room, double *yaw, struct textfile *t, const char *word,
                               struct err *err)
{
    double v[NUMBERS];
    bool all;
    const int count = read_numbers(t, v, &all, err);
    if (count < 0) return err->status;
    if (!strcmp(word, "yaw_degrees")) {
        if (count != 1 || !all || !(fabs(v[0]) <= 360))
            return textfile_error(t, err, word, "\"yaw_degrees\" and a number from -360 to 360");
        *yaw = v[0];
    } else if (!strcmp(word, "t")) {
        if (count != 3 || !all) return textfile_error(t, err, word, "\"t\" and three numbers");
        room->origin = vec3_make(v[0], v[1], v[2]);
    } else if (count == NUMBERS && all) {
        return add_room(room, t, v[2], v[5], err);
    }
    return ST_OK;
}

enum status true_room_read_file(struct true_room *room, const char *path, bool frame, struct err *err)
{
    struct textfile t = {0};
    double yaw = 0;
    *room = (struct true_room){.framed = frame};
    textfile_open(&t, path, err);
    while (!err->status && textfile_next(&t)) {
        char *word;
        textfile_word(&t, "a word", &word, err);
        if (!err->status && frame)
            framed_line(room, &yaw, &t, word, err);
        else if (!err->status && !strcmp(word, "room"))
            described_room(room, &t, err);
    }
    textfile_release(&t);
    const double c = cos(yaw * M_PI / 180), s = sin(yaw * M_PI / 180);
    room->room_from_world = (struct mat3){{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}};
    if (err->status) true_room_release(room);
    return err->status;
}

void true_room_release(struct true_room *room)
{
    free(room->heights);
    *room = (struct true_room){0};
}

enum status true_room_read(struct true_room *room, const char *folder, struct provenance *prov, struct err *err)
{
    static const char *const names[2] = {"scene.txt", "scene-truth.txt"};
    *room = (struct true_room){0};
    for (int k = 0; k < 2; k++) {
        char path[FILE_PATH];
        struct stat info;
        if (file_path(path, folder, names[k], "", err)) return err->status;
        if (stat(path, &info) || !S_ISREG(info.st_mode)) continue;
        return provenance_add_in(prov, "truth", folder, names[k], "", path, err)
                   ? err->status
                   : true_room_read_file(room, path, k, err);
    }
    return ST_OK;
}
