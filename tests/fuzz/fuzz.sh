#!/usr/bin/env bash
# fuzz.sh NAME SECONDS - looks for new inputs that break a parser, with libFuzzer and the sanitizers, starting from its corpus.
#
# NAME is a target, or all, which share the time: SECONDS for each. Inputs that break one are left in out/fuzz/NAME/. Minimize each
# and add it to tests/fuzz/corpus/NAME together with the fix.
set -euo pipefail
name=$1 seconds=$2
names=$(cd tests/fuzz && ls fuzz_*.c | sed 's/^fuzz_//; s/\.c$//' | tr '\n' ' ')
[ "$name" = all ] || [[ " $names" == *" $name "* ]] || { echo "FUZZ=$name is neither all nor one of: $names" >&2; exit 2; }
command -v clang >/dev/null && [ -n "$(find "$(clang -print-resource-dir)" -name 'libclang_rt.fuzzer*' -print -quit)" ] ||
    { echo "Fuzzing needs clang with its run-time library: apt-get install clang libclang-rt-dev libomp-dev" >&2; exit 1; }
[ "$name" = all ] || names=$name
root=$PWD
# shellcheck disable=SC2086 # a list of names
make -s DEPS=manual PHASE=build FLAVOR=fuzz -j"$(nproc)" $(printf 'out/build/fuzz/tests/fuzz/fuzz_%s ' $names) >&2
for name in $names; do
    mkdir -p "out/fuzz/$name/found"
    cd "out/fuzz/$name"
    echo "fuzz: $name"
    # a hang is an input that takes more than a second; with the sanitizers, which make programs some ten times as slow, ten
    OMP_NUM_THREADS=1 ASAN_OPTIONS=detect_leaks=${FUZZ_LEAKS-0} "$root/out/build/fuzz/tests/fuzz/fuzz_$name" -max_total_time="$seconds" -timeout=10 \
        -rss_limit_mb=2048 -print_final_stats=1 found "$root/tests/fuzz/corpus/$name"
    cd "$root"
done
