"""Variants of a character: which there are, how one look is picked out, how files say them.

In a glTF file a node (or its mesh) says in its ``extras`` that not everybody has its mesh::

    "extras": {"tifo_variant": "hair/bun", "tifo_shares": {"woman": 0.1, "old woman": 0.2}}

Modelling tools write such extras from the custom properties of an object.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from .character import Character, SkinnedMesh, Variant
from .gltf_fields import Fields

PEOPLE = ("man", "woman", "boy", "girl", "old man", "old woman")
"""Whom shares may name, besides ``everyone``."""
EVERYONE = "everyone"
MOST_CHOICES = 255
"""Of a group: 255 stands for none of them."""

_VARIANT, _SHARES = "tifo_variant", "tifo_shares"


def variant_groups(character: Character) -> dict[str, tuple[Variant, ...]]:
    """The groups of a character's variants and their choices, in the order of its meshes."""
    groups: dict[str, dict[str, Variant]] = {}
    for level in (character.meshes, *character.lower_levels):
        for mesh in level:
            if mesh.variant is not None:
                choices = groups.setdefault(mesh.variant.group, {})
                choices.setdefault(mesh.variant.choice, mesh.variant)
    return {group: tuple(choices.values()) for group, choices in groups.items()}


def one_look(character: Character, choices: Mapping[str, str | None] | None = None) -> Character:
    """The character with the meshes of one choice of each group, and no variants any more.

    Parameters
    ----------
    character
        With variants, or without: then it comes back as it is.
    choices
        By group; None for none of it. A group that is left out shows its first choice if there is
        somebody for whom all of the group's shares add up to 1, and none otherwise.

    Raises
    ------
    ValueError
        For a group or choice that the character has not.
    """
    groups = variant_groups(character)
    wanted: dict[str, str | None] = {
        group: found[0].choice if is_needed(found) else None for group, found in groups.items()
    }
    for group, choice in (choices or {}).items():
        if group not in groups:
            known = ", ".join(groups) or "none"
            raise ValueError(f"choices has the group '{group}'; '{character.name}' has: {known}")
        known_choices = [variant.choice for variant in groups[group]]
        if choice is not None and choice not in known_choices:
            allowed = ", ".join(known_choices)
            raise ValueError(f"choices has '{choice}' for '{group}', expected one of: {allowed}")
        wanted[group] = choice
    if not groups:
        return character

    def shown(meshes: tuple[SkinnedMesh, ...]) -> tuple[SkinnedMesh, ...]:
        return tuple(
            replace(mesh, variant=None)
            for mesh in meshes
            if mesh.variant is None or wanted[mesh.variant.group] == mesh.variant.choice
        )

    return replace(
        character,
        meshes=shown(character.meshes),
        lower_levels=tuple(shown(level) for level in character.lower_levels),
    )


def default_choices(character: Character) -> dict[str, int]:
    """What is drawn where nobody chose: a choice's number by group, `MOST_CHOICES` for none."""
    return {
        group: 0 if is_needed(found) else MOST_CHOICES
        for group, found in variant_groups(character).items()
    }


def share_of(variant: Variant, people: str) -> float:
    """How many of some people have a choice, before the group's shares are compared with 1."""
    return float(variant.shares.get(people, variant.shares.get(EVERYONE, 0.0)))


def is_needed(choices: tuple[Variant, ...]) -> bool:
    """Whether somebody always has one of the choices: a body, but not a beard."""
    return any(sum(share_of(choice, who) for choice in choices) > 0.999 for who in PEOPLE)


def read_variant(fields: Fields) -> Variant | None:
    """The variant that the ``extras`` of a node or mesh name; None if they name none.

    Raises
    ------
    AssetError
        If they are no group and choice, or the shares no numbers for known people.
    """
    if not isinstance(fields.values.get("extras"), dict):
        return None
    extras = fields.child("extras")
    text = extras.text(_VARIANT)
    if _VARIANT not in extras:
        return None
    group, slash, choice = (part.strip() for part in text.partition("/"))
    if not (group and slash and choice):
        extras.fail(_VARIANT, f"is '{text}', expected a group and a choice: 'hair/bun'")
    if _SHARES not in extras:
        return Variant(group, choice)
    shares = extras.child(_SHARES)
    allowed = (*PEOPLE, EVERYONE)
    for people in shares.values:
        if people not in allowed:
            shares.fail("", f"names '{people}', expected one of: {', '.join(allowed)}")
        if shares.number(people, 0.0) < 0.0:
            shares.fail(people, "is negative")
    return Variant(group, choice, {name: shares.number(name, 0.0) for name in shares.values})


def variant_extras(variant: Variant) -> dict[str, Any]:
    """What `read_variant` reads back."""
    return {_VARIANT: f"{variant.group}/{variant.choice}", _SHARES: dict(variant.shares)}
