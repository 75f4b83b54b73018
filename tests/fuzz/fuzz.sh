#!/usr/bin/env bash
# fuzz.sh NAME SECONDS - looks for new inputs that break a parser, with libFuzzer and the sanitizers, starting from its corpus.
#
# Inputs that break it are left in out/fuzz/NAME/. Minimize each and add it to tests/fuzz/corpus/NAME together with the fix.
set -euo pipefail
name=$1 seconds=$2
names=$(cd tests/fuzz && ls fuzz_*.c | sed 's/^fuzz_//; s/\.c$//' | tr '\n' ' ')
[[ " $names" == *" $name "* ]] || { echo "FUZZ=$name is not one of: $names" >&2; exit 2; }
command -v clang >/dev/null && [ -n "$(find "$(clang -print-resource-dir)" -name 'libclang_rt.fuzzer*' -print -quit)" ] ||
    { echo "Fuzzing needs clang with its run-time library: apt-get install clang libclang-rt-dev libomp-dev" >&2; exit 1; }
mkdir -p "out/fuzz/$name/found"
packages="OpenEXR libjpeg libturbojpeg libpng libtiff-4 libraw_r libexif lcms2 expat libheif libwebp libwebpdemux libjxl inih libxxhash qhull_r libdeflate"
# shellcheck disable=SC2086 # a list of packages
read -ra flags <<<"-std=c11 -D_GNU_SOURCE -O1 -g -fopenmp -fsanitize=fuzzer,address,undefined -I. $(pkg-config --cflags $packages)"
# the stages whose headers it includes, without their main: an archive, of which the linker takes what is needed
rm -rf "out/fuzz/$name/obj" "out/fuzz/$name/stages.a"; mkdir "out/fuzz/$name/obj"
for stage in $(sed -nE 's|^#include "stages/([a-z_0-9]+)/.*"$|\1|p' "tests/fuzz/fuzz_$name.c" | sort -u); do
    for source in "stages/$stage"/*.c; do
        [ "$source" = "stages/$stage/$stage.c" ] || echo "$source"
    done
done | xargs -r -d '\n' -P 2 -I{} bash -c 'clang "${@:2}" -c -o "out/fuzz/$0/obj/$(tr / . <<<"$1").o" "$1"' "$name" {} "${flags[@]}"
find "out/fuzz/$name/obj" -name '*.o' -exec ar rcs "out/fuzz/$name/stages.a" {} +
[ -e "out/fuzz/$name/stages.a" ] || ar rcs "out/fuzz/$name/stages.a"
embree=-lembree3; [ ! -e /usr/include/embree4/rtcore.h ] || embree=-lembree4
# shellcheck disable=SC2046,SC2086 # lists of flags
clang "${flags[@]}" -o "out/fuzz/$name/fuzz" "tests/fuzz/fuzz_$name.c" common/*/*.c "out/fuzz/$name/stages.a" -lOpenEXRCore "$embree" -lcholmod -ljansson -lexpat \
    $(pkg-config --libs $packages) -lm
cd "out/fuzz/$name"
OMP_NUM_THREADS=1 ASAN_OPTIONS=detect_leaks=0 ./fuzz -max_total_time="$seconds" -timeout=20 -rss_limit_mb=4096 found "$OLDPWD/tests/fuzz/corpus/$name"
