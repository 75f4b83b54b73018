# the rules of the tree: layers, headers, format, words
. tests/lib.sh

every_header_compiles_alone()
{
    for h in common/*.h stages/*/*.h; do
        echo "#include \"$h\"" | gcc -std=c11 -D_GNU_SOURCE -mavx2 -mf16c -Wall -Wextra -Werror -I. -fsyntax-only -xc - || fail "$h does not compile alone"
    done
}

lower_layers_never_include_higher()
{
    local base="version scan err log progress outfile file_path hash param cli provenance textfile parallel rng process frame_list samples sort clock"
    local data="vec image photo exr_zip exr camera sfm_model camera_set photo_list photo_data photo_formats photo_tiff photo_raw response photo_mask linear_photo lens_list layered_depth view_image camera_path photo_match rendered_frame exposure_list bracket_list point_cloud upright weighted subject_list photo_camera model_axes"
    layer() { case " $base " in *" $1 "*) echo 0; return ;; esac; case " $data " in *" $1 "*) echo 1 ;; *) echo 2 ;; esac; }
    for f in common/*.[ch]; do
        n=$(basename "${f%.*}")
        for i in $(sed -nE 's|^#include "common/([a-z_0-9]+)\.h".*|\1|p' "$f"); do
            [ "$(layer "$i")" -le "$(layer "$n")" ] || fail "$f (layer $(layer "$n")) includes common/$i.h (layer $(layer "$i"))"
        done
        ! grep -n '#include "stages/' "$f" || fail "$f includes from stages/"
    done
}

a_stage_includes_only_common_and_itself()
{
    for f in stages/*/*.[ch]; do
        s=$(basename "$(dirname "$f")")
        bad=$(grep -oE '#include "[^"]+"' "$f" | sed 's/.*"\(.*\)"/\1/' | grep -vE "^(common/|stages/$s/|[a-z_0-9]+\.h$)" || true)
        [ -z "$bad" ] || fail "$f includes $bad"
    done
}

formatted()
{
    command -v clang-format >/dev/null || skip "clang-format is not installed"
    find common stages tests -name '*.[ch]' | xargs clang-format --dry-run -Werror --style=file
}

default_config_is_the_programs_defaults()
{
    for s in stages/*/; do
        s=$(basename "$s")
        "$B/bin/$s" --print-config | sed 's/[[:space:]]*$//' >"$scratch/compiled"
        "$B/bin/$s" --print-config --config configs/default.cfg | sed 's/[[:space:]]*$//' >"$scratch/default"
        diff "$scratch/compiled" "$scratch/default" || fail "configs/default.cfg differs from the defaults of $s"
        for p in $(sed -nE 's/^([a-z_0-9]+) *=.*/\1/p' "$scratch/compiled"); do
            awk -v s="[$s]" -v p="$p" '/^\[/ { here = $1 == s } here && $1 == p { found = 1 } END { exit !found }' configs/default.cfg ||
                fail "configs/default.cfg does not name $p of [$s]"
        done
    done
}

man_pages_are_current()
{
    for s in stages/*/; do
        s=$(basename "$s")
        common/run/man.sh "$B/bin" "$s" | diff - "docs/man/$s.1" || fail "docs/man/$s.1 is not what common/run/man.sh makes; run make man"
    done
}

run every_header_compiles_alone
run lower_layers_never_include_higher
run a_stage_includes_only_common_and_itself
run formatted
run default_config_is_the_programs_defaults
run man_pages_are_current
