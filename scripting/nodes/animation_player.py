"""Godot's view of a stream that plays clips."""

from __future__ import annotations

from ...engine.streams.pool import Stream, StreamPool
from ...systems.simulation import Simulation
from ..exports import export
from ..signals import Signal
from .stream_node import StreamNode


class AnimationPlayer(StreamNode):
    """A stream of the crowd above that plays one clip at a time.

    Another clip is a cut on the stream: agents show it as soon as they reach that tick, without a
    blend. Blends are made by `show`, which lets agents change to the stream.

    Attributes
    ----------
    autoplay
        Clip that it plays when it gets ready.
    speed_scale
        Factor on every speed.
    animation_started, animation_finished
        Emitted with the clip's name; a looping clip never finishes.
    animation_changed
        Emitted with the old and the new name when a queued clip begins.
    """

    animation_started = Signal[str]()
    animation_finished = Signal[str]()
    animation_changed = Signal[str, str]()

    autoplay: str = export(default="")
    speed_scale: float = export(default=1.0, range=(-100, 100), changed="_speed_changed")

    def _prepare(self) -> None:
        super()._prepare()
        self._name_played, self._speed, self._done = "", 1.0, True
        self._queue: list[str] = []

    @property
    def current_animation(self) -> str:
        """Name of the clip that plays; empty if none does."""
        return "" if self._done else self._name_played

    @property
    def assigned_animation(self) -> str:
        """Name of the clip that plays or was played last."""
        return self._name_played

    @property
    def current_animation_position(self) -> float:
        """Seconds into the clip."""
        running = self._running()
        return 0.0 if running is None else float(running[0].time[running[1].row])

    @property
    def current_animation_length(self) -> float:
        """Seconds of the clip; 0 if none was played."""
        if not self._name_played:
            return 0.0
        bank = self.pool.bank
        return float(bank.duration[bank.index(self._name_played)])

    def get_animation_list(self) -> list[str]:
        """Names of the crowd's clips."""
        return [clip.name for clip in self.pool.bank.clips]

    def has_animation(self, name: str) -> bool:
        """Whether the crowd has a clip."""
        return name in self.get_animation_list()

    def is_playing(self) -> bool:
        """Whether a clip plays."""
        running = self._running()
        return not self._done and running is not None and bool(running[0].running[running[1].row])

    def play(self, name: str = "", *, custom_speed: float = 1.0, from_end: bool = False) -> None:
        """Play a clip, or go on with the one that was paused or stopped.

        Parameters
        ----------
        name
            Of the clip; the last one if empty. One that plays goes on.
        custom_speed
            Factor on its speed; negative plays backwards.
        from_end
            Begin at the end.

        Raises
        ------
        ValueError
            For an unknown clip, or none.
        """
        wanted = name or self._name_played
        if not wanted:
            raise ValueError(f"{self!r} has played nothing yet; name a clip")
        if not self.has_animation(wanted):
            known = ", ".join(self.get_animation_list())
            raise ValueError(f"there is no clip '{wanted}'; there are {known}")
        again = wanted == self._name_played and self._running() is not None
        self._speed = custom_speed
        ended = self._done
        self._name_played, self._done = wanted, False
        stream, pool = self.stream, self.pool
        pool.speed[stream.row] = custom_speed * self.speed_scale
        length = self.current_animation_length
        if again and not ended:
            pool.run(stream)
            return
        if again and 0.0 < pool.time[stream.row] < length and not from_end:
            pool.run(stream)
        else:
            pool.play(stream, wanted, time=length if from_end else 0.0)
            pool.run(stream)
        self.animation_started.emit(wanted)

    def play_backwards(self, name: str = "") -> None:
        """Play a clip backwards from its end."""
        self.play(name, custom_speed=-1.0, from_end=True)

    def queue(self, name: str) -> None:
        """Play a clip when the current one has ended; at once if none plays."""
        if self._done:
            self.play(name)
        else:
            self._queue.append(name)

    def clear_queue(self) -> None:
        """Forget what was queued."""
        self._queue.clear()

    def pause(self) -> None:
        """Hold the pose; `play` goes on from there."""
        running = self._running()
        if running is not None:
            running[0].stop(running[1])

    def stop(self, keep_state: bool = False) -> None:
        """Stop, and go back to the clip's first pose unless `keep_state`."""
        self.clear_queue()
        self._done = True
        running = self._running()
        if running is not None:
            pool, stream = running
            if keep_state:
                pool.stop(stream)
            else:
                pool.seek(stream, 0.0)
                pool.speed[stream.row] = 0.0

    def seek(self, seconds: float) -> None:
        """Go to a time of the clip: a cut. ValueError if nothing was played yet."""
        running = self._running()
        if running is None:
            raise ValueError(f"{self!r} has played nothing yet")
        running[0].seek(running[1], seconds)

    def _make(self, pool: StreamPool) -> Stream:
        if not self._name_played:
            raise ValueError(f"{self!r} has played nothing yet; play a clip or set autoplay")
        return pool.add(self._name_played, speed=self._speed * self.speed_scale)

    def _made_ready(self) -> None:
        if self.autoplay:
            try:
                self.play(self.autoplay)
            except ValueError as error:
                from ..reports import report

                report(error, AnimationPlayer.play, "autoplay", self)

    def _speed_changed(self) -> None:
        running = self._running()
        if running is not None and not self._done:
            running[0].speed[running[1].row] = self._speed * self.speed_scale

    def _after_tick(self, simulation: Simulation) -> None:
        running = self._running()
        if self._done or running is None:
            return
        pool, row = running[0], running[1].row
        length = self.current_animation_length
        time, speed = float(pool.time[row]), float(pool.speed[row])
        over = time >= length if speed > 0 else time <= 0.0 and speed < 0
        if pool.looping[row] or not over or pool.valid[row] == 0:
            return
        self._done = True
        ended = self._name_played
        self.animation_finished.emit(ended)
        if self._queue and self._done:
            following = self._queue.pop(0)
            self.play(following)
            self.animation_changed.emit(ended, following)
