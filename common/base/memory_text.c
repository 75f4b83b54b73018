/* memory_text.c - a stream whose bytes go to a buffer that grows by doubling; a failure is one of the stream. */
#include "common/base/memory_text.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

enum { FIRST_ROOM = 1024 };

/* There is always room for a NUL behind the text. */
static ssize_t take(void *cookie, const char *bytes, size_t count)
{
    struct memory_text *m = cookie;
    if (m->room - m->size <= count) {
        size_t room = m->room ? m->room : FIRST_ROOM;
        while (room - m->size <= count) {
            if (room > SIZE_MAX / 2) return 0; /* which is an error */
            room *= 2;
        }
        char *text = realloc(m->text, room);
        if (!text) return 0;
        m->text = text;
        m->room = room;
    }
    memcpy(m->text + m->size, bytes, count);
    m->size += count;
    m->text[m->size] = '\0';
    return (ssize_t)count;
}

enum status memory_text_open(struct memory_text *m, const char *what, struct err *err)
{
    *m = (struct memory_text){0};
    m->text = calloc(1, FIRST_ROOM);
    if (m->text) m->room = FIRST_ROOM;
    if (m->text) m->to = fopencookie(m, "w", (cookie_io_functions_t){.write = take});
    if (m->to) return ST_OK;
    memory_text_release(m);
    return err_nomem(err, what, FIRST_ROOM);
}

enum status memory_text_close(struct memory_text *m, const char *what, struct err *err)
{
    bool failed = fflush(m->to) != 0;
    failed |= ferror(m->to) != 0;
    failed |= fclose(m->to) != 0;
    m->to = NULL;
    if (!failed) return ST_OK;
    const size_t size = m->size;
    memory_text_release(m);
    return err_nomem(err, what, size);
}

void memory_text_release(struct memory_text *m)
{
    if (!m) return;
    if (m->to) fclose(m->to);
    free(m->text);
    *m = (struct memory_text){0};
}
