# newer versions of COLMAP, by stand-ins that print their help, reject options that they no longer have, begin each line of a
# log with severity and place, and leave the work to the COLMAP that is installed
. tests/lib.sh
project colmap_versions
photos set --views 5 >/dev/null

# stand_in VERSION PREFIX: a COLMAP whose options of matching begin with PREFIX
stand_in()
{
    mkdir -p fake
    cat >fake/colmap <<SH
#!/usr/bin/env bash
version=$1 prefix=$2 real=$(command -v colmap)
SH
    cat >>fake/colmap <<'SH'
place="I20251114 16:04:38.468699 1930356"
if [ "$1" = help ]; then echo "COLMAP $version -- Structure-from-Motion and Multi-View Stereo"; exit; fi
args=()
for a; do
    case $a in
    -h)
        echo "$place option_manager.cc:898] COLMAP $version (Commit 369297b3 on 2025-07-16 with CUDA)" >&2
        printf '  %s\n' '-h [ --help ]' '--random_seed arg (=0)' '--database_path arg' '--match_list_path arg' '--match_type arg (=pairs)' \
            "--$prefix.type arg (=SIFT)" "--$prefix.num_threads arg (=-1)" "--$prefix.use_gpu arg (=1)" "--$prefix.guided_matching arg (=0)" \
            '--SiftMatching.max_ratio arg (=0.8)' '--SiftMatching.cpu_brute_force_matcher arg (=0)'
        exit ;;
    --SiftMatching.use_gpu | --SiftMatching.num_threads | --SiftExtraction.use_gpu)
        echo "E20251114 16:04:38.468699 1930356 option_manager.cc:976] Failed to parse options - unrecognised option '$a'." >&2
        exit 1 ;;
    --"$prefix".*) args+=("--SiftMatching.${a#*.}") ;;
    *) args+=("$a") ;;
    esac
done
"$real" "${args[@]}" 2>&1 | sed "s/^\([ A-Z]\)/$place work.cc:1] \1/" >&2
rc=${PIPESTATUS[0]}
# 3.12 and later write rigs and frames beside cameras and images
if [ "$1" = model_converter ]; then
    for ((i = 0; i < ${#args[@]}; i++)); do [ "${args[i]}" != --output_path ] || out=${args[i + 1]}; done
    printf '# Rig calib list with one line of data per calib:\n1 1 CAMERA 1\n' >"$out/rigs.txt"
    printf '# Frame list with one line of data per frame:\n1 1 1 0 0 0 0 0 0 1 CAMERA 1 1\n' >"$out/frames.txt"
fi
exit "$rc"
SH
    chmod +x fake/colmap
}
# cameras SCENE: its poses and lenses
cameras() { grep -hv '^#' "out/$1"/sfm/0/{cameras,images}.txt; }
m() { make -s DEPS=manual "SCENE=$1" PHOTOS=set/photos "${@:2}" >log 2>&1; }

the_installed_one_places_the_photos()
{
    small installed
    m installed sfm || { cat log; fail "make sfm"; }
    cameras installed >cameras.installed
    [ "$(grep -c photo_ cameras.installed)" = 5 ] || { cat cameras.installed; fail "not all photos are placed"; }
}

# newer VERSION: it gives the cameras of the installed one
newer()
{
    small "new$1"
    stand_in "$2" FeatureMatching
    PATH=$PWD/fake:$PATH m "new$1" sfm || { cat log; fail "make sfm"; }
    cameras "new$1" | diff - cameras.installed || fail "other cameras"
    grep -q "colmap-$2" "out/new$1/sfm/photos.txt" || { head -n 20 "out/new$1/sfm/photos.txt"; fail "the version is not recorded"; }
}
version_3_13_gives_the_same_cameras() { newer 3 3.13.0; }
version_4_gives_the_same_cameras() { newer 4 4.0.1; }

a_colmap_without_either_name_is_refused()
{
    small other
    stand_in 5.0 NewMatching
    if PATH=$PWD/fake:$PATH m other sfm; then fail "make did not fail"; fi
    grep -q 'the help of `colmap matches_importer` names neither --SiftMatching.use_gpu nor --FeatureMatching.use_gpu; it is in .* Install a COLMAP between 3.8 and 4.x' log ||
        { cat log; fail "the message does not say what is missing"; }
    [ ! -e out/other/sfm/models.txt ] || fail "a product was made"
}

for t in the_installed_one_places_the_photos version_3_13_gives_the_same_cameras version_4_gives_the_same_cameras \
    a_colmap_without_either_name_is_refused; do run "$t"; done
