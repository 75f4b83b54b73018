# make regress on a synthetic scene: its metrics are accepted, found again, and found worse with few depth planes
. tests/lib.sh
project regress
photos set --views 4 >/dev/null
small t
mkdir -p truth/depth
cp set/model/cameras.txt set/model/images.txt truth/
cp set/truth/*.exr truth/depth/
printf 'PHOTOS := set/photos\nSFM := set/model\nTRUTH := truth\n' >scenes/t/scene.mk
export EXPECTED=$PWD/expected
m() { make -s DEPS=manual SCENES="t t+holdout4" "$@" >log 2>&1; }

metrics_are_accepted_and_found_again()
{
    m regress-accept || { cat log; fail "make regress-accept"; }
    grep -q '^depth.bad2' expected/t.tsv && grep -q '^holdout.psnr' expected/t+holdout4.tsv || fail "metrics are missing"
    m regress || { cat log; fail "make regress"; }
    grep -q 't: as expected' log && grep -q 't+holdout4: as expected' log || { cat log; fail "the runs were not compared"; }
}

worse_depth_is_found()
{
    sed -i 's/^planes = .*/planes = 4/' scenes/t/scene.cfg
    ! m regress SCENES=t || { cat log; fail "make regress succeeded"; }
    grep -q 't: worse' log || { cat log; fail "the scene is not called worse"; }
}

for t in metrics_are_accepted_and_found_again worse_depth_is_found; do run "$t"; done
