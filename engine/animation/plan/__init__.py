"""Batched evaluation of the controllers of many streams."""

from .plan import EvaluationPlan

__all__ = ["EvaluationPlan"]
