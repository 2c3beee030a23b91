# SPDX-License-Identifier: BSD-3-Clause
# Completion in bash of dem_batch, dem_plot and dem_export. They are asked what they take: --help has the options and
# what follows each, `dem_batch --keys` the keys of decks.

_dem_options()
{
    "$1" --help 2>/dev/null | awk '/^[a-z]/ { wanted = /^(usage|options):/ } wanted' |
        grep -oE '(^|[ [|])--?[a-z][a-z-]*' | tr -d ' [|' | sort -u
}

# What follows an option: FOLDER, N, or the words one|another.
_dem_argument()
{
    "$1" --help 2>/dev/null | sed -nE "s/^.* $2 ([A-Z][^] ]*|\w+[|][^] ]*)( .*)?$/\1/p" | head -n 1
}

# Words of an option that the help has in a section of their own: those of --color under 'colors:'.
_dem_words()
{
    "$1" --help 2>/dev/null | sed -nE "s/^${2#--}s: //p" | tr -d ,
}

# group.key= of every key; the values of the one that is given, if it has a choice of them.
_dem_keys()
{
    "$1" --keys 2>/dev/null | awk -F ' [|] ' -v given="$2" '
        /^## &/ { group = substr($0, 5) }
        /^[|] `/ {
            key = group "." substr($1, 4, length($1) - 4)
            if (given == "") print key "="
            else if (key == given && gsub(/\\[|]/, " ", $5)) print $5
        }'
}

_dem_offer()
{
    mapfile -t COMPREPLY < <(compgen "$@" -- "$current")
}

# What stands by itself: decks and lists of them, or runs.
_dem_file()
{
    local ending=vtkhdf
    [[ ${1##*/} = dem_batch ]] && ending=nml
    if [[ $current = @* ]]; then
        current=${current#@}
        _dem_offer -f -P @
    else
        compopt -o filenames 2>/dev/null
        mapfile -t COMPREPLY < <(compgen -f -X "!*.$ending" -- "$current"; compgen -d -- "$current")
    fi
}

_dem()
{
    local current=$2 previous=$3 argument=
    COMPREPLY=()
    # bash takes '=' for a word of its own.
    [[ ${COMP_WORDS[COMP_CWORD]} = = ]] && previous='=' current= COMP_CWORD=$((COMP_CWORD + 1))
    [[ $previous = -* ]] && argument=$(_dem_argument "$1" "$previous")
    [[ $previous = = ]] && argument='='
    case $argument in
    '=') _dem_offer -W "$(_dem_keys "$1" "${COMP_WORDS[COMP_CWORD - 2]}")" ;;
    GROUP.KEY=VALUE)
        compopt -o nospace 2>/dev/null
        _dem_offer -W "$(_dem_keys "$1")" ;;
    *FOLDER*)
        compopt -o filenames 2>/dev/null
        _dem_offer -d ;;
    *FILE* | NAME)
        compopt -o filenames 2>/dev/null
        _dem_offer -f ;;
    [a-z]*'|'*) _dem_offer -W "${argument//|/ }" ;;
    ?*) _dem_offer -W "$(_dem_words "$1" "$previous")" ;; # of a number, say, there are none
    '') if [[ $current = -* ]]; then _dem_offer -W "$(_dem_options "$1")"; else _dem_file "$1"; fi ;;
    esac
}

complete -F _dem dem_batch dem_plot dem_export
