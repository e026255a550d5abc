# Completion of slosh for bash: verbs and options are asked of the program itself, so they are never old.
_slosh() {
  local current="${COMP_WORDS[COMP_CWORD]}" before="${COMP_WORDS[COMP_CWORD - 1]}" program="${COMP_WORDS[0]}"
  local verb="${COMP_WORDS[1]:-}" words=""
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    words="$("$program" --help 2>/dev/null | sed -n '/^Subcommands:/,$s/^  \([a-z]\{1,\}\) .*/\1/p') --help --version"
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
    return
  fi
  local help
  help="$("$program" "$verb" --help 2>/dev/null)"
  # A choice of words: "--backend TEXT:{auto,cpu,cuda}=auto".
  if [[ "$before" == --* ]]; then
    words="$(sed -n "s/^  $before [A-Z]*:{\([^}]*\)}.*/\1/p" <<<"$help" | tr ',' ' ')"
    if [[ -n "$words" ]]; then
      mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
      return
    fi
  fi
  if [[ "$current" == -* ]]; then
    words="$(sed -n 's/^  \(-[a-z],\)\{0,1\}\(--[a-z-]*\).*/\2/p' <<<"$help")"
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
    return
  fi
  case "$verb" in
    play | host | plan | sweep | check)
      if ((COMP_CWORD == 2)); then words="$("$program" scenes 2>/dev/null | sed -n 's/^ *\([a-z0-9_-]\{1,\}\) .*/\1/p')"; fi
      ;;
    links | devices | report) words="$(sed -n '/^Subcommands:/,/^$/s/^  \([a-z]\{1,\}\) .*/\1/p' <<<"$help")" ;;
  esac
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current"; compgen -f -- "$current")
  compopt -o filenames 2>/dev/null || true
}
complete -F _slosh slosh
