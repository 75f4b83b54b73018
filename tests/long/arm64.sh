# a build for arm64 by a cross compiler: its unit tests and parsers pass under an emulator (docs/architecture.md says what it needs)
. tests/lib.sh

a_build_for_arm64_passes_its_tests()
{
    command -v aarch64-linux-gnu-gcc >/dev/null || skip "no cross compiler for arm64 is installed"
    command -v qemu-aarch64-static >/dev/null || command -v qemu-aarch64 >/dev/null || skip "no emulator of arm64 is installed"
    [ -e /usr/lib/aarch64-linux-gnu/pkgconfig/OpenEXR.pc ] || skip "the libraries for arm64 are not installed"
    CI=true make -s DEPS=manual FLAVOR=arm64 PHASE=build -j"$(nproc)" build unit-build fuzz-build >"$scratch/log" 2>&1 || { tail -n 20 "$scratch/log"; fail "the build for arm64"; }
    tests/run out/build/arm64 unit fuzz >"$scratch/log" 2>&1 || { cat "$scratch/log"; fail "tests of the build for arm64"; }
}

run a_build_for_arm64_passes_its_tests
