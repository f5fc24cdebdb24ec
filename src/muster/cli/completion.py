"""`muster completion`: what a shell needs to complete verbs, options, names of shipped missions and files."""

from __future__ import annotations

import click
from click.shell_completion import BashComplete, add_completion_class, get_completion_class

from muster.cli.options import quiet_option
from muster.mission.texts.packaged_files import packaged_text

_SHELLS = ("bash", "zsh", "fish")
_VARIABLE = "_MUSTER_COMPLETE"


class _Bash(BashComplete):
    """Completes names and files at once: click's own script has either."""

    source_template = packaged_text("muster.cli", "completion.bash")


add_completion_class(_Bash, "bash")


_HELP = """Print the script with which SHELL completes verbs, options, missions and files.

\b
  bash: eval "$(muster completion bash)"       in ~/.bashrc
  zsh:  eval "$(muster completion zsh)"        in ~/.zshrc, after compinit
  fish: muster completion fish > ~/.config/fish/completions/muster.fish
"""


@click.command(help=_HELP)
@click.argument("shell", type=click.Choice(_SHELLS))
@quiet_option
def command(shell: str, quiet: bool, verbose: bool) -> None:
    """Print the script with which a shell completes verbs, options, missions and files."""
    from muster.cli.main import muster

    kind = get_completion_class(shell)
    assert kind is not None
    script = kind(muster, {}, "muster", _VARIABLE)
    click.echo(script.source_template % script.source_vars())  # `source` would run the shell to see its version
