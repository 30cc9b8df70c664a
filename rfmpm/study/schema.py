"""Walks the table models along a key's path: what is allowed there, in words, and what the default is."""

import operator
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

KeyPath = tuple[str | int, ...]
LIMITS = {  # in words, and whether a value keeps them
    "ge": ("at least", operator.ge),
    "gt": ("greater than", operator.gt),
    "le": ("at most", operator.le),
    "lt": ("less than", operator.lt),
}
NOUNS = {bool: "true or false", float: "a number", int: "a whole number", str: "text in quotes, not empty"}


@dataclass(frozen=True)
class Hint:
    """A remark on a key that belongs in its error message."""

    text: str


def bare(annotation: Any) -> Any:
    """Strip `Annotated` and `| None` from an annotation."""
    if get_origin(annotation) is Annotated:
        return bare(get_args(annotation)[0])
    if is_union(annotation):
        members = [member for member in get_args(annotation) if member is not type(None)]
        return bare(members[0]) if len(members) == 1 else annotation
    return annotation


def is_union(annotation: Any) -> bool:
    return get_origin(annotation) in (Union, UnionType)


def tables(annotation: Any) -> list[type[BaseModel]]:
    """The table models an annotation admits: none for a plain value, several where a key such as `kind` chooses."""
    annotation = bare(annotation)
    members = get_args(annotation) if is_union(annotation) else [annotation]
    return [member for member in members if isinstance(member, type) and issubclass(member, BaseModel)]


def tag_name(members: Sequence[type[BaseModel]]) -> str:
    """The key, such as `kind`, by whose value one of several tables is chosen."""
    return next(name for name, info in members[0].model_fields.items() if len(choices(info.annotation)) == 1)


def tag_of(member: type[BaseModel], name: str) -> str:
    return choices(member.model_fields[name].annotation)[0]


def choices(annotation: Any) -> tuple:
    annotation = bare(annotation)
    return get_args(annotation) if get_origin(annotation) is Literal else ()


def chosen(members: Sequence[type[BaseModel]], value: Any) -> type[BaseModel]:
    """The table among `members` that `value` asks for; KeyError if it asks for none of them."""
    if len(members) == 1:
        return members[0]
    name = tag_name(members)
    by_tag = {tag_of(member, name): member for member in members}
    return by_tag[value[name]]


def child(annotation: Any, value: Any, key: str | int) -> tuple[Any, FieldInfo | None]:
    """Annotation and field of what lies under `key`; KeyError if nothing can."""
    if members := tables(annotation):
        info = chosen(members, value).model_fields[key]
        return info.annotation, info
    arguments = get_args(bare(annotation))
    return (arguments[0] if isinstance(key, int) else arguments[1]), None


def field_at(annotation: Any, data: Any, path: KeyPath) -> tuple[Any, FieldInfo | None]:
    """Annotation and field at `path`, where `data` settles which of several tables is meant."""
    info = None
    for key in path:
        annotation, info = child(annotation, data, key)
        data = value_at(data, (key,), default={})
    return annotation, info


def value_at(data: Any, path: KeyPath, default: Any = None) -> Any:
    """What lies at `path` in nested dicts and lists, or `default`."""
    for key in path:
        try:
            data = data[key]
        except (KeyError, IndexError, TypeError):
            return default
    return data


def keys_of(annotation: Any, table: Any) -> list[str]:
    """The keys that `table` may have."""
    if members := tables(annotation):
        return list(chosen(members, table).model_fields)
    return list(choices(get_args(bare(annotation))[0]))


def allowed(annotation: Any, info: FieldInfo | None, with_type: bool = True) -> str:
    """Say what a key may hold: 'a number at least 0 and at most 0.49'."""
    kind = bare(annotation)
    metadata = _metadata(annotation, info)
    hints = "; ".join(entry.text for entry in metadata if isinstance(entry, Hint))
    if options := choices(kind):
        words = one_of(options)
    elif members := tables(kind):
        words = _table_in_words(members)
    elif get_origin(kind) is tuple:
        words = _list_in_words(get_args(kind))
    elif get_origin(kind) is dict:
        words = "a table of tables"
    else:
        limits = " and ".join(
            f"{bound} {_figure(getattr(entry, name))}"
            for name, (bound, _) in LIMITS.items()
            for entry in metadata
            if hasattr(entry, name)
        )
        words = f"{NOUNS[kind]} {limits}".strip() if with_type or not limits else limits
    return f"{words} ({hints})" if hints else words


def limits_of(annotation: Any, info: FieldInfo | None, name: str) -> list[float]:
    """The limits of one kind, a key of LIMITS, on a number."""
    return [getattr(entry, name) for entry in _metadata(annotation, info) if hasattr(entry, name)]


def _figure(limit: float) -> str:
    return str(limit) if isinstance(limit, int) else f"{limit:.10g}"


def one_of(options: Sequence, value: Any = None) -> str:
    """List what may be chosen, with a guess at what `value` was meant to be."""
    listed = ("one of " if len(options) > 1 else "") + ", ".join(shown(option) for option in options)
    names = [option for option in options if isinstance(option, str)]
    meant = near_miss(value, names) if len(options) > 1 and isinstance(value, str) else None
    return f"{listed} (did you mean {shown(meant)}?)" if meant else listed


def _list_in_words(members: Sequence) -> str:
    if tables(members[0]):
        return "a list of tables"
    count = "" if Ellipsis in members else f" of {len(members)}"
    return f"a list{count}, each {allowed(members[0], None)}"


def _table_in_words(members: Sequence[type[BaseModel]]) -> str:
    if len(members) == 1:
        return f"a table with the keys {', '.join(members[0].model_fields)}"
    name = tag_name(members)
    return f"a table with {name} = {one_of([tag_of(member, name) for member in members])}"


def _metadata(annotation: Any, info: FieldInfo | None) -> list:
    """All constraints on a value, those inside `Annotated[...]`, with or without `| None`, too."""
    found = list(info.metadata) if info else []
    inner = get_args(annotation) if is_union(annotation) else [annotation]
    for layer in (member for member in inner if get_origin(member) is Annotated):
        for entry in get_args(layer)[1:]:
            found += entry.metadata if isinstance(entry, FieldInfo) else [entry]
    return found


def shown(value: Any) -> str:
    """Write a value the way the study file does, shortened where it is long."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        text = '"' + value.replace("\n", "\\n") + '"'
    elif isinstance(value, dict):
        return "{...}" if value else "{}"
    elif isinstance(value, list | tuple):
        return "[...]" if value else "[]"
    else:
        text = "nothing" if value is None else repr(value)
    return text if len(text) <= 60 else text[:56] + " ..."


def near_miss(word: Any, candidates: Sequence[str], likeness: float = 0.6) -> str | None:
    """The candidate that `word` was probably meant to be, if one is alike enough."""
    by_lower = {candidate.lower(): candidate for candidate in candidates}
    found = get_close_matches(str(word).lower(), list(by_lower), n=1, cutoff=likeness)
    return by_lower[found[0]] if found else None
