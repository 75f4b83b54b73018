# bash completion of remodel @VERSION@
_remodel()
{
    local word=${COMP_WORDS[COMP_CWORD]} goals="@GOALS@" variables="@VARIABLES@" stages="@STAGES@"
    # a word ends at "=" for bash, too
    if [ "$word" = = ]; then word=; fi
    local before=${COMP_WORDS[COMP_CWORD - 1]} name
    if [ "$before" = = ]; then name=${COMP_WORDS[COMP_CWORD - 2]}; elif [ "${COMP_WORDS[COMP_CWORD]}" = = ]; then name=$before; else name=; fi
    compopt +o nospace 2>/dev/null
    case $name in
    '')
        if [ "$before" = run ] && [ "$COMP_CWORD" = 2 ]; then
            mapfile -t COMPREPLY < <(compgen -W "$stages" -- "$word"); return
        fi
        mapfile -t COMPREPLY < <(compgen -W "$goals $variables help run version" -- "$word")
        [[ ${COMPREPLY[0]-} != *= ]] || compopt -o nospace 2>/dev/null ;;
    SCENE) mapfile -t COMPREPLY < <(compgen -W "$(cd scenes 2>/dev/null && echo */ | tr -d /)" -- "$word") ;;
    QUALITY) mapfile -t COMPREPLY < <(compgen -W "draft default final" -- "$word") ;;
    JOBS) mapfile -t COMPREPLY < <(compgen -W "local slurm" -- "$word") ;;
    TO) mapfile -t COMPREPLY < <(compgen -W "$goals" -- "$word") ;;
    *) mapfile -t COMPREPLY < <(compgen -o filenames -f -- "$word"); compopt -o filenames 2>/dev/null ;;
    esac
}
complete -F _remodel remodel
