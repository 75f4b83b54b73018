/* passing.c - by the reasons that the system gives, which end a sentence. */
#include "stages/report/passing.h"

#include <errno.h>
#include <stdbool.h>
#include <string.h>

enum status passing_refuse(const char *sentence, struct err *err)
{
    static const int reasons[] = {EIO, EMFILE, ENFILE, ENOMEM, ESTALE};
    bool passes = strstr(sentence, "memory") != NULL;
    for (size_t i = 0; i < sizeof reasons / sizeof *reasons; i++)
        passes = passes || strstr(sentence, strerror(reasons[i]));
    return passes ? err_set(err, ST_IO, "%s", sentence) : ST_OK;
}
