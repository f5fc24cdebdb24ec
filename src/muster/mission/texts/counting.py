"""Numbers of things in words."""


def counted(number: int, one: str, several: str = "") -> str:
    """`1 task`, `2 tasks`; `several`: what more than one, or none, are called, if not by an `s` after the word."""
    return f"{number} {one if number == 1 else several or one + 's'}"
