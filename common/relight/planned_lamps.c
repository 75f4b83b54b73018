/* planned_lamps.c - see planned_lamps.h.
 *
 * Mathematics. A luminaire of intensity I(direction) cd at a distance d in metres gives a surface the illuminance I cos
 * / d^2, with the angle between its normal and the direction to the luminaire. That is exact far away. Nearer, within
 * about five times its size, the light is taken to leave all places of the luminous opening alike, each with the same
 * distribution, as ies2rad of [Ward 1994] does. Light through the opening's height is taken to leave its middle. */
#include "common/relight/planned_lamps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/file_path.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"
#include "common/math/numbers.h"
#include "common/texture/texture_map.h"

static const double FARTHEST = 1000, SMALLEST = 1e-3; /* m */

void planned_lamps_release(struct planned_lamps *l)
{
    for (int i = 0; i < l->count; i++) {
        photometry_release(&l->list[i].web);
        free(l->list[i].name);
    }
    free(l->list);
    free(l->path);
    *l = (struct planned_lamps){0};
}

int planned_lamps_find(const struct planned_lamps *l, const char *name)
{
    for (int i = 0; i < l->count; i++)
        if (!strcmp(l->list[i].name, name)) return i;
    return -1;
}

/* ---------------------------------------------------------------------------------------------------------- reading */

static enum status read_vector(struct textfile *t, const char *what, double min, double max, double to[3],
                               struct err *err)
{
    for (int k = 0; k < 3; k++)
        if (textfile_number(t, what, min, max, &to[k], err)) return err->status;
    return ST_OK;
}

/* Sets the directions of a lamp that is turned about its axis, whose upper end the turn is seen from. */
static void set_frame(struct planned_lamp *l, struct vec3 down, double turn)
{
    struct vec3 first = vec3_make(1, 0, 0);
    l->down = vec3_normalize(down);
    if (fabs(vec3_dot(first, l->down)) > 1 - 1e-9) first = vec3_make(0, 0, 1);
    first = vec3_normalize(vec3_sub(first, vec3_scale(l->down, vec3_dot(first, l->down))));
    const struct vec3 axis = vec3_scale(l->down, l->down.z > 0 ? 1 : -1);
    l->along = vec3_add(vec3_scale(first, cos(turn * DEGREE)), vec3_scale(vec3_cross(axis, first), sin(turn * DEGREE)));
}

static enum status read_colour(struct planned_lamp *l, struct textfile *t, struct err *err)
{
    double c[3];
    if (read_vector(t, "a colour", 0, 1e6, c, err)) return err->status;
    const struct rgb colour = rgb_make(c[0], c[1], c[2]);
    if (!(rgb_luminance(colour) > 0)) return textfile_error(t, err, "the colour 0 0 0", "a number above 0 in it");
    l->colour = rgb_scale(colour, 1 / rgb_luminance(colour));
    return ST_OK;
}

static enum status read_options(struct planned_lamp *l, struct textfile *t, struct err *err)
{
    double aim[3] = {0, 0, -1}, turn = 0;
    char *word;
    while (!err->status && textfile_more(t)) {
        if (textfile_word(t, "an option", &word, err)) break;
        if (!strcmp(word, "aim"))
            read_vector(t, "a direction", -FARTHEST, FARTHEST, aim, err);
        else if (!strcmp(word, "turn"))
            textfile_number(t, "degrees", -360, 360, &turn, err);
        else if (!strcmp(word, "colour"))
            read_colour(l, t, err);
        else
            textfile_error(t, err, word, "aim DX DY DZ, turn DEGREES or colour R G B");
    }
    const struct vec3 down = vec3_make(aim[0], aim[1], aim[2]);
    if (!err->status && !(vec3_length(down) > 0))
        return textfile_error(t, err, "aim 0 0 0", "a direction, such as 0 0 -1 for straight down");
    if (!err->status) set_frame(l, down, turn);
    return err->status;
}

/* The file is beside the one that names it. */
static enum status read_web(struct planned_lamp *l, const char *file, const struct textfile *t, struct provenance *prov,
                            struct err *err)
{
    const char *slash = strrchr(t->path, '/');
    char path[FILE_PATH], folder[FILE_PATH] = ".";
    if (!scan_is_file_name(file, ".ies"))
        return textfile_error(t, err, file,
                              "an IES file beside this one, without a folder: FILE.ies, of letters, digits and _-.@+");
    if (slash && (size_t)(slash - t->path) < sizeof folder) {
        memcpy(folder, t->path, (size_t)(slash - t->path));
        folder[slash - t->path] = '\0';
    }
    if (file_path(path, folder, file, "", err) || photometry_read(&l->web, path, NULL, err) ||
        (prov && provenance_add_file(prov, file, path, err)))
        return err_context(err, "%s:%d", t->path, t->line);
    if (photometry_lumens(&l->web) > 0) return ST_OK;
    return textfile_error(t, err, file, "an IES file with an intensity above 0");
}

enum status planned_lamps_read(struct planned_lamps *l, struct textfile *t, struct provenance *prov, struct err *err)
{
    char *word, *file;
    double at[3];
    if (array_append(&l->list, (size_t)l->count, sizeof *l->list, "lamps", err)) return err->status;
    struct planned_lamp *lamp = &l->list[l->count++];
    *lamp = (struct planned_lamp){.colour = rgb_grey(1), .line = t->line};
    if (!l->path && !(l->path = strdup(t->path))) return err_nomem(err, "a path", strlen(t->path));
    if (textfile_word(t, "a lamp's name", &word, err)) return err->status;
    if (!(lamp->name = strdup(word))) return err_nomem(err, "a name", strlen(word));
    if (!scan_is_name(word))
        return textfile_error(t, err, word, "a name of letters, digits, _ and -, which does not begin with -");
    if (planned_lamps_find(l, word) != l->count - 1)
        return textfile_error(t, err, word, "a name that no lamp above has");
    if (textfile_expect(t, "ies", err) || textfile_word(t, "an IES file", &file, err) ||
        read_web(lamp, file, t, prov, err) || textfile_expect(t, "at", err) ||
        read_vector(t, "a coordinate", -FARTHEST, FARTHEST, at, err))
        return err->status;
    lamp->at = vec3_make(at[0], at[1], at[2]);
    return read_options(lamp, t, err);
}

enum status planned_lamps_add(struct planned_lamps *l, const struct texture_planned *of, const char *folder,
                              struct provenance *prov, struct err *err)
{
    const struct rgb colour = rgb_make(of->colour[0], of->colour[1], of->colour[2]);
    char path[FILE_PATH];
    if (planned_lamps_find(l, of->name) >= 0)
        return err_set(err, ST_DATA,
                       "the edit's lamp %s has the name of a lamp of states.txt; give one of them another.", of->name);
    if (!folder)
        return err_set(err, ST_USAGE, "the edit's lamp %s has a file in the scene's folder; give --scene.", of->name);
    if (array_append(&l->list, (size_t)l->count, sizeof *l->list, "lamps", err)) return err->status;
    struct planned_lamp *lamp = &l->list[l->count++];
    *lamp = (struct planned_lamp){.name = strdup(of->name), .at = {of->at[0], of->at[1], of->at[2]}, .on = true};
    if (!lamp->name) return err_nomem(err, "a name", strlen(of->name));
    if (!(rgb_luminance(colour) > 0))
        return err_set(err, ST_DATA, "the edit's lamp %s has a colour of 0 0 0.", of->name);
    lamp->colour =
        rgb_multiply(rgb_scale(colour, 1 / rgb_luminance(colour)), rgb_make(of->scale[0], of->scale[1], of->scale[2]));
    set_frame(lamp, vec3_make(of->aim[0], of->aim[1], of->aim[2]), of->turn);
    if (file_path(path, folder, of->file, "", err) || photometry_read(&lamp->web, path, NULL, err) ||
        (prov && provenance_add_file(prov, of->file, path, err)))
        return err_context(err, "the edit's lamp %s", of->name);
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------ light */

bool planned_lamp_is_wide(const struct planned_lamp *l)
{
    return fabs(l->web.width) > SMALLEST || fabs(l->web.length) > SMALLEST;
}

/* Half the width and length in m, and whether the opening is round; a side that is missing of a round one is that of
 * the other. */
static bool half_sizes(const struct planned_lamp *l, double *width, double *length)
{
    const bool round = l->web.width < 0 || l->web.length < 0;
    *width = 0.5 * fabs(l->web.width);
    *length = 0.5 * fabs(l->web.length);
    if (round && !(*length > 0)) *length = *width;
    if (round && !(*width > 0)) *width = *length;
    return round;
}

/* The place a, b of -1 to 1 along and across the opening. */
static struct vec3 place_at(const struct planned_lamp *l, double a, double b)
{
    const struct vec3 across = vec3_cross(l->down, l->along);
    return vec3_add(l->at, vec3_add(vec3_scale(l->along, a), vec3_scale(across, b)));
}

struct vec3 planned_lamp_place(const struct planned_lamp *l, const double u[2], double metre)
{
    double width, length, a = 2 * u[0] - 1, b = 2 * u[1] - 1;
    if (half_sizes(l, &width, &length)) {
        a = sqrt(u[0]) * cos(2 * PI * u[1]);
        b = sqrt(u[0]) * sin(2 * PI * u[1]);
    }
    return place_at(l, a * length * metre, b * width * metre);
}

bool planned_lamp_covers(const struct planned_lamp *l, struct vec3 point, double metre)
{
    const struct vec3 q = vec3_sub(point, l->at);
    double width, length;
    const bool round = half_sizes(l, &width, &length);
    const double a = vec3_dot(q, l->along) / (length * metre);
    const double b = vec3_dot(q, vec3_cross(l->down, l->along)) / (width * metre);
    return round ? a * a + b * b <= 1 : fmax(fabs(a), fabs(b)) <= 1;
}

double planned_lamp_area(const struct planned_lamp *l)
{
    double width, length;
    return half_sizes(l, &width, &length) ? PI * width * length : 4 * width * length;
}

int planned_lamp_outline(struct vec3 corners[PLANNED_LAMP_CORNERS], const struct planned_lamp *l, double least,
                         double metre)
{
    static const double square[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    double width, length;
    const int count = half_sizes(l, &width, &length) ? PLANNED_LAMP_CORNERS : 4;
    width = metre * fmax(width, least / 2);
    length = metre * fmax(length, least / 2);
    for (int i = 0; i < count; i++)
        corners[i] = count == 4 ? place_at(l, square[i][0] * length, square[i][1] * width)
                                : place_at(l, length * cos(2 * PI * i / count), width * sin(2 * PI * i / count));
    return count;
}

double planned_lamp_illuminance(const struct planned_lamp *l, struct vec3 place, struct vec3 point, struct vec3 normal,
                                double metre)
{
    const struct vec3 to = vec3_sub(point, place);
    const double distance = vec3_length(to);
    if (!(distance > 0)) return 0;
    const struct vec3 direction = vec3_scale(to, 1 / distance);
    const double cosine = -vec3_dot(direction, normal), metres = distance / metre;
    if (!(cosine > 0)) return 0;
    return photometry_candela(&l->web, direction, l->down, l->along) * cosine / (metres * metres);
}
