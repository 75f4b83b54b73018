/* metashape_model.c - Agisoft Metashape's export of cameras, "Agisoft XML".
 *
 *   document / chunk / sensors / sensor id type
 *                        resolution width height
 *                        calibration class: f cx cy b1 b2 k1 k2 k3 k4 p1 p2; "adjusted" goes before "initial"
 *                    / components / component id / transform: rotation translation scale
 *                    / cameras / [group /] camera label sensor_id component_id / transform: 16 numbers
 * A camera's matrix maps its axes, x right, y down, z forward, to the axes of its component, which the component's
 * transform, if there is one, maps to those of the chunk: X = scale rotation x + translation. Cameras without a matrix
 * were not aligned. The lens, by Metashape's manual, "Camera models": with x, y on the plane z = 1, or for type fisheye
 * the direction from the axis times the angle, and r^2 = x^2 + y^2,
 *   x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6 + k4 r^8) + p1 (r^2 + 2 x^2) + 2 p2 x y, y' alike with p2 and p1,
 *   u = width / 2 + cx + x' (f + b1) + y' b2,  v = height / 2 + cy + y' f.
 * So p1 and p2 are OpenCV's p2 and p1. PhotoScan before 1.2 wrote fx, fy, and cx, cy from the corner. */
#include "stages/sfm/metashape_model.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <expat.h>

#include "common/base/array.h"
#include "common/base/file_bytes.h"
#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/base/scan.h"
#include "common/base/xml_line.h"
#include "common/capture/photo_match.h"
#include "stages/sfm/given_cameras.h"

enum number { F, FX, FY, CX, CY, B1, B2, K1, K2, K3, K4, P1, P2, NUMBERS };
static const char *const number_names[NUMBERS] = {"f",  "fx", "fy", "cx", "cy", "b1", "b2",
                                                  "k1", "k2", "k3", "k4", "p1", "p2"};
#define MAX_SKEW 0.5 /* px at the picture's border */

struct sensor {
    int id, line, width, height;
    char type[32];
    double number[NUMBERS]; /* of the calibration; f and fx 0: there is none */
    bool adjusted;
};

struct component {
    int id;
    double rotation[9], translation[3], scale;
};

struct aligned { /* a camera with a pose */
    char *label; /* owned */
    int sensor, component, line;
    double matrix[16];
};

enum { MAX_DEPTH = 32, MAX_TEXT = 2048 };

/* The state while the file is read. */
struct document {
    XML_Parser parser;
    const char *path;
    char names[MAX_DEPTH][32]; /* of the open elements */
    int depth;
    char text[MAX_TEXT]; /* inside of the innermost */
    size_t length;
    bool is_chunk; /* a chunk with sensors or cameras was seen */
    int chunks;
    struct sensor *sensors;
    struct component *components;
    struct aligned *cameras;
    int sensor_count, component_count, camera_count, unaligned;
    struct aligned camera; /* that is open */
    bool has_matrix;
    bool skips; /* the calibration that is open: there is a better one */
    struct err *err;
};

static bool inside(const struct document *d, const char *name)
{
    for (int i = 0; i < d->depth && i < MAX_DEPTH; i++)
        if (!strcmp(d->names[i], name)) return true;
    return false;
}

static const char *attribute(const char **attributes, const char *name)
{
    for (int i = 0; attributes[i]; i += 2)
        if (!strcmp(attributes[i], name)) return attributes[i + 1];
    return NULL;
}

static int int_attribute(const char **attributes, const char *name, int missing)
{
    const char *text = attribute(attributes, name);
    int64_t value;
    return text && scan_int(text, &value) && value >= 0 && value < 1000000000 ? (int)value : missing;
}

static int line_of(const struct document *d) { return (int)xml_line(d->parser); }

static void fail(struct document *d)
{
    if (d->err->status) XML_StopParser(d->parser, XML_FALSE);
}

static void begin_camera(struct document *d, const char **attributes)
{
    const char *label = attribute(attributes, "label");
    free(d->camera.label);
    d->camera = (struct aligned){label ? strdup(label) : NULL,
                                 int_attribute(attributes, "sensor_id", -1),
                                 int_attribute(attributes, "component_id", -1),
                                 line_of(d),
                                 {0}};
    d->has_matrix = false;
    if (!label)
        err_set(d->err, ST_DATA, "%s:%d: found a camera without a label, wanted the name of its photo.", d->path,
                line_of(d));
    else if (!d->camera.label)
        err_nomem(d->err, "a name", strlen(label) + 1);
}

static void begin(void *ctx, const char *name, const char **attributes)
{
    struct document *d = ctx;
    if (d->depth < MAX_DEPTH) snprintf(d->names[d->depth], sizeof *d->names, "%s", name);
    d->depth++;
    d->length = 0;
    if (!strcmp(name, "chunk")) d->chunks++;
    if (d->chunks > 1 || !inside(d, "chunk")) return;
    if (!strcmp(name, "sensor") && inside(d, "sensors")) {
        if (!array_append(&d->sensors, (size_t)d->sensor_count, sizeof *d->sensors, "sensors", d->err)) {
            struct sensor *s = &d->sensors[d->sensor_count++];
            *s = (struct sensor){.id = int_attribute(attributes, "id", -1), .line = line_of(d)};
            snprintf(s->type, sizeof s->type, "%s",
                     attribute(attributes, "type") ? attribute(attributes, "type") : "frame");
            d->is_chunk = true;
        }
    } else if (!strcmp(name, "resolution") && inside(d, "sensor") && d->sensor_count) {
        struct sensor *s = &d->sensors[d->sensor_count - 1];
        s->width = int_attribute(attributes, "width", s->width);
        s->height = int_attribute(attributes, "height", s->height);
    } else if (!strcmp(name, "calibration") && inside(d, "sensor") && d->sensor_count) {
        struct sensor *s = &d->sensors[d->sensor_count - 1];
        const char *class = attribute(attributes, "class");
        const bool adjusted = class && !strcmp(class, "adjusted");
        d->skips = s->adjusted && !adjusted;
        if (!d->skips) memset(s->number, 0, sizeof s->number); /* the one before was only initial */
        s->adjusted = s->adjusted || adjusted;
    } else if (!strcmp(name, "component") && inside(d, "components")) {
        if (!array_append(&d->components, (size_t)d->component_count, sizeof *d->components, "components", d->err))
            d->components[d->component_count++] =
                (struct component){int_attribute(attributes, "id", -1), {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0}, 1};
    } else if (!strcmp(name, "camera") && inside(d, "cameras")) {
        d->is_chunk = true;
        begin_camera(d, attributes);
    }
    fail(d);
}

static void text(void *ctx, const char *s, int length)
{
    struct document *d = ctx;
    const size_t n = (size_t)length, room = MAX_TEXT - 1 - d->length;
    memcpy(d->text + d->length, s, n < room ? n : room);
    d->length += n < room ? n : room;
}

/* The text of an element, which is `count` numbers. */
static void read_numbers(struct document *d, double *values, int count, const char *what)
{
    char shown[SCAN_QUOTED], *save = NULL;
    int n = 0;
    d->text[d->length] = '\0';
    for (char *word = strtok_r(d->text, " \t\r\n", &save); word; word = strtok_r(NULL, " \t\r\n", &save), n++) {
        if (n < count && scan_double(word, &values[n])) continue;
        err_set(d->err, ST_DATA, "%s:%d: found %s in %s, wanted %d numbers.", d->path, line_of(d),
                scan_quote(shown, word), what, count);
        return;
    }
    if (n != count)
        err_set(d->err, ST_DATA, "%s:%d: found %d numbers in %s, wanted %d.", d->path, line_of(d), n, what, count);
}

static void end_camera(struct document *d)
{
    if (!d->has_matrix) {
        d->unaligned++;
    } else if (!array_append(&d->cameras, (size_t)d->camera_count, sizeof *d->cameras, "cameras", d->err)) {
        d->cameras[d->camera_count++] = d->camera;
        d->camera.label = NULL;
    }
}

static void end(void *ctx, const char *name)
{
    struct document *d = ctx;
    const bool ours = d->chunks == 1 && inside(d, "chunk") && !d->err->status;
    if (ours && inside(d, "camera") && inside(d, "cameras")) {
        if (!strcmp(name, "transform")) {
            read_numbers(d, d->camera.matrix, 16, "the transform of a camera");
            d->has_matrix = true;
        } else if (!strcmp(name, "camera")) {
            end_camera(d);
        }
    } else if (ours && inside(d, "component") && d->component_count) {
        struct component *c = &d->components[d->component_count - 1];
        if (!strcmp(name, "rotation")) read_numbers(d, c->rotation, 9, "the rotation of a component");
        if (!strcmp(name, "translation")) read_numbers(d, c->translation, 3, "the translation of a component");
        if (!strcmp(name, "scale")) read_numbers(d, &c->scale, 1, "the scale of a component");
    } else if (ours && inside(d, "calibration") && d->sensor_count && !d->skips) {
        for (int i = 0; i < NUMBERS; i++)
            if (!strcmp(name, number_names[i])) read_numbers(d, &d->sensors[d->sensor_count - 1].number[i], 1, name);
    }
    d->depth--;
    d->length = 0;
    fail(d);
}

/* ------------------------------------------------------------------------------------------------------ the model */

/* name: of the camera's photo. */
static enum status lens_of(struct camera *c, const struct sensor *s, const char *path, const char *name,
                           const struct photo_list *photos, struct err *err)
{
    const double *n = s->number;
    const bool old = n[FX] > 0;
    const double fx = old ? n[FX] : n[F] + n[B1], fy = old ? n[FY] : n[F];
    char where[FILE_PATH + 64];
    snprintf(where, sizeof where, "%s:%d: sensor %d", path, s->line, s->id);
    if (!strcmp(s->type, "spherical")) return given_panorama_lens(c, name, photos, where, err);
    if (strcmp(s->type, "frame") != 0 && strcmp(s->type, "fisheye") != 0)
        return err_set(err, ST_DATA, "%s is of type %s, which is not supported; wanted frame, fisheye or spherical.",
                       where, s->type);
    if (!(fy > 0) || s->width < 1)
        return err_set(err, ST_DATA, "%s has no calibration with a focal length; align the photos, then export again.",
                       where);
    if (fabs(n[B2]) * s->height / (2 * fy) > MAX_SKEW)
        return err_set(err, ST_DATA,
                       "%s has the skew b2 = %.9g px, which is not supported; fix b2 at 0 and align again.", where,
                       n[B2]);
    const struct given_lens lens = {.width = s->width,
                                    .height = s->height,
                                    .fx = fx,
                                    .fy = fy,
                                    .cx = n[CX] + (old ? 0 : s->width / 2.0),
                                    .cy = n[CY] + (old ? 0 : s->height / 2.0),
                                    .k = {n[K1], n[K2], n[K3], n[K4]},
                                    .p = {n[P2], n[P1]},
                                    .fisheye = !strcmp(s->type, "fisheye")};
    return given_lens_camera(c, &lens, where, err);
}

static enum status add_camera(struct sfm_model *m, const struct document *d, const struct aligned *a,
                              const struct photo_list *photos, struct err *err)
{
    const struct sensor *sensor = NULL;
    struct component component = {0, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0}, 1};
    struct camera c;
    struct vec3 axes[3], center;
    char where[FILE_PATH + 300];
    for (int i = 0; i < d->sensor_count; i++)
        if (d->sensors[i].id == a->sensor || d->sensor_count == 1) sensor = &d->sensors[i];
    for (int i = 0; i < d->component_count; i++)
        if (d->components[i].id == a->component) component = d->components[i];
    snprintf(where, sizeof where, "%s:%d: camera \"%.200s\"", d->path, a->line, a->label);
    if (!sensor)
        return err_set(err, ST_DATA, "%s is of sensor %d, which the file does not describe.", where, a->sensor);
    if (lens_of(&c, sensor, d->path, a->label, photos, err)) return err->status;
    struct mat3 turn;
    memcpy(turn.m, component.rotation, sizeof turn.m);
    for (int k = 0; k < 3; k++) axes[k] = mat3_apply(turn, vec3_make(a->matrix[k], a->matrix[4 + k], a->matrix[8 + k]));
    center = vec3_scale(mat3_apply(turn, vec3_make(a->matrix[3], a->matrix[7], a->matrix[11])), component.scale);
    center = vec3_add(center, vec3_make(component.translation[0], component.translation[1], component.translation[2]));
    return given_cameras_add(m, a->label, &c, axes, center, where, err);
}

static void document_release(struct document *d)
{
    for (int i = 0; i < d->camera_count; i++) free(d->cameras[i].label);
    free(d->camera.label);
    free(d->cameras);
    free(d->components);
    free(d->sensors);
    if (d->parser) XML_ParserFree(d->parser);
}

static enum status parse(struct document *d, const struct file_bytes *file, struct err *err)
{
    d->err = err;
    d->parser = XML_ParserCreate(NULL);
    if (!d->parser) return err_nomem(err, "XML", 0);
    XML_SetUserData(d->parser, d);
    XML_SetElementHandler(d->parser, begin, end);
    XML_SetCharacterDataHandler(d->parser, text);
    if (file->size > INT32_MAX)
        err_set(err, ST_DATA, "%s has %zu bytes; wanted a file of cameras.", d->path, file->size);
    else if (XML_Parse(d->parser, file->bytes, (int)file->size, 1) == XML_STATUS_ERROR && !err->status)
        err_set(err, ST_DATA, "%s:%d: this is not XML: %s.", d->path, line_of(d),
                XML_ErrorString(XML_GetErrorCode(d->parser)));
    return err->status;
}

static bool names_a_document(const struct file_bytes *file)
{
    const size_t head = file->size < 400 ? file->size : 400;
    return memmem(file->bytes, head, "<document", 9) != NULL;
}

static enum status read_file(struct sfm_model *m, bool *found, const char *path, const struct photo_list *photos,
                             struct provenance *prov, struct err *err)
{
    struct document d = {.path = path};
    struct file_bytes file = {0};
    file_bytes_read(&file, path, err);
    *found = !err->status && names_a_document(&file) && (parse(&d, &file, err) || d.is_chunk);
    file_bytes_release(&file);
    if (*found && !err->status && prov) provenance_add_file(prov, "model/cameras.xml", path, err);
    for (int i = 0; *found && !err->status && i < d.camera_count; i++) add_camera(m, &d, &d.cameras[i], photos, err);
    if (*found && !err->status && d.unaligned) log_note("%d cameras of %s are not aligned", d.unaligned, path);
    if (*found && !err->status && d.chunks > 1) log_warn("%s has %d chunks; only the first is used", path, d.chunks);
    if (*found && !err->status) given_cameras_end(m, path, err);
    document_release(&d);
    return err->status;
}

enum status metashape_model_read(struct sfm_model *m, bool *found, const char *folder, const struct photo_list *photos,
                                 struct provenance *prov, struct err *err)
{
    struct dirent **names = NULL;
    const int count = scandir(folder, &names, NULL, alphasort);
    *m = (struct sfm_model){0};
    *found = false;
    for (int i = 0; i < count && !err->status && !*found; i++) {
        const char *dot = strrchr(names[i]->d_name, '.');
        char path[FILE_PATH];
        if (dot && !strcasecmp(dot, ".xml") && !file_path(path, folder, names[i]->d_name, "", err))
            read_file(m, found, path, photos, prov, err);
    }
    for (int i = 0; i < count; i++) free(names[i]);
    free(names);
    if (err->status) sfm_model_release(m);
    return err->status;
}
