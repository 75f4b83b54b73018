# clang's static analyser over all C code; what it looks for, and what is left out, is below
. tests/lib.sh

packages="OpenEXR libjpeg libturbojpeg libpng libtiff-4 libraw_r libexif lcms2 expat libheif libwebp libwebpdemux libjxl inih libxxhash qhull_r libdeflate"
# shellcheck disable=SC2086 # a list of packages
CLANG_FLAGS="-std=c11 -D_GNU_SOURCE -ffp-contract=off -I. $(pkg-config --cflags $packages)"
export CLANG_FLAGS
# insecureAPI asks for memcpy_s and the like, which no C library here has
export CHECKS='-*,clang-analyzer-*,-clang-analyzer-security.insecureAPI.*'

the_analyser_has_no_findings()
{
    command -v clang-tidy >/dev/null || skip "clang-tidy is not installed"
    # shellcheck disable=SC2016 # expanded by bash -c
    git ls-files 'common/*.c' 'stages/*.c' | xargs -P "$(nproc)" -n 8 bash -c 'clang-tidy --quiet --checks="$CHECKS" --warnings-as-errors="*" "$@" -- $CLANG_FLAGS 2>/dev/null' - ||
        fail "the analyser has findings"
}

run the_analyser_has_no_findings
