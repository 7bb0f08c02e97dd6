"""New names beside those that are taken."""

from collections.abc import Container


def unused_name(stem: str, suffix: str, taken: Container[str]) -> str:
    """Stem and suffix together, with the first number between them that makes the name new."""
    name, number = stem + suffix, 2
    while name in taken:
        name, number = f"{stem}_{number}{suffix}", number + 1
    return name
