"""XML of files that anyone may have written."""

from __future__ import annotations

from xml.etree import ElementTree
from xml.parsers import expat


def root_of(document: bytes) -> ElementTree.Element:
    """Return the root of a document that defines no entities; the name of a DTD may be given.

    Raises
    ------
    ValueError
        If it is no XML, is truncated, or defines entities, which could grow without bound or name
        other files.
    """
    definitions = expat.ParserCreate()
    definitions.EntityDeclHandler = _refuse_entity
    try:
        definitions.Parse(document, True)
        return ElementTree.fromstring(document)
    except (expat.ExpatError, ElementTree.ParseError) as error:
        raise ValueError(f"it is truncated or no XML: {error}") from error


def _refuse_entity(name: str, *_: object) -> None:
    raise ValueError(f"it defines the entity {name[:40]!r}, which no mesh needs")


def only_child(parent: ElementTree.Element, tag: str) -> ElementTree.Element:
    """Return the child of this kind, of which there must be exactly one."""
    children = parent.findall(tag)
    if len(children) != 1:
        raise ValueError(f"it has {len(children)} elements {tag} where there is one")
    return children[0]


def attribute(element: ElementTree.Element, name: str) -> str:
    """Return an attribute that must be there."""
    value = element.get(name)
    if value is None:
        raise ValueError(f"an element {element.tag} has no attribute {name}")
    return value


def count(element: ElementTree.Element, name: str, default: int | None = None) -> int:
    """Return an attribute that is a number of things."""
    text = element.get(name, None if default is None else str(default))
    longest = len(str(2**63))
    if text is None or not text.strip().isdecimal() or len(text) > longest:
        raise ValueError(f"the attribute {name} of {element.tag} is {text!r}, no count")
    return int(text)
