# Completion of polarcheck for fish: polarcheck completion fish > ~/.config/fish/completions/polarcheck.fish

# Paths that begin so, as they are typed: with ~ where that was typed.
function __polarcheck_paths --argument-names begun ending
    set -l expanded (string replace -r '^~/' "$HOME/" -- $begun)
    for line in (__fish_complete_path $expanded)
        set -l path (string split -m 1 \t -- $line)[1]
        if test "$expanded" != "$begun"
            set path (string replace -- "$HOME/" '~/' $path)
        end
        if test -z "$ending"; or string match -q -- '*/' $path; or string match -q -- "*$ending" $path
            echo $path
        end
    end
end

function __polarcheck_complete
    set -l words (commandline -opc | string join \n | string collect)
    set -l word (commandline -ct | string collect)
    set -l answer (env COMP_WORDS="$words" POLARCHECK_WORD="$word" _POLARCHECK_COMPLETE=fish_complete \
        polarcheck 2> /dev/null)
    set -l head ""
    for line in $answer
        set -l fields (string split \x1f -- $line)
        switch $fields[1]
            case head
                set head $fields[2]
            case word part
                printf '%s%s\t%s\n' $head $fields[2] $fields[3]
            case files
                printf '%s\n' $head(__polarcheck_paths "$fields[2]" "$fields[3]")
            case folders
                printf '%s\n' $head(__polarcheck_paths "$fields[2]" / | string match '*/')
        end
    end
end

complete --no-files --command polarcheck --arguments "(__polarcheck_complete)"
