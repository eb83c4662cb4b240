"""Laying motions over agents: requests for overlays, and what agents show with them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...components.overlays import NO_MASK, NO_REQUEST, Overlays
from .blending import agent_palettes, begin_blend, blend_weight
from .ladder import AFTER_CUT, HURRIED, BlendLadder
from .mask_table import MaskTable, lay_over

MAX_LAYERS = 2


class OverlayStage:
    """Overlays of one crowd.

    A layer's motion blends like any other: by the ladder, in part ``1 + layer``. What is added here
    is its mask and its weight. A layer has one mask at a time: who is asked for another one while
    the first is seen fades that out before.

    Parameters
    ----------
    ladder
        Of the crowd; its columns have a part for each layer.
    columns
        Changed by `step`.
    masks
        The crowd's masks.
    """

    def __init__(self, ladder: BlendLadder, columns: Overlays, masks: MaskTable) -> None:
        self.ladder = ladder
        self.columns = columns
        self.masks = masks
        self._asked = np.zeros(len(columns.mask), np.bool_)
        self._busy = np.zeros(len(columns.mask), np.bool_)
        self._tick = 0
        # Before the ladder, which moves agents off a motion that is removed.
        ladder.pool.before_cut.insert(0, self.before_cut)
        ladder.uniques.before_cut.insert(0, self.before_cut)

    def ask(
        self,
        layer: int,
        agents: NDArray[np.int64],
        mask: int,
        row: NDArray[np.int32] | int,
        offset: NDArray[np.float32] | float,
        weight: NDArray[np.float32] | float,
        duration: NDArray[np.float32] | float,
    ) -> None:
        """Ask for an overlay, or with mask -1 for none; it begins at the next `step`, or later.

        Parameters
        ----------
        layer, agents
            Layer, and (K,) ids.
        mask, row
            Number of the mask, and unified pose index.
        offset, weight, duration
            (K,) each, or one for all: poses behind the stream's head (NaN is drawn), weight to
            reach, and pose ticks to get there.
        """
        columns, at = self.columns, (layer, agents)
        columns.next_mask[at] = mask
        columns.next_row[at] = row
        columns.next_offset[at] = offset
        columns.next_weight[at] = weight
        columns.next_duration[at] = duration
        self._asked[layer] = True

    def step(self, tick: int, rng: np.random.Generator) -> None:
        """Meet the requests at pose tick `tick`, before the ladder's step."""
        self._tick = tick
        for layer in range(len(self.columns.mask)):
            if self._asked[layer]:
                self._answer(layer, tick, rng)
            if self._busy[layer]:
                self._end_finished(layer, tick)

    def before_cut(self, row: int, removed: bool) -> None:
        """Fade out what is laid over from a motion that is removed, and drop requests for it.

        Parameters
        ----------
        row
            Unified index of the stream or unique.
        removed
            Whether it is; a cut alone is the ladder's business.
        """
        if not removed:
            return
        columns = self.columns
        for layer in range(len(columns.mask)):
            wanted = (columns.next_mask[layer] >= 0) & (columns.next_row[layer] == row)
            columns.next_mask[layer, wanted] = NO_REQUEST
            shown = columns.mask[layer] != NO_MASK
            shown &= (self.ladder.anim.row[1 + layer] == row) & (columns.target[layer] > 0)
            agents = np.flatnonzero(shown)
            if len(agents):
                duration = np.full(len(agents), AFTER_CUT, np.float32)
                self._fade(layer, agents, 0.0, duration, self._tick + 1)

    def _answer(self, layer: int, tick: int, rng: np.random.Generator) -> None:
        columns = self.columns
        agents = np.flatnonzero(columns.next_mask[layer] != NO_REQUEST)
        wanted = columns.next_mask[layer, agents]
        weight = layer_weights(columns, layer, agents, tick - 1.0)
        shown = (columns.mask[layer, agents] != NO_MASK) & (weight > 0)
        same = columns.mask[layer, agents] == wanted
        leaving = wanted == NO_MASK
        self._fade_out(layer, agents[leaving & shown], tick, hurried=False)
        self._settle(layer, agents[leaving])
        self._fade_out(layer, agents[shown & ~same & ~leaving], tick, hurried=True)
        new = agents[~leaving & ~shown]
        if len(new):
            at, part = (layer, new), 1 + layer
            row = columns.next_row[at]
            offset = self._offsets(row, columns.next_offset[at], rng)
            self._release(part, new)
            none = np.zeros(len(new), np.float32)
            begin_blend(
                self.ladder.anim, self.ladder.transition, part, new, row, offset, tick - 1, none
            )
            self.ladder.anim.t0[part, new] = tick
            columns.mask[at] = columns.next_mask[at]
            self._fade(layer, new, columns.next_weight[at], columns.next_duration[at], tick)
            self._settle(layer, new)
        going = agents[shown & same & ~leaving]
        if len(going):
            at = (layer, going)
            duration = columns.next_duration[at]
            self.ladder.ask(
                1 + layer, going, columns.next_row[at], columns.next_offset[at], duration
            )
            self._fade(layer, going, columns.next_weight[at], duration, tick)
            self._settle(layer, going)
        self._asked[layer] = bool((columns.next_mask[layer, agents] != NO_REQUEST).any())

    def _offsets(
        self, row: NDArray[np.int32], offset: NDArray[np.float32], rng: np.random.Generator
    ) -> NDArray[np.float32]:
        drawn = np.isnan(offset)
        if drawn.any():
            pool = self.ladder.pool
            stream = row < pool.store.stream_rows
            longest = np.where(stream, pool.room(np.where(stream, row, 0)), 0)
            offset = np.where(drawn, rng.random(len(row)) * longest, offset).astype(np.float32)
        return offset

    def _fade(
        self,
        layer: int,
        agents: NDArray[np.int64],
        weight: NDArray[np.float32] | float,
        duration: NDArray[np.float32],
        tick: int,
    ) -> None:
        columns, at = self.columns, (layer, agents)
        columns.start[at] = layer_weights(columns, layer, agents, tick - 1.0)
        columns.target[at] = weight
        columns.begin[at] = tick - 1
        columns.duration[at] = duration
        columns.version += 1
        self._busy[layer] = True

    def _fade_out(self, layer: int, agents: NDArray[np.int64], tick: int, *, hurried: bool) -> None:
        columns = self.columns
        if hurried:
            agents = agents[columns.target[layer, agents] > 0]
        if len(agents):
            duration = columns.next_duration[layer, agents]
            if hurried:
                duration = np.minimum(duration, np.float32(HURRIED))
            self._fade(layer, agents, 0.0, duration, tick)

    def _settle(self, layer: int, agents: NDArray[np.int64]) -> None:
        self.columns.next_mask[layer, agents] = NO_REQUEST

    def _release(self, part: int, agents: NDArray[np.int64]) -> None:
        """Drop what is left of a layer's own blends and requests."""
        transition = self.ladder.transition
        blending = agents[transition.duration[part, agents] > 0]
        self.ladder.slots.release(transition.row[part, blending])
        transition.duration[part, blending] = 0.0
        transition.next_row[part, agents] = -1

    def _end_finished(self, layer: int, tick: int) -> None:
        """Take off what is not seen any more, so that its stream is not held for nothing."""
        columns = self.columns
        agents = np.flatnonzero(columns.mask[layer] != NO_MASK)
        at = (layer, agents)
        gone = (columns.target[at] == 0) & (tick - 1 >= columns.begin[at] + columns.duration[at])
        done = agents[gone]
        if len(done):
            self._release(1 + layer, done)
            columns.mask[layer, done] = NO_MASK
            columns.start[layer, done] = columns.target[layer, done] = 0.0
            self.ladder.anim.row[1 + layer, done] = self.ladder.pool.store.bind_row
            self.ladder.anim.version += 1
            columns.version += 1
        self._busy[layer] = len(done) < len(agents)

    def lay(
        self, palettes: NDArray[np.float32], agents: NDArray[np.int64], tick: int, alpha: float
    ) -> NDArray[np.float32]:
        """What agents show, overlays included, by the shader's rules.

        Parameters
        ----------
        palettes
            (K, J, 3, 4) float32 what they show without.
        agents, tick, alpha
            (K,) ids, pose tick and the fraction of it that has passed.

        Returns
        -------
        (K, J, 3, 4) float32 palettes
        """
        ladder, masks = self.ladder, self.masks
        for layer in range(len(self.columns.mask)):
            mask = self.columns.mask[layer, agents]
            weight = layer_weights(self.columns, layer, agents, tick - 1 + alpha)
            some = np.flatnonzero((mask != NO_MASK) & (weight > 0))
            if len(some):
                ids, chosen = agents[some], mask[some]
                over = agent_palettes(
                    ladder.pool, ladder.anim, ladder.transition, 1 + layer, ids, tick, alpha
                )
                weights = masks.weights[chosen] * weight[some, None]
                palettes[some] = lay_over(palettes[some], over, weights, masks.anchors[chosen])
        return palettes


def layer_weights(
    columns: Overlays, layer: int, agents: NDArray[np.int64], shown: float
) -> NDArray[np.float32]:
    """(K,) float32 how much agents show of a layer at time `shown`, in pose ticks."""
    at = (layer, agents)
    done = blend_weight(columns.begin[at], columns.duration[at], shown)
    start = columns.start[at]
    weights: NDArray[np.float32] = start + (columns.target[at] - start) * done
    return weights
