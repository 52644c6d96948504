"""`fwk completion`: prints the script that teaches a shell to complete `fwk` and `fwk-launch`."""

from enum import StrEnum
from typing import Annotated

import typer


class Shell(StrEnum):
    """Shells that can complete."""

    BASH = "bash"
    ZSH = "zsh"
    FISH = "fish"


_SCRIPTS = {
    Shell.BASH: """\
_fwk_complete() {
    local line=${COMP_LINE:0:COMP_POINT} words current
    read -ra words <<< "$line"
    [[ $line == *[[:space:]] ]] && words+=("")
    current=${words[-1]}
    local IFS=$'\\n'
    COMPREPLY=($(command fwk __complete "${words[@]}" 2>/dev/null))
    local cut=${current%"${COMP_WORDS[COMP_CWORD]}"}
    [[ -n $cut ]] && COMPREPLY=("${COMPREPLY[@]#"$cut"}")
    [[ ${#COMPREPLY[@]} -eq 1 && ${COMPREPLY[0]} == *[=.] ]] && compopt -o nospace
    return 0
}
complete -o default -F _fwk_complete fwk fwk-launch
""",
    Shell.ZSH: """\
#compdef fwk fwk-launch
_fwk_complete() {
    local -a found
    found=(${(f)"$(command fwk __complete "${(@)words[1,CURRENT]}" 2>/dev/null)"})
    if (( ${#found} )); then
        compadd -Q -S '' -- "${(M@)found:#*[=.]}"
        compadd -Q -- "${(@)found:#*[=.]}"
    else
        _files
    fi
}
(( $+functions[compdef] )) || { autoload -Uz compinit && compinit; }
compdef _fwk_complete fwk fwk-launch
""",
    Shell.FISH: """\
function __fwk_complete
    set -l found (command fwk __complete (commandline -opc) (commandline -ct) 2>/dev/null)
    if set -q found[1]
        printf '%s\\n' $found
    else
        __fish_complete_path (commandline -ct)
    end
end
complete -c fwk -f -a '(__fwk_complete)'
complete -c fwk-launch -f -a '(__fwk_complete)'
""",
}


def completion(shell: Annotated[Shell, typer.Argument(metavar="bash|zsh|fish", help="the shell")]) -> None:
    """Prints the completion script of a shell: commands, options, components, channels, settings and runs.

    bash: eval "$(fwk completion bash)" in ~/.bashrc; zsh: eval "$(fwk completion zsh)" in ~/.zshrc; fish: fwk
    completion fish > ~/.config/fish/completions/fwk.fish
    """
    typer.echo(_SCRIPTS[shell], nl=False)
