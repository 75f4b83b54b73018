/* frame_choice.c - which frames of a clip become photos; frame_choice.h states the rule.
 *
 * A frame's sharpness is known at once, but whether it is the sharpest of its window only when the window has ended.
 * Until then the small pictures of the frames behind the best one are kept, because the progress of these frames is
 * measured anew from the frame that was chosen. A window ends after MAX_WAITING frames, too: a camera that rests would
 * fill memory.
 *
 * A part begins at a frame that can be followed: black frames of a fade and blank walls are passed over. Later
 * frames in
 * which too few points are found are blurred or show something else. Blurred ones are passed over. After
 * CUT_FRAMES sharp ones in a row, or at the end, the clip was cut or moved too fast: it begins anew at the first of
 * them. So all sharp frames of a clip that jumps from one to the next are chosen. */
#include "stages/import_photos/frame_choice.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "stages/import_photos/opencv_track.h"

enum { MAX_WAITING = 90, CUT_FRAMES = 4, MAX_RECENT = 64 };

static const double START = 0.3, EARLY = 0.7, LATE = 1.3, LATEST = 2; /* progress */
static const double SHARP = 0.7;                                      /* of the sharpest of the recent frames */
static const double RECENT = 0.5;                                     /* seconds */

struct waiting {
    struct chosen_frame of;
    unsigned char *grey; /* half the size; owned */
    double progress;
    double sharpest; /* of this and the recent frames before it */
};

struct frame_choice {
    int width, height;                      /* of the pictures given */
    struct track *key;                      /* NULL: the next frame begins a part of the clip */
    bool starting;                          /* the key is the first frame of a part, not yet a chosen one */
    bool untried;                           /* the next frame to be measured is the key itself */
    struct chosen_frame recent[MAX_RECENT]; /* a ring: frame `number` is at number % MAX_RECENT */
    struct waiting *waiting;
    int count, next; /* waiting; next: the first whose progress is not measured */
    int best;        /* of the window; -1: none */
    int lost;        /* sharp frames in a row without progress */
    struct chosen_frames chosen;
};

/* --------------------------------------------------------------------------------------------------------- pictures */

double frame_sharpness(const unsigned char *grey, int width, int height)
{
    double detail = 0, sum = 0, squares = 0;
    for (int y = 1; y + 1 < height; y++) {
        long long row[3] = {0};
        for (int x = 1; x + 1 < width; x++) {
            const unsigned char *p = grey + (size_t)y * (size_t)width + x;
            const int d = 4 * p[0] - p[-1] - p[1] - p[-width] - p[width];
            row[0] += d * d;
            row[1] += p[0];
            row[2] += p[0] * p[0];
        }
        detail += (double)row[0];
        sum += (double)row[1];
        squares += (double)row[2];
    }
    const double pixels = fmax(1, (double)(width - 2) * (height - 2));
    return detail / (pixels + squares - sum * sum / pixels); /* a plain picture is not sharp */
}

static void halve(unsigned char *to, const unsigned char *from, int width, int height)
{
    for (int y = 0; y < height / 2; y++)
        for (int x = 0; x < width / 2; x++) {
            const unsigned char *p = from + 2 * ((size_t)y * (size_t)width + (size_t)x);
            to[(size_t)y * (size_t)(width / 2) + (size_t)x] =
                (unsigned char)((p[0] + p[1] + p[width] + p[width + 1] + 2) / 4);
        }
}

/* --------------------------------------------------------------------------------------------------------- choosing */

static void drop_first(struct frame_choice *c, int count)
{
    for (int i = 0; i < count; i++) free(c->waiting[i].grey);
    memmove(c->waiting, c->waiting + count, (size_t)(c->count - count) * sizeof *c->waiting);
    c->count -= count;
    c->next = c->next > count ? c->next - count : 0;
    c->best = c->best < count ? -1 : c->best - count;
}

/* The frame becomes the key, and those behind it are measured anew. */
static enum status begin_at(struct frame_choice *c, int at, bool starting, struct err *err)
{
    c->starting = c->untried = starting;
    c->lost = 0;
    track_begin(&c->key, c->waiting[at].grey, c->width / 2, c->height / 2, err);
    drop_first(c, at);
    c->best = -1;
    c->next = 0;
    return err->status;
}

static enum status choose(struct frame_choice *c, struct err *err)
{
    struct chosen_frames *to = &c->chosen;
    const struct chosen_frame *best = &c->waiting[c->best].of;
    if (array_append(&to->frames, (size_t)to->count, sizeof *to->frames, "chosen frames", err)) return err->status;
    to->frames[to->count] = *best;
    if (c->starting) to->frames[to->count].parallax = to->frames[to->count].overlap = 0;
    to->count++;
    if (begin_at(c, c->best, false, err)) return err->status;
    drop_first(c, 1);
    return ST_OK;
}

/* The first waiting frame shows nothing that can be followed, not even to itself: the next one begins a part. */
static void pass_over(struct frame_choice *c)
{
    drop_first(c, 1);
    track_release(c->key);
    c->key = NULL;
    c->lost = 0;
}

static double progress_of(const struct track_motion *m)
{
    return fmax(m->parallax / FRAME_PARALLAX, (1 - m->overlap) / (1 - FRAME_OVERLAP));
}

/* Measures the next waiting frame, and decides if its window has ended. */
static enum status step(struct frame_choice *c, struct err *err)
{
    struct waiting *w = &c->waiting[c->next];
    struct track_motion m = {0};
    if (!c->key) return begin_at(c, c->next, true, err);
    if (track_measure(&m, c->key, w->grey, err)) return err->status;
    const bool itself = c->untried;
    c->untried = false;
    if (itself && !m.known) return pass_over(c), ST_OK;
    const int at = c->next++;
    if (!m.known) {
        const bool sharp = w->of.sharpness >= SHARP * w->sharpest;
        if (c->best >= 0 && ((c->lost += sharp) >= CUT_FRAMES || at - c->best >= MAX_WAITING)) return choose(c, err);
        if (c->best >= 0) return ST_OK;
        if (!c->lost) drop_first(c, c->next - sharp); /* the first sharp one is kept, and what follows it */
        c->lost += sharp;
        return c->lost >= CUT_FRAMES ? begin_at(c, 0, true, err) : ST_OK;
    }
    c->lost = 0;
    w->progress = progress_of(&m);
    w->of.parallax = m.parallax;
    w->of.overlap = m.overlap;
    if (!c->starting) c->chosen.most_parallax = fmax(c->chosen.most_parallax, m.parallax);
    const double late = c->starting ? START : LATE;
    /* beyond its window while nothing in it is sharp, and as all there is */
    const bool in = c->starting || w->progress >= EARLY, may_wait = !c->starting && w->progress < LATEST;
    const double wanted = c->starting ? 0 : SHARP * w->sharpest;
    const struct waiting *best = c->best < 0 ? NULL : &c->waiting[c->best];
    const bool more = !best || w->progress <= late || (may_wait && best->of.sharpness < wanted);
    if (in && more && (!best || w->of.sharpness > best->of.sharpness)) best = &c->waiting[c->best = at];
    const bool ended = w->progress >= late && best && (best->of.sharpness >= wanted || !may_wait);
    if (ended || (best && at - c->best >= MAX_WAITING)) return choose(c, err);
    if (c->best < 0)
        drop_first(c, c->next);
    else if (c->best > 0)
        drop_first(c, c->best);
    return ST_OK;
}

enum status frame_choice_begin(struct frame_choice **choice, int width, int height, struct err *err)
{
    struct frame_choice *c = *choice = calloc(1, sizeof *c);
    if (!c) return err_nomem(err, "the choice of frames", sizeof *c);
    *c = (struct frame_choice){.width = width, .height = height, .best = -1};
    return ST_OK;
}

/* Of the frame and those of the last RECENT seconds. */
static double sharpest_of(struct frame_choice *c, const struct chosen_frame *frame)
{
    double most = frame->sharpness;
    c->recent[frame->number % MAX_RECENT] = *frame;
    for (int i = 0; i < MAX_RECENT; i++)
        if (c->recent[i].seconds >= frame->seconds - RECENT) most = fmax(most, c->recent[i].sharpness);
    return most;
}

enum status frame_choice_add(struct frame_choice *c, const unsigned char *grey, int number, double seconds,
                             struct err *err)
{
    const size_t size = (size_t)(c->width / 2 + 1) * (size_t)(c->height / 2 + 1);
    if (array_append(&c->waiting, (size_t)c->count, sizeof *c->waiting, "frames", err)) return err->status;
    struct waiting *w = &c->waiting[c->count];
    *w = (struct waiting){.of = {.number = number, .seconds = seconds}, .grey = malloc(size)};
    if (!w->grey) return err_nomem(err, "a frame", size);
    c->count++;
    halve(w->grey, grey, c->width, c->height);
    w->of.sharpness = frame_sharpness(grey, c->width, c->height);
    w->sharpest = sharpest_of(c, &w->of);
    while (!err->status && c->next < c->count) step(c, err);
    return err->status;
}

/* Evenly spaced ones, the first and the last among them. */
static void thin(struct chosen_frames *chosen, int most)
{
    const int all = chosen->count;
    if (all <= most) return;
    for (int i = 0; i < most; i++)
        chosen->frames[i] = chosen->frames[(int)((2LL * i * (all - 1) + most - 1) / (2 * (most - 1)))];
    chosen->count = most;
}

enum status frame_choice_end(struct chosen_frames *chosen, struct frame_choice *c, int most, struct err *err)
{
    while (!err->status && (c->best >= 0 || c->lost)) {
        if (c->best >= 0)
            choose(c, err);
        else
            begin_at(c, 0, true, err);
        while (!err->status && c->next < c->count) step(c, err);
    }
    *chosen = c->chosen;
    c->chosen = (struct chosen_frames){0};
    thin(chosen, most);
    return err->status;
}

void frame_choice_release(struct frame_choice *c)
{
    if (!c) return;
    for (int i = 0; i < c->count; i++) free(c->waiting[i].grey);
    free(c->waiting);
    track_release(c->key);
    frame_choice_free(&c->chosen);
    free(c);
}

void frame_choice_free(struct chosen_frames *chosen)
{
    free(chosen->frames);
    *chosen = (struct chosen_frames){0};
}
