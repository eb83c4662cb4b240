"""Transition curves of tweens: Robert Penner's equations with the constants that Godot uses.

Each is written for a change from 0 to 1 within a time from 0 to 1. Source: R. Penner, *Programming
Macromedia Flash MX*, chapter 7; http://robertpenner.com/easing.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from enum import IntEnum

Curve = Callable[[float], float]


class Trans(IntEnum):
    """Shape of a transition; Godot's ``TRANS_*``."""

    LINEAR = 0
    SINE = 1
    QUINT = 2
    QUART = 3
    QUAD = 4
    EXPO = 5
    ELASTIC = 6
    CUBIC = 7
    CIRC = 8
    BOUNCE = 9
    BACK = 10
    SPRING = 11


class Ease(IntEnum):
    """At which end a transition is slow; Godot's ``EASE_*``."""

    IN = 0
    OUT = 1
    IN_OUT = 2
    OUT_IN = 3


def ease(t: float, trans: Trans, how: Ease) -> float:
    """Share of the change that is done after the share `t` of the time.

    Half way through ``QUAD``, ``IN`` it is 0.25. Some curves leave [0, 1] on their way.

    Raises
    ------
    ValueError
        If `t` is not in [0, 1].
    """
    if not 0.0 <= t <= 1.0:
        raise ValueError(f"t is {t}, expected 0 to 1")
    return CURVES[trans][how](t)


def _power(exponent: int) -> Curve:
    return lambda t: math.pow(t, exponent)


def _sine(t: float) -> float:
    return 1.0 - math.cos(t * math.pi / 2.0)


def _circ(t: float) -> float:
    return 1.0 - math.sqrt(max(1.0 - t * t, 0.0))


def _flip(curve: Curve) -> Curve:
    """The same from the other end: an *out* of an *in*."""
    return lambda t: 1.0 - curve(1.0 - t)


def _halves(first: Curve, second: Curve) -> Curve:
    """One curve over the first half, another over the second."""
    return lambda t: first(2.0 * t) / 2.0 if t < 0.5 else 0.5 + second(2.0 * t - 1.0) / 2.0


# Exponentials start at 2^-10 instead of 0; Godot's corrections shift or scale that away.
def _expo_in(t: float) -> float:
    return 0.0 if t == 0.0 else math.pow(2.0, 10.0 * (t - 1.0)) - 0.001


def _expo_out(t: float) -> float:
    return 1.0 if t == 1.0 else 1.001 * (1.0 - math.pow(2.0, -10.0 * t))


def _expo_in_out(t: float) -> float:
    if t in (0.0, 1.0):
        return t
    if t < 0.5:
        return math.pow(2.0, 10.0 * (2.0 * t - 1.0)) / 2.0 - 0.0005
    return 1.0005 / 2.0 * (2.0 - math.pow(2.0, -10.0 * (2.0 * t - 1.0)))


def _elastic_in(t: float) -> float:
    if t in (0.0, 1.0):
        return t
    return -(math.pow(2.0, 10.0 * (t - 1.0))) * math.sin((t - 1.0 - 0.075) * math.tau / 0.3)


def _elastic_in_out(t: float) -> float:
    if t in (0.0, 1.0):
        return t
    u = 2.0 * t - 1.0
    wave = math.sin((u - 0.1125) * math.tau / 0.45)
    return (
        -0.5 * math.pow(2.0, 10.0 * u) * wave
        if u < 0.0
        else 0.5 * math.pow(2.0, -10.0 * u) * wave + 1.0
    )


def _bounce_out(t: float) -> float:
    if t < 1.0 / 2.75:
        return 7.5625 * t * t
    for end, middle, floor in ((2.0, 1.5, 0.75), (2.5, 2.25, 0.9375)):
        if t < end / 2.75:
            return 7.5625 * (t - middle / 2.75) ** 2 + floor
    return 7.5625 * (t - 2.625 / 2.75) ** 2 + 0.984375


def _back(overshoot: float) -> Curve:
    return lambda t: t * t * ((overshoot + 1.0) * t - overshoot)


def _spring_out(t: float) -> float:
    rest = 1.0 - t
    swing = math.sin(t * math.pi * (0.2 + 2.5 * t * t * t)) * math.pow(rest, 2.2)
    return (swing + t) * (1.0 + 1.2 * rest)


def _family(into: Curve, in_out: Curve | None = None) -> tuple[Curve, Curve, Curve, Curve]:
    """In, out, in-out and out-in of a curve whose *out* is its *in* flipped."""
    out = _flip(into)
    return into, out, in_out or _halves(into, out), _halves(out, into)


def _linear(t: float) -> float:
    return t


CURVES: dict[Trans, tuple[Curve, Curve, Curve, Curve]] = {
    Trans.LINEAR: (_linear, _linear, _linear, _linear),
    Trans.SINE: _family(_sine),
    Trans.QUINT: _family(_power(5)),
    Trans.QUART: _family(_power(4)),
    Trans.QUAD: _family(_power(2)),
    Trans.EXPO: (_expo_in, _expo_out, _expo_in_out, _halves(_expo_out, _expo_in)),
    Trans.ELASTIC: _family(_elastic_in, _elastic_in_out),
    Trans.CUBIC: _family(_power(3)),
    Trans.CIRC: _family(_circ),
    Trans.BOUNCE: _family(_flip(_bounce_out)),
    Trans.BACK: _family(_back(1.70158), _halves(_back(1.70158 * 1.525), _flip(_back(2.5949095)))),
    Trans.SPRING: _family(_flip(_spring_out)),
}
"""In, out, in-out and out-in of each transition."""
