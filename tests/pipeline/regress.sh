# the small scene, from its description to its figures, against what is expected; its camera poses are committed
. tests/lib.sh

# In the project's own out/: what a run of the scene has left there, and is not stale, need not be made again.
still_life_is_as_good_as_it_was()
{
    [ "$FLAVOR" = release ] || skip "the scene is run by the release programs"
    make -s DEPS=manual regress SCENES="still-life still-life+holdout4" >"$scratch/said" 2>&1 ||
        { cat "$scratch/said"; fail "$(grep -E '^(worse|missing|unlike) ' "$scratch/said" | sed -n 1p || echo 'the run failed')"; }
    grep -q 'still-life+holdout4: as expected' "$scratch/said" || { cat "$scratch/said"; fail "the runs were not compared"; }
}

run still_life_is_as_good_as_it_was
