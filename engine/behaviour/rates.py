"""Checks the constants of a model, so that a wrong one is named at once."""

from __future__ import annotations

from dataclasses import fields
from math import isfinite
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


def check_rates(
    rates: DataclassInstance, *, signed: tuple[str, ...] = (), positive: tuple[str, ...] = ()
) -> None:
    """All fields must be finite numbers, at least 0 unless `signed`, above 0 if `positive`.

    Raises
    ------
    ValueError
        Naming the field, its value and what is allowed.
    """
    for field in fields(rates):
        value = getattr(rates, field.name)
        is_number = isinstance(value, int | float) and isfinite(value)
        if field.name in signed:
            good, allowed = is_number, "a finite number"
        elif field.name in positive:
            good, allowed = is_number and value > 0, "a finite number above 0"
        else:
            good, allowed = is_number and value >= 0, "a finite number of 0 or more"
        if not good:
            name = type(rates).__name__
            raise ValueError(f"{name}: {field.name} is {value!r}, expected {allowed}")
