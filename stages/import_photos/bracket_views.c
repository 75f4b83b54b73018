/* bracket_views.c - which photographs are exposures of one view, by the rules in bracket_views.h. */
#include "stages/import_photos/bracket_views.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/array.h"
#include "common/base/log.h"
#include "common/base/sort.h"
#include "stages/import_photos/bracket_cycle.h"
#include "stages/import_photos/bracket_list.h"
#include "stages/import_photos/photo_order.h"

enum { MAX_DISTINCT = 16 /* references of one view */, MAX_NAMED = 8, TEXT_SIZE = 160 };

/* The time as cameras display it. */
static const char *show_seconds(char text[32], const struct exposure *e)
{
    if (!(e->seconds > 0))
        strcpy(text, "no exposure time");
    else if (e->seconds < 0.4)
        snprintf(text, 32, "1/%.5g s", 1 / e->seconds);
    else
        snprintf(text, 32, "%.5g s", e->seconds);
    return text;
}

static void append(char *text, size_t size, const char *separator, const char *word)
{
    size_t n = strlen(text);
    snprintf(text + n, size - n, "%s%s", n ? separator : "", word);
}

/* -------------------------------------------------------------------------------------------------------- exposures */

static int find_file(const struct photo_scan *scan, const char *file)
{
    for (int i = 0; i < scan->count; i++)
        if (!strcmp(scan->photos[i].file, file)) return i;
    return -1;
}

static void apply_line(struct exposure *e, const struct exposure *own)
{
    if (own->seconds > 0) e->seconds = own->seconds;
    if (own->f_number > 0) e->f_number = own->f_number;
    if (own->iso > 0) e->iso = own->iso;
    e->filter = own->filter;
}

/* What is unknown of a photo is that of all. */
static void apply_to_all(struct exposure *exposures, int count, const struct exposure *all)
{
    for (int i = 0; i < count; i++) {
        struct exposure *e = &exposures[i];
        if (!(e->seconds > 0)) e->seconds = all->seconds;
        if (!(e->f_number > 0)) e->f_number = all->f_number;
        if (!(e->iso > 0)) e->iso = all->iso;
        if (e->filter == 1) e->filter = all->filter;
    }
}

static enum status apply_list(struct exposure *exposures, const struct photo_scan *scan, const char *folder,
                              struct err *err)
{
    struct exposure_list list = {0};
    char *path = NULL, shown[TEXT_SIZE];
    if (asprintf(&path, "%s/exposures.txt", folder) < 0) return err_nomem(err, "a path", 0);
    if (!access(path, F_OK)) exposure_list_read(&list, path, err);
    for (int i = 0; !err->status && i < list.count; i++) {
        const struct exposure_line *line = &list.lines[i];
        int at = find_file(scan, line->file);
        if (at < 0 && !strcmp(line->file, EXPOSURE_OF_ALL)) continue;
        snprintf(shown, sizeof shown, "%s", line->file);
        if (at < 0) {
            err_set(err, ST_DATA,
                    "%s:%d: found %s, wanted the name of a photo in %s; correct the name or remove the line.", path,
                    line->line, shown, scan->folder);
            break;
        }
        apply_line(&exposures[at], &line->exposure);
    }
    for (int i = 0; !err->status && i < list.count; i++)
        if (!strcmp(list.lines[i].file, EXPOSURE_OF_ALL)) apply_to_all(exposures, scan->count, &list.lines[i].exposure);
    exposure_list_release(&list);
    free(path);
    return err->status;
}

static enum status find_exposures(struct bracket_views *v, const struct photo_scan *scan, const char *scene,
                                  struct err *err)
{
    v->exposures = calloc((size_t)scan->count + 1, sizeof *v->exposures);
    if (!v->exposures) return err_nomem(err, "exposures", (size_t)scan->count * sizeof *v->exposures);
    for (int i = 0; i < scan->count; i++) {
        const struct photo_info *info = &scan->photos[i].record.info;
        v->exposures[i] = (struct exposure){info->seconds, info->f_number, info->iso, 1};
    }
    if (!apply_list(v->exposures, scan, scan->folder, err) && scene) apply_list(v->exposures, scan, scene, err);
    return err->status;
}

enum status bracket_views_take_exposures(struct photo_scan *scan, const char *scene, struct err *err)
{
    struct bracket_views v = {0};
    find_exposures(&v, scan, scene, err);
    for (int i = 0; !err->status && i < scan->count; i++) {
        struct photo_info *info = &scan->photos[i].record.info;
        info->seconds = v.exposures[i].seconds;
        info->f_number = v.exposures[i].f_number;
        info->iso = v.exposures[i].iso / v.exposures[i].filter;
    }
    free(v.exposures);
    return err->status;
}

/* --------------------------------------------------------------------------------------------------------- grouping */

static enum status add_view(struct bracket_views *v, const char *id, const int *photos, int count, struct err *err)
{
    if (array_append(&v->views, (size_t)v->count, sizeof *v->views, "views", err)) return err->status;
    struct bracket_view *view = &v->views[v->count++];
    *view = (struct bracket_view){strdup(id), malloc((size_t)count * sizeof *photos), count, 0};
    if (!view->id || !view->photos) return err_nomem(err, "a view", (size_t)count * sizeof *photos);
    memcpy(view->photos, photos, (size_t)count * sizeof *photos);
    return ST_OK;
}

static enum status views_of_line(struct bracket_views *v, const struct photo_scan *scan,
                                 const struct bracket_list *list, const struct bracket_line *line, bool *listed,
                                 struct err *err)
{
    int *photos = malloc((size_t)line->count * sizeof *photos), count = 0;
    if (!photos) err_nomem(err, "a view", (size_t)line->count * sizeof *photos);
    for (int k = 0; !err->status && k < line->count; k++) {
        int at = find_file(scan, line->files[k]);
        if (at < 0) {
            err_set(err, ST_DATA,
                    "%s:%d: found %.100s, wanted the name of a photo in %s; correct the name or remove it.", list->path,
                    line->line, line->files[k], scan->folder);
            break;
        }
        listed[at] = true;
        if (!scan->photos[at].excluded) photos[count++] = at;
    }
    if (!err->status && count) add_view(v, line->view, photos, count, err);
    free(photos);
    return err->status;
}

static enum status group_by_list(struct bracket_views *v, const struct photo_scan *scan, const char *path,
                                 struct err *err)
{
    struct bracket_list list = {0};
    char names[512] = "";
    int missing = 0;
    bool *listed = calloc((size_t)scan->count + 1, sizeof *listed);
    if (listed)
        bracket_list_read(&list, path, err);
    else
        err_nomem(err, "photos", (size_t)scan->count);
    for (int i = 0; !err->status && i < list.count; i++) views_of_line(v, scan, &list, &list.lines[i], listed, err);
    for (int i = 0; !err->status && i < scan->count; i++)
        if (!listed[i] && !scan->photos[i].excluded && missing++ < MAX_NAMED)
            append(names, sizeof names, ", ", scan->photos[i].file);
    if (!err->status && missing)
        err_set(err, ST_DATA,
                "%s has no view with %s%s (%d of the photos in %s); add them to a line, or leave them out (EXCLUDE).",
                path, names, missing > MAX_NAMED ? ", ..." : "", missing, scan->folder);
    bracket_list_release(&list);
    free(listed);
    return err->status;
}

struct ordered { /* the photos that are not excluded, in the order of the camera */
    int *photos;
    struct bracket_shot *shots;
    int count;
    enum photo_order order;
    struct bracket_cycle cycle;
    enum bracket_verdict verdict;
};

static void release_ordered(struct ordered *o)
{
    free(o->photos);
    free(o->shots);
}

/* Looks for a cycle in one order of the photos. Without their times there is none in order of time. */
static enum status find_ordered(struct ordered *o, enum photo_order order, const struct bracket_views *v,
                                const struct photo_scan *scan, enum bracket_wish wish, struct err *err)
{
    size_t room = (size_t)scan->count + 1;
    *o = (struct ordered){.photos = calloc(room, sizeof *o->photos), .order = order};
    o->shots = calloc(room, sizeof *o->shots);
    if (!o->photos || !o->shots) return err_nomem(err, "photos", room * sizeof *o->shots);
    if (photo_order_find(o->photos, &o->count, scan, order, err)) return err->status;
    for (int i = 0; i < o->count; i++) {
        const struct exposure *e = &v->exposures[o->photos[i]];
        o->shots[i] =
            (struct bracket_shot){exposure_value(e), e->seconds, scan->photos[o->photos[i]].record.info.taken};
    }
    o->verdict = o->count ? bracket_cycle_find(&o->cycle, o->shots, o->count, wish) : BRACKETS_NONE;
    return ST_OK;
}

/* The order of time, unless the photos have a complete cycle only in that of names, or no times. */
static enum status order_photos(struct ordered *o, const struct bracket_views *v, const struct photo_scan *scan,
                                enum bracket_wish wish, struct err *err)
{
    struct ordered by_name = {0};
    find_ordered(o, ORDER_BY_TIME, v, scan, wish, err);
    if (!err->status && o->verdict != BRACKETS_ALL) find_ordered(&by_name, ORDER_BY_NAME, v, scan, wish, err);
    if (!err->status && (!o->count || by_name.verdict == BRACKETS_ALL)) {
        const struct ordered other = *o;
        *o = by_name;
        by_name = other;
    }
    release_ordered(&by_name);
    return err->status;
}

static void show_shots(char *text, size_t size, const struct bracket_views *v, const struct ordered *o, int begin,
                       int count)
{
    char one[32];
    *text = 0;
    for (int k = begin; k < begin + count; k++)
        append(text, size, ", ", show_seconds(one, &v->exposures[o->photos[k]]));
}

static enum status incomplete(const struct bracket_views *v, const struct photo_scan *scan, const struct ordered *o,
                              struct err *err)
{
    const struct bracket_cycle *c = &o->cycle;
    char cycle[400], odd[700] = "", ids[400] = "", one[32];
    int count = 0;
    for (int at = 0; at < o->count;) {
        bool occurs = bracket_cycle_at(c, o->shots, o->count, at);
        const struct scanned_photo *p = &scan->photos[o->photos[at]];
        if (!occurs && count++ < MAX_NAMED) {
            char *text = NULL;
            if (asprintf(&text, "%s (%s)", p->file, show_seconds(one, &v->exposures[o->photos[at]])) < 0)
                return err_nomem(err, "a text", 0);
            append(odd, sizeof odd, ", ", text);
            append(ids, sizeof ids, " ", p->id);
            free(text);
        }
        at += occurs ? c->length : 1;
    }
    const char *more = count > MAX_NAMED ? " ..." : "";
    show_shots(cycle, sizeof cycle, v, o, c->begin, c->length);
    return err_set(
        err, ST_DATA,
        "the photos in %s are brackets of %s%s in order of %s, but these belong to no complete one: "
        "%s%s. Add the missing photos (a missing time: to exposures.txt), leave these out (EXCLUDE = %s%s), list "
        "the photos of each view in the scene's brackets.txt, or set [import_photos] brackets = no.",
        scan->folder, cycle, c->steps ? " (the first; others have the same steps)" : "",
        o->order == ORDER_BY_TIME ? "time" : "file name", odd, more, ids, more);
}

/* Photos that jump may be brackets that no rule finds. */
static void warn_of_jumps(const struct bracket_views *v, const struct photo_scan *scan, const struct ordered *o)
{
    char text[400];
    show_shots(text, sizeof text, v, o, 0, o->count < MAX_NAMED ? o->count : MAX_NAMED);
    log_warn("the exposures of the photos in %s jump from photo to photo (%s%s), but form no cycle of brackets; each "
             "photo becomes a view of its own. If some are exposures of one view, list the photos of each view in the "
             "scene's brackets.txt; if not, [import_photos] brackets = no ends this warning.",
             scan->folder, text, o->count > MAX_NAMED ? ", ..." : "");
}

static enum status group_by_cycle(struct bracket_views *v, const struct photo_scan *scan, bool required,
                                  struct err *err)
{
    struct ordered o = {0};
    char text[400];
    order_photos(&o, v, scan, required ? BRACKETS_MUST_BE : scan->references ? BRACKETS_LIKELY : BRACKETS_MAY_BE, err);
    const struct bracket_cycle *c = &o.cycle;
    if (!err->status && o.verdict == BRACKETS_ALL) {
        for (int at = 0; !err->status && at < o.count; at += c->length) add_view(v, "", o.photos + at, c->length, err);
        show_shots(text, sizeof text, v, &o, c->begin, c->length);
        if (!err->status)
            log_note("%d views of %d exposures each: %s%s", c->count, c->length, text,
                     c->steps ? "; the others have the same steps" : "");
    } else if (!err->status && o.verdict == BRACKETS_SOME) {
        incomplete(v, scan, &o, err);
    } else if (!err->status && required) {
        err_set(err, ST_DATA,
                "[import_photos] brackets is yes, but the exposures of the %d photos in %s form no cycle that "
                "occurs at least twice; list the photos of each view in the scene's brackets.txt.",
                o.count, scan->folder);
    } else if (!err->status && o.verdict == BRACKETS_JUMPS && !scan->references) {
        warn_of_jumps(v, scan, &o);
    }
    release_ordered(&o);
    return err->status;
}

static bool any_linear(const struct photo_scan *scan, const char **file)
{
    for (int i = 0; i < scan->count; i++)
        if (!scan->photos[i].excluded && scan->photos[i].record.info.bits == 32) {
            *file = scan->photos[i].file;
            return true;
        }
    return false;
}

/* COLMAP reads JPEG and PNG everywhere, other kinds in some builds or not in 16 bits. NULL: there are no others. */
static const char *other_kind(const struct photo_scan *scan)
{
    for (int i = 0; i < scan->count; i++) {
        const enum photo_kind kind = scan->photos[i].kind;
        if (!scan->photos[i].excluded && kind != PHOTO_KIND_JPEG && kind != PHOTO_KIND_PNG) return scan->photos[i].file;
    }
    return NULL;
}

/* HEIC, AVIF, WebP or JPEG XL, which COLMAP does not read. */
static const char *unread_kind(const struct photo_scan *scan)
{
    for (int i = 0; i < scan->count; i++)
        if (!scan->photos[i].excluded && scan->photos[i].kind >= PHOTO_KIND_HEIF) return scan->photos[i].file;
    return NULL;
}

/* All photos as one view, if no two exposures are equal: a bracket that does not repeat. */
static enum status group_distinct(struct bracket_views *v, const struct photo_scan *scan, struct err *err)
{
    int photos[MAX_DISTINCT], count = 0;
    for (int i = 0; i < scan->count; i++) {
        if (scan->photos[i].excluded) continue;
        const double value = exposure_value(&v->exposures[i]);
        if (count == MAX_DISTINCT || !(value > 0)) return ST_OK;
        for (int k = 0; k < count; k++)
            if (bracket_equal(value, exposure_value(&v->exposures[photos[k]]))) return ST_OK;
        photos[count++] = i;
    }
    return count > 1 ? add_view(v, "", photos, count, err) : ST_OK;
}

/* Whether the same of time, f-number and ISO is known of both. */
static bool known_alike(const struct exposure *a, const struct exposure *b)
{
    return (a->seconds > 0) == (b->seconds > 0) && (a->f_number > 0) == (b->f_number > 0) &&
           (a->iso > 0) == (b->iso > 0);
}

/* may_equal: photos of unknown exposure among others make all equal, since they are pictures for people: edited ones,
 * scans and screenshots have lost their EXIF data. */
static enum status single_views(struct bracket_views *v, const struct photo_scan *scan, bool may_equal, struct err *err)
{
    const struct exposure *first = NULL;
    int timed = 0, count = 0;
    bool alike = true;
    for (int i = 0; !err->status && i < scan->count; i++) {
        const struct exposure *e = &v->exposures[i];
        if (scan->photos[i].excluded) continue;
        if (!first) first = e;
        alike = alike && known_alike(first, e);
        count++;
        timed += e->seconds > 0;
        add_view(v, "", &i, 1, err);
    }
    v->untimed = !timed || (may_equal && !alike);
    for (int i = 0; !err->status && v->untimed && i < scan->count; i++) v->exposures[i] = (struct exposure){1, 0, 0, 1};
    if (!err->status && count)
        log_note("%d views of one exposure each%s", count,
                 !v->untimed ? ""
                 : timed     ? "; not all exposures are known, so all are assumed to be equal"
                             : "; no exposure time is known, so all are assumed to be equal");
    return err->status;
}

/* ------------------------------------------------------------------------------------------------- views and checks */

/* Length of the common beginning of the names of the view's photos, cut after a whole word. */
static size_t common_stem(const struct photo_scan *scan, const struct bracket_view *view)
{
    const char *first = scan->photos[view->photos[0]].file;
    size_t length = photo_stem(first);
    for (int i = 1; i < view->count; i++) {
        const char *file = scan->photos[view->photos[i]].file;
        size_t n = 0, stem = photo_stem(file);
        while (n < length && n < stem && file[n] == first[n]) n++;
        length = n;
    }
    if (view->count > 1) {
        while (length && !strchr("_- .", first[length])) length--;
        while (length && strchr("_- .", first[length - 1])) length--;
    }
    return length;
}

static int by_view(const void *a, const void *b)
{
    return strcmp(((const struct bracket_view *)a)->id, ((const struct bracket_view *)b)->id);
}

static enum status name_views(struct bracket_views *v, const struct photo_scan *scan, struct err *err)
{
    bool stems = true;
    for (int pass = 0; pass < 2; pass++) { /* by stems; by first photos if two stems are equal */
        for (int i = 0; i < v->count; i++) {
            const struct scanned_photo *first = &scan->photos[v->views[i].photos[0]];
            char id[MAX_PHOTO_ID + 1];
            photo_id_from_stem(id, first->file, common_stem(scan, &v->views[i]));
            free(v->views[i].id);
            v->views[i].id = strdup(pass ? first->id : id);
            if (!v->views[i].id) return err_nomem(err, "a view's name", sizeof id);
            stems &= pass || (common_stem(scan, &v->views[i]) && !photo_id_reserved(id));
        }
        qsort(v->views, (size_t)v->count, sizeof *v->views, by_view);
        for (int i = 1; i < v->count; i++) stems &= pass || by_view(&v->views[i - 1], &v->views[i]);
        if (stems) break;
    }
    return ST_OK;
}

struct by_exposure {
    double value;
    const char *file;
    int photo;
};

static int by_value(const void *a, const void *b)
{
    const struct by_exposure *x = a, *y = b;
    if (x->value != y->value) return x->value < y->value ? -1 : 1;
    return strcmp(x->file, y->file);
}

static enum status sort_view(struct bracket_view *view, const struct bracket_views *v, const struct photo_scan *scan,
                             struct err *err)
{
    struct by_exposure *order = calloc((size_t)view->count, sizeof *order);
    if (!order) return err_nomem(err, "a view", (size_t)view->count * sizeof *order);
    for (int i = 0; i < view->count; i++) {
        int p = view->photos[i];
        order[i] = (struct by_exposure){exposure_value(&v->exposures[p]), scan->photos[p].file, p};
    }
    qsort(order, (size_t)view->count, sizeof *order, by_value);
    for (int i = 0; i < view->count; i++) view->photos[i] = order[i].photo;
    view->middle = (view->count - 1) / 2;
    free(order);
    return ST_OK;
}

/* Number of exposures of the view that are equal to the one before. */
static int count_repeats(const struct bracket_view *view, const struct bracket_views *v)
{
    int repeats = 0;
    for (int i = 1; i < view->count; i++)
        repeats += bracket_equal(exposure_value(&v->exposures[view->photos[i]]),
                                 exposure_value(&v->exposures[view->photos[i - 1]]));
    return repeats;
}

/* Whether at least half of the views have as many equal exposures: then the camera was set so. In one view alone they
 * are a slip in brackets.txt. */
static bool repeats_are_meant(const struct bracket_view *view, const struct bracket_views *v)
{
    const int wanted = count_repeats(view, v);
    int same = 0;
    for (int i = 0; i < v->count; i++) same += count_repeats(&v->views[i], v) >= wanted;
    return 2 * same >= v->count && v->count > 1;
}

static enum status check_view(const struct bracket_view *view, const struct bracket_views *v,
                              const struct photo_scan *scan, struct err *err)
{
    const struct scanned_photo *first = &scan->photos[view->photos[0]];
    char one[32];
    for (int i = 0; i < view->count; i++) { /* in order of exposure; unknown ones are first */
        const struct scanned_photo *p = &scan->photos[view->photos[i]];
        const struct photo_info *info = &p->record.info;
        double value = exposure_value(&v->exposures[view->photos[i]]);
        if (!(value > 0))
            return err_set(
                err, ST_DATA,
                "view %s: the exposure time of %s is not known (not in EXIF); write a line \"%s SECONDS\" into "
                "exposures.txt.",
                view->id, p->file, p->file);
        if (info->width != first->record.info.width || info->height != first->record.info.height)
            return err_set(err, ST_DATA,
                           "view %s: %s has %d x %d pixels, but %s %d x %d; all exposures of a view must have the same "
                           "size. Leave one out (EXCLUDE), or correct brackets.txt.",
                           view->id, p->file, info->width, info->height, first->file, first->record.info.width,
                           first->record.info.height);
        if (i && bracket_equal(value, exposure_value(&v->exposures[view->photos[i - 1]])) &&
            !repeats_are_meant(view, v))
            return err_set(err, ST_DATA,
                           "view %s: %s and %s have the same exposure (%s); leave one out (EXCLUDE), or correct them "
                           "in exposures.txt or brackets.txt.",
                           view->id, scan->photos[view->photos[i - 1]].file, p->file,
                           show_seconds(one, &v->exposures[view->photos[i]]));
    }
    return ST_OK;
}

/* Exposures can be compared only if the f-number is known for all or none, and so is the ISO value. */
static enum status check_comparable(const struct bracket_views *v, const struct photo_scan *scan, struct err *err)
{
    const struct exposure *first = NULL;
    const char *first_file = NULL;
    for (int i = 0; i < v->count; i++)
        for (int k = 0; k < v->views[i].count; k++) {
            int p = v->views[i].photos[k];
            const struct exposure *e = &v->exposures[p];
            if (!first) first = e, first_file = scan->photos[p].file;
            bool number = (e->f_number > 0) != (first->f_number > 0);
            if (!number && (e->iso > 0) == (first->iso > 0)) continue;
            bool known = number ? e->f_number > 0 : e->iso > 0;
            return err_set(err, ST_DATA,
                           "the %s of %s is known, but not that of %s, so their exposures cannot be compared; write a "
                           "line \"FILE SECONDS F_NUMBER ISO\" into exposures.txt.",
                           number ? "f-number" : "ISO value", known ? scan->photos[p].file : first_file,
                           known ? first_file : scan->photos[p].file);
        }
    return ST_OK;
}

static void release_view(struct bracket_view *view)
{
    free(view->id);
    free(view->photos);
}

static void exclude_views(struct bracket_views *v, const char *const *exclude, int exclude_count, bool *used)
{
    int kept = 0;
    for (int i = 0; i < v->count; i++) {
        bool out = false;
        for (int k = 0; k < exclude_count; k++)
            if (!strcmp(exclude[k], v->views[i].id)) out = used[k] = true;
        if (out)
            release_view(&v->views[i]);
        else
            v->views[kept++] = v->views[i];
    }
    v->count = kept;
}

static enum status find_white(struct bracket_views *v, struct err *err)
{
    double *middles = malloc((size_t)v->count * sizeof *middles);
    if (!middles) return err_nomem(err, "exposures", (size_t)v->count * sizeof *middles);
    for (int i = 0; i < v->count; i++)
        middles[i] = exposure_value(&v->exposures[v->views[i].photos[v->views[i].middle]]);
    sort_doubles(middles, (size_t)v->count);
    v->white = middles[(v->count - 1) / 2];
    free(middles);
    return ST_OK;
}

enum status bracket_views_find(struct bracket_views *v, const struct photo_scan *scan, const char *scene,
                               const struct photo_params *params, const char *const *exclude, int exclude_count,
                               bool *used, struct err *err)
{
    char *path = NULL;
    const char *linear = NULL;
    const bool single = !strcmp(params->brackets, "single"), has_linear = any_linear(scan, &linear);
    *v = (struct bracket_views){0};
    if (!strcmp(params->brackets, "no") && has_linear && !scan->references)
        return err_set(err, ST_DATA,
                       "%s/%s is an EXR, a raw file or a photo with a gain map, which can only be used if brackets are "
                       "merged; set [import_photos] "
                       "brackets = auto, or leave it out (EXCLUDE).",
                       scan->folder, linear);
    if (!strcmp(params->brackets, "no") && !scan->references && unread_kind(scan))
        return err_set(
            err, ST_DATA,
            "%s/%s is HEIC, AVIF, WebP or JPEG XL, which COLMAP does not read; set [import_photos] brackets = "
            "auto, so that it gets a JPEG, or leave it out (EXCLUDE).",
            scan->folder, unread_kind(scan));
    if (!strcmp(params->brackets, "no") && !scan->references) return ST_OK;
    find_exposures(v, scan, scene, err);
    if (!err->status && scene && asprintf(&path, "%s/brackets.txt", scene) < 0) {
        path = NULL;
        err_nomem(err, "a path", 0);
    }
    bool listed = path && !access(path, F_OK);
    if (!err->status && listed) group_by_list(v, scan, path, err);
    if (!err->status && !listed && !single)
        group_by_cycle(v, scan, !strcmp(params->brackets, "yes") && !scan->references, err);
    if (!err->status && !listed && !v->count && !single && scan->references) group_distinct(v, scan, err);
    if (!err->status && !listed && !v->count && (scan->references || single || has_linear || other_kind(scan)))
        single_views(v, scan, !has_linear && !single && !scan->references, err);
    if (!err->status && listed && v->count) qsort(v->views, (size_t)v->count, sizeof *v->views, by_view);
    if (!err->status && !listed && v->count) name_views(v, scan, err);
    for (int i = 0; !err->status && i < v->count; i++) sort_view(&v->views[i], v, scan, err);
    v->bracketed = v->count > 0;
    if (!err->status) exclude_views(v, exclude, exclude_count, used);
    for (int i = 0; !err->status && i < v->count; i++) check_view(&v->views[i], v, scan, err);
    if (!err->status) check_comparable(v, scan, err);
    if (!err->status && v->count) find_white(v, err);
    free(path);
    if (err->status) bracket_views_release(v);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- writing */

static enum status make_record(struct photo_record *r, const struct bracket_view *view, const struct bracket_views *v,
                               const struct photo_scan *scan, struct err *err)
{
    const struct photo_record *middle = &scan->photos[view->photos[view->middle]].record;
    *r = (struct photo_record){.info = middle->info, .middle = view->middle, .white = v->white};
    if (!v->untimed) { /* exposures.txt wins over EXIF */
        const struct exposure *e = &v->exposures[view->photos[view->middle]];
        r->info.seconds = e->seconds;
        r->info.f_number = e->f_number;
        r->info.iso = e->iso;
    }
    strcpy(r->hash, middle->hash);
    r->id = strdup(view->id);
    r->brackets = calloc((size_t)view->count, sizeof *r->brackets);
    if (asprintf(&r->file, "%s.jpg", view->id) < 0) r->file = NULL;
    if (!r->id || !r->file || !r->brackets) return err_nomem(err, "a record", 0);
    for (int i = 0; i < view->count; i++) {
        const struct scanned_photo *p = &scan->photos[view->photos[i]];
        struct bracket *b = &r->brackets[r->bracket_count++];
        b->exposure = exposure_value(&v->exposures[view->photos[i]]);
        strcpy(b->hash, p->record.hash);
        if (!(b->file = strdup(p->file))) return err_nomem(err, "a record", 0);
    }
    return ST_OK;
}

enum status bracket_views_write(const struct bracket_views *v, const struct photo_scan *scan, const char *records,
                                struct err *err)
{
    size_t count = (size_t)v->count;
    struct photo_list list = {0};
    const char **ids = calloc(count + 1, sizeof *ids);
    list.photos = calloc(count + 1, sizeof *list.photos);
    if (!ids || !list.photos) err_nomem(err, "a list of views", count * sizeof *list.photos);
    for (int i = 0; !err->status && i < v->count; i++) {
        ids[i] = v->views[i].id;
        make_record(&list.photos[list.count++], &v->views[i], v, scan, err);
    }
    if (!err->status) {
        ids[v->count] = "brackets";
        photo_scan_remove_others(records, ids, v->count + 1, err);
    }
    for (int i = 0; !err->status && i < v->count; i++) photo_record_write(&list.photos[i], records, err);
    if (!err->status && v->count < (scan->references || scan->single ? 1 : 2))
        err_set(err, ST_DATA,
                "the photos in %s are exposures of %s; a parallax video needs at least 2 views, taken from "
                "different places, or one with its depth (DEPTH).",
                scan->folder, v->count ? "one view" : "views that are all left out");
    if (!err->status) photo_list_write(&list, records, err);
    photo_list_release(&list);
    free(ids);
    return err->status;
}

void bracket_views_release(struct bracket_views *v)
{
    if (!v) return;
    for (int i = 0; i < v->count; i++) release_view(&v->views[i]);
    free(v->views);
    free(v->exposures);
    *v = (struct bracket_views){0};
}
