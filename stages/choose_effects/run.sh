# run.sh - checks the names of effects before hours of work, and reads what auto and all stand for. Sourced by
# common/run/run_scene.sh, which keeps the films of the run in `effects`, and auto or all in `choose`.

film_needs_a_name() { usage "$folder/keyframes/$1.txt: $1 means something else; give the film of keys another name."; }

# check_effect NAME [WHY]: NAME is an effect or a film of keys
check_effect()
{
    local words
    if [ -e "$folder/keyframes/$1.txt" ]; then
        ! "$bin/choose_effects" --effect "$1" >/dev/null 2>&1 || film_needs_a_name "$1"
        return 0
    fi
    words=$("$bin/choose_effects" --effect "$1" 2>&1) && return
    usage "$(grep -v ': used ' <<<"$words"; echo "${2:-There is no film of keys $folder/keyframes/$1.txt either.}")"
}

check_choose_effects()
{
    local film effect move
    for film in auto all morph; do [ ! -e "$folder/keyframes/$film.txt" ] || film_needs_a_name "$film"; done
    for effect in "${effects[@]}"; do
        check_effect "$effect"
        [ -e "$folder/keyframes/$effect.txt" ] || continue
        for move in $(awk '$1 == "move" && $2 ~ /^[A-Za-z0-9_+-]+$/ { print $2 }' "$folder/keyframes/$effect.txt"); do
            check_effect "$move" "$folder/keyframes/$effect.txt chains it."
        done
    done
}

read_choice() { read -r -a effects <<<"$(sed -n 's/^EFFECTS := *//p' "$O/parallax/$choose-effects.mk")"; }
# an earlier run's choice holds until this run makes it anew
look_choose_effects() { [ -z "$choose" ] || [ ! -e "$O/parallax/$choose-effects.mk" ] || read_choice; }

run_choice()
{
    one choice
    read_choice
}
