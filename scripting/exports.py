"""Exports: attributes of nodes and resources that editors and files can set, checked at every set.

.. code:: python

    class Fan(Node3D):
        excitement: float = export(default=0.5, range=(0, 1))
        mood: Mood = export(default=Mood.CALM)  # an Enum
        songs: list[str] = export(default_factory=list)

A class with exports is made like a dataclass with keyword arguments: ``Fan(excitement=0.8)``.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable, Sequence
from difflib import get_close_matches
from typing import Any, ClassVar, ForwardRef, TypeVar, dataclass_transform, get_origin, overload

from .export_types import WrongValueError, accept, describe

T = TypeVar("T")
_MISSING: Any = object()


class Export:
    """One exported attribute.

    Attributes
    ----------
    name, owner
        Of the attribute, and the class that declares it.
    range
        Least and greatest value, and the step for editors; None where unlimited.
    choices
        Values that are allowed; None for all.
    group
        Heading under which editors show it.
    """

    def __init__(
        self,
        default: Any,
        factory: Any,
        limits: tuple[float, ...] | None,
        choices: tuple[Any, ...] | None,
        group: str,
        changed: str,
    ) -> None:
        self.name = ""
        self.owner: type = object
        self.range, self.choices, self.group = limits, choices, group
        self._default, self._factory, self._changed = default, factory, changed
        self._kind: Any = _MISSING

    def __set_name__(self, owner: Any, name: str) -> None:
        """Called by Python with the name in the class."""
        self.name, self.owner = name, owner

    def __repr__(self) -> str:
        """For messages."""
        return f"export {self.owner.__name__}.{self.name}"

    def __get__(self, instance: Any, owner: type) -> Any:
        """The value of one instance."""
        if instance is None:
            return self
        try:
            return instance.__dict__[self.name]
        except KeyError:
            if self.is_required:
                raise AttributeError(f"{self!r} was never set and has no default") from None
            # Set when first asked for, so that every instance has a list of its own.
            value = instance.__dict__[self.name] = self.check(self.default)
            return value

    def __set__(self, instance: Any, value: Any) -> None:
        """Check and store the value of one instance."""
        instance.__dict__[self.name] = self.check(value)
        if self._changed:
            getattr(instance, self._changed)()

    @property
    def is_required(self) -> bool:
        """Whether it has no default and must be given."""
        return self._default is _MISSING and self._factory is _MISSING

    @property
    def default(self) -> Any:
        """The default value, a new one of a factory; ValueError if there is none."""
        if self.is_required:
            raise ValueError(f"{self!r} has no default")
        return self._default if self._factory is _MISSING else self._factory()

    @property
    def type(self) -> Any:
        """The annotation, or the default's class where the annotation can't be looked up."""
        if self._kind is _MISSING:
            self._kind = _lookup(self.owner, self.name)
            if self._kind is _MISSING:
                if self.is_required or self.default is None:
                    raise ValueError(
                        f"{self!r}: its annotation can't be looked up from its module; "
                        "give it a default of that type"
                    )
                self._kind = type(self.default)
        return self._kind

    @property
    def allowed(self) -> str:
        """What may be set, for messages: ``a number from 0 to 1``."""
        if self.choices is not None:
            return f"one of {', '.join(map(repr, self.choices))}"
        text = describe(self.type)
        return f"{text} from {self.range[0]:.9g} to {self.range[1]:.9g}" if self.range else text

    def check(self, value: Any) -> Any:
        """`value` as it is stored; ValueError with what is allowed if it isn't."""
        try:
            accepted = accept(self.type, value)
        except WrongValueError:
            self.refuse(value)
        if self.choices is not None and accepted not in self.choices:
            self.refuse(value)
        limits = self.range if accepted is not None else None
        if limits and not limits[0] <= accepted <= limits[1]:
            self.refuse(value)
        return accepted

    def refuse(self, value: Any) -> None:
        """Raise the error for a wrong `value`."""
        raise ValueError(
            f"{self.owner.__name__}.{self.name} is {value!r}, expected {self.allowed}"
        ) from None


@overload
def export(
    *,
    default: T,
    range: tuple[float, float] | tuple[float, float, float] | None = None,
    choices: Sequence[T] | None = None,
    group: str = "",
    changed: str = "",
) -> T: ...
@overload
def export(
    *,
    default_factory: Callable[[], T],
    choices: Sequence[T] | None = None,
    group: str = "",
    changed: str = "",
) -> T: ...
@overload
def export(
    *,
    range: tuple[float, float] | tuple[float, float, float] | None = None,
    choices: Sequence[Any] | None = None,
    group: str = "",
    changed: str = "",
) -> Any: ...
def export(
    *,
    default: Any = _MISSING,
    default_factory: Any = _MISSING,
    range: tuple[float, ...] | None = None,
    choices: Sequence[Any] | None = None,
    group: str = "",
    changed: str = "",
) -> Any:
    """Declare an exported attribute; its annotation says what it may hold.

    Parameters
    ----------
    default, default_factory
        Its value if none is given, or what makes one. With neither it must be given.
    range
        Least and greatest value, and the step that editors offer.
    choices
        The values that are allowed.
    group
        Heading under which editors show it.
    changed
        Name of a method that is called after every set.

    Raises
    ------
    ValueError
        If the arguments contradict each other.
    """
    if default is not _MISSING and default_factory is not _MISSING:
        raise ValueError("an export has a default or a default_factory, not both")
    if isinstance(default, (list, dict, set)):
        raise ValueError(
            f"default is {default!r}, which all instances would share; "
            "use default_factory=lambda: ..."
        )
    if range is not None and (len(range) not in (2, 3) or not range[0] <= range[1]):
        raise ValueError(f"range is {range!r}, expected (least, greatest) or (..., step)")
    picked = None if choices is None else tuple(choices)
    return Export(default, default_factory, range, picked, group, changed)


@dataclass_transform(kw_only_default=True, eq_default=False, field_specifiers=(export,))
class Exported:
    """Base of what has exports: keyword arguments for them and for annotated attributes."""

    _exports: ClassVar[dict[str, Export]] = {}
    _fields: ClassVar[frozenset[str]] = frozenset()
    _accepted: ClassVar[frozenset[str]] = frozenset()

    def __init__(self, **values: Any) -> None:
        exports, fields = type(self)._exports, type(self)._fields
        for name, value in values.items():
            if name not in exports and name not in fields and name not in self._accepted:
                raise TypeError(f"{type(self).__name__} has no {unknown(name, [*fields])}")
            setattr(self, name, value)
        for name, spec in exports.items():
            if spec.is_required and name not in values:
                raise TypeError(f"{type(self).__name__} needs {name}: {spec.allowed}")

    def __init_subclass__(cls, **arguments: Any) -> None:
        """Note what a new class declares."""
        super().__init_subclass__(**arguments)
        exports, fields = dict(cls._exports), set(cls._fields)
        for name, annotation in _annotations(cls).items():
            if _is_class_variable(annotation):
                continue
            value = cls.__dict__.get(name, _MISSING)
            if isinstance(value, (list, dict, set)):
                raise ValueError(
                    f"{cls.__name__}.{name} is {value!r}, which all instances would share; "
                    "use export(default_factory=lambda: ...)"
                )
            fields.add(name)
        for name, value in cls.__dict__.items():
            if isinstance(value, Export):
                exports[name] = value
                fields.add(name)
            elif name in exports and not name.startswith("__"):
                del exports[name]  # a subclass put something else in its place
        cls._exports, cls._fields = exports, frozenset(fields)

    @classmethod
    def _check_names(cls, name: str, value: Any) -> None:
        """Raise ValueError or AssetError if a value from a file names another that isn't there."""


def exports_of(cls: type) -> dict[str, Export]:
    """Exports of a class by name: those of its bases first, in the order of declaration."""
    if not (isinstance(cls, type) and issubclass(cls, Exported)):
        raise ValueError(f"cls is {cls!r}, expected a class of nodes or resources")
    return dict(cls._exports)


def unknown(name: str, known: Sequence[str]) -> str:
    """``'speeed'; did you mean speed?``"""
    near = get_close_matches(name, [word for word in known if not word.startswith("_")], n=3)
    if near:
        return f"'{name}'; did you mean {' or '.join(near)}?"
    shown = ", ".join(sorted(word for word in known if not word.startswith("_"))[:12])
    return f"'{name}'; known: {shown}" if shown else f"'{name}'; there are none"


def _annotations(cls: type) -> dict[str, Any]:
    if sys.version_info >= (3, 14):
        import annotationlib

        return dict(annotationlib.get_annotations(cls, format=annotationlib.Format.FORWARDREF))
    return dict(inspect.get_annotations(cls))


def _is_class_variable(annotation: Any) -> bool:
    if isinstance(annotation, ForwardRef):
        annotation = annotation.__forward_arg__
    if isinstance(annotation, str):
        return annotation.partition("[")[0].rpartition(".")[2].strip() == "ClassVar"
    return annotation is ClassVar or get_origin(annotation) is ClassVar


def _lookup(owner: type, name: str) -> Any:
    """The evaluated annotation, or `_MISSING` if it names what its module doesn't have."""
    annotation = _annotations(owner).get(name, _MISSING)
    if isinstance(annotation, ForwardRef):
        annotation = annotation.__forward_arg__
    if not isinstance(annotation, str):
        return annotation
    module = sys.modules.get(owner.__module__)
    try:
        return eval(annotation, dict(vars(module)) if module else {}, dict(vars(owner)))
    except Exception:
        return _MISSING
