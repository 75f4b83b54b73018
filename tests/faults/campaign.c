/* campaign.c - makes the calls of one program fail in turn, damages its inputs, and counts what came of it.
 *
 * campaign --folder DIR --command FILE --shim SO --results TSV --details TXT [--each N] [--inputs N]
 *
 * DIR is a project with a scene, in which the command (as shim.c recorded it) was run before. A first run tells what
 * the command makes; before each injection its products are removed. Afterwards
 *
 *   right      it ended well, and each product has the bytes of the first run
 *   sentence   it failed with "STAGE: error: ..." that names a file or memory; what it left is whole, and nothing else
 *              changed; or it made a page that says so
 *   killed     it was killed, as the injection says; what it left is whole
 *   library    an allocation that failed was a library's, which ended the process
 *   accepted   damaged inputs alone: it ended well, and what it made is not what it makes of the whole input
 *
 * and, which must not happen:
 *
 *   wrong      it ended well, and a product is missing or has other bytes
 *   lost       a file that is not its product was changed or removed
 *   half       it failed, and left a product with other bytes, or a file that is none
 *   crash      it was ended by another signal
 *   hang       it did not end
 *   silent     it failed without a sentence
 *   vague      it failed with a sentence that names neither a file nor memory
 *   rerun      a run after that fails, or its products have other bytes */
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/faults/trace.h"
#include "tests/faults/tree.h"

enum outcome {
    RIGHT,
    SENTENCE,
    KILLED,
    LIBRARY,
    ACCEPTED,
    WRONG,
    LOST,
    HALF,
    CRASH,
    HANG,
    SILENT,
    VAGUE,
    RERUN,
    OUTCOMES
};
static const char *const outcome_names[OUTCOMES] = {"right",  "sentence", "killed", "library", "accepted",
                                                    "wrong",  "lost",     "half",   "crash",   "hang",
                                                    "silent", "vague",    "rerun"};

struct kind {
    const char *name;
    enum trace_call call;
    int error;
    bool shorter, kill, sticky, temporary;
};
static const struct kind kinds[] = {
    {"open-EMFILE", CALL_OPEN, EMFILE, false, false, false, false},
    {"open-EMFILE-on", CALL_OPEN, EMFILE, false, false, true, false},
    {"open-EIO", CALL_OPEN, EIO, false, false, false, false},
    {"open-kill", CALL_OPEN, 0, false, true, false, false},
    {"create-EROFS-on", CALL_CREATE, EROFS, false, false, true, false},
    {"create-EMFILE", CALL_CREATE, EMFILE, false, false, false, false},
    {"read-EIO", CALL_READ, EIO, false, false, false, false},
    {"read-short", CALL_READ, 0, true, false, false, false},
    {"read-kill", CALL_READ, 0, false, true, false, false},
    {"write-ENOSPC", CALL_WRITE, ENOSPC, false, false, false, false},
    {"write-ENOSPC-on", CALL_WRITE, ENOSPC, false, false, true, false},
    {"write-EIO", CALL_WRITE, EIO, false, false, false, false},
    {"write-short", CALL_WRITE, 0, true, false, false, false},
    {"write-kill", CALL_WRITE, 0, false, true, false, false},
    {"close-EIO", CALL_CLOSE, EIO, false, false, false, false},
    {"stat-EIO", CALL_STAT, EIO, false, false, false, false},
    {"list-EIO", CALL_LIST, EIO, false, false, false, false},
    {"rename-EIO", CALL_RENAME, EIO, false, false, false, false},
    {"rename-kill", CALL_RENAME, 0, false, true, false, false},
    {"fsync-EIO", CALL_FSYNC, EIO, false, false, false, false},
    {"fsync-kill", CALL_FSYNC, 0, false, true, false, false},
    {"mkdir-ENOSPC", CALL_MKDIR, ENOSPC, false, false, false, false},
    {"temp-full", CALL_WRITE, ENOSPC, false, false, true, true},
};

static struct {
    const char *folder, *shim, *results, *details, *stage, *label;
    char *argv[512];
    char temp[4096], errors[4096];
    struct fault_page *page;
    int page_fd, limit, error; /* of the fault of this run */
    struct tree before;        /* without the products */
    struct tree made;          /* the products, with their bytes */
    char *opened[4096];
    int opened_count;
    long counts[64][OUTCOMES];
    const char *count_names[64];
    int count_kinds;
} c;

static char said[1 << 16]; /* standard error of the last run */

static void die(const char *what)
{
    fprintf(stderr, "campaign: %s %s: %s\n", c.stage ? c.stage : "", c.label ? c.label : "", what);
    exit(2);
}

/* The files below the folder that the program opens are its inputs. */
static void note_input(void *data, const char *path)
{
    const size_t n = strlen(c.folder);
    char whole[8192], real[4096];

    (void)data;
    snprintf(whole, sizeof whole, "%s%s%s", *path == '/' ? "" : c.folder, *path == '/' ? "" : "/", path);
    if (!realpath(whole, real) || strncmp(real, c.folder, n) || real[n] != '/') return;
    for (int i = 0; i < c.opened_count; i++)
        if (!strcmp(c.opened[i], real + n + 1)) return;
    if (c.opened_count < 4096) c.opened[c.opened_count++] = strdup(real + n + 1);
}

static bool run(struct trace_result *result, struct trace_fault fault, bool note)
{
    struct trace_run r = {.argv = c.argv,
                          .folder = c.folder,
                          .shim = c.shim,
                          .errors = c.errors,
                          .temp = c.temp,
                          .page = c.page,
                          .page_fd = c.page_fd,
                          .seconds = c.limit,
                          .fault = fault};

    if (note) r.opened = note_input;
    c.error = fault.error;
    if (!trace_program(result, &r)) exit(3);
    FILE *f = fopen(c.errors, "rb");
    const size_t n = f ? fread(said, 1, sizeof said - 1, f) : 0;
    said[n] = '\0';
    if (f) fclose(f);
    return !result->code && !result->signal;
}

/* A temporary file of outfile.h, or a file in a temporary folder: a killed program cannot remove its own. */
static bool is_temporary(const char *path)
{
    for (const char *p = path; *p;) {
        const size_t n = strcspn(p, "/");
        if (*p == '.' && n > 4 && !strncmp(p + n - 4, ".tmp", 4)) return true;
        p += n + (p[n] == '/');
    }
    return false;
}

/* In a folder NAME.work, which sfm keeps for people to look at when it fails, and empties when it begins. */
static bool is_workplace(const char *path) { return strstr(path, ".work/") != NULL; }

static bool is_right(const struct tree_file *product)
{
    size_t size = 0;
    const char *dot = strrchr(product->path, '.');
    char *bytes = tree_bytes(c.folder, product->path, &size);
    const bool right = bytes && ((dot && !strcmp(dot, ".log")) || /* the words of COLMAP, with times */
                                 (size == (size_t)product->size && !memcmp(bytes, product->bytes, size)));

    free(bytes);
    return right;
}

/* Takes away what a run made, so that the next one begins as the first did. */
static void clean(const struct tree *now)
{
    for (size_t i = 0; i < now->count; i++)
        if (!tree_find(&c.before, now->files[i].path)) tree_remove(c.folder, now->files[i].path);
}

/* A sentence about a file or about memory. */
static enum outcome judge_words(const char *words)
{
    char head[128];

    snprintf(head, sizeof head, "%s: error: ", c.stage);
    const char *at = strstr(words, head);
    if (!at) return SILENT;
    at += strlen(head);
    const size_t n = strcspn(at, "\n");
    if (n < 12) return SILENT;
    for (size_t i = 0; i < n; i++)
        if (at[i] == '/') return SENTENCE;
    char line[4096];
    snprintf(line, sizeof line, "%.*s", (int)(n < 4095 ? n : 4095), at);
    static const char *const named[] = {"memory", "alloc", ".txt", ".exr", ".jpg"};
    for (size_t i = 0; i < sizeof named / sizeof *named; i++)
        if (strstr(line, named[i])) return SENTENCE;
    return VAGUE;
}

/* Whether a page that was made all the same says what went wrong: the page of a scene shows what it can. */
static bool is_said(int error, const char *path)
{
    const size_t n = strlen(c.folder);
    if (!strncmp(path, c.folder, n) && path[n] == '/') path += n + 1;
    const char *words[] = {path, error ? strerror(error) : "not enough memory", "not enough memory",
                           "Cannot allocate memory"};

    for (size_t i = 0; i < c.made.count; i++) {
        size_t size = 0;
        char *bytes = tree_bytes(c.folder, c.made.files[i].path, &size);
        bool said_so = false;
        for (size_t k = *path ? 0 : 1; bytes && k < sizeof words / sizeof *words; k++)
            if (!memmem(c.made.files[i].bytes, (size_t)c.made.files[i].size, words[k], strlen(words[k])))
                said_so = said_so || memmem(bytes, size, words[k], strlen(words[k]));
        free(bytes);
        if (said_so) return true;
    }
    return false;
}

/* Empties the folder for temporary files. True: something had been left there, though nobody killed the program. */
static bool leave_temporary(bool killing)
{
    struct tree left;
    bool any = false;

    if (!tree_read(&left, c.temp)) die("the folder for temporary files cannot be read");
    for (size_t i = 0; i < left.count; i++) {
        tree_remove(c.temp, left.files[i].path);
        any = true;
    }
    tree_release(&left);
    return any && !killing;
}

/* What came of a run; `damaged`: the path of an input that was damaged on purpose. The tree is as before afterwards. */
static enum outcome judge(const struct trace_result *r, bool killing, const char *damaged, char *why, size_t why_size)
{
    struct tree now;
    enum outcome o = RIGHT;
    bool touched = false;

    *why = '\0';
    if (!tree_read(&now, c.folder)) die("the folder cannot be read");
    const bool well = !r->code && !r->signal;
    bool all = true, whole = true;
    for (size_t i = 0; i < c.made.count; i++) {
        const struct tree_file *p = &c.made.files[i];
        if (!tree_find(&now, p->path)) {
            all = false;
            if (well) snprintf(why, why_size, "%s is missing", p->path);
        } else if (touched = true, !is_right(p)) {
            whole = false;
            snprintf(why, why_size, "%s has other bytes", p->path);
        }
    }
    bool lost = false, strange = false;
    for (size_t i = 0; i < c.before.count; i++) {
        const struct tree_file *f = tree_find(&now, c.before.files[i].path);
        if (f && tree_same(f, &c.before.files[i])) continue;
        if (f && tree_hash_of(c.folder, f->path) == c.before.files[i].hash) { /* written anew, the same */
            c.before.files[i].inode = f->inode;
            c.before.files[i].changed = f->changed;
            continue;
        }
        if (damaged && !strcmp(damaged, c.before.files[i].path)) continue;
        lost = true;
        snprintf(why, why_size, "%s was changed", c.before.files[i].path);
    }
    for (size_t i = 0; i < now.count; i++) {
        const char *path = now.files[i].path;
        if (tree_find(&c.before, path) || tree_find(&c.made, path)) continue;
        touched = true;
        if (is_workplace(path) || (killing && is_temporary(path))) continue;
        strange = true;
        snprintf(why, why_size, "%s was left", path);
    }
    const bool left = leave_temporary(killing);
    if (left && !strange) {
        strange = true;
        snprintf(why, why_size, "a file was left in TMPDIR");
    }
    if (lost)
        o = LOST;
    else if (r->hung)
        o = HANG;
    else if (r->signal && !(killing && r->signal == SIGKILL))
        o = c.page->foreign ? LIBRARY : CRASH;
    else if (well && (!all || !whole))
        o = damaged ? ACCEPTED : is_said(c.error, r->path) ? SENTENCE : WRONG;
    else if (strange || (!whole && !damaged))
        o = c.page->foreign ? LIBRARY : HALF;
    else if (well)
        o = RIGHT;
    else if (killing)
        o = KILLED;
    else
        o = judge_words(said);
    if ((o == SILENT || o == VAGUE) && c.page->foreign) o = LIBRARY;
    if (o == VAGUE && damaged) o = SENTENCE; /* it may name a place in a file that it read before */
    if (touched && !lost && o != RIGHT && o != ACCEPTED) {
        struct trace_result again;
        struct fault_page kept = *c.page;
        char words[sizeof said];
        memcpy(words, said, sizeof said);
        tree_release(&now);
        memset(c.page, 0, sizeof *c.page);
        const bool runs = run(&again, (struct trace_fault){0}, false);
        if (!tree_read(&now, c.folder)) die("the folder cannot be read");
        bool same = true, gone = true;
        const char *other = "";
        for (size_t i = 0; i < c.made.count; i++)
            if (!is_right(&c.made.files[i])) {
                same = false;
                other = c.made.files[i].path;
            }
        for (size_t i = 0; i < now.count; i++)
            gone = gone && (tree_find(&c.before, now.files[i].path) || tree_find(&c.made, now.files[i].path) ||
                            is_workplace(now.files[i].path) || (killing && is_temporary(now.files[i].path)));
        if (!runs || !same) {
            o = RERUN;
            snprintf(why, why_size, "%s: %.200s",
                     runs ? "a run afterwards makes other bytes" : "a run afterwards fails", runs ? other : said);
        } else if (o == HALF && gone && whole && !left) {
            o = killing ? KILLED : judge_words(words); /* whole files that the next run takes away */
        }
        memcpy(said, words, sizeof said);
        *c.page = kept;
    }
    clean(&now);
    tree_release(&now);
    if (lost) die(why);
    return o;
}

static void tally(const char *kind, const char *where, enum outcome o, const char *why, const struct trace_result *r)
{
    int k = 0;

    while (k < c.count_kinds && strcmp(c.count_names[k], kind)) k++;
    if (k == c.count_kinds) c.count_names[c.count_kinds++] = kind;
    c.counts[k][o]++;
    if (o < LIBRARY && !getenv("FAULT_ALL")) return;
    FILE *f = fopen(c.details, "a");
    if (!f) die("the details cannot be written");
    /* the sentence, and the end of what it said */
    const char *error = strstr(said, ": error: ");
    const size_t length = strlen(said);
    char line[512], places[256] = "";
    snprintf(line, sizeof line, "%.*s ... %.200s", error ? (int)strcspn(error + 2, "\n") % 300 : 0,
             error ? error + 2 : "", length > 160 ? said + length - 160 : said);
    for (char *p = line; *p; p++)
        if (*p == '\n' || *p == '\t') *p = '|';
    for (size_t i = 0; i < sizeof c.page->frames / sizeof *c.page->frames && c.page->frames[i]; i++)
        snprintf(places + strlen(places), sizeof places - strlen(places), " %#lx", c.page->frames[i]);
    fprintf(f, "%s\t%s\t%s\t%s\t%s\texit %d signal %d\t%s\t%s\t%s\t%s\n", outcome_names[o], c.stage, kind, where,
            c.label, r->code, r->signal, why, r->happened ? r->path : c.page->library, places, line);
    fclose(f);
}

static void inject(const struct kind *k, long count, int each)
{
    char why[8192], where[64];
    const long n = count < each ? count : each;

    for (long i = 0; i < n; i++) {
        const long at = k->sticky && i == 0 ? 1 : 1 + (long)((double)count * ((double)i + 0.5) / (double)n);
        struct trace_result r;
        memset(c.page, 0, sizeof *c.page);
        run(&r,
            (struct trace_fault){.call = k->call,
                                 .at = at,
                                 .error = k->error,
                                 .shorter = k->shorter,
                                 .kill = k->kill,
                                 .sticky = k->sticky,
                                 .temporary = k->temporary},
            false);
        snprintf(where, sizeof where, "%ld of %ld", at, count);
        const enum outcome o = judge(&r, k->kill, NULL, why, sizeof why);
        if (r.happened) tally(k->name, where, o, why, &r);
    }
}

static void starve(long count, int each, bool sticky)
{
    char why[8192], where[64];
    const long n = count < each ? count : each;

    for (long i = 0; i < n; i++) {
        const long at = 1 + (long)((double)count * ((double)i + 0.5) / (double)n);
        struct trace_result r;
        memset(c.page, 0, sizeof *c.page);
        c.page->malloc_at = at;
        c.page->malloc_sticky = sticky;
        run(&r, (struct trace_fault){0}, false);
        snprintf(where, sizeof where, "%ld of %ld", at, count);
        tally(sticky ? "malloc-on" : "malloc", where, judge(&r, false, NULL, why, sizeof why), why, &r);
    }
}

static void turn_clock(long count)
{
    char why[8192], where[64];
    const long at[] = {1, 1 + count / 2};

    for (int i = 0; i < (count > 1 ? 2 : count > 0); i++) {
        struct trace_result r;
        memset(c.page, 0, sizeof *c.page);
        c.page->clock_at = at[i];
        run(&r, (struct trace_fault){0}, false);
        snprintf(where, sizeof where, "%ld of %ld", at[i], count);
        tally("clock-back", where, judge(&r, false, NULL, why, sizeof why), why, &r);
    }
}

/* The same command twice at once, and a third time while it runs. */
static void run_twice(void)
{
    for (int gap = 0; gap < 3; gap++) {
        pid_t pids[2];
        struct trace_result r = {0};
        char why[8192];
        char errors[2][4200];
        memset(c.page, 0, sizeof *c.page);
        for (int i = 0; i < 2; i++) {
            snprintf(errors[i], sizeof errors[i], "%s.%d", c.errors, i);
            fflush(NULL);
            if (i) usleep((useconds_t)gap * 20000);
            if ((pids[i] = fork()) == 0) {
                const int fd = open(errors[i], O_WRONLY | O_CREAT | O_TRUNC, 0666), out = open("/dev/null", O_RDWR);
                if (fd < 0 || dup2(fd, 2) < 0 || dup2(out, 1) < 0 || dup2(out, 0) < 0 || chdir(c.folder)) _exit(125);
                alarm((unsigned)c.limit);
                execv(c.argv[0], c.argv);
                _exit(124);
            }
        }
        for (int i = 0; i < 2; i++) {
            int status = 0;
            waitpid(pids[i], &status, 0);
            if (WIFEXITED(status) && !WEXITSTATUS(status)) continue;
            r.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
            r.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
            FILE *f = fopen(errors[i], "rb");
            said[f ? fread(said, 1, sizeof said - 1, f) : 0] = '\0';
            if (f) fclose(f);
        }
        tally("two-at-once", gap ? "one after the other" : "together", judge(&r, false, NULL, why, sizeof why), why,
              &r);
        for (int i = 0; i < 2; i++) unlink(errors[i]);
    }
}

static void damage_one(const char *kind, const char *path, const char *bytes, size_t size, const char *where)
{
    char whole[8192], aside[8200], why[8192], place[8300];
    struct trace_result r;

    snprintf(whole, sizeof whole, "%s/%s", c.folder, path);
    snprintf(aside, sizeof aside, "%s.aside", c.folder); /* beside all that a program may list */
    if (rename(whole, aside)) die("an input cannot be put aside");
    if (bytes && !tree_write(c.folder, path, bytes, size)) die("an input cannot be written");
    memset(c.page, 0, sizeof *c.page);
    run(&r, (struct trace_fault){0}, false);
    if (rename(aside, whole)) die("an input cannot be put back");
    snprintf(place, sizeof place, "%s %s", path, where);
    tally(kind, place, judge(&r, false, path, why, sizeof why), why, &r);
}

/* Another file of the same extension below the folder, with other first bytes or of another name; NULL if none. */
static const char *another(const char *path)
{
    const char *dot = strrchr(path, '.'), *slash = strrchr(path, '/');
    size_t n = 0;

    if (!dot) return NULL;
    const size_t start = strlen(path) % (c.before.count ? c.before.count : 1);
    for (; n < c.before.count; n++) {
        const char *p = c.before.files[(start + n * 7919) % c.before.count].path, *d = strrchr(p, '.'),
                   *s = strrchr(p, '/');
        if (d && !strcmp(d, dot) && s && slash && (s - p != slash - path || strncmp(p, path, (size_t)(s - p))))
            return p;
    }
    return NULL;
}

static void damage(const char *path)
{
    size_t size = 0;
    char *bytes = tree_bytes(c.folder, path, &size), where[64];
    const char *text = strstr(bytes ? bytes : "", "remodel-");

    if (!bytes) return;
    damage_one("missing", path, NULL, 0, "");
    damage_one("empty", path, "", 0, "");
    for (int i = 0; i < 3 && size > 1; i++) {
        const size_t at = i == 2 ? size - 1 : size * (size_t)(i + 1) / 3;
        snprintf(where, sizeof where, "at %zu of %zu", at, size);
        damage_one("truncated", path, bytes, at, where);
    }
    for (int i = 0; i < 5 && size; i++) {
        const size_t at = i == 0 ? size / 97 : size * (size_t)(2 * i - 1) / 8;
        bytes[at] ^= (char)(1 << (i * 3 + (int)(size % 8)) % 8);
        snprintf(where, sizeof where, "at %zu of %zu", at, size);
        damage_one("flipped", path, bytes, size, where);
        bytes[at] ^= (char)(1 << (i * 3 + (int)(size % 8)) % 8);
    }
    if (text && (text == bytes || text[-1] == '\n') && (size_t)(text - bytes) < 4096 && strcspn(text, "\n") < 60) {
        const size_t end = (size_t)(text - bytes) + strcspn(text, "\n");
        char *newer = malloc(size + 2);
        if (!newer) abort();
        memcpy(newer, bytes, end);
        newer[end] = '7'; /* version 1 becomes 17 */
        memcpy(newer + end + 1, bytes + end, size - end);
        damage_one("version", path, newer, size + 1, "");
        free(newer);
    }
    const char *other = another(path);
    if (other) {
        size_t other_size = 0;
        char *others = tree_bytes(c.folder, other, &other_size);
        if (others) damage_one("exchanged", path, others, other_size, other);
        free(others);
    }
    free(bytes);
}

static void first_run(void)
{
    struct tree start, after;
    struct trace_result r;

    if (!tree_read(&start, c.folder)) die("the folder cannot be read");
    memset(c.page, 0, sizeof *c.page);
    if (!run(&r, (struct trace_fault){0}, true)) die(said);
    if (!tree_read(&after, c.folder)) die("the folder cannot be read");
    /* What it made are its products; all others are inputs or belong to others. A file that would get the bytes that
     * it has is not written at all. And there are pictures of a page, which are kept from run to run. */
    for (size_t i = 0; i < start.count && !strcmp(c.stage, "report"); i++)
        if (strstr(start.files[i].path, "/page/")) tree_remove(c.folder, start.files[i].path);
    bool any = false;
    const char *out = NULL;
    for (int i = 1; c.argv[i]; i++)
        if (!strcmp(c.argv[i - 1], "--out")) out = c.argv[i];
    if (out && tree_find(&start, out)) {
        tree_remove(c.folder, out);
        any = true;
    }
    for (size_t i = 0; i < after.count; i++) {
        const struct tree_file *old = tree_find(&start, after.files[i].path);
        if (old && tree_same(old, &after.files[i])) continue;
        tree_remove(c.folder, after.files[i].path);
        any = true;
    }
    for (size_t i = 0; !any && out && i < after.count; i++)
        if (!strncmp(after.files[i].path, out, strlen(out)) && after.files[i].path[strlen(out)] == '/')
            tree_remove(c.folder, after.files[i].path);
    tree_release(&start);
    tree_release(&after);
    if (!tree_read(&c.before, c.folder)) die("the folder cannot be read");
    tree_hash(&c.before, c.folder);
    memset(c.page, 0, sizeof *c.page);
    if (!run(&r, (struct trace_fault){0}, true)) die(said);
    if (!tree_read(&after, c.folder)) die("the folder cannot be read");
    for (size_t i = 0; i < after.count; i++) {
        size_t size = 0;
        if (tree_find(&c.before, after.files[i].path)) continue;
        if (c.made.count == c.made.room) {
            c.made.room = c.made.room ? 2 * c.made.room : 64;
            c.made.files = realloc(c.made.files, c.made.room * sizeof *c.made.files);
            if (!c.made.files) abort();
        }
        struct tree_file *p = &c.made.files[c.made.count++];
        *p = after.files[i];
        p->path = strdup(after.files[i].path);
        p->bytes = tree_bytes(c.folder, p->path, &size);
        if (!p->bytes) die("a product cannot be read");
    }
    clean(&after);
    tree_release(&after);
    const int wanted = (int)(20 * r.seconds) + 1;
    c.limit = wanted > 20 ? wanted : 20;
}

static bool is_listed(const char *words, const char *name)
{
    const size_t n = strcspn(name, "-");

    for (const char *p = words; *p;) {
        const size_t m = strcspn(p, " ");
        if (m == n && !strncmp(p, name, n)) return true;
        p += m + (p[m] == ' ');
    }
    return false;
}

static void write_results(void)
{
    FILE *f = fopen(c.results, "a");

    if (!f) die("the results cannot be written");
    for (int k = 0; k < c.count_kinds; k++) {
        fprintf(f, "%s\t%s", c.stage, c.count_names[k]);
        for (int o = 0; o < OUTCOMES; o++) fprintf(f, "\t%ld", c.counts[k][o]);
        fprintf(f, "\n");
    }
    fclose(f);
}

static void read_command(const char *file)
{
    size_t size = 0, n = 0;
    char *bytes = tree_bytes(".", file, &size);

    if (!bytes) die("the command cannot be read");
    char *at = bytes + strlen(bytes) + 1; /* after the folder it was recorded in */
    for (; at < bytes + size && n < 500; at += strlen(at) + 1) c.argv[n++] = at;
    c.argv[n] = NULL;
    if (!n) die("the command is empty");
    const char *slash = strrchr(c.argv[0], '/');
    c.stage = slash ? slash + 1 : c.argv[0];
    slash = strrchr(file, '/');
    c.label = slash ? slash + 1 : file;
}

/* Seconds that the programs have computed so far. */
static double computed(void)
{
    struct rusage u;

    getrusage(RUSAGE_CHILDREN, &u);
    return (double)(u.ru_utime.tv_sec + u.ru_stime.tv_sec) + 1e-6 * (double)(u.ru_utime.tv_usec + u.ru_stime.tv_usec);
}

int main(int argc, char **argv)
{
    const char *command = NULL, *folder = NULL, *temp = NULL;
    char real[4096], shim[4096];
    int each = 6, inputs = 8;

    for (int i = 1; i + 1 < argc; i += 2) {
        if (!strcmp(argv[i], "--folder"))
            folder = argv[i + 1];
        else if (!strcmp(argv[i], "--command"))
            command = argv[i + 1];
        else if (!strcmp(argv[i], "--shim"))
            c.shim = argv[i + 1];
        else if (!strcmp(argv[i], "--results"))
            c.results = argv[i + 1];
        else if (!strcmp(argv[i], "--details"))
            c.details = argv[i + 1];
        else if (!strcmp(argv[i], "--temp"))
            temp = argv[i + 1];
        else if (!strcmp(argv[i], "--each"))
            each = atoi(argv[i + 1]);
        else if (!strcmp(argv[i], "--inputs"))
            inputs = atoi(argv[i + 1]);
        else
            die(argv[i]);
    }
    if (!folder || !command || !c.shim || !c.results || !c.details || !temp || !realpath(folder, real) ||
        !realpath(c.shim, shim))
        die("wanted --folder --command --shim --results --details --temp");
    c.folder = real;
    c.shim = shim;
    snprintf(c.temp, sizeof c.temp, "%s", temp);
    snprintf(c.errors, sizeof c.errors, "%s.err", temp);
    c.limit = 120;
    read_command(command);
    c.page_fd = memfd_create("faults", 0);
    if (c.page_fd < 0 || ftruncate(c.page_fd, sizeof *c.page)) die("no page of memory");
    c.page = mmap(NULL, sizeof *c.page, PROT_READ | PROT_WRITE, MAP_SHARED, c.page_fd, 0);
    if (c.page == MAP_FAILED) die("no page of memory");

    first_run();
    struct trace_result r;
    char why[8192];
    memset(c.page, 0, sizeof *c.page);
    const double before = computed();
    run(&r, (struct trace_fault){0}, false);
    const double slow = (computed() - before) / 0.3; /* fewer injections into what takes long */
    if (slow > 1) {
        each = (int)ceil(each / slow);
        inputs = (int)ceil(inputs / slow);
    }
    const long mallocs = atomic_load(&c.page->mallocs), clocks = atomic_load(&c.page->clocks);
    if (judge(&r, false, NULL, why, sizeof why) != RIGHT) die("a second run does not give the same bytes");
    const struct trace_result counted = r;
    const char *only = getenv("FAULT_ONLY"); /* the first kinds whose names begin with a word of these; and no others */
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        if (!only || is_listed(only, kinds[k].name))
            inject(&kinds[k], kinds[k].temporary ? each : counted.counts[kinds[k].call], each);
    if (!only) {
        starve(mallocs, 3 * each, false);
        starve(mallocs, each, true);
        turn_clock(clocks);
        run_twice();
    }
    /* inputs of all kinds: those of one kind lie beside each other */
    int damaged = 0;
    for (int i = 0; i < c.opened_count && inputs && !only; i++) {
        const int n = c.opened_count < inputs ? c.opened_count : inputs;
        if (i * n / c.opened_count < damaged) continue;
        /* a run writes the parameters of a stage anew before it calls it */
        if (!tree_find(&c.before, c.opened[i]) || strstr(c.opened[i], "/slice/")) continue;
        damage(c.opened[i]);
        damaged++;
    }
    write_results();
    memset(c.page, 0, sizeof *c.page);
    run(&r, (struct trace_fault){0}, false); /* others read its products */
    return 0;
}
