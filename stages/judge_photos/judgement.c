/* judgement.c - warnings about single photos, and what suits all of them. */
#include "stages/judge_photos/judgement.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/base/sort.h"
#include "common/capture/panorama_name.h"
#include "common/product/product.h"

#define WIDE_LENS      18 /* mm for 35 mm film; many wider lenses are fisheyes */
#define FEW_FEATURES   200
#define REFERENCE_SIDE 1600 /* px; widths of edges are compared in a picture of this size */

enum { SENTENCE = 600, FILM_BEST = 8, FILM_MOST = 30 };

static void join_groups(struct judgement *j, int first, int second)
{
    const int keep = j->photos[first].group, drop = j->photos[second].group;
    const int to = keep < drop ? keep : drop, from = keep < drop ? drop : keep;
    for (int i = 0; i < j->count; i++)
        if (j->photos[i].group == from) j->photos[i].group = to;
}

void judgement_link(struct judgement *j, int first, int second)
{
    j->photos[first].links++;
    j->photos[second].links++;
    join_groups(j, first, second);
}

/* The first view of the same panorama; the photo itself if it is none. */
static int first_view(const struct judgement *j, int photo)
{
    for (int i = 0; i < photo; i++)
        if (panorama_name_same(j->photos[i].record->file, j->photos[photo].record->file)) return i;
    return photo;
}

static bool is_panoramic(const struct judged_photo *p)
{
    int yaw;
    return panorama_name_read(&yaw, p->record->file) > 0;
}

void judgement_join_panoramas(struct judgement *j)
{
    for (int i = 0; i < j->count; i++)
        if (first_view(j, i) != i) join_groups(j, first_view(j, i), i);
}

/* Writes a line of the file and says it; id NULL: advice about all photos. */
static void say(FILE *f, const char *id, const char *format, ...) __attribute__((format(printf, 3, 4)));
static void say(FILE *f, const char *id, const char *format, ...)
{
    char text[SENTENCE], quoted[2 * SENTENCE + 3];
    struct err ignored = ERR_INIT;
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    if (textfile_quote(text, quoted, sizeof quoted, &ignored)) return;
    if (id) {
        log_warn("%s %s", id, text);
        fprintf(f, "warn %s %s\n", id, quoted);
    } else {
        log_note("%s", text);
        fprintf(f, "advice %s\n", quoted);
    }
}

/* The width of a photo's sharper edges in a picture of at most REFERENCE_SIDE. */
static double scaled_edge(const struct judged_photo *p)
{
    const int w = p->record->info.width, h = p->record->info.height, side = w > h ? w : h;
    return side > REFERENCE_SIDE ? p->measures.edge * REFERENCE_SIDE / side : p->measures.edge;
}

/* 0: no photo has enough edges. */
static double median_edge(const struct judgement *j, double *values)
{
    size_t count = 0;
    for (int i = 0; i < j->count; i++)
        if (j->photos[i].readable && j->photos[i].measures.edge > 0) values[count++] = scaled_edge(&j->photos[i]);
    return count ? sort_median(values, count) : 0;
}

static void judge_photo(const struct judgement *j, const struct judged_photo *p, double median, FILE *f)
{
    const struct judge_params *limit = j->params;
    const char *id = p->record->id;
    const double edge = scaled_edge(p);
    if (!p->readable) {
        say(f, id, "cannot be read; leave it out, or copy it anew.");
        return;
    }
    if (edge > limit->max_edge || (edge > limit->soft_edge && edge > limit->max_edge_ratio * median))
        say(f, id,
            "is blurred: its sharper edges are %.1f px wide, those of the middle photo %.1f px. Take it again with a "
            "steady hand, or leave it out.",
            edge, median);
    if (!p->record->bracket_count && p->measures.bright > limit->max_bright)
        say(f, id,
            "is too bright: %.0f %% of it is white. Expose less; where a window is in the picture, take several "
            "exposures from one place.",
            100 * p->measures.bright);
    if (!p->record->bracket_count && !p->measures.round && p->measures.dark > limit->max_dark)
        say(f, id, "is too dark: %.0f %% of it is black. Expose longer.", 100 * p->measures.dark);
    if (is_panoramic(p)) return; /* it need not overlap by itself */
    if (p->features < FEW_FEATURES)
        say(f, id,
            "has %d features, which is few (%d are enough): it shows little texture. Take in more of the "
            "surroundings.",
            p->features, FEW_FEATURES);
    else if (!p->links && j->count > 1)
        say(f, id, "overlaps no other photo. Take photos between it and the others.");
}

/* Panoramas none of whose views overlaps a photo beyond them. */
static void judge_panoramas(const struct judgement *j, FILE *f)
{
    for (int i = 0; i < j->count; i++) {
        int links = 0, others = 0;
        if (!is_panoramic(&j->photos[i]) || first_view(j, i) != i) continue;
        for (int k = 0; k < j->count; k++) {
            const bool own = first_view(j, k) == i;
            links += own ? j->photos[k].links : 0;
            others += !own;
        }
        if (!links && others)
            say(f, j->photos[i].record->id,
                "and the other views of its panorama overlap no other photo. Take photos between them and the others.");
    }
}

static void judge_lens(const struct judgement *j, FILE *f)
{
    double least = INFINITY, most = 0;
    int unknown = 0, round = 0, readable = 0, sizes = 1, panoramic = 0;
    for (int i = 0; i < j->count; i++) {
        const struct photo_info *info = &j->photos[i].record->info, *first = &j->photos[0].record->info;
        if (is_panoramic(&j->photos[i])) {
            panoramic++;
            continue;
        }
        readable += j->photos[i].readable;
        round += j->photos[i].readable && j->photos[i].measures.round;
        if (info->focal35_mm > 0) {
            least = fmin(least, info->focal35_mm);
            most = fmax(most, info->focal35_mm);
        } else
            unknown++;
        if (!panoramic && (info->width != first->width || info->height != first->height)) sizes++;
    }
    if (panoramic) say(f, NULL, "The lens of %d views of panoramas is known; LENS is for other photos.", panoramic);
    if (panoramic == j->count) return;
    if (readable && 5 * round >= 4 * readable)
        say(f, NULL,
            "The corners of the photos are black: this is a fisheye lens that draws a circle. Give LENS=EQUISOLID.");
    else if (unknown == j->count - panoramic)
        say(f, NULL,
            "EXIF does not state the lens, so it is found from the photos, which works for ordinary lenses. For "
            "a fisheye lens give LENS=EQUISOLID.");
    else if (least <= WIDE_LENS)
        say(f, NULL,
            "The lens is very wide (%.0f mm for 35 mm film). If straight lines bend towards the rim it is a "
            "fisheye: give LENS=EQUISOLID.",
            least);
    else if (most > 1.02 * least)
        say(f, NULL,
            "The focal length differs between photos (%.0f to %.0f mm for 35 mm film): each gets a lens of its "
            "own. One zoom setting for all is more exact.",
            least, most);
    else
        say(f, NULL, "The lens is an ordinary one (%.0f mm for 35 mm film); LENS need not be given.", most);
    if (sizes > 1) say(f, NULL, "The photos differ in size. That works; each size gets a lens of its own.");
}

/* The size of the largest group of photos that overlap, the places that they were taken from (the views of a panorama
 * have one), and the number of groups of two places or more. */
static int largest_group(const struct judgement *j, int *places, int *groups)
{
    int largest = 0;
    *places = *groups = 0;
    for (int g = 0; g < j->count; g++) {
        int size = 0, from = 0;
        for (int i = 0; i < j->count; i++) {
            size += j->photos[i].group == g;
            from += j->photos[i].group == g && first_view(j, i) == i;
        }
        if (from > *places || (from == *places && size > largest)) *places = from, largest = size;
        *groups += from > 1;
    }
    return largest;
}

static void judge_set(const struct judgement *j, FILE *f)
{
    int groups, joined, bracketed = 0;
    const int photos = largest_group(j, &joined, &groups);
    const char *what = photos > joined ? "places" : "photos";
    for (int i = 0; i < j->count; i++) bracketed += j->photos[i].record->bracket_count > 1;
    if (j->count > 1 && photos < j->count)
        say(f, NULL,
            "%d of %d photos overlap as one group%s. Photos outside of it are left out; take photos in between.",
            photos, j->count, groups > 1 ? ", and others in groups of their own" : "");
    if (photos > joined && joined > 1)
        say(f, NULL, "These %d photos are from %d places: the views of a panorama have one. Films need places.", photos,
            joined);
    if (j->count == 1)
        say(f, NULL,
            "One photo gives a film only with its depth: DEPTH=DIR. Otherwise take two more, each a step aside.");
    else if (joined < 2 && photos > 1)
        say(f, NULL,
            "All photos that overlap are of one panorama, from one place. Take photos from other places, a step "
            "apart.");
    else if (joined < 2)
        say(f, NULL, "No two photos overlap. Take photos of the same thing, from places a step apart.");
    else if (joined == 2 && photos == 2)
        say(f, NULL, "Two photos that overlap give a film that changes from one into the other (make morph).");
    else if (joined < FILM_BEST)
        say(f, NULL, "%d %s that overlap give a film with parallax (make video); 8 to 15 give a better one.", joined,
            what);
    else if (joined <= FILM_MOST)
        say(f, NULL,
            "%d %s that overlap give a film with parallax (make video). If they show a room from all sides, "
            "begin its model with make axes suggest.",
            joined, what);
    else
        say(f, NULL,
            "%d %s that overlap are many: if they show rooms, begin their model with make axes suggest; a film "
            "is made from those that see its subject.",
            joined, what);
    if (bracketed)
        say(f, NULL, "%d photos have several exposures: lamps and daylight can be measured (make lights relight).",
            bracketed);
}

enum status judgement_write(const struct judgement *j, const char *path, const struct provenance *prov, struct err *err)
{
    struct outfile f = {0};
    double *values = malloc(((size_t)j->count + 1) * sizeof *values);
    if (!values) return err_nomem(err, "widths of edges", (size_t)j->count * sizeof *values);
    if (!product_begin(&f, PRODUCT_JUDGEMENT, path, prov, err)) {
        fprintf(f.fp, "# photo ID WIDTH HEIGHT FEATURES OVERLAPS EDGE BRIGHT DARK\n");
        for (int i = 0; i < j->count; i++) {
            const struct judged_photo *p = &j->photos[i];
            fprintf(f.fp, "photo %s %d %d %d %d %.2f %.4f %.4f\n", p->record->id, p->record->info.width,
                    p->record->info.height, p->features, p->links, p->measures.edge, p->measures.bright,
                    p->measures.dark);
        }
        const double median = median_edge(j, values);
        for (int i = 0; i < j->count; i++) judge_photo(j, &j->photos[i], median, f.fp);
        judge_panoramas(j, f.fp);
        if (j->count) judge_lens(j, f.fp);
        judge_set(j, f.fp);
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    free(values);
    return err->status;
}
