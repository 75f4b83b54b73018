# everything built with clang, without warnings; the unit tests and the parsers pass
. tests/lib.sh

clang_builds_what_passes_its_tests()
{
    command -v clang >/dev/null || skip "clang is not installed"
    CI=true make -s DEPS=manual FLAVOR=clang PHASE=build -j"$(nproc)" tests-build >"$scratch/log" 2>&1 || { tail -n 20 "$scratch/log"; fail "the build with clang"; }
    tests/run out/build/clang unit fuzz >"$scratch/log" 2>&1 || { tail -n 20 "$scratch/log"; fail "tests of the build with clang"; }
}

run clang_builds_what_passes_its_tests
