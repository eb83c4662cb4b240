"""Which of a character's mesh variants every agent has: body, hair, beard, or a file's own."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from ...components.body import Body
from ..assets.character import Character
from ..assets.variants import MOST_CHOICES, PEOPLE, is_needed, share_of, variant_groups
from .body_types import CHILD, OLD


def people_of(body: Body) -> NDArray[np.intp]:
    """(N,) index into `PEOPLE` of every agent."""
    kind = np.where(body.kind == CHILD, 2, np.where(body.kind == OLD, 4, 0))
    people: NDArray[np.intp] = (kind + body.woman).astype(np.intp)
    return people


def draw_choices(character: Character, body: Body, rng: np.random.Generator) -> NDArray[np.uint8]:
    """Draw `Body.choice` by the shares that the character's variants have.

    Parameters
    ----------
    character
        With variants or without.
    body
        Who is who.
    rng
        Where choices come from.

    Returns
    -------
    (G, N) uint8. People whom none of a group's shares name have none of it, unless somebody always
    has one of them, as with bodies: then they have any.
    """
    groups = variant_groups(character)
    people = people_of(body)
    choice = np.full((len(groups), len(people)), MOST_CHOICES, np.uint8)
    for row, variants in zip(choice, groups.values(), strict=True):
        draw = rng.random(len(people))
        shares = np.array([[share_of(v, who) for v in variants] for who in PEOPLE])
        nobody = shares.sum(axis=1) == 0.0
        if nobody.any() and is_needed(variants):
            shares[nobody] = 1.0
        total = np.maximum(shares.sum(axis=1, keepdims=True), 1.0)
        edges = np.cumsum(shares / total, axis=1)
        # Rounding must not leave one in a billion without a body.
        edges[edges > 1.0 - 1e-9] = 1.0
        number = (draw[:, None] >= edges[people]).sum(axis=1)
        row[:] = np.where(number < len(variants), number, MOST_CHOICES)
    return choice


def wears(
    character: Character, body: Body, group: str, choices: Iterable[str]
) -> NDArray[np.bool_]:
    """(N,) who has one of some choices; nobody for a group that the character has not."""
    groups = variant_groups(character)
    if group not in groups or len(body.choice) != len(groups):
        return np.zeros(len(body.kind), np.bool_)
    wanted = set(choices)
    numbers = [k for k, variant in enumerate(groups[group]) if variant.choice in wanted]
    result: NDArray[np.bool_] = np.isin(body.choice[list(groups).index(group)], numbers)
    return result


def choose(
    character: Character,
    body: Body,
    agents: NDArray[np.int64],
    choices: Mapping[str, str | None],
) -> None:
    """Give agents other choices, by group; None is none of it.

    Raises
    ------
    ValueError
        For a group or choice that the character has not; nothing is changed then.
    """
    groups = variant_groups(character)
    numbers: dict[int, int] = {}
    for group, choice in choices.items():
        if group not in groups:
            known = ", ".join(groups) or "none"
            raise ValueError(f"'{character.name}' has no group '{group}'; groups: {known}")
        names = [variant.choice for variant in groups[group]]
        if choice is not None and choice not in names:
            raise ValueError(f"'{group}' has no '{choice}', expected one of: {', '.join(names)}")
        number = MOST_CHOICES if choice is None else names.index(choice)
        numbers[list(groups).index(group)] = number
    for row, number in numbers.items():
        body.choice[row, agents] = number
    body.version += 1
