/* process.c - starts programs by fork() and execve().
 *
 * If the child cannot start the program, it writes errno to a pipe that a successful execve() closes. Everything that
 * needs memory (path, environment) is prepared before fork(), because other threads of this process may hold locks. */
#include "common/base/process.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static const struct {
    const char *program, *package;
} packages[] = {{"colmap", "colmap"}, {"ffmpeg", "ffmpeg"}, {"ffprobe", "ffmpeg"}};

static enum status missing(const char *program, struct err *err)
{
    for (size_t i = 0; i < sizeof packages / sizeof *packages; i++)
        if (!strcmp(program, packages[i].program))
            return err_set(err, ST_IO, "the program %s is not in PATH; install Debian's package %s.", program,
                           packages[i].package);
    return err_set(err, ST_IO, "the program %s is not in PATH; install it.", program);
}

static bool executable(const char *path)
{
    struct stat info;

    return !access(path, X_OK) && !stat(path, &info) && S_ISREG(info.st_mode);
}

static enum status find_program(char found[PATH_MAX], const char *program, struct err *err)
{
    const char *path = getenv("PATH");

    if (strchr(program, '/')) {
        snprintf(found, PATH_MAX, "%s", program);
        return executable(found) ? ST_OK
                                 : err_set(err, ST_IO, "the program %s does not exist or is not executable.", program);
    }
    for (const char *p = path ? path : "/usr/local/bin:/usr/bin:/bin"; *p;) {
        const size_t n = strcspn(p, ":");
        /* an empty entry means the current folder; skipped for safety */
        if (n && snprintf(found, PATH_MAX, "%.*s/%s", (int)n, p, program) < PATH_MAX && executable(found)) return ST_OK;
        p += n + (p[n] == ':');
    }
    return missing(program, err);
}

static bool same_name(const char *a, const char *b)
{
    const size_t n = strcspn(a, "=");

    return !strncmp(a, b, n) && b[n] == '=';
}

/* environ with the variables of env added or replaced. The caller frees the array, not the strings. */
static char **merge_environment(const char *const env[])
{
    size_t old = 0, added = 0, n = 0;

    while (environ && environ[old]) old++;
    while (env && env[added]) added++;
    char **merged = calloc(old + added + 1, sizeof *merged);
    if (!merged) return NULL;
    for (size_t i = 0; i < old; i++) {
        bool replaced = false;
        for (size_t j = 0; j < added; j++) replaced = replaced || same_name(env[j], environ[i]);
        if (!replaced) merged[n++] = environ[i];
    }
    for (size_t j = 0; j < added; j++) merged[n++] = (char *)env[j];
    return merged;
}

/* Runs in the child between fork() and execve(): only async-signal-safe calls. error_pipe gets errno on failure. */
static void run_child(const char *path, char *const argv[], char *const envp[], int in, int out, int error_pipe,
                      pid_t parent)
{
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE};
    sigset_t none;
    int reason;

    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) {
        struct sigaction old;
        /* signals ignored at our start (nohup) stay ignored; SIGPIPE is ignored for our own writes only */
        if (!sigaction(signals[i], NULL, &old) && (old.sa_handler != SIG_IGN || signals[i] == SIGPIPE))
            signal(signals[i], SIG_DFL);
    }
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    if (!prctl(PR_SET_PDEATHSIG, SIGKILL) && getppid() == parent && dup2(in, STDIN_FILENO) >= 0 &&
        (out < 0 || (dup2(out, STDOUT_FILENO) >= 0 && dup2(out, STDERR_FILENO) >= 0)))
        execve(path, argv, envp);
    reason = errno;
    if (write(error_pipe, &reason, sizeof reason) < 0) _exit(126);
    _exit(127);
}

/* Starts the program with `in` as its standard input. */
static enum status start(long *pid, const char *const argv[], const char *const env[], int in, const char *log,
                         struct err *err)
{
    char path[PATH_MAX];
    int error_pipe[2] = {-1, -1}, out = -1, reason = 0;
    char **envp = NULL;
    ssize_t n;

    if (find_program(path, argv[0], err)) return err->status;
    if (!(envp = merge_environment(env))) {
        err_nomem(err, "the environment of a program", 0);
    } else if (log && (out = open(log, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666)) < 0) {
        err_errno(err, "write", log);
    } else if (pipe2(error_pipe, O_CLOEXEC)) {
        err_errno(err, "start", argv[0]);
    } else {
        const pid_t parent = getpid(), child = fork();
        if (!child) run_child(path, (char *const *)argv, envp, in, out, error_pipe[1], parent);
        close(error_pipe[1]);
        if (child < 0) {
            err_errno(err, "start", argv[0]);
        } else {
            while ((n = read(error_pipe[0], &reason, sizeof reason)) < 0 && errno == EINTR) continue;
            if (n == (ssize_t)sizeof reason) {
                while (waitpid(child, NULL, 0) < 0 && errno == EINTR) continue;
                errno = reason;
                err_errno(err, "start", path);
            } else {
                *pid = child;
            }
        }
        close(error_pipe[0]);
    }
    if (out >= 0) close(out);
    free(envp);
    return err->status;
}

static enum status wait_for(long pid, int *code, struct err *err)
{
    int status = 0;
    pid_t got;

    while ((got = waitpid((pid_t)pid, &status, 0)) < 0 && errno == EINTR) continue;
    if (got < 0) return err_errno(err, "wait for", "a program");
    *code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    return ST_OK;
}

/* Calls tick until the program has ended; the program remains to be waited for. */
static void watch(long pid, void (*tick)(void *ctx), void *ctx)
{
    const struct timespec pause = {.tv_nsec = 50000000};
    siginfo_t info = {0};

    while (!waitid(P_PID, (id_t)pid, &info, WEXITED | WNOHANG | WNOWAIT) && !info.si_pid) {
        tick(ctx);
        nanosleep(&pause, NULL);
    }
    tick(ctx);
}

enum status process_run(const char *const argv[], const char *const env[], const char *log, int *code, struct err *err)
{
    return process_run_watched(argv, env, log, NULL, NULL, code, err);
}

enum status process_run_watched(const char *const argv[], const char *const env[], const char *log,
                                void (*tick)(void *ctx), void *ctx, int *code, struct err *err)
{
    const int in = open("/dev/null", O_RDONLY | O_CLOEXEC);
    long pid = 0;

    if (in < 0) return err_errno(err, "open", "/dev/null");
    start(&pid, argv, env, in, log, err);
    close(in);
    if (!err->status && tick) watch(pid, tick, ctx);
    if (!err->status) wait_for(pid, code, err);
    return err->status;
}

/* SIGPIPE is ignored while a pipe to a program is open. */
static pthread_mutex_t pipes_lock = PTHREAD_MUTEX_INITIALIZER;
static struct sigaction pipes_before;
static int pipes_open;

static void pipe_opened(void)
{
    const struct sigaction ignore = {.sa_handler = SIG_IGN};

    pthread_mutex_lock(&pipes_lock);
    if (pipes_open++ == 0) sigaction(SIGPIPE, &ignore, &pipes_before);
    pthread_mutex_unlock(&pipes_lock);
}

static void pipe_closed(void)
{
    pthread_mutex_lock(&pipes_lock);
    if (--pipes_open == 0) sigaction(SIGPIPE, &pipes_before, NULL);
    pthread_mutex_unlock(&pipes_lock);
}

enum status process_start(struct process *p, const char *const argv[], const char *log, struct err *err)
{
    int ends[2];

    *p = (struct process){0};
    if (pipe2(ends, O_CLOEXEC)) return err_errno(err, "make a pipe to", argv[0]);
    start(&p->pid, argv, NULL, ends[0], log, err);
    close(ends[0]);
    if (!err->status && !(p->input = fdopen(ends[1], "wb"))) {
        err_nomem(err, "a pipe", BUFSIZ);
        process_kill(p);
    }
    if (err->status) {
        close(ends[1]);
        *p = (struct process){0};
        return err->status;
    }
    pipe_opened();
    return ST_OK;
}

enum status process_finish(struct process *p, int *code, struct err *err)
{
    *code = 0;
    if (!p || !p->pid) return ST_OK;
    bool failed = ferror(p->input);
    if (fclose(p->input)) failed = true;
    pipe_closed();
    const enum status st = wait_for(p->pid, code, err);
    /* exit code 0 without reading all of the input is a failure too */
    if (!st && failed && !*code) *code = 128 + SIGPIPE;
    *p = (struct process){0};
    return st;
}

void process_kill(struct process *p)
{
    int code;

    if (!p || !p->pid) return;
    kill((pid_t)p->pid, SIGKILL);
    if (p->input) {
        fclose(p->input);
        pipe_closed();
    }
    wait_for(p->pid, &code, NULL);
    *p = (struct process){0};
}
