# a second compiler and a linter of C: clang's warnings, and clang-tidy
. tests/lib.sh

packages="OpenEXR libturbojpeg libpng libtiff-4 libraw_r libexif inih libxxhash qhull_r libdeflate"
warnings="-Wall -Wextra -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wvla -Wpointer-arith -Wwrite-strings"
# shellcheck disable=SC2086 # a list of packages
CLANG_FLAGS="-std=c11 -D_GNU_SOURCE -ffp-contract=off -fopenmp $warnings -I. -I$B $(pkg-config --cflags $packages)"
export CLANG_FLAGS

clang_has_no_warnings()
{
    command -v clang >/dev/null || skip "clang is not installed"
    # shellcheck disable=SC2016 # expanded by bash -c
    git ls-files 'common/*.c' 'stages/*.c' 'tests/*.c' | xargs -P "$(nproc)" -n 16 bash -c 'clang $CLANG_FLAGS -Werror -fsyntax-only "$@"' - ||
        fail "clang has warnings"
}

clang_tidy_has_no_findings()
{
    command -v clang-tidy >/dev/null || skip "clang-tidy is not installed"
    # shellcheck disable=SC2016 # expanded by bash -c
    git ls-files 'common/*.c' 'stages/*.c' | xargs -P "$(nproc)" -n 8 bash -c 'clang-tidy --quiet --warnings-as-errors="*" "$@" -- $CLANG_FLAGS 2>/dev/null' - ||
        fail "clang-tidy has findings (.clang-tidy says what is checked)"
}

run clang_has_no_warnings
run clang_tidy_has_no_findings
