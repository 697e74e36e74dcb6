# Completion of polarcheck for bash 4.4 or newer. In ~/.bashrc: eval "$(polarcheck completion bash)"

_polarcheck() {
    local kind value extra line head=""
    local -a answer names=()
    # The line, not its words: bash parts them at = and : as well.
    mapfile -t answer < <(
        COMP_WORDS="${COMP_LINE:0:COMP_POINT}" POLARCHECK_BREAKS="$COMP_WORDBREAKS" \
            _POLARCHECK_COMPLETE=bash_complete "${1/#\~\//$HOME/}" 2> /dev/null
    )
    COMPREPLY=()
    for line in "${answer[@]}"; do
        IFS=$'\037' read -r kind value extra <<< "$line"
        case $kind in
            head) head=$value ;;
            word) COMPREPLY+=("$head$value") ;;
            part)
                COMPREPLY+=("$head$value")
                compopt -o nospace
                ;;
            files)
                if [[ -z $head$extra && ${#COMPREPLY[@]} -eq 0 ]]; then
                    compopt -o default # readline knows ~, variables and quotes
                else
                    compopt -o filenames
                    mapfile -t names < <(compgen -f -X "${extra:+!*$extra}" -- "$value"; [[ $extra ]] && compgen -d -- "$value")
                    COMPREPLY+=("${names[@]/#/$head}")
                fi
                ;;
            folders)
                compopt -o filenames
                mapfile -t names < <(compgen -d -- "$value")
                COMPREPLY+=("${names[@]/#/$head}")
                ;;
        esac
    done
}

complete -o nosort -F _polarcheck polarcheck
