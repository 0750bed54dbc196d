# Completion of detp for bash. Commands, options and their values come from `detp COMMAND --help all`.
_detp() {
  local cur prev words cword
  _init_completion -n : || return
  local command=${words[1]} help values
  if ((cword == 1)); then
    COMPREPLY=($(compgen -W "$(detp --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p') help --help --version" -- "$cur"))
    return
  fi
  help=$(detp "$command" --help all 2>/dev/null) || return
  if [[ $prev == --* ]]; then
    values=$(sed -n "s/^  \(-[a-zA-Z],\)\?$prev [^{ ]*{\([^}]*\)}.*/\2/p" <<<"$help" | tr ',' ' ')
    if [[ $prev == --technique || $prev == --disable ]]; then
      values=$(detp run --help all | sed -n '/^  --technique /,/;/p' | tr '\n' ' ' | sed 's/^  --technique [A-Z,.]* *//; s/;.*//' | tr -d ' ' | tr ',' ' ')
    fi
    if [[ -n $values ]]; then
      COMPREPLY=($(compgen -W "$values" -- "$cur"))
      return
    fi
    grep -q -- "^  \(-[a-zA-Z],\)\?$prev TEXT" <<<"$help" && { _filedir; return; }
    grep -q -- "^  \(-[a-zA-Z],\)\?$prev [A-Z]" <<<"$help" && return
  fi
  if [[ $cur == -* ]]; then
    COMPREPLY=($(compgen -W "$(grep -o -- '^  [-a-zA-Z,]*--[a-z0-9-]*' <<<"$help" | grep -o -- '--[a-z0-9-]*')" -- "$cur"))
  elif [[ $cur == @* ]]; then
    COMPREPLY=($(compgen -W "$(detp run --help all | sed -n '/^  SCENE/,/^$/p' | grep -o '@[a-z-]*' | sort -u)" -- "$cur"))
  else
    _filedir '@(obj|ply)'
  fi
} &&
  complete -F _detp detp
