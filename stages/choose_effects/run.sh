# run.sh - checks the names of effects before hours of work, and reads what auto and all stand for. Sourced by
# common/run/run_scene.sh, which keeps the films of the run in `effects`, and auto or all in `choose`.

# the films of the run: EFFECT, or the establishing dolly. EFFECT_NAMED: those that somebody asked for by name
begin_choose_effects()
{
    read -r -a effects <<<"$(tr ' ' '\n' <<<"${REMODEL_EFFECT:-establishing_dolly}" | awk 'NF && !seen[$0]++' | tr '\n' ' ')"
    REMODEL_EFFECT_NAMED=$(tr ' ' '\n' <<<"$REMODEL_EFFECT" | awk 'NF && $0 != "auto" && $0 != "all"' | tr '\n' ' ')
    export REMODEL_EFFECT_NAMED=${REMODEL_EFFECT_NAMED% }
    given_film
    case ${effects[*]} in auto | all) choose=${effects[0]} effects=() ;; esac
    # a scene that does not ask for films gets only those that are asked for by name
    case " $REMODEL_PRODUCTS $goal " in
    *" parallax "* | *" choice "* | *" path "* | *" frames "* | *" video "* | *" pan_scan "* | *" morph "*) ;;
    *) [ -n "$REMODEL_EFFECT_NAMED" ] || effects=() choose= ;;
    esac
}

# CAMERAS=FILE names a film, `given`, where a film is asked for: that of the file, without .json
given=
given_film()
{
    [ -n "${REMODEL_CAMERAS-}" ] || return 0
    case " $goal ${REMODEL_TO-} " in *" path "* | *" eyes "* | *" frames "* | *" video "*) ;; *) return 0 ;; esac
    given=${REMODEL_CAMERAS%/} given=${given##*/} given=${given%.json}
    [ -n "${REMODEL_EFFECT-}" ] || effects=()
    effects+=("$given")
    export REMODEL_EFFECT_NAMED="${REMODEL_EFFECT_NAMED:+$REMODEL_EFFECT_NAMED }$given" REMODEL_GIVEN_FILM=$given
}

check_given()
{
    local good="Give transforms.json of nerfstudio, instant-ngp or Blender, or a folder with cameras.txt and images.txt, COLMAP's text format."
    [ -n "$given" ] || return 0
    [[ $given =~ ^[A-Za-z0-9_][A-Za-z0-9_-]*$ ]] ||
        usage "CAMERAS=$REMODEL_CAMERAS: the film would be called \"$given\"; wanted a name of letters, digits, _ and -. Rename it."
    case $REMODEL_CAMERAS in *.json) [ -f "$REMODEL_CAMERAS" ] ;; *) [ -e "$REMODEL_CAMERAS/images.txt" ] && [ -e "$REMODEL_CAMERAS/cameras.txt" ] ;; esac ||
        usage "CAMERAS=$REMODEL_CAMERAS has no cameras. $good"
    [ "${REMODEL_CAMERAS_FRAME:-scene}" = scene ] ||
        usage "CAMERAS_FRAME=$REMODEL_CAMERAS_FRAME: a film's cameras are in the scene's frame, that of points/points.ply. Leave it out, or make remodel alone."
    [ ! -e "$folder/keyframes/$given.txt" ] || usage "CAMERAS=$REMODEL_CAMERAS: $folder/keyframes/$given.txt is a film of this name. Rename one of them."
    case $given in auto | all | morph) false ;; *) ! "$bin/choose_effects" --effect "$given" >/dev/null 2>&1 ;; esac ||
        usage "CAMERAS=$REMODEL_CAMERAS: $given means something else; rename it."
}

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
    check_given
    for effect in "${effects[@]}"; do
        [ "$effect" != "$given" ] || continue
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

unknown_choose_effects() { [ -z "$choose" ] || echo "not known before the subjects are found: which films EFFECT=$choose makes"; }
dry_choose_effects()
{
    case $goal in report | path | frames | video | pan_scan) ;; *) return 0 ;; esac
    [ -n "$choose" ] || return 0
    first=(choice)
    # two photos get their morph, unless a move is asked for by name
    [ "${#effects[@]}" -gt 0 ] || { [ -z "$REMODEL_EFFECT_NAMED" ] && [ "$(grep -c '^[^#]' "$S/photos/list.txt")" = 2 ]; } ||
        { unknown_choose_effects | sed 's/^/# /'; first=(); goal=choice; }
}
