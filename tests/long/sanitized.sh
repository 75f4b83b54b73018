# the unit tests that take minutes under the address and undefined-behaviour sanitizers; make check runs them without
. tests/lib.sh
asan=out/build/asan
eval "$(sed -n "/^long_sanitized='/,/'$/p" tests/run)"

long_tests_pass_under_the_sanitizers()
{
    [ -n "$long_sanitized" ] || fail "tests/run names no tests"
    # shellcheck disable=SC2086 # a list of words
    CI=true make -s DEPS=manual FLAVOR=asan PHASE=build -j"$(nproc)" $(printf "$asan/tests/unit/%s " $long_sanitized) >"$scratch/log" 2>&1 ||
        { tail -n 20 "$scratch/log"; fail "the build with sanitizers"; }
    for t in $long_sanitized; do
        ASAN_OPTIONS=detect_leaks=1 "$asan/tests/unit/$t" >"$scratch/log" 2>&1 || { tail -n 30 "$scratch/log"; fail "$t"; }
    done
}

run long_tests_pass_under_the_sanitizers
