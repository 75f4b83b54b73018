/* progress.c - draws progress lines. A thread that adds to the count draws if the interval is over and no other thread
 * is drawing. */
#include "common/base/progress.h"

#include <inttypes.h>
#include <stdio.h>
#include <unistd.h>

#include "common/base/clock.h"
#include "common/base/log.h"

static const double terminal_interval = 0.25, log_interval = 10; /* seconds */

static void time_text(char *text, size_t size, double seconds)
{
    const int64_t s = (int64_t)(seconds + 0.5);

    if (s < 60)
        snprintf(text, size, "%" PRId64 " s", s);
    else if (s < 3600)
        snprintf(text, size, "%" PRId64 " min %02" PRId64 " s", s / 60, s % 60);
    else
        snprintf(text, size, "%" PRId64 " h %02" PRId64 " min", s / 3600, s / 60 % 60);
}

static void draw(struct progress *p, double time, bool last)
{
    const int64_t done = atomic_load(&p->done);
    const double seconds = time - p->started, rate = seconds > 0 ? (double)done / seconds : 0;
    char line[256], span[64], tail[80] = "";

    if (last) {
        time_text(span, sizeof span, seconds);
        snprintf(tail, sizeof tail, ", %s", span);
    } else if (rate > 0 && done <= p->total) {
        time_text(span, sizeof span, (double)(p->total - done) / rate);
        snprintf(tail, sizeof tail, ", %s left", span);
    }
    snprintf(line, sizeof line, "%s %" PRId64 "/%" PRId64 " %s, %.3g %s/s%s", p->what, done, p->total, p->unit, rate,
             p->unit, tail);
    if (p->terminal)
        log_redraw(line, last);
    else
        log_line("", line);
    p->drawn = time;
}

void progress_start(struct progress *p, const char *what, int64_t total, const char *unit)
{
    p->what = what;
    p->unit = unit;
    p->total = total;
    atomic_store(&p->done, 0);
    p->started = p->drawn = clock_seconds();
    atomic_flag_clear(&p->drawing);
    p->terminal = isatty(STDERR_FILENO);
}

void progress_add(struct progress *p, int64_t n)
{
    atomic_fetch_add(&p->done, n);
    if (atomic_flag_test_and_set(&p->drawing)) return;
    const double time = clock_seconds();
    if (time - p->drawn >= (p->terminal ? terminal_interval : log_interval)) draw(p, time, false);
    atomic_flag_clear(&p->drawing);
}

void progress_end(struct progress *p)
{
    if (!p->what) return;
    const double time = clock_seconds();
    if (p->terminal ? p->drawn > p->started : time - p->started >= log_interval) draw(p, time, true);
    p->what = NULL;
}
