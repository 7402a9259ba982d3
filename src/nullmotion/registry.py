"""One registry for everything that is one file each: laws, layouts, metrics, papers.

A kind is a package (``nullmotion.laws``); every class in one of its modules
that has a ``name`` of its own is an entry. Installed distributions add entries
through the entry point group of the same name, and `load_file` adds a user's.
"""

from __future__ import annotations

import dataclasses
import importlib
import importlib.util
import inspect
import pkgutil
from importlib.metadata import entry_points
from pathlib import Path
from types import ModuleType
from typing import Any

from nullmotion.errors import InputError, UnknownNameError


class Registry:
    """Entries of one kind by name.

    Args:
        kind: What an entry is called in messages (``law``).
        package: Package that holds one entry a module; also the entry point group.
        base: Dotted name of the class that entries derive from.
    """

    def __init__(self, kind: str, package: str, base: str) -> None:
        """Remember where to look; nothing is imported yet."""
        self.kind, self.package, self._base_name = kind, package, base
        self._entries: dict[str, type[Any]] = {}
        self._scanned = False

    @property
    def base(self) -> type[Any]:
        """Class that entries derive from."""
        module, _, name = self._base_name.rpartition(".")
        return getattr(importlib.import_module(module), name)

    def _scan(self) -> None:
        if self._scanned:
            return
        self._scanned = True
        package = importlib.import_module(self.package)
        for info in pkgutil.iter_modules(package.__path__):
            self._add_module(importlib.import_module(f"{self.package}.{info.name}"))
        for point in entry_points(group=self.package):
            loaded = point.load()
            self._add_module(loaded) if isinstance(loaded, ModuleType) else self.add(loaded)

    def _add_module(self, module: ModuleType) -> list[type[Any]]:
        found = [
            item
            for _, item in inspect.getmembers(module, inspect.isclass)
            if issubclass(item, self.base)
            and item.__module__ == module.__name__
            and item.__dict__.get("name")
        ]
        for item in found:
            self.add(item)
        return found

    def add(self, entry: Any) -> None:
        """Add an entry; a name may be taken once."""
        if not (inspect.isclass(entry) and issubclass(entry, self.base)):
            raise InputError(self.kind, entry, f"a class derived from {self.base.__name__}")
        names: tuple[str, ...] = (getattr(entry, "name", ""), *getattr(entry, "aliases", ()))
        for name in names:
            known = self._entries.get(name)
            if known is not None and known.__qualname__ != entry.__qualname__:
                raise InputError(
                    self.kind, name, f"a name that is not taken yet ({known.__module__} has it)"
                )
            self._entries[name] = entry

    def load_file(self, path: str | Path) -> list[type[Any]]:
        """Add the entries of a Python file and return them."""
        file = Path(path)
        if not file.is_file():
            raise InputError(f"{self.kind} file", str(path), "an existing Python file")
        spec = importlib.util.spec_from_file_location(f"nullmotion_user_{file.stem}", file)
        assert spec is not None and spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        try:
            spec.loader.exec_module(module)
        except Exception as error:
            raise InputError(
                f"{self.kind} file", str(path), f"a file that can be imported ({error!r})"
            ) from error
        self._scan()
        found = self._add_module(module)
        if not found:
            raise InputError(
                f"{self.kind} file",
                str(path),
                f"a file with a class derived from {self.base.__name__}",
            )
        return found

    def names(self) -> list[str]:
        """Return the names of all entries (no aliases), sorted."""
        self._scan()
        return sorted({entry.name for entry in self._entries.values()})

    def get(self, name: str) -> type[Any]:
        """Return the class registered under a name or alias.

        Raises:
            UnknownNameError: With the nearest names.
        """
        self._scan()
        if name not in self._entries:
            raise UnknownNameError(self.kind, name, self.names())
        return self._entries[name]

    def create(self, name: str, **parameters: Any) -> Any:
        """Return an entry made with parameters; the rest keep their defaults.

        Raises:
            UnknownNameError: For an unknown entry or parameter, with the nearest names.
            InputError: For a parameter value that the entry refuses.
        """
        cls = self.get(name)
        known = {f.name for f in dataclasses.fields(cls)}
        for key in parameters:
            label = f"{self.kind}.{key}"
            if key not in known and known:
                raise UnknownNameError(label, key, known)
            if not known:
                allowed = f"no parameters: {self.kind} {name!r} has none"
                raise InputError(label, parameters[key], allowed)
        return cls(**parameters)
