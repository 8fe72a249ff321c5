"""Read TOML files into frozen pydantic models; one line names the key that is wrong."""

from __future__ import annotations

import difflib
import json
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeVar, cast, get_args, get_origin

from pydantic import BaseModel, ConfigDict, ValidationError
from pydantic_core import ErrorDetails

from eulerplateau.errors import OutputError, SpecError

if TYPE_CHECKING:
    from pydantic._internal._model_construction import ModelMetaclass as _ModelClass
else:
    _ModelClass = type(BaseModel)

_LONGEST_QUOTE = 60


class _Checked(_ModelClass):
    """Classes whose instances made in Python are checked as if read from TOML."""

    def __call__(self, **data: Any) -> Any:
        """Return an instance; raises SpecError, as `validate` does."""
        return validate(data, cast(type[Settings], self), self.__name__)


class Settings(BaseModel, metaclass=_Checked):
    """Base of everything read from TOML: frozen, strict, no unknown keys, no NaN.

    An integer is accepted where a float is meant, a list or an array where a tuple is, and
    a string where an enumeration or a path is; "3" is not 3. Made in Python too, what is
    wrong raises SpecError. Checks that a type cannot express raise ValueError in a
    pydantic validator.
    """

    model_config = ConfigDict(
        frozen=True, extra="forbid", strict=True, allow_inf_nan=False, validate_default=True
    )


Model = TypeVar("Model", bound=Settings)


def load_toml(path: str | Path, model: type[Model]) -> Model:
    """Read the TOML file `path` into `model`.

    Raises SpecError naming the key (or the file itself) that is wrong, OutputError if the
    file exists and cannot be read.
    """
    return validate(read_toml(path), model, str(path))


def read_toml(path: str | Path) -> dict[str, Any]:
    """Read the TOML file `path` as plain data; raises what `load_toml` raises."""
    try:
        text = Path(path).read_bytes()
    except FileNotFoundError:
        raise SpecError(str(path), "there is no such file") from None
    except IsADirectoryError:
        raise SpecError(str(path), "is a folder, not a TOML file") from None
    except OSError as error:
        raise OutputError(path, f"cannot be read: {error.strerror}") from None
    try:
        # Some editors begin a file with a mark of its byte order.
        return tomllib.loads(text.decode("utf-8-sig"))
    except (ValueError, RecursionError) as error:
        raise SpecError(str(path), f"is not valid TOML: {error}") from None


def validate(data: Mapping[str, Any], model: type[Model], source: str) -> Model:
    """Return `data` as an instance of `model`.

    Raises SpecError whose `key` is the dotted key at fault, or `source` (the file's path,
    or a word for where the data came from) if the data as a whole is wrong.
    """
    try:
        content = json.dumps(data, default=_plain)
    except (ValueError, RecursionError) as error:
        # Thousands of digits in a number, or of brackets in each other.
        raise SpecError(source, f"cannot be read: {error}") from None
    try:
        # JSON is the mode in which strict pydantic still takes lists for tuples and
        # strings for enumerations, which is all that TOML can offer.
        return model.model_validate_json(content)
    except ValidationError as error:
        raise _spec_error(error.errors(include_url=False), data, model, source) from None
    except SpecError as error:
        # From a validator that knows which of two sections to blame.
        key, problem = error.args
        raise SpecError(key, f"{problem} (in {source})") from None


def _plain(value: Any) -> Any:
    """Return arrays as lists, models as what they were given, anything else as a string."""
    if hasattr(value, "tolist"):
        return value.tolist()
    given = isinstance(value, BaseModel)
    return value.model_dump(exclude_unset=True) if given else str(value)


def _spec_error(
    errors: Sequence[ErrorDetails],
    data: Mapping[str, Any],
    model: type[Settings],
    source: str,
) -> SpecError:
    # A misspelt key is also reported as a missing one: the misspelling comes first.
    first = min(errors, key=lambda error: error["type"] != "extra_forbidden")
    # The branch of a union that fails deepest inside is the one that was meant.
    top = _key(first, data)
    inside = [e for e in errors if _key(e, data).startswith((f"{top}.", f"{top}["))]
    first = max([first, *inside], key=lambda error: len(error["loc"]))
    key = _key(first, data)
    if first["type"] == "extra_forbidden":
        problem = unknown_key(
            str(first["loc"][-1]), _allowed_keys(model, first["loc"][:-1])
        )
    elif first["type"] in ("missing", "union_tag_not_found"):
        problem = "is missing and has no default"
        field = model.model_fields.get(key)
        if field is not None and field.description:
            problem = f"is missing: it {field.description}"
    else:
        # The branches of a union fail one by one at the same key: any would be right.
        alike = [error for error in errors if _key(error, data) == key]
        problem = _mismatch(alike)
    if not key:
        return SpecError(source, problem)
    return SpecError(key, f"{problem} (in {source})")


def _key(error: ErrorDetails, data: Any) -> str:
    """Return the dotted TOML key; pydantic's location also holds names of union members."""
    key = ""
    for place, part in enumerate(error["loc"]):
        if isinstance(part, int) and isinstance(data, list) and part < len(data):
            key += f"[{part}]"
            data = data[part]
        elif isinstance(data, Mapping) and part in data:
            key += f".{part}"
            data = data[part]
        elif error["type"] == "missing" and place == len(error["loc"]) - 1:
            key += f".{part}"
    if error["type"] in ("union_tag_invalid", "union_tag_not_found"):
        key += "." + error["ctx"]["discriminator"].strip("'")
    return key.removeprefix(".")


def _mismatch(errors: Sequence[ErrorDetails]) -> str:
    first = errors[0]
    if first["type"] == "union_tag_invalid":
        tags = first["ctx"]["expected_tags"]
        return f"found '{first['ctx']['tag']}'; should be one of {tags}"
    if first["type"] == "too_short":
        expected = f"should hold {first['ctx']['min_length']} or more"
    elif first["type"] == "value_error":
        expected = str(first["ctx"]["error"])
    else:
        bare = dict.fromkeys(error["msg"].removeprefix("Input ") for error in errors)
        expected = " or ".join(bare).replace(" or should be ", " or ")
    if isinstance(first["input"], dict):
        return expected
    return f"found {_quote(first['input'])}; {expected}"


def unknown_key(name: str, allowed: Sequence[str]) -> str:
    """Return what is wrong with a key that is none of those allowed."""
    near = difflib.get_close_matches(name, allowed, n=1)
    hint = f"did you mean {near[0]!r}? " if near else ""
    return f"is not a known key; {hint}The keys here are {', '.join(allowed)}"


def _allowed_keys(model: type[BaseModel], place: Sequence[str | int]) -> list[str]:
    """Return the keys allowed at `place`, a pydantic location inside `model`."""
    models = [model]
    for part in place:
        if isinstance(part, int):
            continue
        inside = [
            nested
            for outer in models
            if part in outer.model_fields
            for nested in _models(outer.model_fields[part].annotation)
        ]
        tagged = [candidate for candidate in models if _has_tag(candidate, part)]
        models = inside or tagged or models
    return list(dict.fromkeys(name for m in models for name in m.model_fields))


def _models(annotation: Any) -> list[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [model for part in get_args(annotation) for model in _models(part)]


def choices(model: type[BaseModel], prefix: str = "") -> dict[str, tuple[str, ...]]:
    """Return the dotted keys of a specification, and of each the words it may be."""
    found: dict[str, tuple[str, ...]] = {}
    for name, field in model.model_fields.items():
        sections = _models(field.annotation)
        for section in sections:
            found |= choices(section, f"{prefix}{name}.")
        if not sections:
            found[f"{prefix}{name}"] = tuple(_words(field.annotation))
    return found


def _words(annotation: Any) -> Iterator[str]:
    if get_origin(annotation) is Literal:
        yield from (word for word in get_args(annotation) if isinstance(word, str))
    elif annotation is bool:
        yield from ("true", "false")
    else:
        for part in get_args(annotation):
            yield from _words(part)


def _has_tag(model: type[BaseModel], tag: str) -> bool:
    return any(tag in get_args(field.annotation) for field in model.model_fields.values())


def _quote(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=False, default=str)
    return text if len(text) <= _LONGEST_QUOTE else text[: _LONGEST_QUOTE - 3] + "..."
