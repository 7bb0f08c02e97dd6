"""The folders that a robot file may take other text from."""

from collections.abc import Iterable, Iterator
from pathlib import Path


def roots_of(file: Path) -> tuple[Path, ...]:
    """A robot file's own folder and the ROS package or repository around it.

    Where the file is a link, as in a workspace that is installed by links, so too where it leads.
    """
    folders = dict.fromkeys((file.absolute().parent, file.resolve().parent))
    return tuple(root for folder in folders for root in (folder, *_project_around(folder)))


def package_roots(folder: Path) -> tuple[Path, ...]:
    """A ROS package and where its files lead to; nothing if the folder is no package."""
    manifest = folder / "package.xml"
    return (folder, manifest.resolve().parent) if manifest.is_file() else ()


def is_below(path: Path, roots: Iterable[Path]) -> bool:
    """Whether a file lies below one of some folders, links followed."""
    target = path.resolve()
    return any(target.is_relative_to(root.resolve()) for root in roots)


def _project_around(folder: Path) -> Iterator[Path]:
    """The nearest folder above that is marked as a package or a repository."""
    for above in (folder, *folder.parents):
        if (above / "package.xml").is_file() or (above / ".git").exists():
            yield above
            return
