#compdef polarcheck
# Completion of polarcheck for zsh. In ~/.zshrc, behind compinit: source <(polarcheck completion zsh)
# or as a file of the name _polarcheck in a folder of $fpath.

_polarcheck() {
    local line kind value extra
    local -a answer fields words_said parts_said
    local -i asked_files=0 found=1
    answer=("${(@f)$(
        COMP_WORDS="${(pj:\n:)${(@Q)words[1,CURRENT-1]}}" POLARCHECK_WORD="${(Q)PREFIX}" \
            _POLARCHECK_COMPLETE=zsh_complete ${(Q)words[1]/#\~\//$HOME/} 2> /dev/null
    )}")
    for line in $answer; do
        fields=("${(@ps:\037:)line}")
        kind=$fields[1] value=$fields[2] extra=$fields[3]
        case $kind in
            head) compset -p ${#value} ;;
            word) words_said+=("${value//:/\\:}:$extra") ;;
            part) parts_said+=("${value//:/\\:}:$extra") ;;
            files) if [[ -n $extra ]]; then _files -g "*$extra(-.)" && found=0; else _files && found=0; fi ;;
            folders) _files -/ && found=0 ;;
        esac
    done
    (( $#words_said )) && _describe -t values 'polarcheck' words_said && found=0
    (( $#parts_said )) && _describe -t values 'polarcheck' parts_said -S '' && found=0
    return found
}

if [[ $zsh_eval_context[-1] == loadautofunc ]]; then
    _polarcheck "$@"
else
    compdef _polarcheck polarcheck
fi
