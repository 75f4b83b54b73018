/* shim.c - a library that is loaded into a program before all others (LD_PRELOAD), to make its allocations fail and its
 * clocks go back, as page.h says. Calls of the kernel are counted and made to fail from outside (trace.c): the C
 * library does not pass its own writes through a name that a loaded library could take over.
 *
 * With FAULT_RECORD=DIR it does none of this: each program below a folder bin/ leaves its command line in DIR. */
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <malloc.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include "tests/faults/page.h"

/* the C library's own, and the function that it calls main() with, which this file replaces */
void *own_malloc(size_t size) __asm__("__libc_malloc");
void *own_calloc(size_t n, size_t size) __asm__("__libc_calloc");
void *own_realloc(void *old, size_t size) __asm__("__libc_realloc");
void *own_memalign(size_t align, size_t size) __asm__("__libc_memalign");
int shim_start(int (*program)(int, char **, char **), int argc, char **argv, void (*init)(void), void (*fini)(void),
               void (*rtld_fini)(void), void *stack_end) __asm__("__libc_start_main");

static struct fault_page *page;
static int (*real_main)(int, char **, char **);
static void *main_base;
static _Thread_local bool inside;

/* Notes which file asked for the allocation: the first on the stack that is not a part of the languages' own libraries;
 * and, of the first one that fails, the program's own places on the way there. The
 * last one counts: it is what a program ends of. */
static void note_owner(bool first)
{
    static const char *const own[] = {"/libc.so", "/libc-",    "/libstdc++", "/libgcc_s",
                                      "/libm.so", "/ld-linux", "shim.so"};
    void *frames[48];
    const int n = backtrace(frames, 48);
    bool known = false;
    size_t places = 0;

    for (int i = 0; i < n; i++) {
        Dl_info info;
        bool skipped = false;
        if (!dladdr(frames[i], &info) || !info.dli_fname) continue;
        for (size_t k = 0; k < sizeof own / sizeof *own; k++) skipped = skipped || strstr(info.dli_fname, own[k]);
        if (skipped) continue;
        if (first && info.dli_fbase == main_base && places < sizeof page->frames / sizeof *page->frames)
            page->frames[places++] = (char *)frames[i] - (char *)main_base - 1;
        if (!known) {
            atomic_store(&page->foreign, info.dli_fbase != main_base);
            snprintf(page->library, sizeof page->library, "%s", info.dli_fname);
        }
        known = true;
    }
}

static bool refused(void)
{
    if (!page || inside) return false;
    const long n = atomic_fetch_add(&page->mallocs, 1) + 1;
    if (!page->malloc_at || n < page->malloc_at || (n > page->malloc_at && !page->malloc_sticky)) return false;
    inside = true;
    note_owner(n == page->malloc_at);
    inside = false;
    errno = ENOMEM;
    return true;
}

void *malloc(size_t size) { return refused() ? NULL : own_malloc(size); }
void *calloc(size_t n, size_t size) { return refused() ? NULL : own_calloc(n, size); }
void *realloc(void *old, size_t size) { return size && refused() ? NULL : own_realloc(old, size); }
void *memalign(size_t align, size_t size) { return refused() ? NULL : own_memalign(align, size); }
void *aligned_alloc(size_t align, size_t size) { return refused() ? NULL : own_memalign(align, size); }

int posix_memalign(void **out, size_t align, size_t size)
{
    const int saved = errno;
    void *p = refused() ? NULL : own_memalign(align, size);

    errno = saved;
    if (!p) return ENOMEM;
    *out = p;
    return 0;
}

static long hours_back(void)
{
    if (!page) return 0;
    const long n = atomic_fetch_add(&page->clocks, 1) + 1;
    return page->clock_at && n >= page->clock_at ? n - page->clock_at + 1 : 0;
}

int clock_gettime(clockid_t clock, struct timespec *t)
{
    const int rc = (int)syscall(SYS_clock_gettime, clock, t);

    if (!rc) t->tv_sec -= 3600 * hours_back();
    return rc;
}

int gettimeofday(struct timeval *restrict t, void *restrict zone)
{
    const int rc = (int)syscall(SYS_gettimeofday, t, zone);

    if (!rc) t->tv_sec -= 3600 * hours_back();
    return rc;
}

time_t time(time_t *t)
{
    struct timespec now;

    syscall(SYS_clock_gettime, CLOCK_REALTIME, &now);
    now.tv_sec -= 3600 * hours_back();
    if (t) *t = now.tv_sec;
    return now.tv_sec;
}

/* FOLDER/PROGRAM.PID: the current folder, then the arguments, each with a 0 at its end */
static void record(const char *folder, char **argv)
{
    char exe[4096], cwd[4096], path[8192];
    const ssize_t n = readlink("/proc/self/exe", exe, sizeof exe - 1);

    if (n <= 0 || !getcwd(cwd, sizeof cwd)) return;
    exe[n] = '\0';
    char *slash = strrchr(exe, '/');
    if (!slash || slash - exe < 4 || strncmp(slash - 4, "/bin", 4) || !strncmp(exe, "/usr/", 5) ||
        !strncmp(exe, "/bin/", 5))
        return;
    snprintf(path, sizeof path, "%s/%s.%ld", folder, slash + 1, (long)getpid());
    FILE *f = fopen(path, "wb");
    if (!f) return;
    fwrite(cwd, 1, strlen(cwd) + 1, f);
    for (; *argv; argv++) fwrite(*argv, 1, strlen(*argv) + 1, f);
    fclose(f);
}

static int begin(int argc, char **argv, char **env)
{
    const char *folder = getenv("FAULT_RECORD"), *fd = getenv("FAULT_PAGE");
    Dl_info info;

    if (folder) record(folder, argv);
    if (fd) {
        void *frames[4];
        void *p = mmap(NULL, sizeof *page, PROT_READ | PROT_WRITE, MAP_SHARED, atoi(fd), 0);
        if (p != MAP_FAILED && ((struct fault_page *)p)->pid == getpid()) {
            backtrace(frames, 4); /* which allocates when it is first called */
            main_base = dladdr((void *)real_main, &info) ? info.dli_fbase : NULL;
            prctl(FAULT_MARK, 0, 0, 0, 0);
            page = p;
        }
    }
    return real_main(argc, argv, env);
}

int shim_start(int (*program)(int, char **, char **), int argc, char **argv, void (*init)(void), void (*fini)(void),
               void (*rtld_fini)(void), void *stack_end)
{
    int (*next)(int (*)(int, char **, char **), int, char **, void (*)(void), void (*)(void), void (*)(void), void *);

    *(void **)&next = dlsym(RTLD_NEXT, "__libc_start_main");
    real_main = program;
    return next(begin, argc, argv, init, fini, rtld_fini, stack_end);
}
