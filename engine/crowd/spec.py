"""What crowd is wanted: one set of names for Python, TOML files and the command line."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from dataclasses import replace as _replace
from math import isfinite
from numbers import Integral, Real
from pathlib import Path
from typing import Literal, cast, get_args

from ...components.team import MOST_SIDES
from ..errors import AssetError
from .bowl import MAX_SEATS
from .selection import parse_selection
from .settings_file import format_settings, read_settings
from .stand import MOST_ROWS, MOST_SEATS

Layout = Literal["bowl", "stand"]
Poses = Literal["streams", "baked", "none"]
Offsets = Literal["normal", "uniform"]
Fans = Literal["away block", "mixed", "blocks"]
Parties = Literal["football", "general"]
LAYOUTS: tuple[Layout, ...] = get_args(Layout)

_CHOICES: dict[str, tuple[str, ...]] = {
    "layout": LAYOUTS,
    "poses": get_args(Poses),
    "offsets": get_args(Offsets),
    "fans": get_args(Fans),
    "parties": get_args(Parties),
}

_WHOLE = {
    "seats": (1, MAX_SEATS),
    "rows": (1, MOST_ROWS),
    "columns": (1, MOST_ROWS),
    "sides": (1, MOST_SIDES),
    "streams": (1, 256),
    "spare_streams": (0, 256),
    "history": (2, 254),
    "slots": (0, 8192),
    "stewards": (0, 1000),
    "uniques": (0, 2048),
    "seed": (0, 2**63 - 1),
}
_FLAGS = ("rest_idle", "lod", "casting", "walking")
_REAL = {
    "step": (0.3, 10.0),
    "rise": (0.0, 10.0),
    "depth": (0.3, 10.0),
    "occupancy": (0.0, 1.0),
    "neutrals": (0.0, 1.0),
    "away_share": (0.0, 1.0),
    "children": (0.0, 1.0),
    "old": (0.0, 1.0),
    "women": (0.0, 1.0),
    "props": (0.0, 1.0),
    "tint": (0.0, 1.0),
    "ultras": (0.0, 1.0),
    "latecomers": (0.0, 1.0),
    "embarrassment": (0.0, 1.0),
}


def _help(text: str) -> Mapping[str, str]:
    return {"help": text}


@dataclass(frozen=True, slots=True, kw_only=True)
class CrowdSpec:
    """Everything that decides how many spectators there are, where, and for whom.

    Wrong values raise ValueError; whole and real numbers of NumPy are taken too. Every field's
    metadata has a one-line ``help`` text.

    Parameters
    ----------
    layout
        ``"bowl"`` uses `seats`; ``"stand"`` uses `rows`, `columns`, `step`, `rise`, `depth`. The
        values of the other layout are kept and have no effect.
    occupancy, empty, occupied
        Who is there, applied in this order: a random share `occupancy` of all seats is taken,
        then the seats of `empty` are cleared, then those of `occupied` are taken. The texts are
        explained in `selection`: ``"12|345"``, ``"rows 3-10"``, ``"section 5"``, ...
    sides, neutrals, away_share, fans
        The share `neutrals` of all seats supports nobody. With several sides `fans` says how their
        supporters sit: ``"away block"`` gives the share `away_share` of the seats to one contiguous
        block, which the sides but home divide among them; ``"mixed"`` draws every supporter's side,
        each as likely as the others; ``"blocks"`` gives each side an equal block of neighbours.
    ultras
        Share of home supporters who make more of everything and stand all match; three times as
        many of the others.
    parties
        Who comes with whom: ``"football"``, a quarter of the people alone and parties of four on
        average; or ``"general"``, mostly pairs. Children come with adults.
    behaviour
        Table of what people do: ``sport``, ``rock_concert``, ``classical_concert``, ``speech``, or
        a file.
    women
        Share of women among the grown-ups and of girls among the children; they have other bodies
        and hair where the character has such variants.
    embarrassment
        Of the whole crowd: nobody minds being seen at 0, everybody does at 1.
    latecomers
        Share of the people who come within the first five minutes and walk to their seats.
    stewards
        Stewards on the gangways; each has the agent of a seat that stays empty.
    walking
        Whether people can be told to come and go (`Crowd.arrive`, `Crowd.leave`); always where
        there are latecomers or stewards. It takes a bowl, streams, and a clip of walking.
    streams, history
        Animation streams and poses kept of each.
    spare_streams
        Further stream rows that are left free for motions of your own.
    slots, uniques
        Agents that can blend from the middle of another blend at once, and motions that are not
        shared, such as live ones.
    rest_idle
        Whether streams that nobody shows stop until somebody wants them again. What a stadium costs
        then follows from the motions that are in use; agents whose stream just woke play in step
        for a moment before they drift apart.
    props
        Share of a side's supporters who have a cap, a scarf, a flag, a foam hand or, among ultras,
        a drum in its colours. They are made for the built-in spectator; other characters have none.
    tint
        How much of the agents' colours characters take on whose materials don't say what they are,
        part by part; 0 leaves them as their file has them.
    casting
        Whether neighbours who were drawn too much alike swap clothes or motions with others.
    poses
        Whether motions are streamed, or every frame of every clip is baked beforehand. With
        ``"none"`` nobody has poses and nothing can be drawn: only what people do is stepped, many
        times faster than it happens. Getting up and sitting down take no time then.
    offsets
        How the agents of a stream are first spread over its history.
    seed
        Of all random choices.
    lod
        Whether levels of detail are used when drawing.
    character, motions
        Files, as written by the user; empty means the built-in spectator and motions.
    """

    layout: Layout = field(default="bowl", metadata=_help("bowl or stand"))
    seats: int = field(default=65_000, metadata=_help("seats of a bowl"))
    rows: int = field(default=10, metadata=_help("rows of a stand"))
    columns: int = field(default=20, metadata=_help("seats in each row of a stand"))
    step: float = field(default=1.5, metadata=_help("metres between neighbours of a stand"))
    rise: float = field(default=2.0, metadata=_help("metres that each row of a stand rises"))
    depth: float = field(default=2.0, metadata=_help("metres between the rows of a stand"))
    occupancy: float = field(default=0.96, metadata=_help("share of the seats taken, 0 to 1"))
    occupied: tuple[str, ...] = field(default=(), metadata=_help("seats taken in any case"))
    empty: tuple[str, ...] = field(default=(), metadata=_help("seats cleared"))
    sides: int = field(default=1, metadata=_help("supporting sides, 1 to 8"))
    neutrals: float = field(default=0.03, metadata=_help("share that supports nobody"))
    away_share: float = field(default=0.05, metadata=_help("share of the away block, with 2 sides"))
    children: float = field(default=0.06, metadata=_help("share of children"))
    old: float = field(default=0.1, metadata=_help("share of old people"))
    women: float = field(default=0.4, metadata=_help("share of women, and of girls"))
    fans: Fans = field(
        default="away block", metadata=_help("how sides sit: away block, mixed or blocks")
    )
    ultras: float = field(default=0.05, metadata=_help("share of supporters who are ultras"))
    parties: Parties = field(default="football", metadata=_help("party sizes: football or general"))
    behaviour: str = field(default="sport", metadata=_help("behaviour table: a name or a file"))
    embarrassment: float = field(default=0.25, metadata=_help("of the whole crowd, 0 to 1"))
    latecomers: float = field(default=0.0, metadata=_help("share of people who come late"))
    stewards: int = field(default=0, metadata=_help("stewards on the gangways, 0 to 1000"))
    walking: bool = field(default=False, metadata=_help("let people come and go"))
    streams: int = field(default=256, metadata=_help("animation streams, 1 to 256"))
    spare_streams: int = field(default=0, metadata=_help("further streams for your own motions"))
    history: int = field(default=60, metadata=_help("poses kept of each stream, 2 to 254"))
    slots: int = field(default=800, metadata=_help("transition slots, 0 to 8192"))
    uniques: int = field(default=64, metadata=_help("motions that are not shared, 0 to 2048"))
    rest_idle: bool = field(default=False, metadata=_help("stop streams that nobody shows"))
    props: float = field(
        default=0.35, metadata=_help("share of supporters with a cap, a scarf, a flag, ...")
    )
    tint: float = field(default=1.0, metadata=_help("colours of agents on imported characters"))
    casting: bool = field(default=True, metadata=_help("keep neighbours from being clones"))
    poses: Poses = field(default="streams", metadata=_help("streams, all frames baked, or none"))
    offsets: Offsets = field(
        default="normal", metadata=_help("first offsets on a stream: normal or uniform")
    )
    seed: int = field(default=1, metadata=_help("seed of all random choices"))
    lod: bool = field(default=True, metadata=_help("draw with levels of detail"))
    character: str = field(default="", metadata=_help("glTF file of the spectators"))
    motions: tuple[str, ...] = field(default=(), metadata=_help("files with motions"))

    def __post_init__(self) -> None:
        """Check every value and give it the field's own type."""
        for name in _NAMES:
            object.__setattr__(self, name, _clean(name, getattr(self, name)))
        if self.layout == "stand" and self.rows * self.columns > MOST_SEATS:
            raise ValueError(
                f"rows * columns must be at most {MOST_SEATS:,}, "
                f"not {self.rows} * {self.columns} = {self.rows * self.columns:,}"
            )
        if self.children + self.old > 1.0 + 1e-9:
            raise ValueError(f"children + old must be at most 1, not {self.children} + {self.old}")
        if (
            self.sides > 1
            and self.fans == "away block"
            and self.neutrals + self.away_share > 1.0 + 1e-9
        ):
            raise ValueError(
                "neutrals + away_share must be at most 1 with an away block, "
                f"not {self.neutrals} + {self.away_share}"
            )

    @property
    def seat_count(self) -> int:
        """Seats of the layout, taken or not."""
        return self.seats if self.layout == "bowl" else self.rows * self.columns

    @property
    def walks(self) -> bool:
        """Whether people can be on their way."""
        return self.walking or self.latecomers > 0.0 or self.stewards > 0

    def replace(self, **changes: object) -> CrowdSpec:
        """A copy with other values; ValueError also for a name that is not a field."""
        for name in changes:
            if name not in _NAMES:
                raise ValueError(f"{name} is not a field of CrowdSpec; fields: {', '.join(_NAMES)}")
        return _replace(self, **changes)  # type: ignore[arg-type]

    @classmethod
    def from_toml(cls, path: str | Path) -> CrowdSpec:
        """Read a file whose keys are the field names; a missing key has its default.

        Where `layout` is missing, `rows` or `columns` make it a stand. File names inside are kept
        as written.

        Raises
        ------
        AssetError
            With the line of the mistake: no TOML, an unknown key, a wrong type or value.
        """
        values, places = read_settings(path, _NAMES)
        for name, value in values.items():
            try:
                values[name] = _clean(name, value)
            except ValueError as error:
                raise AssetError(path, places[name], str(error)) from error
        if "layout" not in values and ("rows" in values or "columns" in values):
            values["layout"] = "stand"
        try:
            return cls().replace(**values)
        except ValueError as error:
            raise AssetError(path, "", str(error)) from error

    def to_toml(self) -> str:
        """The text that `from_toml` reads back as an equal spec; it names every field."""
        return format_settings({name: getattr(self, name) for name in _NAMES})


_NAMES = tuple(f.name for f in fields(CrowdSpec))


def _clean(name: str, value: object) -> object:
    """The value in the field's own type; ValueError names field, value and what is allowed."""
    if name in _CHOICES:
        if not isinstance(value, str) or value not in _CHOICES[name]:
            allowed = " or ".join(f"'{choice}'" for choice in _CHOICES[name])
            raise ValueError(f"{name} must be {allowed}, not {value!r}")
        return value
    if name in _FLAGS:
        if not isinstance(value, bool):
            raise ValueError(f"{name} must be true or false, not {value!r}")
        return value
    if name in _WHOLE:
        low, high = _WHOLE[name]
        good = isinstance(value, Integral) and not isinstance(value, bool)
        if not good or not low <= int(cast(int, value)) <= high:
            raise ValueError(f"{name} must be a whole number from {low} to {high}, not {value!r}")
        return int(cast(int, value))
    if name in _REAL:
        least, most = _REAL[name]
        good = isinstance(value, Real) and not isinstance(value, bool)
        if not good or not isfinite(cast(float, value)) or not least <= cast(float, value) <= most:
            raise ValueError(f"{name} must be a number from {least:g} to {most:g}, not {value!r}")
        return float(cast(float, value))
    if name in ("character", "behaviour"):
        if isinstance(value, Path):
            return str(value)
        if not isinstance(value, str):
            raise ValueError(f"{name} must be a file name, not {value!r}")
        return value
    return _clean_texts(name, value)


def _clean_texts(name: str, value: object) -> tuple[str, ...]:
    """A tuple of texts; those of `occupied` and `empty` must name seats."""
    texts = list(value) if isinstance(value, (list, tuple)) else None
    if texts is None or not all(isinstance(text, (str, Path)) for text in texts):
        raise ValueError(f"{name} must be a list of texts, not {value!r}")
    result = tuple(str(text) for text in texts)
    if name != "motions":
        for text in result:
            try:
                parse_selection(text)
            except ValueError as error:
                raise ValueError(f"{name}: {error}") from error
    return result
