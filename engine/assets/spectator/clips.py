"""All motions of the built-in spectator, in the order of the shipped file."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from ...animation.clip import Clip
from ...animation.skeleton import Skeleton
from . import (
    applause,
    calm,
    cheering,
    dodging,
    gait,
    jumping,
    kicking,
    seated,
    singing,
    social,
    sorrow,
    upright,
)
from . import gestures as g
from .acting import Acting
from .applause import numbered
from .curves import Performance, Pose
from .poses import arms_up, seated_arms_up, standing
from .poses import seated as sitting

Act = Callable[[str, Pose], Performance]


def _both(word: str, *acts: Act) -> Iterator[Performance]:
    """A motion and its variants, from standing and from the seat."""
    for prefix, base in (("", standing), ("sit_", sitting)):
        for number, act in enumerate(acts, 1):
            yield act(prefix + numbered(word, number), base())


def _mirrored(act: Callable[[str, Pose], Acting]) -> Act:
    return lambda name, base: act(name, base).mirrored()


def _style(act: Callable[..., Performance], style: int) -> Act:
    return lambda name, base: act(name, base, style=style)


def _calm() -> Iterator[Performance]:
    yield seated.sit_idle()
    yield seated.sit_idle_2()
    yield upright.stand_idle()
    yield upright.stand_idle_2()
    yield from calm.performances()
    yield seated.stand_up()
    yield seated.sit_down()


def _social() -> Iterator[Performance]:
    def lean(name: str, base: Pose) -> Acting:
        return social.look(name, base, far=1.15, lean=0.10)

    yield from _both("look_left", social.look, lean)
    yield from _both("look_right", _mirrored(social.look), _mirrored(lean))
    yield from _both("turn_left", social.turn)
    yield from _both("turn_right", _mirrored(social.turn))
    yield from _both("talk", social.talk, social.talk_2, social.talk_3, social.talk_4)
    yield from _both(
        "point",
        social.point,
        lambda name, base: social.point(name, base, g.POINT_SIDE).mirrored(),
        lambda name, base: social.point(name, base, g.POINT_HIGH),
    )
    yield from _both(
        "laugh", social.laugh, lambda name, base: social.laugh(name, base, slap=True).mirrored()
    )
    yield from _both(
        "drink", social.drink, lambda name, base: social.drink(name, base, long=0.8).mirrored()
    )
    yield social.hug("hug_a", standing(), lead=1.0)
    yield social.hug("hug_b", standing(), lead=-1.0)


def _joy() -> Iterator[Performance]:
    for prefix, rest, high in (("", standing, arms_up), ("sit_", sitting, seated_arms_up)):
        for style in (1, 2, 3, 4):
            name = numbered(f"{prefix}arm_up", style)
            yield cheering.arm_up(name, rest(), high(), style)
        for number, act in enumerate(
            (cheering.cheer, cheering.cheer_2, cheering.cheer_3, cheering.cheer_4), 1
        ):
            yield act(numbered(f"{prefix}cheer", number), high())
        for style in (1, 2, 3, 4):
            yield cheering.cheer_beat(numbered(f"{prefix}cheer_beat", style), high(), style)
        for style in (1, 2, 3, 4):
            name = numbered(f"{prefix}arm_down", style)
            yield cheering.arm_down(name, high(), rest(), style)
        yield cheering.wave(f"{prefix}wave", high())
        yield cheering.wave_over(f"{prefix}wave_2", high())
        yield singing.greet(f"{prefix}wave_3", rest())
        yield singing.greet(f"{prefix}wave_4", rest(), big=True).mirrored()
    for number, leap in enumerate(jumping.LEAPS, 1):
        yield jumping.jump(numbered("jump", number), leap)
    yield from _both(
        "fist_pump",
        singing.fist_pump,
        lambda name, base: singing.fist_pump(name, base, low=True).mirrored(),
        lambda name, base: singing.fist_pump(name, base, both=True),
        lambda name, base: singing.fist_pump(name, base, low=True, both=True),
    )
    yield from _both("chant", *(_style(singing.chant, style) for style in (1, 2, 3, 4)))
    yield from _both(
        "scarf_raise",
        singing.scarf_raise,
        lambda name, base: singing.scarf_raise(name, base, sway=0.03),
    )
    yield singing.mexican_wave("mexican_wave", standing())
    yield singing.sit_mexican_wave("sit_mexican_wave", sitting())


def _sorrow() -> Iterator[Performance]:
    yield sorrow.dismay()
    yield from _both("disappointed", *(_style(sorrow.disappointed, k) for k in (1, 2, 3, 4)))
    yield from _both("anticipate", *(_style(sorrow.anticipate, k) for k in (1, 2, 3, 4)))
    yield from _both("boo", sorrow.boo, lambda name, base: sorrow.boo(name, base, thumbs=True))
    yield from _both("protest", *(_style(sorrow.protest, k) for k in (1, 2)))
    yield from _both("angry", *(_style(sorrow.angry, k) for k in (1, 2)))


def _moving() -> Iterator[Performance]:
    yield from _both("hit_by_ball", *(_style(dodging.hit_by_ball, k) for k in (1, 2)))
    yield from _both("duck", *(_style(dodging.duck, k) for k in (1, 2)))
    yield from _both(
        "reach", dodging.reach, lambda name, base: dodging.reach(name, base, high=True).mirrored()
    )
    yield from _both("let_pass", dodging.let_pass, _mirrored(dodging.let_pass))
    yield dodging.side_step("side_step", standing())
    yield dodging.side_step("side_step_2", standing()).mirrored()
    for word, gaits in (("walk", gait.WALKS), ("jog", gait.JOGS), ("run", gait.RUNS)):
        for number, way in enumerate(gaits, 1):
            yield gait.moving(numbered(word, number), way)
    for style in (1, 2):
        yield kicking.kick(numbered("kick", style), standing(), style)


def performances() -> Iterator[Performance]:
    """Every motion, not solved yet."""
    yield from _calm()
    yield from applause.performances()
    yield from _social()
    yield from _joy()
    yield from _sorrow()
    yield from _moving()


def spectator_clips(skeleton: Skeleton) -> tuple[Clip, ...]:
    """Every clip, with 60 keys a second."""
    return tuple(performance.clip(skeleton) for performance in performances())
