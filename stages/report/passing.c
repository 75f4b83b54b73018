/* passing.c - by the reasons that the system and libraries give. */
#include "stages/report/passing.h"

#include <errno.h>
#include <stdbool.h>
#include <string.h>

enum status passing_refuse(const char *sentence, struct err *err)
{
    static const int reasons[] = {EIO, EMFILE, ENFILE, ENOMEM, ESTALE};
    /* as err_nomem() and libraries say it: a path may have the word "memory" */
    static const char *const words[] = {"not enough memory", "out of memory", "insufficient memory",
                                        "unable to allocate"};
    bool passes = false;
    for (size_t i = 0; i < sizeof reasons / sizeof *reasons; i++)
        passes = passes || strstr(sentence, strerror(reasons[i]));
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) passes = passes || strcasestr(sentence, words[i]);
    return passes ? err_set(err, ST_IO, "%s", sentence) : ST_OK;
}
