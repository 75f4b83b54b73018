/* rooms_choice.c - which photos show the changes.
 *
 * Changes take turns in choosing the photo that shows them best, until ROOMS_SHOWN are chosen: what changed and is
 * known, not guessed; new light counts less, and a photo from the place of another that was chosen comes later. A photo
 * that most changes alter comes first. All changes that one sees in a photo can be chosen for it; what alters less than
 * LEAST percent of it is left out. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/sort.h"
#include "common/capture/panorama_name.h"
#include "common/math/numbers.h"
#include "stages/report/rooms_parts.h"

static const double LEAST = 0.5, LIGHT_WORTH = 0.3, COVERED = 0.9;
static const double NEAR = 0.25, TURN = 20, LIKENESS = 0.1; /* of the spread; degrees; worth of one like another */

/* Shares of the photo: those of its views by the pixels that they know. */
static struct room_look measure_look(const struct rooms_reading *r, const struct source_photo *p, int change)
{
    struct room_look look = {.change = change};
    double all = 0, light = 0;
    for (int i = p->first; i < p->first + p->count; i++) {
        const struct view_change *v = rooms_change_of(r, change, i);
        const double pixels = (double)r->views[i].width * r->views[i].height;
        const double weight = pixels * fmax(1, 100 - v->file.shares[MADE_NOTHING]);
        if (v->drawn) {
            all += weight;
            look.changed += weight * v->file.changed;
            for (int k = 0; k < MADE_COUNT; k++) look.shares[k] += weight * v->file.shares[k];
        }
        if (!v->lit) continue;
        light += weight;
        look.light += weight * v->light.changed;
        look.bounded += weight * v->light.bounded;
        look.kept += weight * v->light.kept;
    }
    all = fmax(all, 1e-300), light = fmax(light, 1e-300);
    look.changed /= all;
    for (int k = 0; k < MADE_COUNT; k++) look.shares[k] /= all;
    look.light /= light, look.bounded /= light, look.kept /= light;
    return look;
}

/* A photo of which little is left, such as one that looks straight at a new wall, tells less. */
static double worth(const struct room_look *look)
{
    const double guessed = look->shares[MADE_SYNTHESISED] + look->shares[MADE_UNSURE];
    const double known = look->changed > guessed ? (look->changed - guessed) / look->changed : 0;
    const double sure = look->light > look->bounded ? (look->light - look->bounded) / look->light : 0;
    const double telling = look->changed * (1 - COVERED * look->changed / 100);
    return known * known * telling + 1e-3 * look->changed + LIGHT_WORTH * sure * look->light;
}

static bool is_seen(const struct room_look *look) { return look->changed >= LEAST || look->light >= LEAST; }

/* The distance that half of the photos' pairs exceed; of many photos some pairs stand for all. */
static double find_spread(const struct rooms_reading *r)
{
    enum { PAIRS = 4096 };
    double *distances = malloc(PAIRS * sizeof *distances), spread = 0;
    size_t n = 0;
    const int step = r->photo_count / 64 + 1;
    for (int i = 0; distances && i < r->photo_count; i += step)
        for (int k = 0; k < i && n < PAIRS; k += step)
            distances[n++] =
                vec3_length(vec3_sub(r->views[r->photos[i].first].center, r->views[r->photos[k].first].center));
    if (n) {
        sort_doubles(distances, n);
        spread = distances[n / 2];
    }
    free(distances);
    return spread;
}

/* Whether two photos were taken from about the same place in about the same direction. */
static bool are_alike(const struct rooms_reading *r, const struct source_photo *a, const struct source_photo *b)
{
    const struct view *p = &r->views[a->first], *q = &r->views[b->first];
    return vec3_length(vec3_sub(p->center, q->center)) < NEAR * r->spread &&
           vec3_dot(mat3_row(p->cam_from_world, 2), mat3_row(q->cam_from_world, 2)) > cos(TURN * DEGREE);
}

static bool is_like_chosen(const struct rooms_reading *r, const struct source_photo *p)
{
    for (int i = 0; i < r->photo_count; i++)
        if (r->photos[i].chosen && are_alike(r, p, &r->photos[i])) return true;
    return false;
}

/* The photo not yet chosen that shows a change best; NULL: none shows it. One like another that was chosen comes after
 * those that are not. */
static struct source_photo *best_photo(const struct rooms_reading *r, int change)
{
    struct source_photo *best = NULL;
    double most = 0;
    for (int i = 0; i < r->photo_count; i++) {
        const struct room_look look = measure_look(r, &r->photos[i], change);
        if (r->photos[i].chosen || !is_seen(&look)) continue;
        const double value = worth(&look) * (is_like_chosen(r, &r->photos[i]) ? LIKENESS : 1);
        if (!(value > most)) continue;
        most = value;
        best = &r->photos[i];
    }
    return best;
}

static void count_photos(struct rooms_reading *r)
{
    for (int i = 0; i < r->photo_count; i++) {
        bool changed = false;
        for (int e = 0; e < r->rooms->change_count; e++) {
            const struct room_look look = measure_look(r, &r->photos[i], e);
            r->rooms->changes[e].photos += is_seen(&look);
            changed |= is_seen(&look);
        }
        r->rooms->photos_changed += changed;
    }
}

static int choose_photos(struct rooms_reading *r)
{
    int chosen = 0;
    for (bool any = true; any && chosen < ROOMS_SHOWN;) {
        any = false;
        for (int e = 0; e < r->rooms->change_count && chosen < ROOMS_SHOWN; e++) {
            struct source_photo *p = best_photo(r, e);
            if (!p) continue;
            p->chosen = any = true;
            chosen++;
        }
    }
    return chosen;
}

static int compare_looks(const void *a, const void *b)
{
    const struct room_look *p = a, *q = b;
    if (worth(p) != worth(q)) return worth(p) < worth(q) ? 1 : -1;
    return (p->change > q->change) - (p->change < q->change);
}

static enum status add_room(struct rooms_reading *r, const struct source_photo *p, struct err *err)
{
    struct rooms *rooms = r->rooms;
    struct room_photo *to = &rooms->photos[rooms->photo_count++];
    memcpy(to->photo, p->photo, sizeof to->photo);
    to->looks = calloc((size_t)rooms->change_count + 1, sizeof *to->looks);
    if (!to->looks) return err_nomem(err, "changes of a photo", (size_t)rooms->change_count * sizeof *to->looks);
    for (int e = 0; e < rooms->change_count; e++) {
        const struct room_look look = measure_look(r, p, e);
        if (is_seen(&look)) to->looks[to->look_count++] = look;
    }
    qsort(to->looks, (size_t)to->look_count, sizeof *to->looks, compare_looks);
    return ST_OK;
}

static double worth_of_photo(const struct room_photo *p)
{
    double sum = 0;
    for (int i = 0; i < p->look_count; i++) sum += sqrt(worth(&p->looks[i]));
    return sum;
}

static int compare_photos(const void *a, const void *b)
{
    const struct room_photo *p = a, *q = b;
    const double x = worth_of_photo(p), y = worth_of_photo(q);
    if (x != y) return x < y ? 1 : -1;
    return strcmp(p->photo, q->photo);
}

/* Faces of one panorama were taken from one place: they follow the one that tells most. */
static void gather_places(struct rooms *rooms)
{
    for (int i = 0; i + 1 < rooms->photo_count; i++) {
        int to = i + 1;
        for (int k = to; k < rooms->photo_count; k++) {
            if (!panorama_name_same(rooms->photos[i].photo, rooms->photos[k].photo)) continue;
            const struct room_photo face = rooms->photos[k];
            memmove(&rooms->photos[to + 1], &rooms->photos[to], (size_t)(k - to) * sizeof face);
            rooms->photos[to++] = face;
        }
        i = to - 1;
    }
}

enum status rooms_choose(struct rooms_reading *r, struct err *err)
{
    struct rooms *rooms = r->rooms;
    count_photos(r);
    r->spread = find_spread(r);
    const int chosen = choose_photos(r);
    rooms->photos = calloc((size_t)chosen + 1, sizeof *rooms->photos);
    if (!rooms->photos) return err_nomem(err, "photos", (size_t)chosen * sizeof *rooms->photos);
    for (int i = 0; !err->status && i < r->photo_count; i++)
        if (r->photos[i].chosen) add_room(r, &r->photos[i], err);
    if (!err->status && chosen) qsort(rooms->photos, (size_t)chosen, sizeof *rooms->photos, compare_photos);
    gather_places(rooms);
    return err->status;
}
