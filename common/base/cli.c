/* cli.c - parses a stage's command line.
 *
 * A stage lists its options in a table; the options of every stage and the parameters of a config are added here, so
 * all programs behave alike: --option VALUE or --option=VALUE, no short options, no positional arguments. An option
 * that takes one value may be given once, since a second one is more likely an error than a correction; --threads
 * may be repeated, so that scripts can override it.
 *
 * Order. Arguments are taken from left to right; --help and --version answer at once, whatever follows. Then
 * parameters get their values: defaults, config files in their order, --set, the stage's own option of a parameter;
 * the relations between them are checked at the end, when all are known. What is printed by --print-config is the
 * text that goes into the provenance: the effective values, not where they came from. Missing required options are
 * reported last, so that --print-config needs none.
 *
 * Verdicts. CLI_RUN: go on. CLI_DONE: something was printed, exit 0 (an error in writing it still fails).
 * CLI_FAILED: err has a sentence; with ST_USAGE the exit status is 2.
 *
 * At its exit a stage logs its time and memory, which the report shows; cli_make_each() does so after each item of a
 * list, and one that fails keeps no other from being made. A forked child does not report. */
#include "common/base/cli.h"

#include <assert.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "common/base/array.h"
#include "common/base/clock.h"
#include "common/base/log.h"
#include "common/base/memory_text.h"
#include "common/base/parallel.h"
#include "common/base/scan.h"
#include "common/base/version.h"

enum { MAX_THREADS = 1024 };

/* ------------------------------------------------------------------------------------------ the last line on stderr */

static double started, used_cpu; /* since when, and what had been used by then */
static pid_t owner;

static double cpu_seconds(const struct rusage *u)
{
    return (double)(u->ru_utime.tv_sec + u->ru_stime.tv_sec) +
           1e-6 * (double)(u->ru_utime.tv_usec + u->ru_stime.tv_usec);
}

/* What has been used since the last report. */
static void report_use(void)
{
    struct rusage self = {0}, children = {0};

    if (getpid() != owner) return; /* the exit of a forked child */
    getrusage(RUSAGE_SELF, &self);
    getrusage(RUSAGE_CHILDREN, &children);
    const long peak = self.ru_maxrss > children.ru_maxrss ? self.ru_maxrss : children.ru_maxrss; /* KiB */
    const double now = clock_seconds(), cpu = cpu_seconds(&self) + cpu_seconds(&children);
    log_set_subject(NULL); /* the line is the whole program's */
    log_note("used %.2f s wall, %.2f s cpu, %ld MiB peak", now - started, cpu - used_cpu, (peak + 1023) / 1024);
    started = now;
    used_cpu = cpu;
}

enum status cli_make_each(const struct cli_list *names, cli_make_one *make, void *ctx, struct err *err)
{
    int failed = 0;

    if (names->count == 1) return make(ctx, 0, err);
    for (int i = 0; i < names->count; i++) {
        struct err one = ERR_INIT;
        const enum status st = make(ctx, i, &one);
        err_report(&one);
        failed += st != ST_OK;
        report_use();
        log_note("%s %d of %d: %s", st ? "failed" : "made", i + 1, names->count, names->items[i]);
    }
    if (!failed) return ST_OK;
    return err_set(err, ST_DATA, "%d of %d failed; the reasons are above.", failed, names->count);
}

/* ---------------------------------------------------------------------------------------------------- the options */

static const struct param no_params[] = {PARAM_END};

struct common_opts {
    struct cli_list configs, sets;
    int threads;
    bool help, version, print_config, explain_config;
};

static enum status list_add(struct cli_list *list, const char *item, struct err *err)
{
    if (!array_append(&list->items, (size_t)list->count, sizeof *list->items, "options", err))
        list->items[list->count++] = item;
    return err->status;
}

void cli_list_release(struct cli_list *list)
{
    if (!list) return;
    free(list->items);
    *list = (struct cli_list){0};
}

static const char *kind_value(enum cli_kind kind)
{
    switch (kind) {
    case CLI_KIND_STR:
        return " TEXT";
    case CLI_KIND_LIST:
        return " TEXT...";
    case CLI_KIND_INT:
        return " N";
    default:
        return "";
    }
}

static void print_option(const char *name, const char *value, const char *help, const char *note)
{
    char left[64];

    snprintf(left, sizeof left, "--%s%s", name, value);
    printf("  %-20s %s%s\n", left, help, note);
}

static void print_help(const char *stage, const struct cli_opt *opts, const struct cli_opt *common,
                       const struct cli_opt *params)
{
    printf("usage: %s [OPTION]...\n", stage);
    for (const struct cli_opt *o = opts; o->kind != CLI_KIND_END; o++)
        if (o->kind == CLI_KIND_ABOUT) printf("%s\n", o->help);
    printf("\noptions:\n");
    for (const struct cli_opt *o = opts; o->kind != CLI_KIND_END; o++)
        if (o->name)
            print_option(o->name, kind_value(o->kind), o->help,
                         o->required                ? " (required)"
                         : o->kind == CLI_KIND_LIST ? " (repeatable)"
                                                    : "");
    printf("\noptions of every stage:\n");
    for (const struct cli_opt *o = common; o->kind != CLI_KIND_END; o++)
        print_option(o->name, kind_value(o->kind), o->help, "");
    if (params->table->name) {
        printf("\nparameters (section [%s] of a config file, or --set):\n", stage);
        params_help(params->table, params->value, stdout);
    }
}

struct known { /* the candidates for "did you mean" */
    const struct cli_opt *opts, *common;
};

static const char *known_name(const void *ctx, int i)
{
    const struct known *k = ctx;
    const struct cli_opt *lists[] = {k->opts, k->common};

    for (int l = 0; l < 2; l++)
        for (const struct cli_opt *o = lists[l]; o->kind != CLI_KIND_END; o++)
            if (o->name && i-- == 0) return o->name;
    return NULL;
}

static const struct cli_opt *find(const struct cli_opt *opts, const char *name, size_t n)
{
    for (; opts->kind != CLI_KIND_END; opts++)
        if (opts->name && strlen(opts->name) == n && !memcmp(opts->name, name, n)) return opts;
    return NULL;
}

static enum status store(const struct cli_opt *o, const char *value, bool repeated, struct err *err)
{
    char shown[SCAN_QUOTED];
    int64_t v;

    if (repeated && (o->kind == CLI_KIND_STR || o->kind == CLI_KIND_PARAM || o->kind == CLI_KIND_INT))
        return err_set(err, ST_USAGE, "--%s is given twice; keep one.", o->name);
    switch (o->kind) {
    case CLI_KIND_STR:
    case CLI_KIND_PARAM:
        *(const char **)o->value = value;
        return ST_OK;
    case CLI_KIND_LIST:
        return list_add(o->value, value, err);
    case CLI_KIND_FLAG:
        *(bool *)o->value = true;
        return ST_OK;
    default:
        break;
    }
    if (!scan_int(value, &v) || v < INT_MIN || v > INT_MAX)
        return err_set(err, ST_USAGE, "--%s %s: wanted an integer.", o->name, scan_quote(shown, value));
    *(int *)o->value = (int)v;
    return ST_OK;
}

/* Takes the argument at *i, and the next one if that is its value; *i moves to the last one taken. seen: a flag for
 * each of the stage's options. */
static enum status take_arg(int argc, char **argv, int *i, const struct known *known, bool *seen, struct err *err)
{
    const char *arg = argv[*i], *name = arg + 2, *value = NULL;
    char shown[SCAN_QUOTED], word[64];
    bool repeated = false; /* a common option (--threads) may be repeated; the last one counts */

    if (strncmp(arg, "--", 2) || !*name)
        return err_set(err, ST_USAGE, "unexpected argument %s; every argument is --option or --option value.",
                       scan_quote(shown, arg));
    const size_t n = strcspn(name, "=");
    if (name[n]) value = name + n + 1;
    const struct cli_opt *o = find(known->opts, name, n);
    if (o) {
        repeated = seen[o - known->opts];
        seen[o - known->opts] = true;
    } else if (!(o = find(known->common, name, n))) {
        snprintf(word, sizeof word, "%.*s", (int)n, name);
        const char *near = scan_nearest(word, known_name, known);
        return err_set(err, ST_USAGE, "unknown option %s%s%s%s", scan_quote(shown, word),
                       near ? "; did you mean --" : "; --help lists them", near ? near : "", near ? "?" : ".");
    }
    if (o->kind == CLI_KIND_FLAG && value) return err_set(err, ST_USAGE, "--%s takes no value.", o->name);
    if (o->kind != CLI_KIND_FLAG && !value) {
        if (*i + 1 == argc || !strncmp(argv[*i + 1], "--", 2))
            return err_set(err, ST_USAGE, "--%s needs a value (write --%s=VALUE if it begins with --).", o->name,
                           o->name);
        value = argv[++*i];
    }
    return store(o, value, repeated, err);
}

static enum status set_param(const struct cli_opt *params, const struct cli_opt *o, struct err *err)
{
    const char *value = *(const char *const *)o->value;
    char assignment[PARAM_TEXT_SIZE + 64];

    if (!value) return ST_OK;
    if (snprintf(assignment, sizeof assignment, "%s=%s", o->name, value) >= (int)sizeof assignment)
        return err_set(err, ST_USAGE, "--%s: the value is longer than %d bytes; shorten it.", o->name,
                       PARAM_TEXT_SIZE - 1);
    return params_set(params->table, params->value, assignment, err);
}

/* Reads config files, then --set, then the options of parameters; checks relations between parameters; stores the
 * effective parameters in the provenance. */
static enum status effective_params(const struct cli_opt *opts, const struct cli_opt *params,
                                    const struct common_opts *common, const char *stage, struct provenance *prov,
                                    struct err *err)
{
    for (int i = 0; !err->status && i < common->configs.count; i++)
        params_read_file(params->table, params->value, stage, common->configs.items[i], err);
    for (int i = 0; !err->status && i < common->sets.count; i++)
        params_set(params->table, params->value, common->sets.items[i], err);
    for (const struct cli_opt *o = opts; !err->status && o->kind != CLI_KIND_END; o++)
        if (o->kind == CLI_KIND_PARAM) set_param(params, o, err);
    if (!err->status && params->check) params->check(params->value, err);
    if (err->status) return err->status;

    struct memory_text m = {0};
    if (memory_text_open(&m, "the parameters", err)) return err->status;
    params_print(params->table, params->value, stage, m.to);
    if (memory_text_close(&m, "the parameters", err)) return err->status;
    prov->params = m.text;
    return ST_OK;
}

static enum status parse(int argc, char **argv, const char *stage, const struct cli_opt *opts,
                         const struct cli_opt *common_opts, struct common_opts *common, struct provenance *prov,
                         struct err *err)
{
    enum { MAX_OPTIONS = 64 };
    static const struct cli_opt none = {CLI_KIND_PARAMS, NULL, NULL, false, NULL, no_params, NULL};
    const struct known known = {opts, common_opts};
    const struct cli_opt *params = &none;
    bool seen[MAX_OPTIONS] = {false};

    for (const struct cli_opt *o = opts; o->kind != CLI_KIND_END; o++) {
        assert(o - opts < MAX_OPTIONS);
        if (o->kind == CLI_KIND_PARAMS) params = o;
    }
    for (int i = 1; !err->status && i < argc; i++) {
        take_arg(argc, argv, &i, &known, seen, err);
        if (!err->status && common->help) {
            print_help(stage, opts, common_opts, params);
            return ST_OK;
        }
        if (!err->status && common->version) {
            printf("remodel %s %s\n", stage, REMODEL_VERSION);
            return ST_OK;
        }
    }
    if (!err->status && (common->threads < 0 || common->threads > MAX_THREADS))
        err_set(err, ST_USAGE, "--threads %d: wanted 0 (one per core) to %d.", common->threads, MAX_THREADS);
    if (!err->status && common->explain_config) {
        params_explain(params->table, params->value, stage, stdout);
        return ST_OK;
    }
    if (!err->status) effective_params(opts, params, common, stage, prov, err);
    if (err->status || common->print_config) {
        if (!err->status) fputs(prov->params, stdout);
        return err->status;
    }
    for (const struct cli_opt *o = opts; !err->status && o->kind != CLI_KIND_END; o++)
        if (o->required && !seen[o - opts]) err_set(err, ST_USAGE, "--%s is missing: %s.", o->name, o->help);
    return err->status;
}

enum cli_verdict cli_parse(int argc, char **argv, const char *stage, const struct cli_opt *opts,
                           struct provenance *prov, struct err *err)
{
    struct common_opts common = {0};
    const struct cli_opt common_opts[] = {
        CLI_FLAG("help", &common.help, "print this help and exit"),
        CLI_FLAG("version", &common.version, "print the release and exit"),
        CLI_FLAG("print-config", &common.print_config, "print the effective parameters and exit"),
        CLI_FLAG("explain-config", &common.explain_config,
                 "print the stage's section of configs/default.cfg, with comments, and exit"),
        CLI_INT("threads", &common.threads, CLI_OPTIONAL, "number of threads; 0: one per core (default)"),
        CLI_LIST("config", &common.configs, CLI_OPTIONAL, "config file to read parameters from; later files win"),
        CLI_LIST("set", &common.sets, CLI_OPTIONAL, "parameter to set, as key=value; wins over config files"),
        CLI_END,
    };
    enum cli_verdict verdict = CLI_RUN;

    log_set_name(stage);
    started = clock_seconds();
    owner = getpid();
    *prov = (struct provenance){.stage = stage, .version = REMODEL_VERSION};
    parse(argc, argv, stage, opts, common_opts, &common, prov, err);
    if (common.help || common.version || common.print_config || common.explain_config) verdict = CLI_DONE;
    if (!err->status && verdict == CLI_DONE && (fflush(stdout) || ferror(stdout)))
        err_errno(err, "write", "standard output");
    if (err->status) verdict = CLI_FAILED;
    if (verdict == CLI_RUN) {
        parallel_set_threads(common.threads);
        atexit(report_use);
    } else {
        provenance_release(prov);
    }
    cli_list_release(&common.configs);
    cli_list_release(&common.sets);
    return verdict;
}
