"""From a crowd spec to seats, and from seats to the stadium's mesh."""

from __future__ import annotations

from .bowl import build_bowl
from .pitch import add_pitch
from .seating import SeatPlan
from .shell import add_bowl_shell, add_stand_shell
from .spec import CrowdSpec
from .stadium_mesh import MeshBuilder, StadiumMesh
from .stand import build_stand
from .terraces import add_terraces


def build_seats(spec: CrowdSpec) -> SeatPlan:
    """The seats of the layout that `spec` asks for."""
    if spec.layout == "stand":
        return build_stand(spec.rows, spec.columns, spec.step, spec.rise, spec.depth)
    return build_bowl(spec.seats)


def build_stadium_mesh(plan: SeatPlan) -> StadiumMesh:
    """Pitch, stands, walls, roof and ground; about 136,000 triangles for 65,000 seats."""
    builder = MeshBuilder()
    add_terraces(builder, plan.structure)
    if plan.structure.outline is None:
        add_stand_shell(builder, plan.structure)
    else:
        add_pitch(builder)
        add_bowl_shell(builder, plan.structure, plan.structure.outline)
    return builder.build()
