/* outfile.c - writes a temporary file and renames it; removes leftovers at exit.
 *
 * Live temporary files are in a list that exit and signal handlers can walk: nodes are reused but never freed, and a
 * node's path is valid while its owner is set. A name is listed before its file is created, so that a signal in between
 * leaves no file behind. A forked child has another process id and removes nothing. */
#include "common/base/outfile.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/ledger.h"

struct live {
    struct live *next;
    atomic_long owner; /* process id; 0: unused node */
    char path[PATH_MAX];
};

static _Atomic(struct live *) lives;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_once_t once = PTHREAD_ONCE_INIT;

static void remove_all(void)
{
    const long self = (long)getpid();

    for (struct live *l = atomic_load(&lives); l; l = l->next)
        if (atomic_load(&l->owner) == self) unlink(l->path);
}

static void on_signal(int sig)
{
    remove_all();
    raise(sig); /* the default action now, because of SA_RESETHAND */
}

static void arrange_removal(void)
{
    /* a library that has no memory, or a fault of ours, raises the last three */
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGABRT, SIGSEGV, SIGBUS};
    struct sigaction old, action = {.sa_handler = on_signal, .sa_flags = (int)SA_RESETHAND};

    sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) /* a SIGHUP that nohup ignores stays ignored */
        if (!sigaction(signals[i], NULL, &old) && old.sa_handler == SIG_DFL) sigaction(signals[i], &action, NULL);
    atexit(remove_all);
}

static struct live *live_find(const char *path)
{
    struct live *l = atomic_load(&lives);

    while (l && !(atomic_load(&l->owner) == (long)getpid() && !strcmp(l->path, path))) l = l->next;
    return l;
}

static enum status live_add(const char *path, struct err *err)
{
    pthread_once(&once, arrange_removal);
    pthread_mutex_lock(&lock);
    struct live *l = atomic_load(&lives);
    while (l && atomic_load(&l->owner)) l = l->next;
    if (!l && (l = calloc(1, sizeof *l))) {
        l->next = atomic_load(&lives);
        atomic_store(&lives, l);
    }
    if (l) {
        strcpy(l->path, path);
        atomic_store(&l->owner, (long)getpid());
    }
    pthread_mutex_unlock(&lock);
    return l ? ST_OK : err_nomem(err, "a temporary file's name", sizeof *l);
}

static void live_drop(const char *path)
{
    pthread_mutex_lock(&lock);
    struct live *l = live_find(path);
    if (l) atomic_store(&l->owner, 0);
    pthread_mutex_unlock(&lock);
}

enum status outfile_make_folders(const char *path, struct err *err)
{
    char *folder = strdup(path);
    struct stat info;

    if (!folder) return err_nomem(err, "a folder's name", strlen(path) + 1);
    for (char *p = folder; !err->status && *p; p++) {
        const char *slash = strchr(p + 1, '/');
        p = slash ? folder + (slash - folder) : p + strlen(p);
        const char kept = *p;
        *p = '\0';
        /* stat() first: mkdir() may fail with EACCES or EROFS in an existing parent folder */
        if (stat(folder, &info) || !S_ISDIR(info.st_mode)) {
            if (mkdir(folder, 0777) && (errno != EEXIST || stat(folder, &info) || !S_ISDIR(info.st_mode)))
                err_errno(err, "make the folder", folder);
        }
        if (!kept) break;
        *p = kept;
    }
    free(folder);
    return err->status;
}

/* Sets temp to ".NAME.XXXXXX.tmp" in the folder of `path`. NAME is cut to 200 bytes, to fit a file name. */
static enum status temp_name(char temp[PATH_MAX], const char *path, struct err *err)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyz0123456789";
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    unsigned char random[6];
    char middle[7] = "";

    if (getrandom(random, sizeof random, 0) != (ssize_t)sizeof random) return err_errno(err, "name a file for", path);
    for (int i = 0; i < 6; i++) middle[i] = letters[random[i] % (sizeof letters - 1)];
    const int n = snprintf(temp, PATH_MAX, "%.*s.%.200s.%s.tmp", (int)(name - path), path, name, middle);
    if (n < PATH_MAX) return ST_OK;
    errno = ENAMETOOLONG;
    return err_errno(err, "write", path);
}

static enum status make_parent(const char *path, struct err *err)
{
    const char *slash = strrchr(path, '/');

    if (!slash || slash == path) return ST_OK;
    char *folder = strndup(path, (size_t)(slash - path));
    if (!folder) return err_nomem(err, "a folder's name", strlen(path));
    outfile_make_folders(folder, err);
    free(folder);
    return err->status;
}

enum status outfile_open(struct outfile *f, const char *path, struct err *err)
{
    char temp[PATH_MAX];
    struct stat info;
    int fd = -1;

    *f = (struct outfile){0};
    /* renaming would replace a device such as /dev/null by a file */
    if (!stat(path, &info) && !S_ISREG(info.st_mode))
        return err_set(err, ST_IO, "cannot write %s: it exists and is not a regular file; give another name.", path);
    if (make_parent(path, err)) return err->status;
    for (int tries = 0; fd < 0; tries++) {
        if (temp_name(temp, path, err) || live_add(temp, err)) return err->status;
        /* not mkstemp(), which makes mode 0600: open() applies the umask, which threads share and must not change */
        fd = open(temp, O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
        if (fd >= 0) break;
        live_drop(temp);
        if (errno != EEXIST || tries == 100) return err_errno(err, "write", path);
    }
    f->fp = fdopen(fd, "wb");
    f->path = strdup(path);
    f->temp = strdup(temp);
    if (f->fp && f->path && f->temp) return ST_OK;
    if (!f->fp) close(fd);
    unlink(temp);
    live_drop(temp);
    if (f->fp) fclose(f->fp);
    free(f->path);
    free(f->temp);
    *f = (struct outfile){0};
    return err_nomem(err, "a file to write", strlen(path) + strlen(temp));
}

/* Opens by name, because a library may have replaced the temporary file. */
static int sync_path(const char *path, int flags)
{
    const int fd = open(path, O_RDONLY | O_CLOEXEC | flags);
    int rc = -1;

    if (fd < 0) return -1;
    rc = fsync(fd);
    const int saved = errno;
    close(fd);
    errno = saved;
    return rc;
}

static void sync_parent(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *folder = slash ? strndup(path, slash == path ? 1 : (size_t)(slash - path)) : strdup(".");

    /* errors are ignored: the product is complete and in place, and some network file systems cannot sync folders */
    if (folder) sync_path(folder, O_DIRECTORY);
    free(folder);
}

enum status outfile_commit(struct outfile *f, struct err *err)
{
    if (!f->fp) return err_set(err, ST_INTERNAL, "outfile_commit() was called for a file that is not open.");
    if (fflush(f->fp))
        err_errno(err, "write", f->path);
    else if (ferror(f->fp))
        err_set(err, ST_IO, "cannot write %s: a write failed; the disk may be full.", f->path);
    if (fclose(f->fp) && !err->status) err_errno(err, "write", f->path);
    f->fp = NULL;
    if (!err->status && sync_path(f->temp, 0)) err_errno(err, "write", f->path);
    if (!err->status) ledger_add(f->path, f->temp, err);
    if (!err->status && rename(f->temp, f->path)) err_errno(err, "write", f->path);
    if (!err->status) {
        live_drop(f->temp);
        sync_parent(f->path);
        free(f->path);
        free(f->temp);
        *f = (struct outfile){0};
        return ST_OK;
    }
    outfile_discard(f);
    return err->status;
}

void outfile_discard(struct outfile *f)
{
    if (!f) return;
    if (f->fp) fclose(f->fp);
    if (f->temp) {
        unlink(f->temp);
        live_drop(f->temp);
    }
    free(f->path);
    free(f->temp);
    *f = (struct outfile){0};
}

enum status outfile_write_if_changed(const char *path, const char *text, size_t size, struct err *err)
{
    FILE *old = fopen(path, "rb");
    bool same = old != NULL;
    for (size_t i = 0; same && i < size; i++) same = getc(old) == (unsigned char)text[i];
    if (same) same = getc(old) == EOF;
    if (old) fclose(old);
    if (same) return ST_OK;

    struct outfile f = {0};
    outfile_open(&f, path, err);
    if (!err->status && fwrite(text, 1, size, f.fp) != size) err_errno(err, "write", path);
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

enum status outfile_copy(const char *to, const char *from, struct err *err)
{
    struct outfile file = {0};
    char buffer[1 << 16];
    size_t got = 0;
    FILE *source = fopen(from, "rbe");
    if (!source) return err_errno(err, "open", from);
    outfile_open(&file, to, err);
    /* the commit reports a failed write */
    while (!err->status && (got = fread(buffer, 1, sizeof buffer, source)) > 0) fwrite(buffer, 1, got, file.fp);
    if (!err->status && ferror(source)) err_errno(err, "read", from);
    if (!err->status) outfile_commit(&file, err);
    outfile_discard(&file);
    fclose(source);
    return err->status;
}
