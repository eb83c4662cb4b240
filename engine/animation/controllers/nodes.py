"""Controllers as data: the trees that a stream evaluates once a pose tick (*Streams 2017*, 3.4).

A node is a frozen description without state, so one tree, or one part of a tree, may serve any
number of streams and stand in several places. What changes while it plays (parameters, times, the
state of a machine) is kept in columns of the evaluation plan, one set a stream. Parameters are
named by the path of their node: ``"top/amount"``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from .checks import check_controller, check_name, check_range

Children = Sequence[tuple[str, "Controller"]]
"""Children with the name of their place, which names a child that has no name of its own."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Controller:
    """What all nodes share.

    Parameters
    ----------
    name
        Part of the paths of its parameters; a node without one is called by its place in its
        parent. The root's name may stay empty, its parameters then have no prefix.
    """

    name: str = field(default="", kw_only=True)

    def children(self) -> Children:
        """The nodes below, each with the name of its place."""
        return ()

    def __repr__(self) -> str:
        """Type and name; never the tree below, which may be deep."""
        return f"<{type(self).__name__} {self.name!r}>"


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ClipNode(Controller):
    """A leaf that plays a clip of the bank.

    Parameter ``speed`` (any finite number; negative plays backwards).

    Parameters
    ----------
    clip
        The clip's name.
    speed
        What ``speed`` begins with.
    loop
        Whether time wraps at the clip's end; as the clip says if None.
    phase
        Where the clip begins, 0 to 1 of its duration: 0.25 in a 2 s clip is 0.5 s.
    """

    clip: str
    speed: float = 1.0
    loop: bool | None = None
    phase: float = 0.0

    def __post_init__(self) -> None:
        """Check the values."""
        check_name(self, "clip", self.clip)
        check_range(self, "speed", self.speed)
        check_range(self, "phase", self.phase, 0.0, 1.0)
        if self.loop is not None and not isinstance(self.loop, bool):
            raise ValueError(f"{self!r} loop is {self.loop!r}, expected true, false or none")


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Blend2(Controller):
    """Equation 2: ``P = Pa + (Pb - Pa) amount``, rotations by the shortest path, renormalised.

    Parameter ``amount`` (0 to 1). At 0 only `a` is evaluated, at 1 only `b`; what isn't evaluated
    doesn't advance.

    Parameters
    ----------
    a, b
        The two children.
    amount
        What ``amount`` begins with.
    """

    a: Controller
    b: Controller
    amount: float = 0.0

    def __post_init__(self) -> None:
        """Check the values."""
        check_controller(self, "a", self.a)
        check_controller(self, "b", self.b)
        check_range(self, "amount", self.amount, 0.0, 1.0)

    def children(self) -> Children:
        """Both children, ``a`` and ``b``."""
        return (("a", self.a), ("b", self.b))


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class BlendN(Controller):
    """A weighted mean of any number of children.

    Parameter ``weights`` (>= 0 each; ``weights/0`` sets one). They are divided by their sum; while
    all are 0 the first child plays. Rotations are added in order of the children, each in the
    hemisphere of the sum so far, and renormalised.

    Parameters
    ----------
    nodes
        At least one child; a child without a name is called by its number.
    weights
        What ``weights`` begins with; all 1 if empty.
    """

    nodes: Sequence[Controller]
    weights: Sequence[float] = ()

    def __post_init__(self) -> None:
        """Check the values."""
        object.__setattr__(self, "nodes", tuple(self.nodes))
        object.__setattr__(self, "weights", tuple(self.weights) or (1.0,) * len(self.nodes))
        if not self.nodes:
            raise ValueError(f"{self!r} nodes is empty, expected at least one child")
        if len(self.weights) != len(self.nodes):
            raise ValueError(
                f"{self!r} has {len(self.weights)} weights for {len(self.nodes)} children"
            )
        for number, (node, weight) in enumerate(zip(self.nodes, self.weights, strict=True)):
            check_controller(self, f"nodes[{number}]", node)
            check_range(self, f"weights[{number}]", weight, 0.0)

    def children(self) -> Children:
        """All children, called by their numbers."""
        return tuple((str(number), node) for number, node in enumerate(self.nodes))


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class TimeScale(Controller):
    """Lets time run faster or slower below it.

    Parameter ``scale`` (any finite number): 0 holds, negative reverses.

    Parameters
    ----------
    node
        The child.
    scale
        What ``scale`` begins with.
    """

    node: Controller
    scale: float = 1.0

    def __post_init__(self) -> None:
        """Check the values."""
        check_controller(self, "node", self.node)
        check_range(self, "scale", self.scale)

    def children(self) -> Children:
        """The child, ``node``."""
        return (("node", self.node),)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Additive(Controller):
    """Puts the difference between a pose and a reference on top of another pose.

    With the reference R, ``q = q_base * nlerp(1, q_R^-1 q_add, amount)``,
    ``t = t_base + (t_add - t_R) amount`` and ``s = s_base (1 + (s_add / s_R - 1) amount)``.
    Parameter ``amount`` (0 to 1).

    Parameters
    ----------
    base, add
        The children.
    amount
        What ``amount`` begins with.
    reference
        Clip whose pose is R; the skeleton's rest pose if empty.
    reference_time
        Seconds into the reference clip.
    """

    base: Controller
    add: Controller
    amount: float = 1.0
    reference: str = ""
    reference_time: float = 0.0

    def __post_init__(self) -> None:
        """Check the values."""
        check_controller(self, "base", self.base)
        check_controller(self, "add", self.add)
        check_range(self, "amount", self.amount, 0.0, 1.0)
        check_range(self, "reference_time", self.reference_time)
        if not isinstance(self.reference, str):
            raise ValueError(f"{self!r} reference is {self.reference!r}, expected a clip's name")

    def children(self) -> Children:
        """The children, ``base`` and ``add``."""
        return (("base", self.base), ("add", self.add))


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class OneShot(Controller):
    """Plays one child over the other once whenever it is asked to.

    Parameter ``request``: ``"fire"`` (1), ``"abort"`` (2) or ``"fade_out"`` (3), back to 0 once it
    was seen. To be read: ``active``. The shot starts anew at each "fire", fades in over `fadein`
    seconds, and fades out so that it ends with its leading clip; one without a clip lasts until it
    is told to stop. Where the shot covers the base wholly, the base isn't evaluated and waits.

    Parameters
    ----------
    base, shot
        The children.
    fadein, fadeout
        Seconds, 0 or more.
    """

    base: Controller
    shot: Controller
    fadein: float = 0.0
    fadeout: float = 0.0

    def __post_init__(self) -> None:
        """Check the values."""
        check_controller(self, "base", self.base)
        check_controller(self, "shot", self.shot)
        check_range(self, "fadein", self.fadein, 0.0)
        check_range(self, "fadeout", self.fadeout, 0.0)

    def children(self) -> Children:
        """The children, ``base`` and ``shot``."""
        return (("base", self.base), ("shot", self.shot))
