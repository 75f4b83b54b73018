/* mark_candidates.c - where the edge of a lamp's cone is seen in the photos.
 *
 * Rays leave the lamp's centre evenly in azimuth, and at each whole degree from its normal. Where they meet the model,
 * the views say how bright it is there. Along an azimuth, in one photo, this is a profile. At the edge of the cone it
 * falls by a step, at the same angle in all profiles; borders of things, textures and shadows fall or rise at other
 * angles in each. So at each angle the logarithm of the radiance on both sides, on one face, is fitted as a line with a
 * step. The angle is taken at which the steps, over their standard errors, are largest in the mean: borders of things
 * are clear in few of the profiles, even if these are many.
 *
 * Proposed are the profiles with the clearest steps on plain surfaces, well apart from each other: as lines across the
 * edge, and as rectangles on both sides of it that keep off it. */
#include "stages/fit_lights/mark_candidates.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/base/sort.h"
#include "common/base/textfile.h"
#include "common/capture/photo_camera.h"
#include "common/light/frame.h"
#include "common/math/numbers.h"
#include "common/product/product.h"
#include "stages/fit_lights/cone_edge.h"
#include "stages/fit_lights/observe_lights.h"

enum {
    AZIMUTHS = 72,
    ANGLES = 85, /* of 1 to ANGLES degrees from the normal */
    SIDE = 5,    /* places on each side of a step */
    GAP = 2,     /* places between the sides: the lamp has a size, so its edge is a penumbra */
    STEPS = ANGLES - 2 * SIDE - GAP + 1,
    MIN_PROFILES = 8, /* that see a step, so that its angle is sure */
    MAX_LINES = 6,
    MAX_AREAS = 4,
    APART = 4,    /* azimuths between two lines */
    MIN_LINE = 12 /* px */
};
static const double MIN_STEP = 0.03;   /* of the logarithm of the radiance */
static const double MIN_SURE = 2;      /* standard errors of a step that counts as clear */
static const double MAX_SURE = 4;      /* as many standard errors count; a border of a thing may have more */
static const double MIN_SUM = 4;       /* standard errors of all steps together */
static const double FEW = 30;          /* profiles without a step, added to those of an angle */
static const double STEP_NOISE = 0.01; /* of a step, which the profile's own noise does not show */
static const double HIGHEST = 2;       /* times the median step of plain surfaces */
static const double AREA = 0.3;        /* half side of a rectangle, of the distance from its middle to the edge */

/* The places of one lamp. */
struct place {
    struct curve_point at;
    unsigned face;
    bool met; /* the ray meets the model */
};

struct step {
    int photo, azimuth; /* photo: its first view */
    double height, sure;
    double noise; /* standard deviation of the profile about its line and step */
};

struct finder {
    const struct lit_scene *scene;
    const struct annotation_list *notes;
    const struct lit_model *model;
    struct place *places; /* by lamp (as in `lamps`), then azimuth, then angle */
    int *lamps;           /* their indices */
    int lamp_count;
    struct lit_scene probe; /* its points are the places that are met; their marks are of no person */
    int *place_of;          /* of each point */
    struct observations seen;
    float *profiles;    /* of one lamp: log radiance by photo, azimuth, colour, angle; NAN: not seen */
    struct step *steps; /* scratch: of one angle */
    double *numbers;    /* scratch: of as many */
};

static bool is_looked_at(const struct finder *f, int lamp)
{
    const struct annotation *a = &f->notes->items[f->scene->lamp_notes[lamp]];
    return a->kind == NOTE_DISK && a->has_beta == QUANTITY_FIT;
}

/* ----------------------------------------------------------------------------------------------------------- places */

static void place_rays(struct finder *f, int at)
{
    const struct lamp *l = &f->scene->lights.lamps[f->lamps[at]];
    for (int i = 0; i < AZIMUTHS * ANGLES; i++) {
        struct place *p = &f->places[at * AZIMUTHS * ANGLES + i];
        const double angle = (i % ANGLES + 1) * DEGREE, turns = (i / ANGLES) / (double)AZIMUTHS;
        const struct vec3 d = frame_direction(l->normal, sin(angle), cos(angle), turns);
        p->met = cone_edge_ray(&p->at, l, d, &f->model->rays, &p->face);
    }
}

static void list_points(struct finder *f)
{
    for (int i = 0; i < f->lamp_count * AZIMUTHS * ANGLES; i++) {
        const struct place *p = &f->places[i];
        const int lamp = f->lamps[i / (AZIMUTHS * ANGLES)];
        if (!p->met) continue;
        f->place_of[f->probe.point_count] = i;
        f->probe.points[f->probe.point_count++] = (struct lit_point){
            p->at.at, p->at.normal, lamp, f->scene->lamp_notes[lamp], i / (AZIMUTHS * ANGLES), NOTE_LINE, 0};
    }
}

static enum status find_places(struct finder *f, struct err *err)
{
    const int lamps = f->scene->lights.lamp_count;
    const size_t n = (size_t)lamps * AZIMUTHS * ANGLES + 1;
    f->lamps = calloc((size_t)lamps + 1, sizeof *f->lamps);
    f->places = calloc(n, sizeof *f->places);
    f->place_of = calloc(n, sizeof *f->place_of);
    f->probe.points = calloc(n, sizeof *f->probe.points);
    f->probe.marks = calloc((size_t)lamps + 1, sizeof *f->probe.marks);
    if (!f->lamps || !f->places || !f->place_of || !f->probe.points || !f->probe.marks)
        return err_nomem(err, "places about lamps", n * sizeof *f->places);
    for (int i = 0; i < lamps; i++) {
        if (!is_looked_at(f, i)) continue;
        f->lamps[f->lamp_count] = i;
        f->probe.marks[f->probe.mark_count++] = (struct lit_mark){f->scene->lamp_notes[i], 0, 0, -1};
        place_rays(f, f->lamp_count++);
    }
    list_points(f);
    return ST_OK;
}

/* --------------------------------------------------------------------------------------------------------- profiles */

static float *profile_of(const struct finder *f, int photo, int azimuth, int colour)
{
    return f->profiles + (((size_t)photo * AZIMUTHS + (size_t)azimuth) * 3 + (size_t)colour) * ANGLES;
}

static const struct place *places_of(const struct finder *f, int at, int azimuth)
{
    return f->places + ((size_t)at * AZIMUTHS + (size_t)azimuth) * ANGLES;
}

static void fill_profiles(struct finder *f, int at)
{
    const size_t n = (size_t)f->model->in.set.view_count * AZIMUTHS * 3 * ANGLES;
    for (size_t i = 0; i < n; i++) f->profiles[i] = NAN;
    for (int i = 0; i < f->seen.count; i++) {
        const struct observation *o = &f->seen.items[i];
        const int place = f->place_of[o->point], within = place % (AZIMUTHS * ANGLES);
        if (place / (AZIMUTHS * ANGLES) != at) continue;
        for (int c = 0; c < 3; c++)
            if (o->radiance[c] > 0)
                profile_of(f, o->photo, within / ANGLES, c)[within % ANGLES] = (float)log(o->radiance[c]);
    }
}

/* The step of a profile between its places first + SIDE - 1 and first + SIDE + GAP. False: they are not all seen, or
 * not on one face. */
static bool measure_step(struct step *s, const float *profile, const struct place *places, int first)
{
    double x[2 * SIDE], l[2 * SIDE], mean_x = 0, mean_l = 0, xx = 0, xl = 0, sx = 0, sl = 0;
    const double ss = SIDE / 2.0;
    for (int i = 0; i < 2 * SIDE; i++) {
        const int k = first + i + (i >= SIDE ? GAP : 0);
        if (!places[k].met || places[k].face != places[first].face || !isfinite(profile[k])) return false;
        x[i] = k;
        l[i] = profile[k];
        mean_x += x[i] / (2 * SIDE);
        mean_l += l[i] / (2 * SIDE);
    }
    for (int i = 0; i < 2 * SIDE; i++) {
        const double inside = i < SIDE ? 0.5 : -0.5;
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xl += (x[i] - mean_x) * (l[i] - mean_l);
        sx += inside * (x[i] - mean_x);
        sl += inside * (l[i] - mean_l);
    }
    const double det = xx * ss - sx * sx, slope = (xl * ss - sl * sx) / det;
    double rest = 0;
    s->height = (sl * xx - xl * sx) / det;
    for (int i = 0; i < 2 * SIDE; i++) {
        const double r = l[i] - mean_l - slope * (x[i] - mean_x) - s->height * (i < SIDE ? 0.5 : -0.5);
        rest += r * r / (2 * SIDE - 3);
    }
    s->noise = sqrt(rest);
    s->sure = s->height / sqrt(rest * xx / det + STEP_NOISE * STEP_NOISE);
    return true;
}

/* That of the colour in which it is least: light has a step in all colours, paint and rugs seldom. */
static bool least_step(struct step *s, const struct finder *f, int at, int photo, int azimuth, int first)
{
    const struct place *places = places_of(f, at, azimuth);
    for (int c = 0; c < 3; c++) {
        struct step one = {photo, azimuth, 0, 0, 0};
        if (!measure_step(&one, profile_of(f, photo, azimuth, c), places, first)) return false;
        if (!c || one.height < s->height) *s = one;
    }
    return true;
}

/* Fills f->steps with those at an angle; returns how many there are. *sum: of their standard errors. */
static int steps_at(double *sum, const struct finder *f, int at, int first)
{
    int count = 0;
    *sum = 0;
    for (int photo = 0; photo < f->model->in.set.view_count; photo++)
        for (int azimuth = 0; azimuth < AZIMUTHS; azimuth++) {
            struct step s;
            if (!least_step(&s, f, at, photo, azimuth, first)) continue;
            *sum += clamp(s.sure, -MAX_SURE, MAX_SURE);
            f->steps[count++] = s;
        }
    return count;
}

/* The angle of the edge, as `first` of measure_step(); -1: none is sure. */
static int find_edge(const struct finder *f, int at)
{
    int best = -1;
    double most = 0;
    for (int first = 0; first < STEPS; first++) {
        double sum;
        int clear = 0;
        const int count = steps_at(&sum, f, at, first);
        for (int i = 0; i < count; i++) clear += f->steps[i].height >= MIN_STEP && f->steps[i].sure >= MIN_SURE;
        if (sum < MIN_SUM * sqrt(count) || clear < MIN_PROFILES || sum / (count + FEW) <= most) continue;
        most = sum / (count + FEW);
        best = first;
    }
    return best;
}

static double edge_angle(int first) { return first + SIDE + 0.5 * (GAP + 1); } /* degrees */

/* ---------------------------------------------------------------------------------------------------------- drawing */

struct sheet {
    const struct finder *f;
    struct photo_camera camera;
    const char *lamp, *photo;
    int at, first;
};

static bool pixel_at(double pixel[2], const struct sheet *s, int azimuth, int angle)
{
    const struct place *p = &places_of(s->f, s->at, (azimuth + AZIMUTHS) % AZIMUTHS)[angle];
    if (!p->met) return false;
    const struct vec3 world = world_from_model_point(&s->f->model->in.axes, p->at.at);
    return photo_camera_project(&s->camera, world, &pixel[0], &pixel[1]) && pixel[0] > 0 && pixel[1] > 0 &&
           pixel[0] < s->camera.lens.width && pixel[1] < s->camera.lens.height;
}

/* The line across the step; false: it is too short. */
static bool line_of(double line[4], const struct sheet *s, int azimuth)
{
    return pixel_at(line, s, azimuth, s->first) && pixel_at(line + 2, s, azimuth, s->first + 2 * SIDE + GAP - 1) &&
           hypot(line[2] - line[0], line[3] - line[1]) >= MIN_LINE;
}

/* A rectangle about the outermost place of a side, that keeps off the edge. */
static bool area_of(double area[4], const struct sheet *s, int azimuth, bool lit)
{
    double middle[2], nearest = INFINITY;
    if (!pixel_at(middle, s, azimuth, lit ? s->first : s->first + 2 * SIDE + GAP - 1)) return false;
    for (int d = -APART; d <= APART; d++) {
        double edge[2];
        if (!pixel_at(edge, s, azimuth + d, s->first + SIDE + (lit ? -1 : GAP))) continue;
        nearest = fmin(nearest, hypot(edge[0] - middle[0], edge[1] - middle[1]));
    }
    const double half = AREA * nearest;
    if (!(half >= 1 && isfinite(half))) return false;
    for (int k = 0; k < 4; k++) area[k] = middle[k % 2] + (k < 2 ? -half : half);
    return area[0] > 0 && area[1] > 0 && area[2] < s->camera.lens.width && area[3] < s->camera.lens.height;
}

/* Places of one face are taken for one material. */
static void print_mark(FILE *to, const char *word, const struct sheet *s, int azimuth, const double pixel[4])
{
    const struct place *p = &places_of(s->f, s->at, azimuth)[s->first];
    fprintf(to, "%s %s in %s %.1f %.1f %.1f %.1f of %s\n", word, s->lamp, s->photo, pixel[0], pixel[1], pixel[2],
            pixel[3], solid_face_name(&s->f->model->rays.mesh, (int)p->face));
}

static int compare_steps(const void *a, const void *b)
{
    const struct step *x = a, *y = b;
    if (x->sure != y->sure) return x->sure < y->sure ? 1 : -1;
    return x->photo != y->photo ? x->photo - y->photo : x->azimuth - y->azimuth;
}

static bool is_near(const int *taken, int count, int azimuth)
{
    for (int i = 0; i < count; i++) {
        const int d = abs(taken[i] - azimuth);
        if (d < APART || AZIMUTHS - d < APART) return true;
    }
    return false;
}

/* What steps on plain surfaces have: those on posters and rugs are noisier, or higher than the others. */
static void find_plain(double *noise, double *height, const struct finder *f, int count)
{
    double *values = f->numbers;
    int clear = 0;
    for (int i = 0; i < count; i++) values[i] = f->steps[i].noise;
    *noise = sort_median(values, (size_t)count);
    for (int i = 0; i < count; i++)
        if (f->steps[i].height >= MIN_STEP && f->steps[i].sure >= MIN_SURE && f->steps[i].noise <= *noise)
            values[clear++] = f->steps[i].height;
    *height = clear ? sort_median(values, (size_t)clear) : 0;
}

/* Prints marks at the clearest of `count` steps; returns how many lines there are. */
static int print_marks(FILE *to, struct sheet *s, int count, struct err *err)
{
    double noise, height;
    const struct lit_model *model = s->f->model;
    int taken[MAX_LINES], lines = 0, areas[2] = {0, 0};
    find_plain(&noise, &height, s->f, count);
    qsort(s->f->steps, (size_t)count, sizeof *s->f->steps, compare_steps);
    for (int i = 0; !err->status && i < count && lines < MAX_LINES; i++) {
        const struct step *step = &s->f->steps[i];
        const struct lens *lens = photo_lens_of_view(&model->in.set, &model->in.lenses, step->photo);
        s->photo = lens ? lens->photo : model->in.set.views[step->photo].name;
        double pixel[4];
        if (step->height < MIN_STEP || step->sure < MIN_SURE) break;
        if (step->noise > noise || step->height > HIGHEST * height) continue;
        if (is_near(taken, lines, step->azimuth)) continue;
        if (photo_camera_find(&s->camera, s->photo, &model->in.set, &model->in.lenses, s->f->notes->path, 1, err))
            break;
        if (!line_of(pixel, s, step->azimuth)) continue;
        taken[lines++] = step->azimuth;
        print_mark(to, "line", s, step->azimuth, pixel);
        for (int lit = 0; lit < 2; lit++) {
            if (areas[lit] >= MAX_AREAS || !area_of(pixel, s, step->azimuth, lit)) continue;
            areas[lit]++;
            print_mark(to, lit ? "lit" : "unlit", s, step->azimuth, pixel);
        }
    }
    return lines;
}

static bool has_line(const struct finder *f, int lamp)
{
    for (int i = 0; i < f->notes->count; i++)
        if (f->notes->items[i].kind == NOTE_LINE && f->notes->items[i].lamp == f->scene->lamp_notes[lamp]) return true;
    return false;
}

static enum status print_lamp(FILE *to, const struct finder *f, int at, const char *path, struct err *err)
{
    const int lamp = f->lamps[at];
    char name[600];
    struct sheet s = {.f = f, .lamp = name, .at = at};
    double sum;
    if (textfile_quote(f->scene->lights.lamps[lamp].name, name, sizeof name, err)) return err->status;
    fill_profiles((struct finder *)f, at);
    s.first = find_edge(f, at);
    if (s.first < 0) {
        fprintf(to, "# %s: the photos show no edge of its cone\n", name);
        return ST_OK;
    }
    const int count = steps_at(&sum, f, at, s.first);
    fprintf(to, "# %s: the edge of its cone seems to be %.1f degrees from its normal\n", name, edge_angle(s.first));
    const int lines = print_marks(to, &s, count, err);
    if (lines && !has_line(f, lamp))
        log_note("no line of %s is marked across the edge of its cone; %s proposes %d of them", name, path, lines);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- writing */

static enum status print_all(struct finder *f, const char *path, const struct provenance *prov, struct err *err)
{
    struct outfile out = {0};
    const size_t profiles = (size_t)f->model->in.set.view_count * AZIMUTHS;
    f->profiles = malloc((profiles * 3 * ANGLES + 1) * sizeof *f->profiles);
    f->steps = malloc((profiles + 1) * sizeof *f->steps);
    f->numbers = malloc((profiles + 1) * sizeof *f->numbers);
    if (!f->profiles || !f->steps || !f->numbers)
        return err_nomem(err, "profiles", profiles * 3 * ANGLES * sizeof *f->profiles);
    product_begin(&out, PRODUCT_MARK_CANDIDATES, path, prov, err);
    for (int i = 0; !err->status && i < f->lamp_count; i++) print_lamp(out.fp, f, i, path, err);
    if (!err->status) outfile_commit(&out, err);
    outfile_discard(&out);
    return err->status;
}

enum status mark_candidates_write(const struct lit_scene *scene, const struct annotation_list *notes,
                                  const struct lit_model *model, const struct model_rays *furnished, const char *views,
                                  const char *ids, const struct fit_lights_params *params, const char *path,
                                  struct provenance *prov, struct err *err)
{
    struct finder f = {.scene = scene, .notes = notes, .model = model};
    if (!find_places(&f, err)) {
        if (!f.lamp_count)
            unlink(path); /* of an earlier run */
        else if (!observe(&f.seen, &f.probe, notes, model, furnished, views, ids, params, prov, err))
            print_all(&f, path, prov, err);
    }
    observe_release(&f.seen);
    free(f.lamps);
    free(f.places);
    free(f.place_of);
    free(f.probe.points);
    free(f.probe.marks);
    free(f.profiles);
    free(f.steps);
    free(f.numbers);
    return err->status;
}
