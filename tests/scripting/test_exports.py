"""Exports: what may be set, what is refused and how that is said."""

from __future__ import annotations

from enum import Enum
from typing import Any, ClassVar, Literal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tifo import Node, Node3D, Quaternion, Resource, Vector3, export, exports_of


class Mood(Enum):
    """Of a fan."""

    CALM = 1
    ANGRY = 2


class Kit(Resource):
    """Shirt and number."""

    colour: str = export(default="red")
    number: int = export(default=10, range=(1, 99))


class Fan(Node3D):
    """Has exports of all kinds."""

    excitement: float = export(default=0.5, range=(0, 1, 0.05), group="Feelings")
    age: int = export(default=30, range=(0, 120))
    loud: bool = export(default=False)
    song: str = export(default="la")
    mood: Mood = export(default=Mood.CALM)
    side: str = export(default="home", choices=("home", "away"))
    corner: Literal["n", "s"] = export(default="n")
    kit: Kit | None = export(default=None)
    friend: Node | None = export(default=None)
    songs: list[str] = export(default_factory=list)
    pair: tuple[int, float] = export(default=(1, 2.0))
    marks: dict[str, int] = export(default_factory=dict)
    speed: float = export(default=1.0, changed="_speed_changed")
    hits: int = 0
    shared: ClassVar[int] = 5

    def _speed_changed(self) -> None:
        self.hits += 1


def test_they_are_listed_with_their_bases_first() -> None:
    listed = exports_of(Fan)
    assert [*listed][:6] == [
        *("process_mode", "process_priority", "position", "rotation", "scale", "top_level")
    ]
    excitement = listed["excitement"]
    assert excitement.type is float
    assert (excitement.default, excitement.range, excitement.group) == (
        0.5,
        (0, 1, 0.05),
        "Feelings",
    )
    assert listed["mood"].type is Mood
    assert listed["side"].choices == ("home", "away")
    assert "hits" not in listed
    assert "shared" not in listed
    with pytest.raises(ValueError, match="cls is"):
        exports_of(int)


def test_constructor_and_defaults() -> None:
    fan = Fan(name="Ann", excitement=1, hits=3, position=(1, 2, 3))  # type: ignore[arg-type]
    assert (fan.name, fan.excitement, fan.hits) == ("Ann", 1.0, 3)
    assert type(fan.excitement) is float
    assert fan.position == Vector3(1.0, 2.0, 3.0)
    assert fan.mood is Mood.CALM
    fan.songs.append("x")
    assert Fan().songs == []
    assert fan.songs == ["x"]


GOOD: list[tuple[str, Any, Any]] = [
    ("excitement", np.float32(0.25), 0.25),
    ("age", np.int64(3), 3),
    ("mood", Mood.ANGRY, Mood.ANGRY),
    ("songs", ("a", "b"), ["a", "b"]),
    ("pair", [3, 4], (3, 4.0)),
    ("marks", {"a": 1}, {"a": 1}),
    ("position", np.array([1.0, 2.0, 3.0]), Vector3(1.0, 2.0, 3.0)),
    ("rotation", (0, 0, 0, 2), Quaternion(0.0, 0.0, 0.0, 1.0)),
    ("kit", None, None),
]


@pytest.mark.parametrize(("name", "value", "stored"), GOOD)
def test_what_fits_is_stored_in_its_type(name: str, value: Any, stored: Any) -> None:
    fan = Fan()
    setattr(fan, name, value)
    assert getattr(fan, name) == stored
    assert type(getattr(fan, name)) is type(stored)


BAD: list[tuple[str, Any, str]] = [
    ("excitement", 1.5, "Fan.excitement is 1.5, expected a number from 0 to 1"),
    ("excitement", float("nan"), "a number from 0 to 1"),
    ("excitement", "0.5", "a number from 0 to 1"),
    ("excitement", True, "a number"),
    ("age", 30.5, "Fan.age is 30.5, expected a whole number from 0 to 120"),
    ("age", True, "a whole number"),
    ("loud", 1, "true or false"),
    ("song", 3, "a text"),
    ("mood", "ANGRY", "one of CALM, ANGRY"),
    ("side", "left", "one of 'home', 'away'"),
    ("corner", "w", "one of 'n', 's'"),
    ("kit", 3, "a Kit or nothing"),
    ("songs", "abc", "a list of: a text"),
    ("songs", [1], "a list of: a text"),
    ("pair", (1, 2, 3), "[a whole number, a number]"),
    ("marks", {"a": "b"}, "a table of: a whole number"),
    ("position", (1, 2), "three numbers"),
    ("position", (1, 2, float("inf")), "three numbers"),
    ("position", Vector3(0.0, float("nan"), 0.0), "three numbers"),
    ("rotation", (0, 0, 0, 0), "four numbers"),
]


@pytest.mark.parametrize(("name", "value", "message"), BAD)
def test_what_does_not_fit_is_refused(name: str, value: Any, message: str) -> None:
    fan = Fan()
    before = getattr(fan, name)
    with pytest.raises(ValueError, match="expected") as caught:
        setattr(fan, name, value)
    assert message in str(caught.value)
    assert getattr(fan, name) == before
    with pytest.raises(ValueError, match="expected"):
        Fan(**{name: value})


@given(st.floats(allow_nan=True, allow_infinity=True))
def test_the_range_holds_for_every_float(value: float) -> None:
    fan = Fan()
    if 0.0 <= value <= 1.0:
        fan.excitement = value
        assert fan.excitement == value
    else:
        with pytest.raises(ValueError, match="from 0 to 1"):
            fan.excitement = value


def test_a_change_is_told() -> None:
    fan = Fan()
    fan.speed = 2.0
    fan.speed = 2.0
    assert fan.hits == 2


def test_unknown_arguments_get_suggestions() -> None:
    with pytest.raises(TypeError, match=r"Fan has no 'excitment'; did you mean excitement\?"):
        Fan(excitment=1)  # type: ignore[call-arg]


def test_exports_without_default_must_be_given() -> None:
    class Needs(Node):
        team: int = export(range=(0, 3))

    assert Needs(team=2).team == 2
    with pytest.raises(TypeError, match="Needs needs team: a whole number from 0 to 3"):
        Needs()


def test_traps_are_refused_when_a_class_is_made() -> None:
    with pytest.raises(ValueError, match="would share"):
        export(default=[])
    with pytest.raises(ValueError, match="not both"):
        export(default=1, default_factory=int)  # type: ignore[call-overload]
    with pytest.raises(ValueError, match="range is"):
        export(default=1, range=(3, 1))
    with pytest.raises(ValueError, match="would share"):

        class Shares(Node):
            items: list[int] = []  # noqa: RUF012


def test_annotations_of_local_classes_come_from_the_default() -> None:
    class Local(Enum):
        A = 1

    class Uses(Node):
        kind: Local = export(default=Local.A)
        other: Local | None = export(default=None)

    assert exports_of(Uses)["kind"].type is Local
    with pytest.raises(ValueError, match="can't be looked up"):
        _ = exports_of(Uses)["other"].type


def test_subclasses_override() -> None:
    class Child(Fan):
        age: int = export(default=9, range=(0, 17))

    assert Child().age == 9
    assert [*exports_of(Child)].count("age") == 1
    with pytest.raises(ValueError, match="from 0 to 17"):
        Child(age=30)


def test_duplicates_of_resources() -> None:
    class Wardrobe(Resource):
        kit: Kit | None = export(default=None)
        tags: list[str] = export(default_factory=list)

    one = Wardrobe(kit=Kit(number=7), tags=["a"])
    shallow, deep = one.duplicate(), one.duplicate(deep=True)
    assert shallow.kit is one.kit
    assert deep.kit is not one.kit
    assert deep.kit is not None
    assert deep.kit.number == 7
    shallow.tags.append("b")
    assert one.tags == ["a"]
    with pytest.raises(ValueError, match="from 1 to 99"):
        shallow.kit.number = 0  # type: ignore[union-attr]
