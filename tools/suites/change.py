"""What a change touches: files since a commit, and the commits that raised `.ci/turn`."""

import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TURN = ".ci/turn"


def git(*arguments: str) -> str:
    """Return what a command of git prints, without the last line's end."""
    done = subprocess.run(["git", *arguments], cwd=ROOT, check=True, capture_output=True, text=True)
    return done.stdout.rstrip("\n")


def changed_files(base: str) -> list[str]:
    """Return all files that differ from a commit, files that git does not know yet and removed files included."""
    tracked = git("diff", "--name-only", "--no-renames", base, "--").splitlines()
    untracked = git("ls-files", "--others", "--exclude-standard").splitlines()
    return sorted({*tracked, *untracked})


def turn() -> int:
    """Return the number in `.ci/turn`."""
    return int((ROOT / TURN).read_text(encoding="utf-8"))


def raises() -> list[str]:
    """Return the commits that changed `.ci/turn`, the newest first."""
    return git("log", "--first-parent", "-m", "--format=%H", "--", TURN).splitlines()


def base_of_submission() -> str | None:
    """Return the commit before the change that `.ci/run` checks: the one that raised the turn the last time but one.

    None: the turn was raised once, or never, so that the change is everything.
    """
    found = raises()
    return found[1] if len(found) > 1 else None


def base_of_work() -> str:
    """Return the commit before the work that is under way: where the branch left `origin/main`, or HEAD."""
    done = subprocess.run(
        ["git", "merge-base", "HEAD", "origin/main"], cwd=ROOT, check=False, capture_output=True, text=True
    )
    return done.stdout.strip() if done.returncode == 0 else "HEAD"
