# a second compiler and a linter of C: clang's warnings, and clang-tidy
. tests/lib.sh

packages="OpenEXR libjpeg libturbojpeg libpng libtiff-4 libraw_r libexif lcms2 expat libheif libwebp libwebpdemux libjxl inih libxxhash qhull_r libdeflate"
warnings="-Wall -Wextra -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wvla -Wpointer-arith -Wwrite-strings"
warnings+=" -Wreserved-identifier"
# shellcheck disable=SC2086 # a list of packages
libraries=$(pkg-config --cflags $packages | sed 's/-I/-isystem /g') # no warnings from their headers
CLANG_FLAGS="-std=c11 -D_GNU_SOURCE -ffp-contract=off -fopenmp $warnings -I. -I$B $libraries"
export CLANG_FLAGS

# clang-tidy prints the warnings of the other sources, too, but not those of headers. The headers of common/, and those of each
# stage, are compiled together: most of the time goes into what they all include.
headers_and_tests_have_no_warnings_of_clang()
{
    command -v clang >/dev/null || skip "clang is not installed"
    local folder others=()
    command -v clang-tidy >/dev/null || others=('common/*.c' 'stages/*.c')
    # shellcheck disable=SC2016 # expanded by bash -c
    git ls-files 'tests/*.c' "${others[@]}" | xargs -P "$(nproc)" -n 16 bash -c 'clang $CLANG_FLAGS -Werror -fsyntax-only "$@"' - ||
        fail "clang has warnings"
    for folder in common $(git ls-files 'stages/*.h' | cut -d/ -f1,2 | sort -u); do
        # shellcheck disable=SC2086 # a list of flags
        # common/base/wasm has headers in place of the system's
        git ls-files "$folder/*.h" ':!common/base/wasm' | sed 's/.*/#include "&"/' | clang $CLANG_FLAGS -Werror -fsyntax-only -xc - ||
            fail "clang has warnings of headers in $folder"
    done
}

clang_and_clang_tidy_have_no_findings()
{
    command -v clang-tidy >/dev/null || skip "clang-tidy is not installed"
    # shellcheck disable=SC2016 # expanded by bash -c
    git ls-files 'common/*.c' 'stages/*.c' | xargs -P "$(nproc)" -n 8 bash -c 'clang-tidy --quiet --warnings-as-errors="*" "$@" -- $CLANG_FLAGS 2>/dev/null' - ||
        fail "clang-tidy has findings, or clang warnings (.clang-tidy says what is checked)"
}

run headers_and_tests_have_no_warnings_of_clang
run clang_and_clang_tidy_have_no_findings
