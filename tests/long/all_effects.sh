# all films of a scene with two subjects: the same bytes for any number of cores, and after killed runs (fewer films: tests/pipeline/effects.sh)
. tests/lib.sh
project all_effects
photos set --views 4 >/dev/null
tiny t
printf 'subject photo_2 76 58 108 94\nsubject photo_2 20 20 56 48\n' >scenes/t/subjects.txt
m() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t EFFECT=all "$@" >log 2>&1; }

two_subjects_give_34_films()
{
    m CORES=2 || { cat log; fail "make"; }
    [ "$(ls out/t/parallax/*/video.mp4 | wc -l)" = 34 ] || { ls out/t/parallax; fail "wanted 34 videos"; }
    products t >want
}

the_same_bytes_for_any_number_of_cores()
{
    for cores in 1 3; do
        rm -r out/t/depth out/t/parallax
        m CORES=$cores FRAMES_PER_JOB=2 || { cat log; fail "make CORES=$cores"; }
        products t | diff want - || fail "CORES=$cores gives other bytes"
    done
}

a_killed_run_resumes_to_the_same_bytes()
{
    rm -r out/t/depth out/t/parallax
    for file in depth/photo_2.exr parallax/all-effects.mk parallax/dolly_zoom/validity.txt parallax/dolly+pull_focus/path.txt \
        parallax/dolly_in+narrow_dof/frames/0002.exr parallax/establishing_dolly/frames/0001.exr parallax/dolly_out/video.mp4; do
        kill_at "out/t/$file" make -s DEPS=manual SCENE=t EFFECT=all
    done
    m || { cat log; fail "make"; }
    products t | diff want - || fail "a resumed run gives other bytes"
}

every_film_has_a_pan_scan()
{
    m pan_scan || { cat log; fail "make pan_scan"; }
    [ "$(ls out/t/parallax/*/pan_scan/video.mp4 | wc -l)" = 34 ] || fail "wanted 34 videos"
    m || { cat log; fail "make"; }
    snapshot out/t >a
    m || { cat log; fail "make again"; }
    snapshot out/t >b
    diff a b || fail "a second make remade something"
}

for t in two_subjects_give_34_films the_same_bytes_for_any_number_of_cores a_killed_run_resumes_to_the_same_bytes every_film_has_a_pan_scan; do run "$t"; done
