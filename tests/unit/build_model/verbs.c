/* verbs.c - the table of statements: its rows, and the places that list the same words. The documents are read from the
 * folder in which tests run, the root of the tree. */
#include "stages/build_model/script/script.h"
#include "stages/build_model/script/script_words.h"
#include "tests/unit/scratch.h"

static void every_row_is_complete(void **state)
{
    (void)state;
    assert_true(verb_count > 20);
    for (int i = 0; i < verb_count; i++) {
        const struct verb *v = &verbs[i];
        const size_t length = strlen(v->word);
        assert_true(length && strspn(v->word, "abcdefghijklmnopqrstuvwxyz") == length);
        assert_true(!strncmp(v->usage, v->word, length) && v->usage[length] == ' ');
        assert_true(v->read && v->apply && v->where & IN_EDITS);
        assert_true(v->options < 1u << OPTION_COUNT);
        assert_ptr_equal(verb_find(v->word), v); /* the first of that word */
        assert_string_equal(verb_word(NULL, i), v->word);
    }
    assert_null(verb_find(""));
    assert_null(verb_word(NULL, verb_count));
}

static void usages_name_their_options(void **state)
{
    (void)state;
    for (int i = 0; i < verb_count; i++)
        for (int o = 0; o < OPTION_COUNT; o++)
            if (verbs[i].options & 1u << o && !strstr(verbs[i].usage, script_option_name((enum option)o)) &&
                !strstr(verbs[i].usage, "options"))
                fail_msg("the usage of %s does not name its option %s", verbs[i].word,
                         script_option_name((enum option)o));
}

static void an_unknown_word_lists_the_table(void **state)
{
    struct script script;
    struct err err = ERR_INIT;
    char list[1024] = "wanted a statement: ";
    (void)state;
    for (int i = 0; i < verb_count; i++) {
        if (i) strcat(list, i + 1 < verb_count ? ", " : " or ");
        strcat(list, verbs[i].word);
    }
    strcat(list, ".");
    assert_int_not_equal(script_read(&script, scratch_write("s.txt", "remodel-script 1\nzzzzzzzz a\n"), &err), ST_OK);
    assert_err(err, ST_DATA, list);
}

static void the_document_has_the_statements_of_the_table(void **state)
{
    FILE *file = fopen("docs/model-script.md", "r");
    char line[4096], word[64];
    bool found[64] = {false};
    (void)state;
    assert_non_null(file);
    assert_true(verb_count <= 64);
    while (fgets(line, sizeof line, file)) {
        /* a row of the table of statements: | `open NAME`, `close NAME` | meaning | */
        const char *at = strncmp(line, "| `", 3) ? NULL : line, *end = at ? strstr(at + 1, " | ") : NULL;
        for (; at && at < end && sscanf(at, "%*[|,] `%63[a-z]", word) == 1; at = strstr(at + 1, ", `")) {
            const struct verb *v = verb_find(word);
            if (!v) fail_msg("docs/model-script.md has a statement %s, which is not in the table", word);
            found[v - verbs] = true;
        }
    }
    fclose(file);
    for (int i = 0; i < verb_count; i++)
        if (!found[i]) fail_msg("docs/model-script.md does not describe %s", verbs[i].word);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_row_is_complete),
        cmocka_unit_test(usages_name_their_options),
        cmocka_unit_test(an_unknown_word_lists_the_table),
        cmocka_unit_test(the_document_has_the_statements_of_the_table),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
