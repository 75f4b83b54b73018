/* csv_model.c - RealityScan's and RealityCapture's export "Internal/External camera parameters".
 *
 *   #name,x,y,alt,heading,pitch,roll,f,px,py,k1,k2,k3,k4,t1,t2
 * x, y, alt is the camera's centre; heading, pitch, roll are degrees: the axes of the camera, x right, y up, z
 * backward, are the columns of Rz(-heading) Rx(pitch) Ry(roll). f is the focal length for a picture 36 mm long; px, py
 * is the principal point off the middle, in parts of the picture's longer side, y down. k and t are coefficients of
 * the Brown-Conrady model. Columns may be in any order, and those from px on may be missing. Columns are separated by
 * commas, semicolons or tabs. The table has no sizes: they are those of the photos. */
#include "stages/sfm/csv_model.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"
#include "common/capture/photo_match.h"
#include "common/math/numbers.h"
#include "stages/sfm/given_cameras.h"

enum column { NAME, X, Y, ALT, HEADING, PITCH, ROLL, FOCAL, PX, PY, K1, K2, K3, K4, T1, T2, COLUMNS };
enum { REQUIRED = FOCAL + 1, MAX_FIELDS = 64 };
static const char *const titles[COLUMNS] = {"name", "x",  "y",  "alt", "heading", "pitch", "roll", "f",
                                            "px",   "py", "k1", "k2",  "k3",      "k4",    "t1",   "t2"};

/* Cuts a line into fields, in place. A field in quotes may have separators; "" is a quote in it. */
static int cut_fields(char *fields[MAX_FIELDS], char *line, char separator)
{
    int count = 0;
    for (char *p = line; p && count < MAX_FIELDS;) {
        while (*p == ' ') p++;
        char *to = p, *from = p;
        const bool quoted = *from == '"';
        from += quoted;
        fields[count++] = to;
        while (*from && (quoted ? *from != '"' || from[1] == '"' : *from != separator)) {
            if (quoted && *from == '"') from++;
            *to++ = *from++;
        }
        while (*from && *from != separator) from++;
        p = *from ? from + 1 : NULL;
        *to = '\0';
        while (to > fields[count - 1] && to[-1] == ' ') *--to = '\0';
    }
    return count;
}

struct table {
    char separator;
    int at[COLUMNS]; /* of each column; -1: missing */
};

/* Whether a line names the columns of such a table. */
static bool read_titles(struct table *t, char *line)
{
    char *fields[MAX_FIELDS];
    t->separator = strchr(line, ';') ? ';' : strchr(line, '\t') ? '\t' : ',';
    const int count = cut_fields(fields, line, t->separator);
    for (int c = 0; c < COLUMNS; c++) {
        t->at[c] = -1;
        for (int i = 0; i < count && t->at[c] < 0; i++)
            if (!strcasecmp(fields[i] + (fields[i][0] == '#'), titles[c])) t->at[c] = i;
        if (t->at[c] < 0 && c < REQUIRED) return false;
    }
    return true;
}

/* Values of a row. The decimal sign may be a comma where columns are separated by others. */
static enum status read_values(double values[COLUMNS], const struct table *t, char *const *fields, int count,
                               const char *where, struct err *err)
{
    for (int c = X; c < COLUMNS; c++) {
        char shown[SCAN_QUOTED], *field = t->at[c] >= 0 && t->at[c] < count ? fields[t->at[c]] : NULL;
        char *comma = field && t->separator != ',' ? strchr(field, ',') : NULL;
        values[c] = 0;
        if (!field && t->at[c] < 0) continue;
        if (comma) *comma = '.';
        if (!field || !scan_double(field, &values[c]))
            return err_set(err, ST_DATA, "%s: found %s, wanted the number %s.", where,
                           field ? scan_quote(shown, field) : "the end of the line", titles[c]);
    }
    return ST_OK;
}

static void axes_of(struct vec3 axes[3], double heading, double pitch, double roll)
{
    const double a = -heading * DEGREE, b = pitch * DEGREE, c = roll * DEGREE;
    const struct mat3 z = {{{cos(a), -sin(a), 0}, {sin(a), cos(a), 0}, {0, 0, 1}}};
    const struct mat3 x = {{{1, 0, 0}, {0, cos(b), -sin(b)}, {0, sin(b), cos(b)}}};
    const struct mat3 y = {{{cos(c), 0, sin(c)}, {0, 1, 0}, {-sin(c), 0, cos(c)}}};
    const struct mat3 turn = mat3_multiply(z, mat3_multiply(x, y));
    for (int k = 0; k < 3; k++) {
        const double sign = k ? -1 : 1; /* to y down, z forward */
        axes[k] = vec3_make(sign * turn.m[0][k], sign * turn.m[1][k], sign * turn.m[2][k]);
    }
}

static enum status add_row(struct sfm_model *m, const double values[COLUMNS], const char *name,
                           const struct photo_info *photo, const char *where, struct err *err)
{
    const double longer = fmax(photo->width, photo->height), focal = values[FOCAL] * longer / 36;
    const struct given_lens lens = {.width = photo->width,
                                    .height = photo->height,
                                    .fx = focal,
                                    .fy = focal,
                                    .cx = photo->width / 2.0 + values[PX] * longer,
                                    .cy = photo->height / 2.0 + values[PY] * longer,
                                    .k = {values[K1], values[K2], values[K3], values[K4]},
                                    .p = {values[T1], values[T2]}};
    struct camera c;
    struct vec3 axes[3];
    axes_of(axes, values[HEADING], values[PITCH], values[ROLL]);
    return given_lens_camera(&c, &lens, where, err) ||
                   given_cameras_add(m, name, &c, axes, vec3_make(values[X], values[Y], values[ALT]), where, err)
               ? err->status
               : ST_OK;
}

static enum status read_rows(struct sfm_model *m, struct textfile *f, const struct table *t,
                             const struct photo_list *photos, struct err *err)
{
    int unknown = 0;
    while (!err->status && textfile_next_raw(f)) {
        char *fields[MAX_FIELDS], where[FILE_PATH + 16];
        double values[COLUMNS];
        if (!textfile_more(f)) continue;
        const int count = cut_fields(fields, f->cursor, t->separator);
        const int photo = t->at[NAME] < count ? photo_list_match(photos, fields[t->at[NAME]]) : -1;
        snprintf(where, sizeof where, "%s:%d", f->path, f->line);
        unknown += photo < 0;
        if (read_values(values, t, fields, count, where, err) || photo < 0) continue;
        add_row(m, values, fields[t->at[NAME]], &photos->photos[photo].info, where, err);
    }
    if (!err->status && unknown)
        log_note("%d images of the model are not photos of the scene and are left out", unknown);
    return err->status;
}

/* Reads the file if it is such a table; *found: whether it is. */
static enum status try_table(struct sfm_model *m, bool *found, const char *path, const struct photo_list *photos,
                             struct provenance *prov, struct err *err)
{
    struct textfile f = {0};
    struct table t;
    struct err other = ERR_INIT; /* of another file: a table in UTF-16, a picture */
    if (textfile_open(&f, path, &other)) return ST_OK;
    bool any = textfile_next_raw(&f);
    while (any && (!textfile_more(&f) || !strncmp(f.cursor, "#cameras ", 9))) any = textfile_next_raw(&f);
    *found = any && read_titles(&t, f.cursor);
    if (*found && !read_rows(m, &f, &t, photos, err) && prov) provenance_add_file(prov, "model/cameras.csv", path, err);
    textfile_release(&f);
    if (*found && !err->status) given_cameras_end(m, path, err);
    return err->status;
}

enum status csv_model_read(struct sfm_model *m, bool *found, const char *folder, const struct photo_list *photos,
                           struct provenance *prov, struct err *err)
{
    struct dirent **names = NULL;
    const int count = scandir(folder, &names, NULL, alphasort);
    *m = (struct sfm_model){0};
    *found = false;
    for (int i = 0; i < count && !err->status && !*found; i++) {
        const char *dot = strrchr(names[i]->d_name, '.');
        char path[FILE_PATH];
        if (dot && !strcasecmp(dot, ".csv") && !file_path(path, folder, names[i]->d_name, "", err))
            try_table(m, found, path, photos, prov, err);
    }
    for (int i = 0; i < count; i++) free(names[i]);
    free(names);
    if (err->status) sfm_model_release(m);
    return err->status;
}
