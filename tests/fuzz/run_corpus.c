/* run_corpus.c - main() of a fuzz target without a fuzzer: runs the target on all files in the given files and folders.
 *
 * Each input is copied to memory of its exact size, so that the address sanitizer detects reads past its end. */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "tests/fuzz/fuzz.h"

static int run_file(const char *path)
{
    struct stat info;
    FILE *fp = fopen(path, "rb");
    int failed = !fp || fstat(fileno(fp), &info);
    const size_t size = failed ? 0 : (size_t)info.st_size;
    uint8_t *data = malloc(size ? size : 1);

    failed = failed || !data || fread(data, 1, size, fp) != size;
    if (fp) fclose(fp);
    if (failed) {
        fprintf(stderr, "cannot read %s\n", path);
    } else {
        /* the last line names the input that crashed */
        fprintf(stderr, "%s (%zu bytes)\n", path, size);
        LLVMFuzzerTestOneInput(data, size);
    }
    free(data);
    return failed;
}

static int visible(const struct dirent *e) { return e->d_name[0] != '.'; }

static int run_path(const char *path, int *count)
{
    struct stat info;
    struct dirent **entries = NULL;
    char entry[4096];
    int failed = 0;

    if (stat(path, &info) || !S_ISDIR(info.st_mode)) {
        ++*count;
        return run_file(path);
    }
    const int n = scandir(path, &entries, visible, alphasort);
    if (n < 0) {
        fprintf(stderr, "cannot read %s\n", path);
        return 1;
    }
    for (int i = 0; i < n; i++) {
        snprintf(entry, sizeof entry, "%s/%s", path, entries[i]->d_name);
        failed |= run_path(entry, count);
        free(entries[i]);
    }
    free(entries);
    return failed;
}

int main(int argc, char **argv)
{
    int count = 0, failed = 0;

    for (int i = 1; i < argc; i++) failed |= run_path(argv[i], &count);
    if (!count) {
        fprintf(stderr, "no inputs: give files or folders\n");
        return 1;
    }
    printf("%d inputs\n", count);
    return failed;
}
