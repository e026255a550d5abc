# Completion of slosh for bash (and zsh, by _slosh): verbs and options are asked of the program itself, so they are
# never old. What this does not know is completed as a file's name.
_slosh() {
  local current="${COMP_WORDS[COMP_CWORD]}" before="${COMP_WORDS[COMP_CWORD-1]}"
  local program="${COMP_WORDS[0]}" verb="${COMP_WORDS[1]}" words="" help
  COMPREPLY=()
  if [[ $COMP_CWORD -eq 1 ]]; then
    words="$("$program" --help 2>/dev/null | sed -n '/^Subcommands:/,$s/^  \([a-z]\{1,\}\) .*/\1/p') --help --version"
    COMPREPLY=($(compgen -W "$words" -- "$current"))
    return
  fi
  help="$("$program" "$verb" --help 2>/dev/null)"
  case "$before" in
    --*) # a choice of words: "--backend TEXT:{auto,cpu,cuda}=auto"
      words="$(printf '%s\n' "$help" | sed -n "s/^  $before [A-Z]*:{\([^}]*\)}.*/\1/p" | tr ',' ' ')"
      ;;
  esac
  if [[ -z "$words" ]]; then
    case "$current" in
      -*) words="$(printf '%s\n' "$help" | sed -n 's/^  \(-[a-z],\)\{0,1\}\(--[a-z-]*\).*/\2/p')" ;;
      *)
        case "$verb" in
          play | host | plan | sweep | check)
            [[ $COMP_CWORD -ne 2 ]] || words="$("$program" scenes 2>/dev/null | sed -n 's/^ *\([a-z0-9_-]\{1,\}\) .*/\1/p')"
            ;;
          links | devices | report)
            words="$(printf '%s\n' "$help" | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]\{1,\}\) .*/\1/p')"
            ;;
        esac
        ;;
    esac
  fi
  COMPREPLY=($(compgen -W "$words" -- "$current"))
}
complete -o default -F _slosh slosh
