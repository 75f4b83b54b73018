/* trace.c - a seccomp filter stops the program at the calls of interest; others run at full speed. */
#include "tests/faults/trace.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

const char *const trace_call_names[CALL_COUNT] = {"none", "open", "create", "read",  "write", "close",
                                                  "stat", "list", "rename", "fsync", "mkdir"};

enum { THREADS = 4096 };

struct tracer {
    const struct trace_run *run;
    struct trace_result *result;
    pid_t main;
    pid_t threads[THREADS]; /* of the program; other processes are its children */
    int count;
    pid_t returning; /* a thread whose close() shall seem to fail */
    bool begun;      /* main() */
    bool stopped;    /* a thread waits for its first stop */
};

static const struct {
    long number;
    enum trace_call call;
} calls[] = {
    {SYS_open, CALL_OPEN},        {SYS_openat, CALL_OPEN},     {SYS_creat, CALL_CREATE},  {SYS_read, CALL_READ},
    {SYS_pread64, CALL_READ},     {SYS_readv, CALL_READ},      {SYS_write, CALL_WRITE},   {SYS_pwrite64, CALL_WRITE},
    {SYS_writev, CALL_WRITE},     {SYS_close, CALL_CLOSE},     {SYS_stat, CALL_STAT},     {SYS_lstat, CALL_STAT},
    {SYS_newfstatat, CALL_STAT},  {SYS_statx, CALL_STAT},      {SYS_access, CALL_STAT},   {SYS_faccessat, CALL_STAT},
    {SYS_faccessat2, CALL_STAT},  {SYS_getdents64, CALL_LIST}, {SYS_rename, CALL_RENAME}, {SYS_renameat, CALL_RENAME},
    {SYS_renameat2, CALL_RENAME}, {SYS_link, CALL_RENAME},     {SYS_fsync, CALL_FSYNC},   {SYS_fdatasync, CALL_FSYNC},
    {SYS_mkdir, CALL_MKDIR},      {SYS_mkdirat, CALL_MKDIR},   {SYS_prctl, CALL_NONE},
};
enum { CALLS = sizeof calls / sizeof *calls };

static void install_filter(void)
{
    struct sock_filter code[CALLS * 2 + 2];
    int n = 0;

    code[n++] = (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr));
    for (int i = 0; i < CALLS; i++) {
        code[n++] = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (unsigned)calls[i].number, 0, 1);
        code[n++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRACE);
    }
    code[n++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    struct sock_fprog program = {.len = (unsigned short)n, .filter = code};
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program, 0, 0)) _exit(125);
}

static void run_child(const struct trace_run *run)
{
    char fd[32];
    const int out = open("/dev/null", O_RDWR), err = open(run->errors, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    const struct rlimit none = {0, 0}, memory = {6UL << 30, 6UL << 30};
    const struct rlimit time = {(rlim_t)run->seconds, (rlim_t)run->seconds + 1};

    if (out < 0 || err < 0 || dup2(out, 0) < 0 || dup2(out, 1) < 0 || dup2(err, 2) < 0 || chdir(run->folder))
        _exit(125);
    if (out > 2) close(out);
    if (err > 2) close(err);
    setpgid(0, 0);
    setrlimit(RLIMIT_CORE, &none);
    setrlimit(RLIMIT_AS, &memory);
    setrlimit(RLIMIT_CPU, &time);
    snprintf(fd, sizeof fd, "%d", run->page_fd);
    setenv("FAULT_PAGE", fd, 1);
    setenv("LD_PRELOAD", run->shim, 1);
    setenv("TMPDIR", run->temp, 1);
    run->page->pid = getpid();
    if (ptrace(PTRACE_TRACEME, 0, 0, 0)) _exit(125);
    raise(SIGSTOP);
    install_filter();
    execv(run->argv[0], run->argv);
    _exit(124);
}

static bool is_ours(const struct tracer *t, pid_t pid)
{
    for (int i = 0; i < t->count; i++)
        if (t->threads[i] == pid) return true;
    return false;
}

static bool read_text(pid_t pid, unsigned long at, char *text, size_t size)
{
    size_t n = 0;

    while (n < size - 1) {
        /* not across the end of a page, which may be the last one */
        const size_t left = 4096 - (at + n) % 4096, part = left < size - 1 - n ? left : size - 1 - n;
        struct iovec to = {text + n, part}, from = {(void *)(at + n), part};
        const ssize_t got = process_vm_readv(pid, &to, 1, &from, 1, 0);
        if (got <= 0) return false;
        if (memchr(text + n, 0, (size_t)got)) return true;
        n += (size_t)got;
    }
    text[n] = '\0';
    return true;
}

static bool path_of_fd(pid_t pid, long fd, char *path, size_t size)
{
    char link[64];

    snprintf(link, sizeof link, "/proc/%ld/fd/%ld", (long)pid, fd);
    const ssize_t n = readlink(link, path, size - 1);
    path[n > 0 ? n : 0] = '\0';
    return n > 0;
}

static bool of_interest(const char *path)
{
    static const char *const others[] = {
        "/proc/",  "/sys/", "/dev/",      "/etc/",  "/usr/lib/", "/lib/", "/lib64/", "/run/", "/usr/share/locale",
        "/memfd:", "pipe:", "anon_inode", "socket:"};

    if (!*path) return false;
    if (!strncmp(path, "/dev/shm/", strlen("/dev/shm/"))) return true; /* where a campaign may work */
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (!strncmp(path, others[i], strlen(others[i]))) return false;
    return true;
}

/* What a stopped thread is about to call; its path, or that of its file, goes to `path`. */
static enum trace_call classify(pid_t pid, const struct user_regs_struct *r, char *path, size_t size)
{
    enum trace_call call = CALL_NONE;

    for (int i = 0; i < CALLS; i++)
        if ((long)r->orig_rax == calls[i].number) call = calls[i].call;
    *path = '\0';
    unsigned long name = 0;
    switch (r->orig_rax) {
    case SYS_open:
        name = r->rdi;
        call = r->rsi & (O_WRONLY | O_RDWR) ? CALL_CREATE : CALL_OPEN;
        break;
    case SYS_openat:
        name = r->rsi;
        call = r->rdx & (O_WRONLY | O_RDWR) ? CALL_CREATE : CALL_OPEN;
        break;
    case SYS_creat:
    case SYS_stat:
    case SYS_lstat:
    case SYS_access:
    case SYS_rename:
    case SYS_link:
    case SYS_mkdir:
        name = r->rdi;
        break;
    case SYS_newfstatat:
    case SYS_statx:
    case SYS_faccessat:
    case SYS_faccessat2:
    case SYS_renameat:
    case SYS_renameat2:
    case SYS_mkdirat:
        name = r->rsi;
        break;
    default:
        if (!call || (long)r->rdi < 3 || !path_of_fd(pid, (long)r->rdi, path, size) || !of_interest(path))
            return CALL_NONE;
        return call;
    }
    if (!name || !read_text(pid, name, path, size)) return CALL_NONE;
    if (!*path && !path_of_fd(pid, (long)r->rdi, path, size)) return CALL_NONE; /* fstat() */
    return of_interest(path) ? call : CALL_NONE;
}

/* Lets the call happen, or not. */
static void at_call(struct tracer *t, pid_t pid)
{
    struct user_regs_struct r;
    char path[4096];
    const struct trace_fault *f = &t->run->fault;

    if (ptrace(PTRACE_GETREGS, pid, 0, &r)) return;
    if (r.orig_rax == SYS_prctl) {
        if (r.rdi == FAULT_MARK && is_ours(t, pid)) t->begun = true;
        return;
    }
    if (!t->begun || !is_ours(t, pid)) return;
    const enum trace_call call = classify(pid, &r, path, sizeof path);
    if (!call) return;
    if (call == CALL_OPEN && t->run->opened) t->run->opened(t->run->data, path);
    if (f->temporary && strncmp(path, t->run->temp, strlen(t->run->temp))) return;
    const long n = ++t->result->counts[call];
    if (call != f->call || n < f->at || (n > f->at && !f->sticky)) return;
    if (!t->result->happened) snprintf(t->result->path, sizeof t->result->path, "%.511s", path);
    t->result->happened = true;
    if (f->kill) {
        kill(-t->main, SIGKILL);
        kill(t->main, SIGKILL);
        return;
    }
    if (call == CALL_CLOSE) {
        t->returning = pid;
        return;
    }
    if (f->shorter) {
        if (r.rdx < 2 || r.orig_rax == SYS_writev || r.orig_rax == SYS_readv) return;
        r.rdx /= 2;
    } else {
        r.orig_rax = (unsigned long)-1;
        r.rax = (unsigned long)-f->error;
    }
    ptrace(PTRACE_SETREGS, pid, 0, &r);
}

/* A close() that fails has closed the file: only what it returns is changed. */
static void at_return(struct tracer *t, pid_t pid)
{
    struct user_regs_struct r;

    t->returning = 0;
    if (ptrace(PTRACE_GETREGS, pid, 0, &r)) return;
    r.rax = (unsigned long)-t->run->fault.error;
    ptrace(PTRACE_SETREGS, pid, 0, &r);
}

static double now(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void on_alarm(int sig) { (void)sig; }

static void at_stop(struct tracer *t, pid_t pid, int status)
{
    const int sig = WSTOPSIG(status), event = status >> 16;
    unsigned long made = 0;
    int pass = 0;

    if (event == PTRACE_EVENT_SECCOMP)
        at_call(t, pid);
    else if (event == PTRACE_EVENT_CLONE) {
        ptrace(PTRACE_GETEVENTMSG, pid, 0, &made);
        if (is_ours(t, pid) && t->count < THREADS) {
            /* a new thread, unless it is a process: clone() makes both */
            char task[96];
            snprintf(task, sizeof task, "/proc/%ld/task/%lu", (long)t->main, made);
            if (!access(task, F_OK)) t->threads[t->count++] = (pid_t)made;
        }
    } else if (!event && sig != SIGSTOP && sig != SIGTRAP)
        pass = sig;
    else if (!event && sig == SIGTRAP && t->returning == pid)
        at_return(t, pid);
    ptrace(t->returning == pid ? PTRACE_SYSCALL : PTRACE_CONT, pid, 0, pass);
}

bool trace_program(struct trace_result *result, const struct trace_run *run)
{
    struct tracer *t = calloc(1, sizeof *t);
    const double begun = now();
    int status = 0;

    *result = (struct trace_result){.code = -1};
    const pid_t pid = fork();
    if (!t || pid < 0) return false;
    if (!pid) run_child(run);
    t->run = run;
    t->result = result;
    t->main = t->threads[t->count++] = pid;
    if (waitpid(pid, &status, 0) != pid || !WIFSTOPPED(status)) {
        fprintf(stderr, "campaign: %s cannot be traced here.\n", run->argv[0]);
        free(t);
        return false;
    }
    ptrace(PTRACE_SETOPTIONS, pid, 0,
           PTRACE_O_TRACESECCOMP | PTRACE_O_TRACECLONE | PTRACE_O_TRACEFORK | PTRACE_O_TRACEVFORK | PTRACE_O_EXITKILL);
    ptrace(PTRACE_CONT, pid, 0, 0);
    const struct sigaction action = {.sa_handler = on_alarm}; /* interrupts waitpid() */
    sigaction(SIGALRM, &action, NULL);
    alarm(15 * (unsigned)run->seconds); /* the machine may have other work */
    for (bool over = false;;) {
        const pid_t who = waitpid(-1, &status, __WALL);
        if (who < 0 && errno == EINTR) {
            result->hung = true;
            kill(-pid, SIGKILL);
            kill(pid, SIGKILL);
            continue;
        }
        if (who < 0) break; /* no child is left */
        if (WIFSTOPPED(status))
            at_stop(t, who, status);
        else if (who == pid) {
            over = true;
            result->code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
            result->signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
            result->hung = result->hung || result->signal == SIGXCPU;
        }
        if (over && kill(-pid, 0)) break;
    }
    alarm(0);
    result->seconds = now() - begun;
    free(t);
    return true;
}
