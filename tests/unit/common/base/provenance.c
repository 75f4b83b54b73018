/* provenance.c - what products record of their making. */
#include "tests/unit/scratch.h"

#include "common/base/provenance.h"

static void provenance_is_printed(void **state)
{
    struct provenance prov = {.stage = "rectify", .version = "1.2.3"};
    struct err err = ERR_INIT;
    char *text = NULL, wanted[1024], a[HASH_TEXT], b[HASH_TEXT];
    size_t size = 0;

    (void)state;
    prov.params = strdup("[rectify]\nmegapixels = 2\nnote = [x]\nempty =\n");
    assert_ok(hash_file(a, scratch_write("one", "one"), &err), err);
    assert_ok(hash_file(b, scratch_write("two", "two"), &err), err);
    assert_ok(provenance_add_file(&prov, "photos/b.jpg", scratch_path("one"), &err), err);
    assert_ok(provenance_add_file(&prov, "photos/a b.jpg", scratch_path("two"), &err), err);
    assert_ok(provenance_add_file(&prov, "photos/b.jpg", scratch_path("one"), &err), err); /* recorded once */
    assert_int_equal(prov.count, 2);

    FILE *to = open_memstream(&text, &size);
    assert_non_null(to);
    provenance_print(&prov, to);
    fclose(to);
    snprintf(wanted, sizeof wanted,
             "# remodel rectify 1.2.3\n# megapixels = 2\n# note = [x]\n# empty =\n# input photos/b.jpg %s\n"
             "# input \"photos/a b.jpg\" %s\n",
             a, b);
    assert_string_equal(text, wanted);
    free(text);

    snprintf(wanted, sizeof wanted, "photos/b.jpg %s\n\"photos/a b.jpg\" %s\n", a, b);
    text = provenance_inputs_text(&prov);
    assert_string_equal(text, wanted);
    free(text);

    provenance_keep(&prov, 2);
    assert_int_equal(prov.count, 2);
    provenance_keep(&prov, 1);
    snprintf(wanted, sizeof wanted, "photos/b.jpg %s\n", a);
    text = provenance_inputs_text(&prov);
    assert_string_equal(text, wanted);
    free(text);
    assert_ok(provenance_add_file(&prov, "photos/a b.jpg", scratch_path("two"), &err), err); /* it was forgotten */
    assert_int_equal(prov.count, 2);
    provenance_release(&prov);
    provenance_release(&prov);
    provenance_release(NULL);
}

static void unprintable_input_names_are_refused(void **state)
{
    struct provenance prov = {.stage = "s", .version = "v"};
    struct err none = ERR_INIT, name = ERR_INIT;

    (void)state;
    assert_int_equal(provenance_add_file(&prov, "x", scratch_path("none"), &none), ST_IO);
    assert_err(none, ST_IO, "cannot open");
    assert_int_equal(provenance_add_file(&prov, "a\nb", scratch_write("f", "f"), &name), ST_DATA);
    assert_err(name, ST_DATA, "contains a line break");
    assert_int_equal(prov.count, 0);
    char *text = provenance_inputs_text(&prov);
    assert_string_equal(text, "");
    free(text);
    provenance_release(&prov);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(provenance_is_printed),
        cmocka_unit_test(unprintable_input_names_are_refused),
    };

    return cmocka_run_group_tests_name("provenance", tests, scratch_make, scratch_remove);
}
