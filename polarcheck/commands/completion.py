"""`polarcheck completion`: shows the script for completion in a shell."""

from __future__ import annotations

from pathlib import Path

import click

from polarcheck.commands import options
from polarcheck.commands.output import show

#: The folder of the scripts; the extension of each is the name of its shell.
FOLDER = Path(__file__).parent / "completions"
SHELLS = ("bash", "zsh", "fish", "powershell")


@click.command(short_help="Show the script that completes commands, options and files.")
@click.argument("shell", type=click.Choice(SHELLS))
@options.debug
def completion(shell: str) -> None:
    """
    Show the script that completes commands, options, files, machines and rules in a SHELL.

    \b
    bash          in ~/.bashrc:                  eval "$(polarcheck completion bash)"
    zsh           in ~/.zshrc, behind compinit:  source <(polarcheck completion zsh)
    fish          once:   polarcheck completion fish > ~/.config/fish/completions/polarcheck.fish
    powershell    in $PROFILE:  polarcheck completion powershell | Out-String | Invoke-Expression
    """
    # As bytes, without CR, which ported shells such as bash on Windows do not accept.
    show((FOLDER / f"polarcheck.{shell}").read_bytes())
