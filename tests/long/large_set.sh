# the same cameras for one core and two, of a set so large that COLMAP by itself adjusts bundles in several threads
# (only where a developer has the photographs)
. tests/lib.sh
data=$root/../shared/data/bonsai
project large_set

# cameras_with CORES: hashes of the cameras that a run with so many cores finds
cameras_with()
{
    rm -rf "out/set+draft" out/set/sfm
    make -s DEPS=manual QUALITY=draft SCENE=set PHOTOS="$data/photos" CORES="$1" sfm >log 2>&1 || { cat log; fail "make sfm"; } >&2
    (cd out/set+draft/views && sha256sum cameras.txt images.txt points3D.txt lenses.txt residuals.txt)
}

cameras_of_a_large_set_are_the_same_for_any_number_of_cores()
{
    [ -d "$data/photos" ] || skip "the photos are not here"
    cameras_with 1 >one
    awk -F: '/Residuals :/ && $2 > 50000 { large = 1 } END { exit !large }' out/set/sfm/colmap-3.log || fail "the set is too small to show it"
    [ "$(grep -c 'Importing matches' out/set/sfm/colmap-2.log)" -ge 2 ] || fail "the matches are one block"
    cameras_with 2 >two
    diff one two || fail "other bytes with two cores"
}

run cameras_of_a_large_set_are_the_same_for_any_number_of_cores
