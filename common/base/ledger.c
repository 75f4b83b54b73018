/* ledger.c - adds lines to this process's file. A forked child begins one of its own. */
#include "common/base/ledger.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include "common/base/file_path.h"
#include "common/base/hash.h"
#include "common/base/textfile.h"

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static FILE *lines;
static pid_t owner;

/* Opens FOLDER/HOST-PID-NANOSECONDS.txt: no other process, on no other node, has this name. */
static enum status open_lines(const char *folder, struct err *err)
{
    char host[65] = "", name[160], path[FILE_PATH];
    struct timespec now = {0};

    if (gethostname(host, sizeof host - 1)) host[0] = '\0';
    for (char *c = host; *c; c++)
        if (*c == '/') *c = '_';
    clock_gettime(CLOCK_REALTIME, &now);
    snprintf(name, sizeof name, "%s-%ld-%lld%09ld", host, (long)getpid(), (long long)now.tv_sec, now.tv_nsec);
    if (file_path(path, folder, name, ".txt", err)) return err->status;
    if (lines) fclose(lines);
    lines = fopen(path, "ae");
    owner = getpid();
    return lines ? ST_OK : err_errno(err, "write", path);
}

enum status ledger_add(const char *path, const char *content, struct err *err)
{
    const char *folder = getenv("REMODEL_LEDGER");
    char hash[HASH_TEXT], quoted[2 * FILE_PATH];

    if (!folder || !*folder) return ST_OK;
    if (hash_file(hash, content, err) || textfile_quote(path, quoted, sizeof quoted, err)) return err->status;
    pthread_mutex_lock(&lock);
    if (!lines || owner != getpid()) open_lines(folder, err);
    if (!err->status && (fprintf(lines, "%s %s %s\n", hash, log_name(), quoted) < 0 || fflush(lines)))
        err_errno(err, "write into", folder);
    pthread_mutex_unlock(&lock);
    return err->status;
}
