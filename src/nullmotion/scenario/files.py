"""Write several files as one: all new or all as before."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from nullmotion.errors import InputError


@contextmanager
def replacing(directory: str | Path, owned: Sequence[str] = ()) -> Iterator[Path]:
    """Give an empty folder; what is in it at the end replaces the files in ``directory``.

    An exception or Ctrl-C on the way, and even while files are put in place, leaves
    everything as it was; a kill leaves each file whole, the old or the new one.

    Args:
        directory: Where the files go; made if need be. Other files in it stay.
        owned: Names of an earlier result that go away when the new one has no such file.

    Raises:
        InputError: If the folder cannot be written to.
    """
    target = Path(directory)
    made = not target.exists()
    work = _work_folder(target)
    try:
        new, old = work / "new", work / "old"
        new.mkdir()
        old.mkdir()
        yield new
        _put_in_place(target, new, old, owned)
    except BaseException:
        shutil.rmtree(work, ignore_errors=True)
        if made:
            with suppress(OSError):
                target.rmdir()
        raise
    shutil.rmtree(work, ignore_errors=True)


def _work_folder(target: Path) -> Path:
    try:
        target.mkdir(parents=True, exist_ok=True)
        return Path(tempfile.mkdtemp(prefix=".nullmotion-", dir=target))
    except OSError as error:
        raise InputError(
            "--out", str(target), f"a folder that can be written to ({error.strerror})"
        ) from None


def _put_in_place(target: Path, new: Path, old: Path, owned: Sequence[str]) -> None:
    names = sorted(item.name for item in new.iterdir())
    stale = [name for name in owned if name not in names and (target / name).is_file()]
    try:
        for name in [*names, *stale]:
            if (target / name).is_file():
                _keep(target / name, old / name)
        for name in names:
            os.replace(new / name, target / name)
        for name in stale:
            (target / name).unlink()
    except BaseException:
        _restore(target, new, old, names)
        raise


def _keep(file: Path, copy: Path) -> None:
    """Keep a second name of a file; a copy where the file system has no hard links."""
    try:
        os.link(file, copy)
    except OSError:
        shutil.copy2(file, copy)


def _restore(target: Path, new: Path, old: Path, names: Sequence[str]) -> None:
    for name in names:
        placed = not (new / name).exists()
        if placed and not (old / name).exists():
            (target / name).unlink(missing_ok=True)
    for kept in old.iterdir():
        os.replace(kept, target / kept.name)
