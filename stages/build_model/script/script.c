/* script.c - reads model scripts.
 *
 * The first word of a line finds the statement's row in the table of verbs. Its read() reads the fixed words and names,
 * then script_words.c the options. All names are copied to one buffer of the file's size. */
#include "stages/build_model/script/script.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "stages/build_model/script/script_words.h"

enum { MAX_STATEMENTS = 200000 };

void script_release(struct script *script)
{
    if (!script) return;
    for (int i = 0; i < script->count; i++) {
        free(script->statements[i].names);
        free(script->statements[i].corners);
    }
    free(script->statements);
    free(script->words);
    free(script->path);
    *script = (struct script){0};
}

static enum status read_header(struct script_reader *r)
{
    char *word;
    int64_t version;
    if (!textfile_next(&r->t)) return textfile_error(&r->t, r->err, NULL, "the first line \"remodel-script 1\"");
    if (textfile_word(&r->t, "\"remodel-script\"", &word, r->err)) return r->err->status;
    if (strcmp(word, "remodel-script"))
        return textfile_error(&r->t, r->err, word, "the first line \"remodel-script 1\"");
    if (textfile_int(&r->t, "version 1", 1, 1, &version, r->err)) return r->err->status;
    return textfile_end(&r->t, r->err);
}

static enum status unknown_verb(struct script_reader *r, const char *word)
{
    char list[1024];
    size_t used = 0;
    const char *near = scan_nearest(word, verb_word, NULL);
    if (near) return textfile_error(&r->t, r->err, word, "a statement; did you mean %s?", near);
    for (int i = 0; i < verb_count && used < sizeof list; i++)
        used += (size_t)snprintf(list + used, sizeof list - used, "%s%s",
                                 i == 0                ? ""
                                 : i == verb_count - 1 ? " or "
                                                       : ", ",
                                 verbs[i].word);
    return textfile_error(&r->t, r->err, word, "a statement: %s", list);
}

static enum status read_statement(struct script_reader *r, struct statement *s)
{
    char *word;
    if (textfile_word(&r->t, "a statement", &word, r->err)) return r->err->status;
    r->verb = verb_find(word);
    if (!r->verb) return unknown_verb(r, word);
    *s = (struct statement){.verb = r->verb, .line = r->t.line, .end = END_NONE};
    return r->verb->read(r, s) || script_read_options(r, s) ? r->err->status : ST_OK;
}

enum status script_read(struct script *script, const char *path, struct err *err)
{
    struct script_reader r = {.err = err};
    *script = (struct script){0};
    if (!textfile_open(&r.t, path, err)) {
        script->path = strdup(path);
        /* a word and its terminating zero need no more than the word and the blank after it */
        r.words = script->words = malloc(r.t.size + 2);
        if (!script->path || !script->words) err_nomem(err, "a script", r.t.size);
    }
    if (!err->status) read_header(&r);
    while (!err->status && textfile_next(&r.t)) {
        if (script->count == MAX_STATEMENTS) {
            err_set(err, ST_DATA, "%s:%d: found more than %d statements.", path, r.t.line, MAX_STATEMENTS);
            break;
        }
        if (array_append(&script->statements, (size_t)script->count, sizeof *script->statements, "statements", err))
            break;
        struct statement *s = &script->statements[script->count++];
        *s = (struct statement){0};
        r.count = script->count;
        read_statement(&r, s);
    }
    script->base = r.base;
    script->base_line = r.base_line;
    textfile_release(&r.t);
    if (err->status) script_release(script);
    return err->status;
}
