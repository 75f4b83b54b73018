# the committed scene still-life, from its description to its metrics, against the expected ones; its camera poses are committed
. tests/lib.sh

# in the project's own out/, so that products that are not stale are not remade
still_life_is_as_expected()
{
    [ "$FLAVOR" = release ] || skip "the scene is run by the release programs"
    make -s DEPS=manual regress SCENES="still-life still-life+holdout4" >"$scratch/log" 2>&1 ||
        { cat "$scratch/log"; fail "$(grep -E '^(worse|missing|unlike) ' "$scratch/log" | sed -n 1p || echo 'the run failed')"; }
    grep -q 'still-life+holdout4: as expected' "$scratch/log" || { cat "$scratch/log"; fail "the runs were not compared"; }
}

run still_life_is_as_expected
