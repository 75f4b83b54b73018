# docs/adding-a-stage.md: a new stage is added to a copy of the tree, as one folder, and run by make; what make does there with
# programs that it has linked again
. tests/lib.sh
mkdir "$scratch/copy"
cp -a Makefile .clang-format stages common configs docs "$scratch/copy/"
mkdir -p "$scratch/copy/tests" "$scratch/copy/scenes" "$scratch/copy/out/build/$FLAVOR"
cp -a "$B"/{bin,code,stripped,flags,lib,libremodel.a,obj} "$scratch/copy/out/build/$FLAVOR/"
cd "$scratch/copy" || exit 1
photos set --views 4 >/dev/null
small t
m() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t "$@" >log 2>&1 || { cat log; fail "make $*"; }; }

# a run beside make install must write nothing where that reads (it failed now and then)
a_program_linked_again_is_looked_at_once()
{
    local code=out/build/$FLAVOR/code stripped=out/build/$FLAVOR/stripped
    build() { make -s DEPS=manual PHASE=build build >log 2>&1 || { cat log; fail "the build"; }; }
    build
    stat -c '%y %n' $code $code/* >before
    touch "out/build/$FLAVOR/bin/verify"
    build
    stat -c '%y %n' $code $code/* | diff before - || fail "the code is the same, but its checksums were touched"
    stat -c '%y %n' $stripped $stripped/* >before
    build
    stat -c '%y %n' $stripped $stripped/* | diff before - || fail "the program was looked at again"
}

# the stage: three files
add_the_stage()
{
    mkdir stages/mean_colour
    cat >stages/mean_colour/stage.mk <<'MK'
# mean_colour: the mean colour of each view.
FOLLOWS.mean_colour := rectify
READS.mean_colour := views
HELP.mean_colour := + the mean colour of each view
MK
    cat >stages/mean_colour/rules.c <<'C'
/* rules.c - the mean colour, from all views. */
#include "common/graph/scene_rules.h"

RULES(mean_colour)
{
    (void)f;
    const char *out = graph_own(g, "mean_colour.txt");
    graph_step(g, "mean_colour", STEP_ONE, "views");
    graph_goal(g, "mean_colour", out);
    graph_rule(g, "all");
    rule_makes(g, out);
    rule_needs_cameras(g);
    rule_needs_set(g, "views");
    rule_option(g, "--views", FOLDER(g, CAMERAS));
    rule_option(g, "--out", out);
}
C
    cat >stages/mean_colour/mean_colour.c <<'C'
/* mean_colour.c - the mean colour of each view.
 *
 * reads   VIEWS/cameras.txt, images.txt, points3D.txt, VIEW.exr   the views
 * writes  OUT                                                     a line for each view: its name and mean radiance */
#include "common/base/cli.h"
#include "common/base/outfile.h"
#include "common/capture/view_image.h"

#define MEAN_PARAMS(X) X(gain, double, 1, 0, 1000, "", "factor of the written means")
struct mean_params {
    MEAN_PARAMS(PARAM_FIELD)
};
#define PARAM_STRUCT struct mean_params
static const struct param mean_param_table[] = {MEAN_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

static enum status write_means(const char *views, const struct mean_params *params, struct outfile *f,
                               struct provenance *prov, struct err *err)
{
    struct camera_set set = {0};
    enum status st = camera_set_read(&set, views, prov, err);
    if (!st) provenance_print(prov, f->fp);
    for (int i = 0; !st && i < set.view_count; i++) {
        struct image im = {0};
        double sum[3] = {0};
        st = view_image_read(&im, views, &set.views[i], prov, err);
        const size_t count = st ? 0 : (size_t)im.width * (size_t)im.height;
        for (size_t k = 0; k < count; k++)
            for (int c = 0; c < 3; c++) sum[c] += (double)im.data[k * 4 + (size_t)c];
        if (!st) fprintf(f->fp, "%s", set.views[i].name);
        for (int c = 0; !st && c < 3; c++) fprintf(f->fp, " %.9g", params->gain * sum[c] / (double)count);
        if (!st) fputc('\n', f->fp);
        image_release(&im);
    }
    camera_set_release(&set);
    return st;
}

int main(int argc, char **argv)
{
    const char *views = NULL, *out = NULL;
    struct mean_params params = {MEAN_PARAMS(PARAM_DEFAULT)};
    const struct cli_opt opts[] = {
        CLI_ABOUT("The mean colour of each view."),
        CLI_STR("views", &views, CLI_REQUIRED, "folder of cameras and rectified views"),
        CLI_STR("out", &out, CLI_REQUIRED, "text file to write"),
        CLI_PARAMS(mean_param_table, &params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct outfile f = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "mean_colour", opts, &prov, &err) != CLI_RUN || outfile_open(&f, out, &err) ||
        write_means(views, &params, &f, &prov, &err) || outfile_commit(&f, &err))
        err_report(&err);
    outfile_discard(&f);
    provenance_release(&prov);
    return err_exit_code(&err);
}
C
}

a_new_stage_is_built_and_run()
{
    m sfm
    cp -a . ../before
    add_the_stage
    m mean_colour
    [ "$(grep -cE '^photo_[1-4] [0-9.]+ [0-9.]+ [0-9.]+$' out/t/mean_colour.txt)" = 4 ] || { cat out/t/mean_colour.txt; fail "wrong product"; }
    grep -q '^# *stage mean_colour\|mean_colour' out/t/mean_colour.txt || fail "no provenance"
    m mean_colour
    ! grep -q run_stage log || fail "a second make remade something"
}

its_parameter_redoes_only_it()
{
    cp out/t/mean_colour.txt before.txt
    stat -c %y out/t/views/photo_1.exr >a
    printf '[mean_colour]\ngain = 2\n' >>scenes/t/scene.cfg
    m mean_colour
    ! cmp -s before.txt out/t/mean_colour.txt || fail "the parameter changed nothing"
    stat -c %y out/t/views/photo_1.exr | diff a - || fail "the views were remade"
}

every_list_of_stages_has_it()
{
    make -s help >log
    grep -qE '^  mean_colour +\+ the mean colour of each view$' log || fail "make help does not list it"
    make -s DEPS=manual generated >log 2>&1 || { cat log; fail "make generated"; }
    # its product is no row of the table of products, whose change would compile everything anew
    grep -qF '| `mean_colour` | views | nothing that is kept |' docs/architecture.md || fail "the table of stages does not list it"
    grep -qx '\[mean_colour\]' configs/default.cfg && grep -qx 'gain = 1' configs/default.cfg || fail "default.cfg does not list it"
    [ -s docs/man/mean_colour.1 ] || fail "it has no manual page"
    m depth
    m report
    grep -q mean_colour out/t/page/numbers.html || fail "the page does not list it"
}

no_other_file_is_changed_by_hand()
{
    { diff -rq ../before . || true; } | grep -vE '[:/] ?(out|log|set|scenes|before|before.txt|a)( |$)|^Only in \./?out|^(Files|Only in) (\.\./before/|\./)?(out|scenes|set)' |
        sed -E 's|^Only in \./?([^:]*): (.*)|\1/\2|; s|^Files \.\./before/(.*) and .*|\1|' | LC_ALL=C sort >touched
    printf '%s\n' configs/default.cfg docs/architecture.md docs/man/mean_colour.1 stages/mean_colour | diff - <(grep -v '^/\|touched\|log' touched) ||
        fail "a new stage changes more than its folder and generated files"
}

for t in a_program_linked_again_is_looked_at_once a_new_stage_is_built_and_run its_parameter_redoes_only_it every_list_of_stages_has_it no_other_file_is_changed_by_hand; do run "$t"; done
