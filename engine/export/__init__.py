"""Crowds as files for other programs: recordings of what agents show, as glTF and USD."""

from .clip_schedule import ClipSchedule
from .recording import Recording, recorded_bytes
from .targets import Exported

__all__ = ["ClipSchedule", "Exported", "Recording", "recorded_bytes"]
