# every parser of outside bytes, fuzzed for FUZZ_SECONDS (20) each under the sanitizers, starting from its corpus
. tests/lib.sh

command -v clang >/dev/null && [ -n "$(find "$(clang -print-resource-dir)" -name 'libclang_rt.fuzzer*' -print -quit)" ] ||
    { echo "skip fuzz: clang with its run-time library is not installed (Debian: clang libclang-rt-dev libomp-dev)"; exit 0; }

no_input_breaks_a_parser()
{
    FUZZ_LEAKS=1 tests/fuzz/fuzz.sh all "${FUZZ_SECONDS:-20}" >"$scratch/log" 2>&1 || { grep '^fuzz: ' "$scratch/log" | tail -n 1; tail -n 40 "$scratch/log"; fail "see above"; }
    awk '/^fuzz: / { name = $2; n++ } /^stat::number_of_executed_units/ { runs += $2 } END { printf "# %d parsers, %d runs\n", n, runs }' "$scratch/log"
}

run no_input_breaks_a_parser
