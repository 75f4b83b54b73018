/* measure.c - runs a command and measures its time and memory.
 *
 *   measure FILE COMMAND [ARGUMENT...]
 *
 * Writes "seconds S" (wall time), "cpu_seconds S" and "peak_mib M" to FILE and exits with the command's status. The
 * shell's `time` would not do: the peak of a child starts at the memory of the process that forked it, so that process
 * must be small. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static double seconds_of(struct timeval t) { return (double)t.tv_sec + (double)t.tv_usec * 1e-6; }

int main(int argc, char **argv)
{
    if (argc < 3) {
        fprintf(stderr, "measure: found %d arguments, wanted FILE COMMAND [ARGUMENT...].\n", argc - 1);
        return 2;
    }
    struct timespec begin, end;
    clock_gettime(CLOCK_MONOTONIC, &begin);
    pid_t pid = fork();
    if (pid == 0) {
        execvp(argv[2], argv + 2);
        fprintf(stderr, "measure: cannot run %s: %s.\n", argv[2], strerror(errno));
        _exit(127);
    }
    int status = 0;
    struct rusage use;
    if (pid < 0 || wait4(pid, &status, 0, &use) != pid) {
        fprintf(stderr, "measure: cannot start or wait for %s: %s.\n", argv[2], strerror(errno));
        return 1;
    }
    clock_gettime(CLOCK_MONOTONIC, &end);

    FILE *to = fopen(argv[1], "w");
    int written = to ? fprintf(to, "seconds %.6f\ncpu_seconds %.6f\npeak_mib %.1f\n",
                               (double)(end.tv_sec - begin.tv_sec) + (double)(end.tv_nsec - begin.tv_nsec) * 1e-9,
                               seconds_of(use.ru_utime) + seconds_of(use.ru_stime), (double)use.ru_maxrss / 1024)
                     : -1;
    if ((to && fclose(to)) || written < 0) {
        fprintf(stderr, "measure: cannot write %s: %s.\n", argv[1], strerror(errno));
        return 1;
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}
