/* photometry.c - intensities of a luminaire from an IES file.
 *
 * Format [IES 2002]. Lines of a label up to one that begins with TILT=; then numbers, in any lines: with TILT=INCLUDE
 * the lamp's position in the luminaire, a count, angles, factors; then lamps, lumens per lamp, multiplier, counts of
 * vertical and horizontal angles, type, unit, three sizes; ballast factor, ballast-lamp factor, watts; vertical angles;
 * horizontal angles; intensities, those of one horizontal angle after the other. The first line names the revision:
 * IESNA91, IESNA:LM-63-1995, -2002, IES:LM-63-2019; revision 1986 has no such line. Intensities are those of the file
 * times multiplier and ballast factor; the ballast-lamp factor counts up to revision 1991, later ones use the field
 * otherwise.
 *
 * Horizontal angles from 0 to 0 mean that the light is the same all around; to 90, that quarters repeat by reflection;
 * to 180, that halves do; from 90 to 270, that the halves on both sides of the plane 90 - 270 do; beyond 180, no
 * symmetry, and the last angle continues to the first.
 *
 * Mathematics. Lumens are the integral of what photometry_intensity() returns. Between vertical angles s and t an
 * intensity a + b x has the integral of (a + b x) sin x, which is b sin x - (a + b x) cos x; it is averaged over
 * horizontal angles by trapezia. Both are exact for intensities linear in the angles.
 *
 * What differs from the format: tilt in a file of its own (TILT=NAME) is refused, and so are types A and B; commas
 * between numbers are blanks. A lamp that is horizontal and stays so (position 2) is not affected by the tilt; for the
 * others the tilt is the angle between the luminaire's axis and straight down, whatever its direction. */
#include "common/daylight/photometry.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "common/base/scan.h"
#include "common/base/textfile.h"
#include "common/math/numbers.h"

enum {
    ANGLES_MAX = 4096,
    TYPE_C = 1,
    TYPE_B,
    TYPE_A,
    FEET = 1,
    METRES,
    VERTICAL_LAMP = 1,
    HORIZONTAL_LAMP,
    TILTED_LAMP
};

static const double METRES_OF_A_FOOT = 0.3048, INTENSITY_MAX = 1e12, SIZE_MAX_METRES = 1e4;

struct reader {
    struct textfile t;
    struct err *err;
};

static enum status next_number(struct reader *r, const char *what, double min, double max, double *value)
{
    char *word;
    while (!textfile_more(&r->t)) {
        if (!textfile_next(&r->t)) return textfile_error(&r->t, r->err, NULL, "%s", what);
        for (char *p = r->t.cursor; *p; p++)
            if (*p == ',' || *p == '"') *p = ' ';
    }
    if (textfile_word(&r->t, what, &word, r->err)) return r->err->status;
    return textfile_number_of(&r->t, word, what, min, max, value, r->err);
}

static enum status next_count(struct reader *r, const char *what, int min, int max, int *value)
{
    double number = 0;
    if (next_number(r, what, min, max, &number)) return r->err->status;
    if (number != floor(number)) return textfile_wrong_number(&r->t, number, "a whole number", r->err);
    *value = (int)number;
    return ST_OK;
}

/* Reads `count` numbers into memory of its own. */
static enum status next_list(struct reader *r, const char *what, size_t count, double min, double max, double **list)
{
    if (!(*list = malloc(count * sizeof **list))) return err_nomem(r->err, "a luminaire", count * sizeof **list);
    for (size_t i = 0; i < count; i++)
        if (next_number(r, what, min, max, &(*list)[i])) return r->err->status;
    return ST_OK;
}

static enum status next_angles(struct reader *r, const char *what, int count, double **list)
{
    if (next_list(r, what, (size_t)count, 0, 360, list)) return r->err->status;
    for (int i = 1; i < count; i++)
        if ((*list)[i] <= (*list)[i - 1]) {
            char found[32];
            snprintf(found, sizeof found, "%.9g", (*list)[i]);
            return textfile_error(&r->t, r->err, found, "%s, each greater than the one before (%.9g)", what,
                                  (*list)[i - 1]);
        }
    return ST_OK;
}

/* ----------------------------------------------------------------------------------------------------------- label */

static char *after_key(char *line, const char *key)
{
    const size_t n = strlen(key);
    if (strncasecmp(line, key, n)) return NULL;
    for (line += n; *line == ' ' || *line == '\t';) line++;
    return line;
}

static enum status keep_name(struct photometry *p, const char *name, struct err *err)
{
    free(p->name);
    p->name = strdup(name);
    return p->name ? ST_OK : err_nomem(err, "a name", strlen(name) + 1);
}

static enum photometry_format format_of(const char *line)
{
    if (!strncmp(line, "IESNA91", 7)) return LM63_1991;
    if (!strncmp(line, "IESNA:LM-63-1995", 16)) return LM63_1995;
    if (!strncmp(line, "IESNA:LM-63-", 12) || !strncmp(line, "IES:LM-63-", 10)) return LM63_2002;
    return LM63_1986;
}

/* The label, up to the line of the tilt, whose value is *tilt. */
static enum status read_label(struct photometry *p, struct reader *r, char **tilt)
{
    enum { NOTHING, LINE, CATALOGUE, LUMINAIRE } rank = NOTHING;
    for (bool first = true; textfile_next(&r->t); first = false) {
        char *line = r->t.cursor, *value;
        if (first) p->format = format_of(line);
        if ((value = after_key(line, "TILT"))) {
            if ((*tilt = after_key(value, "="))) return p->name ? ST_OK : keep_name(p, "", r->err);
        }
        int of_line = *line == '[' || (first && p->format != LM63_1986) ? NOTHING : LINE;
        if ((value = after_key(line, "[LUMINAIRE]"))) of_line = LUMINAIRE, line = value;
        if ((value = after_key(line, "[LUMCAT]"))) of_line = CATALOGUE, line = value;
        if (of_line <= (int)rank || !*line) continue;
        rank = of_line;
        if (keep_name(p, line, r->err)) return r->err->status;
    }
    return textfile_error(&r->t, r->err, NULL, "a line TILT=NONE or TILT=INCLUDE, as in photometric files of LM-63");
}

static enum status read_tilt(struct photometry *p, struct reader *r, char *tilt)
{
    for (char *end = tilt + strlen(tilt); end > tilt && isspace((unsigned char)end[-1]);) *--end = '\0';
    if (strcasecmp(tilt, "NONE") && strcasecmp(tilt, "INCLUDE"))
        return textfile_error(&r->t, r->err, tilt,
                              "TILT=NONE or TILT=INCLUDE; copy the numbers of that file behind a line TILT=INCLUDE");
    const bool include = !strcasecmp(tilt, "INCLUDE");
    r->t.cursor += strlen(r->t.cursor);
    if (!include) return ST_OK;
    if (next_count(r, "the lamp's position in the luminaire, 1 to 3", VERTICAL_LAMP, TILTED_LAMP, &p->tilt_geometry) ||
        next_count(r, "the number of tilt factors", 1, ANGLES_MAX, &p->tilt_count) ||
        next_angles(r, "angles of tilt", p->tilt_count, &p->tilt_angle))
        return r->err->status;
    return next_list(r, "a tilt factor", (size_t)p->tilt_count, 0, 100, &p->tilt_factor);
}

/* ------------------------------------------------------------------------------------------------------ intensities */

static enum status find_symmetry(struct photometry *p, struct reader *r)
{
    const double first = p->horizontal[0], last = p->horizontal[p->horizontal_count - 1];
    p->mirror = -1;
    p->turn = 360;
    if (p->horizontal_count == 1) return ST_OK;
    if (first == 90 && last == 270) {
        p->mirror = 90;
    } else if (first == 0 && last == 90) {
        p->mirror = 0;
        p->turn = 180;
    } else if (first == 0 && last == 180) {
        p->mirror = 0;
    } else if (first != 0 || last < 180) {
        char found[80];
        snprintf(found, sizeof found, "%.9g to %.9g", first, last);
        return textfile_error(&r->t, r->err, found,
                              "horizontal angles from 0 to 0, 90, 180 or 360, or from 90 to 270 degrees");
    }
    return ST_OK;
}

static enum status read_type(struct reader *r)
{
    int type = 0;
    if (next_count(r, "the type of photometry, 1 for C", TYPE_C, TYPE_A, &type)) return r->err->status;
    if (type == TYPE_C) return ST_OK;
    return textfile_error(
        &r->t, r->err, type == TYPE_B ? "photometry of type B" : "photometry of type A",
        "type C, whose angles count from straight down; ask the maker for such a file, or convert it");
}

static enum status read_sizes(struct photometry *p, struct reader *r)
{
    int unit = METRES;
    double *sizes[3] = {&p->width, &p->length, &p->height};
    if (next_count(r, "the unit of sizes, 1 for feet or 2 for metres", FEET, METRES, &unit)) return r->err->status;
    for (int i = 0; i < 3; i++) {
        if (next_number(r, "a size of the luminous opening", -SIZE_MAX_METRES, SIZE_MAX_METRES, sizes[i]))
            return r->err->status;
        if (unit == FEET) *sizes[i] *= METRES_OF_A_FOOT;
    }
    return ST_OK;
}

static enum status read_numbers(struct photometry *p, struct reader *r)
{
    double multiplier = 0, ballast = 0, ballast_lamp = 0;
    if (next_number(r, "the number of lamps", 0, 1e6, &p->lamps) ||
        next_number(r, "the lumens of a lamp, or -1", -1, 1e9, &p->lumens_per_lamp) ||
        next_number(r, "the multiplier of intensities", 0, 1e6, &multiplier) ||
        next_count(r, "the number of vertical angles", 2, ANGLES_MAX, &p->vertical_count) ||
        next_count(r, "the number of horizontal angles", 1, ANGLES_MAX, &p->horizontal_count) || read_type(r) ||
        read_sizes(p, r) || next_number(r, "the ballast factor", 0, 100, &ballast) ||
        next_number(r, "the ballast-lamp factor", 0, 100, &ballast_lamp) ||
        next_number(r, "the watts", 0, 1e9, &p->watts) ||
        next_angles(r, "vertical angles in degrees", p->vertical_count, &p->vertical))
        return r->err->status;
    if (p->vertical[p->vertical_count - 1] > 180)
        return textfile_wrong_number(&r->t, p->vertical[p->vertical_count - 1],
                                     "vertical angles of at most 180 degrees", r->err);
    if (next_angles(r, "horizontal angles in degrees", p->horizontal_count, &p->horizontal) || find_symmetry(p, r))
        return r->err->status;
    const size_t count = (size_t)p->vertical_count * (size_t)p->horizontal_count;
    if (count > r->t.size) /* each intensity takes a byte at least */
        return textfile_error(&r->t, r->err, NULL, "%zu intensities; the file is cut off", count);
    if (next_list(r, "an intensity in candela", count, 0, INTENSITY_MAX, &p->candela)) return r->err->status;
    const double factor = multiplier * ballast * (p->format <= LM63_1991 ? ballast_lamp : 1);
    for (size_t i = 0; i < count; i++) p->candela[i] *= factor;
    return ST_OK;
}

enum status photometry_read(struct photometry *p, const char *path, struct provenance *prov, struct err *err)
{
    struct reader r = {.err = err};
    char *tilt = NULL;
    *p = (struct photometry){0};
    if (!provenance_open(prov, "luminaire", &r.t, path, err) && !read_label(p, &r, &tilt) && !read_tilt(p, &r, tilt))
        read_numbers(p, &r);
    textfile_release(&r.t);
    if (err->status) photometry_release(p);
    return err->status;
}

void photometry_release(struct photometry *p)
{
    free(p->name);
    free(p->vertical);
    free(p->horizontal);
    free(p->candela);
    free(p->tilt_angle);
    free(p->tilt_factor);
    *p = (struct photometry){0};
}

/* ------------------------------------------------------------------------------------------------------------- use */

/* The place of x in an ascending list: index and fraction of the interval; clamped to the list's ends. */
static int interval_of(const double *list, int count, double x, double *fraction)
{
    int i = 0;
    *fraction = 0;
    if (count < 2) return 0;
    while (i < count - 2 && x >= list[i + 1]) i++;
    *fraction = clamp((x - list[i]) / (list[i + 1] - list[i]), 0, 1);
    return i;
}

/* The horizontal angle of the file that stands for any angle. */
static double folded(const struct photometry *p, double angle)
{
    if (p->horizontal_count == 1) return p->horizontal[0];
    angle -= p->turn * floor(angle / p->turn);
    if (p->mirror == 0 && angle > p->turn / 2) return p->turn - angle;
    if (p->mirror == 90 && (angle < 90 || angle > 270)) return angle < 90 ? 180 - angle : 540 - angle;
    return angle;
}

static double at_vertical(const struct photometry *p, int h, double vertical)
{
    double f;
    const int v = interval_of(p->vertical, p->vertical_count, vertical, &f);
    const double *of = p->candela + (size_t)h * (size_t)p->vertical_count + v;
    return of[0] + f * (of[1] - of[0]);
}

double photometry_intensity(const struct photometry *p, double vertical, double horizontal)
{
    if (vertical < p->vertical[0] || vertical > p->vertical[p->vertical_count - 1]) return 0;
    const int last = p->horizontal_count - 1;
    const double angle = folded(p, horizontal);
    if (last == 0) return at_vertical(p, 0, vertical);
    if (angle > p->horizontal[last]) { /* from the last angle on to the first */
        const double f = (angle - p->horizontal[last]) / (360 - p->horizontal[last]);
        return (1 - f) * at_vertical(p, last, vertical) + f * at_vertical(p, 0, vertical);
    }
    double f;
    const int h = interval_of(p->horizontal, p->horizontal_count, angle, &f);
    return (1 - f) * at_vertical(p, h, vertical) + f * at_vertical(p, h + 1, vertical);
}

double photometry_tilt(const struct photometry *p, double degrees)
{
    double f;
    if (!p->tilt_count || p->tilt_geometry == HORIZONTAL_LAMP) return 1;
    const int i = interval_of(p->tilt_angle, p->tilt_count, degrees, &f);
    return p->tilt_count < 2 ? p->tilt_factor[0] : p->tilt_factor[i] + f * (p->tilt_factor[i + 1] - p->tilt_factor[i]);
}

double photometry_candela(const struct photometry *p, struct vec3 direction, struct vec3 down, struct vec3 along)
{
    const struct vec3 across = vec3_cross(down, along);
    const double vertical = acos(clamp(vec3_dot(direction, down), -1, 1)) / DEGREE;
    const double horizontal = atan2(vec3_dot(direction, across), vec3_dot(direction, along)) / DEGREE;
    return photometry_tilt(p, acos(clamp(-down.z, -1, 1)) / DEGREE) * photometry_intensity(p, vertical, horizontal);
}

/* The integral over vertical angles of one horizontal angle's intensities, times the sine. */
static double zonal(const struct photometry *p, int h)
{
    const double *of = p->candela + (size_t)h * (size_t)p->vertical_count;
    double sum = 0;
    for (int v = 1; v < p->vertical_count; v++) {
        const double s = p->vertical[v - 1] * DEGREE, t = p->vertical[v] * DEGREE, b = (of[v] - of[v - 1]) / (t - s);
        sum += b * (sin(t) - sin(s)) - of[v] * cos(t) + of[v - 1] * cos(s);
    }
    return sum;
}

double photometry_lumens(const struct photometry *p)
{
    const int last = p->horizontal_count - 1;
    const double *angle = p->horizontal;
    double sum = 0, turn = angle[last] - angle[0];
    if (last == 0) return 2 * PI * zonal(p, 0);
    for (int h = 1; h <= last; h++) sum += (angle[h] - angle[h - 1]) * (zonal(p, h - 1) + zonal(p, h)) / 2;
    if (p->mirror < 0) {
        sum += (360 - turn) * (zonal(p, last) + zonal(p, 0)) / 2;
        turn = 360;
    }
    return 2 * PI * sum / turn;
}
