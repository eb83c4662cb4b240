"""What an entity has: plain columns of NumPy arrays, one row an agent.

A crowd is one entity whose components hold one row for each of its agents; an agent's id is its row
and is never reused. Nothing here knows of systems, engines or drawing.
"""

from .animation import AgentAnimID, BakedAnim, Transition
from .appearance import Appearance
from .attachment import MOST_PARTS, Attachment, PartBits
from .behaviour import Behaviour
from .body import Body
from .detail import Detail, Level
from .dilation import Dilation, DilationRequest
from .emotion import Emotion
from .motion import MotionState
from .overlays import Overlays
from .party import Party, PartyKind
from .placement import Placement
from .seat import Seat, Section
from .team import Team
from .view import View
from .walk import Errand, Leg, Stage, Walk

__all__ = [
    "MOST_PARTS",
    "AgentAnimID",
    "Appearance",
    "Attachment",
    "BakedAnim",
    "Behaviour",
    "Body",
    "Detail",
    "Dilation",
    "DilationRequest",
    "Emotion",
    "Errand",
    "Leg",
    "Level",
    "MotionState",
    "Overlays",
    "PartBits",
    "Party",
    "PartyKind",
    "Placement",
    "Seat",
    "Section",
    "Stage",
    "Team",
    "Transition",
    "View",
    "Walk",
]
