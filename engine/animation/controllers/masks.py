"""Blend masks: which joints an overlay moves, and how much of each (*Streams 2017*, equation 3)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..skeleton import Skeleton
from .checks import Label, check_controller, check_name, check_range
from .nodes import Children, Controller

_MASK, _OVERLAY = Label("a Mask's"), Label("an Overlay's")


@dataclass(frozen=True, slots=True)
class Mask:
    """Weights of joints, by name.

    Parameters
    ----------
    weights
        Weight of each named joint, 0 to 1.
    descendants
        Whether a weight also holds for the joints below, down to the next named one. Otherwise
        all joints that aren't named have 0.
    """

    weights: Mapping[str, float]
    descendants: bool = True

    def __post_init__(self) -> None:
        """Check the values."""
        object.__setattr__(self, "weights", dict(self.weights))
        if not self.weights:
            raise ValueError("a Mask's weights are empty, expected at least one joint")
        if not isinstance(self.descendants, bool):
            raise ValueError(f"a Mask's descendants is {self.descendants!r}, expected a bool")
        for joint, weight in self.weights.items():
            check_name(_MASK, "joint", joint)
            check_range(_MASK, f"weights[{joint!r}]", weight, 0.0, 1.0)

    def of(self, skeleton: Skeleton) -> NDArray[np.float32]:
        """(J,) float32 weights of a skeleton's joints.

        Raises
        ------
        ValueError
            If the skeleton has no joint of a name; near ones are named.
        """
        out = np.full(skeleton.joint_count, -1.0, np.float32)
        for joint, weight in self.weights.items():
            out[skeleton.index(joint)] = weight
        for child in np.flatnonzero(out < 0):  # parents come before their children
            parent = skeleton.parents[child]
            out[child] = out[parent] if self.descendants and parent >= 0 else 0.0
        return out


@dataclass(frozen=True, slots=True)
class Overlay:
    """One layer of a `Masked`: a controller, the joints it moves, and how much it begins with."""

    node: Controller
    mask: Mask
    amount: float = 1.0

    def __post_init__(self) -> None:
        """Check the values."""
        check_controller(_OVERLAY, "node", self.node)
        check_range(_OVERLAY, "amount", self.amount, 0.0, 1.0)
        if not isinstance(self.mask, Mask):
            raise ValueError(f"an Overlay's mask is {self.mask!r}, expected a Mask")


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Masked(Controller):
    """Equation 3: overlays that move some joints of a base.

    Each overlay in turn is blended over the result so far, joint by joint by ``amount`` times its
    mask; masks that don't overlap give the sum of equation 3. Parameter ``amount`` (0 to 1); with
    several overlays it has one number each, and ``amount/0`` sets one.

    Parameters
    ----------
    base
        What moves all joints.
    overlays
        One `Overlay` or several, the later ones on top. A node in it without a name is called
        ``overlay``, or ``overlay_0``, ``overlay_1``, ... if there are several.
    """

    base: Controller
    overlays: Sequence[Overlay] | Overlay

    def __post_init__(self) -> None:
        """Check the values."""
        given = self.overlays
        layers = (given,) if isinstance(given, Overlay) else tuple(given)
        object.__setattr__(self, "overlays", layers)
        check_controller(self, "base", self.base)
        if not layers:
            raise ValueError(f"{self!r} overlays is empty, expected at least one")
        for layer in layers:
            if not isinstance(layer, Overlay):
                raise ValueError(f"{self!r} has {layer!r} among its overlays, expected an Overlay")

    @property
    def layers(self) -> tuple[Overlay, ...]:
        """The overlays, always as a tuple."""
        return (self.overlays,) if isinstance(self.overlays, Overlay) else tuple(self.overlays)

    def children(self) -> Children:
        """The base and the overlays' nodes."""
        layers = self.layers
        places = ["overlay"] if len(layers) == 1 else [f"overlay_{k}" for k in range(len(layers))]
        over = [(place, layer.node) for place, layer in zip(places, layers, strict=True)]
        return (("base", self.base), *over)
