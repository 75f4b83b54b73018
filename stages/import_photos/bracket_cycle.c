/* bracket_cycle.c - finds cycles in a sequence of exposures.
 *
 * The rules are in bracket_views.h. A cycle is found by trial: for every length from 2 to MAX_CYCLE and every start
 * among the first CYCLE_STARTS shots, the exposures there are the candidate; its occurrences are counted without
 * overlap. Of the candidates that cover most shots the longest wins, then the first: an even bracket of 1 4 4 16 could
 * also be two of two steps. A candidate that repeats a shorter one is left out.
 *
 * Two kinds are tried, equal exposures first. Photos with automatic exposure have no cycle, but a short sequence may
 * look like one by chance. If k occurrences of n exposures have the same steps, (k - 1)(n - 1) steps agree that need
 * not. Of 96 000 walks drawn by tests/unit/import_photos/bracket_cycle.c, 8 become brackets if 2 steps must agree, one
 * if it is 3 or 4, and none if it is 6, which is MIN_STEPS.
 * Where the times show that photos of an occurrence follow each other faster than occurrences do, that is evidence of
 * its own. */
#include "stages/import_photos/bracket_cycle.h"

#include <math.h>

enum {
    MAX_CYCLE = 16,
    CYCLE_STARTS = 48,
    MIN_CYCLED = 6,      /* photos of a cycle of equal exposures */
    MIN_STEPS = 6,       /* steps that agree: (k - 1)(n - 1) */
    MIN_BURST_STEPS = 4, /* the same if the times show bursts */
    MIN_SOME_STEPS = 12, /* the same if photos are missing or extra */
};

static const double MAX_EQUAL = 1.01, MIN_DISTINCT = 1.2; /* ratios of exposures */
static const double MAX_STEP_ERROR = 1.15;                /* of ratios: cameras round 1/16 s to 1/15 s, 32 s to 30 s */
static const double MIN_RANGE = 2, MIN_JUMP = 1.8;

bool bracket_equal(double a, double b) { return a > 0 && b > 0 && a < MAX_EQUAL * b && b < MAX_EQUAL * a; }

static bool within(double a, double b, double factor) { return a < factor * b && b < factor * a; }

/* Exposures of automatic exposure may alternate, but rarely by this much. */
static bool has_range(const struct bracket_shot *s, int length)
{
    double least = INFINITY, most = 0;
    for (int i = 0; i < length; i++) {
        least = fmin(least, s[i].exposure);
        most = fmax(most, s[i].exposure);
    }
    return most > MIN_RANGE * least * (1 - 1e-9);
}

/* Exposures of a cycle are known and clearly different. repeats: some may be equal, if three are different and the
 * range is that of a bracket. */
static bool can_be_cycle(const struct bracket_shot *s, int length, bool repeats)
{
    int different = 0;
    for (int i = 0; i < length; i++) {
        bool seen = false;
        if (!(s[i].exposure > 0)) return false;
        for (int k = 0; k < i; k++) {
            const bool equal = bracket_equal(s[i].exposure, s[k].exposure);
            if (!equal && within(s[i].exposure, s[k].exposure, MIN_DISTINCT)) return false;
            seen |= equal;
        }
        if (seen && !repeats) return false;
        different += !seen;
    }
    return !repeats || (has_range(s, length) && (different == length || different >= 3));
}

/* Whether the exposures themselves repeat with a shorter period. */
static bool is_repetition(const struct bracket_shot *s, int length)
{
    for (int period = 1; 2 * period <= length; period++) {
        bool repeats = length % period == 0;
        for (int i = period; repeats && i < length; i++)
            repeats = within(s[i].exposure, s[i - period].exposure, MAX_STEP_ERROR);
        if (repeats) return true;
    }
    return false;
}

bool bracket_cycle_at(const struct bracket_cycle *c, const struct bracket_shot *shots, int count, int at)
{
    if (at + c->length > count) return false;
    const double first = shots[c->begin].exposure, here = shots[at].exposure;
    for (int k = 0; k < c->length; k++) {
        const double wanted = shots[c->begin + k].exposure, found = shots[at + k].exposure;
        if (!(found > 0)) return false;
        if (!c->steps && !bracket_equal(wanted, found)) return false;
        if (c->steps && !within(wanted * here, found * first, MAX_STEP_ERROR)) return false;
        /* equal exposures are equal everywhere, and different ones different */
        for (int j = 0; c->steps && j < k; j++)
            if (bracket_equal(shots[c->begin + j].exposure, wanted) != bracket_equal(shots[at + j].exposure, found))
                return false;
    }
    return true;
}

/* The best cycle of one kind; length 0: none. */
static struct bracket_cycle best_cycle(const struct bracket_shot *shots, int count, bool steps)
{
    struct bracket_cycle best = {0};
    for (int length = 2; length <= MAX_CYCLE && length <= count; length++)
        for (int begin = 0; begin + length <= count && begin < CYCLE_STARTS; begin++) {
            struct bracket_cycle c = {begin, length, 0, steps};
            if (!can_be_cycle(shots + begin, length, steps)) continue;
            if (steps && is_repetition(shots + begin, length)) continue;
            for (int at = 0; at < count;) {
                const bool occurs = bracket_cycle_at(&c, shots, count, at);
                c.count += occurs;
                at += occurs ? length : 1;
            }
            const int more = c.count * length - best.count * best.length;
            if (c.count >= 2 && (more > 0 || (!more && length > best.length))) best = c;
        }
    return best;
}

/* From the end of a shot to the begin of the next. */
static double pause_after(const struct bracket_shot *s) { return fmax(0, s[1].taken - s[0].taken - s[0].seconds); }

/* What the times say of a cycle that covers all shots: 1: bursts, since each pause within an occurrence is shorter than
 * each between two; -1: no bursts, since most pauses within are longer than most between; 0: neither, or unknown. */
static int find_bursts(const struct bracket_cycle *c, const struct bracket_shot *shots, int count)
{
    double longest_within = 0, shortest_between = INFINITY, sum_within = 0, sum_between = 0;
    for (int i = 0; i < count; i++)
        if (!(shots[i].taken > 0)) return 0;
    for (int i = 0; i + 1 < count; i++) {
        const double pause = pause_after(&shots[i]);
        if ((i + 1) % c->length) {
            longest_within = fmax(longest_within, pause);
            sum_within += pause;
        } else {
            shortest_between = fmin(shortest_between, pause);
            sum_between += pause;
        }
    }
    if (longest_within < shortest_between) return 1;
    return sum_within / (c->count * (c->length - 1)) > sum_between / (c->count - 1) ? -1 : 0;
}

static bool jumps(const struct bracket_shot *shots, int count)
{
    int jumped = 0;
    for (int i = 1; i < count; i++) {
        if (!(shots[i].exposure > 0) || !(shots[i - 1].exposure > 0)) return false;
        jumped += !within(shots[i].exposure, shots[i - 1].exposure, MIN_JUMP);
    }
    return count >= MIN_CYCLED && 3 * jumped >= 2 * (count - 1);
}

enum bracket_verdict bracket_cycle_find(struct bracket_cycle *c, const struct bracket_shot *shots, int count,
                                        enum bracket_wish wish)
{
    const struct bracket_cycle equal = best_cycle(shots, count, false), steps = best_cycle(shots, count, true);
    const int equal_covered = equal.count * equal.length, steps_covered = steps.count * steps.length;
    const int agreeing = (steps.count - 1) * (steps.length - 1);
    const int bursts = steps_covered && steps_covered == count ? find_bursts(&steps, shots, count) : 0;

    *c = equal;
    const bool must = wish == BRACKETS_MUST_BE;
    const bool equal_counts = equal_covered && (wish != BRACKETS_MAY_BE || equal_covered >= MIN_CYCLED);
    if (equal_counts && equal_covered == count) return BRACKETS_ALL;
    if (steps_covered && steps_covered == count &&
        (must || (bursts >= 0 && agreeing >= (bursts ? MIN_BURST_STEPS : MIN_STEPS)))) {
        *c = steps;
        return BRACKETS_ALL;
    }
    if (equal_counts && (must || (4 * equal_covered >= 3 * count && has_range(shots + equal.begin, equal.length))))
        return BRACKETS_SOME;
    if (steps_covered &&
        (must || (steps_covered < count && 4 * steps_covered >= 3 * count && agreeing >= MIN_SOME_STEPS))) {
        *c = steps;
        return BRACKETS_SOME;
    }
    *c = (struct bracket_cycle){0};
    return jumps(shots, count) ? BRACKETS_JUMPS : BRACKETS_NONE;
}
