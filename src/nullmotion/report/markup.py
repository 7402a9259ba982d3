"""HTML from Python: elements that escape whatever they are given."""

from __future__ import annotations

from html import escape

_VOID = frozenset({"br", "hr", "input", "meta"})


class Markup(str):
    """Text that is HTML already."""

    __slots__ = ()


def text(value: object) -> Markup:
    """Return a value as HTML: `Markup` as it stands, anything else escaped."""
    return value if isinstance(value, Markup) else Markup(escape(str(value), quote=True))


def join(*parts: object, between: str = "") -> Markup:
    """Return parts one after the other as HTML."""
    return Markup(between.join(text(part) for part in parts))


def tag(name: str, *children: object, **attributes: object) -> Markup:
    """Return an element.

    Args:
        name: Element name.
        *children: Text (escaped) or `Markup`.
        **attributes: Values are escaped; ``None`` and ``False`` leave one out, ``True``
            writes it bare. A trailing underscore is dropped (``class_``), others become
            hyphens (``aria_label``).
    """
    written = "".join(_attribute(key, value) for key, value in attributes.items())
    if name in _VOID:
        return Markup(f"<{name}{written}>")
    return Markup(f"<{name}{written}>{join(*children)}</{name}>")


def _attribute(key: str, value: object) -> str:
    if value is None or value is False:
        return ""
    name = key.rstrip("_").replace("_", "-")
    return f" {name}" if value is True else f' {name}="{escape(str(value), quote=True)}"'
