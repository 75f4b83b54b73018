# an installed remodel: a scene in a folder outside of the source tree, the words of its command, a package
. tests/lib.sh
prefix=$scratch/usr
mkdir "$scratch/home"; cd "$scratch/home" || exit 1
photos photos --views 4 >/dev/null
PATH=$prefix/bin:$PATH

it_is_installed()
{
    cd "$root" || exit 1
    make -s DEPS=manual FLAVOR="$FLAVOR" PREFIX="$prefix" install >"$scratch/log" 2>&1 || { cat "$scratch/log"; fail "make install: $(tail -n 3 "$scratch/log" | tr '\n' ' ')"; }
    diff <(ls "$prefix/lib/remodel/build/code") <(make -s DEPS=manual list-stages | tr ' ' '\n' | LC_ALL=C sort) || fail "other checksums than those of the stages"
}

a_scene_is_made_outside_of_the_source_tree()
{
    small trip
    remodel SCENE=trip PHOTOS=photos/photos SFM=photos/model QUALITY=draft >log 2>&1 || { cat log; fail "remodel"; }
    [ -s out/trip+draft/index.html ] && [ -n "$(find out/trip+draft/parallax -name video.mp4)" ] || { cat log; fail "no page or no video"; }
    ! grep -rlF "$root" out/trip+draft/graph scenes log || fail "a path of the source tree"
    remodel SCENE=trip QUALITY=draft why >log 2>&1 || { cat log; fail "why"; }
    grep -q 'Nothing is stale' log || { cat log; fail "a product is stale at once"; }
    make -s SCENE=trip QUALITY=draft plan >log 2>&1 || { cat log; fail "make in the project"; }
}

its_words_are_those_of_make()
{
    remodel help >log || fail "remodel help"
    grep -q '^  relight ' log || { cat log; fail "a goal is missing"; }
    ! grep -E '^  (check|bench|install|generated) ' log || fail "goals of developers"
    remodel --help | matches 'remodel SCENE=NAME PHOTOS=DIR' || fail "no usage"
    [ "$(remodel version)" = "remodel $(sed -nE 's/.*REMODEL_VERSION "(.*)"/\1/p' "$root/common/base/version.h")" ] || fail "version"
    remodel run verify --help | matches -i usage || fail "a stage's help"
    ! remodel run nothing 2>err || fail "a stage that does not exist"
    grep -q 'nothing is not a stage. The stages are: .*verify' err || { cat err; fail "no list of stages"; }
}

what_it_cannot_do_is_said()
{
    mkdir own; cd own || exit 1; : >Makefile
    ! remodel SCENE=a 2>../err || fail "a Makefile of the user's was taken"
    grep -q "own has a Makefile of its own, where a project has a link to .*lib/remodel/Makefile. Run remodel in another folder" ../err || { cat ../err; fail "no reason"; }
    [ ! -e common ] && [ ! -e out ] || fail "links were left"
    rm Makefile
    ! remodel depth 2>../err || fail "no scene was given"
    grep -q 'give the scene to work on: remodel SCENE=NAME depth' ../err || { cat ../err; fail "no advice"; }
}

words_are_completed()
{
    # shellcheck source=/dev/null
    . "$prefix/share/bash-completion/completions/remodel"
    complete_words() { COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); COMPREPLY=(); _remodel; echo "${COMPREPLY[*]}"; }
    [ "$(complete_words remodel irr)" = irradiance ] || fail "a goal: $(complete_words remodel irr)"
    [ "$(complete_words remodel QUAL)" = QUALITY= ] || fail "a variable: $(complete_words remodel QUAL)"
    [ "$(complete_words remodel QUALITY = dr)" = draft ] || fail "a value: $(complete_words remodel QUALITY = dr)"
    [ "$(complete_words remodel run veri)" = verify ] || fail "a stage: $(complete_words remodel run veri)"
    mkdir -p scenes/attic
    [ "$(complete_words remodel SCENE = att)" = attic ] || fail "a scene: $(complete_words remodel SCENE = att)"
}

manual_pages_are_there()
{
    for p in remodel remodel-verify; do [ -s "$prefix/share/man/man1/$p.1" ] || fail "no page $p"; done
    grep -q '^.TH REMODEL-VERIFY 1' "$prefix/share/man/man1/remodel-verify.1" || fail "another name"
    ! grep -rn '@[A-Z]*@' "$prefix/share/man" "$prefix/bin" "$prefix/share/bash-completion" || fail "a place that was not filled in"
}

a_package_has_the_same_files()
{
    command -v dpkg-shlibdeps >/dev/null || skip "dpkg-dev is not installed (make deb installs it)"
    cd "$root" || exit 1
    local package
    package=$(make -s DEPS=manual FLAVOR="$FLAVOR" deb | sed -n 's/^made \([^ ]*\) .*/\1/p')
    [ -s "$package" ] || fail "no package"
    dpkg-deb -f "$package" Depends | matches 'libceres.*colmap, ffmpeg' || { dpkg-deb -f "$package"; fail "what it needs"; }
    dpkg-deb -c "$package" >"$scratch/files"
    for f in usr/bin/remodel usr/lib/remodel/build/bin/print_graph usr/share/man/man1/remodel.1.gz usr/share/doc/remodel/copyright; do
        grep -q " ./$f\$" "$scratch/files" || fail "no $f"
    done
}

it_is_removed_whole()
{
    cd "$root" || exit 1
    make -s DEPS=manual PREFIX="$prefix" uninstall || fail "uninstall"
    [ -z "$(find "$prefix" -type f)" ] || { find "$prefix" -type f; fail "files stay"; }
    ! make -s DEPS=manual PREFIX="$prefix" uninstall 2>"$scratch/err" || fail "removed twice"
    grep -q 'remodel is not installed in' "$scratch/err" || fail "no reason"
    ! make -s DEPS=manual PREFIX=usr install 2>"$scratch/err" || fail "a relative PREFIX"
    grep -q 'PREFIX=usr is not a path from the root' "$scratch/err" || { cat "$scratch/err"; fail "no reason"; }
}

for t in it_is_installed a_scene_is_made_outside_of_the_source_tree its_words_are_those_of_make what_it_cannot_do_is_said \
    words_are_completed manual_pages_are_there a_package_has_the_same_files it_is_removed_whole; do run "$t"; done
