"""Crowds as files for other programs: recordings of what agents show, as glTF and USD."""

from .recording import Recording, recorded_bytes
from .targets import Exported

__all__ = ["Exported", "Recording", "recorded_bytes"]
