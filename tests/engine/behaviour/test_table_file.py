"""Tables as designers write them: what the shipped ones say, and what is said of broken ones."""

from __future__ import annotations

import re
from pathlib import Path
from types import ModuleType

import pytest

from tifo.engine.behaviour import KINDS, TABLES, load_table, table_from_toml
from tifo.engine.behaviour.compiled import compile_table
from tifo.engine.behaviour.table import BehaviourTable, Rule, State
from tifo.engine.crowd.motions import Role, sort_motions
from tifo.engine.errors import AssetError

GOOD = """\
[states.sit]
posture = "seated"
role = "calm"
pieces = [2, 5]
variants = [{ clips = "sit_.*" }]

[states.clap]
arms = "clap"
role = "applaud"
limit = 30
variants = [{ clips = ["clap_9", "clap"], effort = 2.0 }, { clips = "no_such", excitement = 0.4 }]

[[rules]]
from = "sit"
to = "clap"
event = ["goal", "cue"]
side = "own"
excitement = [0.2, inf]
signals = { clapping_wanted = true }
limits = { loudness = [0.5, inf] }
rapid = true

[[rules]]
from = "clap"
to = "sit"
event = false

[responses.cue.own]
gain = 0.5
"""


def _ways(table: BehaviourTable, origin: str) -> set[str]:
    return {rule.target for rule in table.rules if rule.origin == origin}


@pytest.mark.parametrize("name", TABLES)
def test_shipped_tables_are_sound(name: str, factories: ModuleType) -> None:
    table = load_table(name)
    assert table.problem() is None
    assert table.name == name
    assert {kind for kind, _ in table.responses} == set(KINDS)
    library = sort_motions(factories.make_character().clips)
    assert len(compile_table(table, library).names) == len(table.states)


def test_the_reference_table_is_the_machine_of_the_thesis() -> None:
    table = load_table("sport")
    assert table.machines == ("body", "head", "arms")
    assert table.states[0].name == "start"
    assert _ways(table, "start") - {"struck"} == {"sit"}
    assert {"turn_left", "turn_right", "stand"} <= _ways(table, "sit")
    assert {"clap", "cheer"} <= _ways(table, "arm_up")
    assert _ways(table, "arm_down") - {"struck"} == {"stand"}
    effort = {r.target: r.effort for r in table.rules if r.origin == "arm_up" and not r.events}
    assert effort["clap"] == effort["cheer"]
    for state in ("arm_up", "arm_down", "clap", "cheer"):
        assert table.state(state).pieces == (1, 1)
    for state in ("sit", "stand", "clap", "cheer"):
        assert [variant.effort for variant in table.state(state).variants] == [1.0] * 4


def test_a_table_says_what_its_file_says() -> None:
    table = table_from_toml(GOOD)
    sit, clap = table.states
    assert (sit.posture, sit.role, sit.pieces, sit.line) == ("seated", Role.CALM, (2, 5), 1)
    assert (clap.arms, clap.limit, clap.line) == ("clap", 30, 7)
    assert [v.clips for v in clap.variants] == [("clap_9", "clap"), "no_such"]
    assert [(v.effort, v.excitement) for v in clap.variants] == [(2.0, 0.0), (1.0, 0.4)]
    up, down = table.rules
    assert up.events == {"goal", "cue"}
    assert up.relations == {"own"}
    assert up.rapid
    assert not up.calm
    assert up.limits == (
        ("excitement", 0.2, float("inf")),
        ("loudness", 0.5, float("inf")),
    )
    assert up.signals == (("clapping_wanted", True),)
    assert down.calm
    assert not down.events
    assert table.responses["cue", "own"].gain == 0.5
    assert table.responses["goal", "own"].gain == 1.0, "from the common responses"


BROKEN = [
    ("[states.sit]", "[states.sit", 1, "not valid TOML"),
    ('posture = "seated"', 'posture = "lying"', 2, "posture is 'lying', expected one of"),
    ("pieces = [2, 5]", "pieces = [5, 2]", 4, "the least is more than the most"),
    ("pieces = [2, 5]", "pieces = [2.5, 5]", 4, "pieces are whole numbers"),
    ("pieces = [2, 5]", "piece = [2, 5]", 4, "unknown key 'piece'; did you mean pieces"),
    ("pieces = [2, 5]", "pieces = 4", 4, "expected [least, most]"),
    ('role = "applaud"', 'role = "sing"', 9, "role is 'sing', expected one of calm"),
    ("limit = 30", "limit = 0", 10, "limit is 0, expected a number, 1 to"),
    ('"no_such"', '"no_such("', 11, "is no expression"),
    ('clips = "no_such", ', "", 11, "variant 2 has no clips"),
    ("effort = 2.0", "effort = nan", 11, "effort is nan, expected a number, 1e-06 or more"),
    ("effort = 2.0", "effort = -1", 11, "effort is -1"),
    ('from = "sit"', "form = 1", 14, "unknown key 'form'; did you mean from"),
    ('to = "clap"', 'to = "clapp"', 13, "there is no state 'clapp'; states: sit, clap"),
    ('event = ["goal", "cue"]', 'event = "gaol"', 16, "event is 'gaol'; did you mean goal"),
    ('side = "own"', 'side = "left"', 17, "side is 'left'; known: own"),
    ("excitement = [0.2, inf]", "excitement = [0.2, nan]", 18, "excitement is nan"),
    ("clapping_wanted = true", "clapping_wanted = 1", 19, "signals are wanted true or false"),
    ("rapid = true", 'rapid = "yes"', 21, "rapid is 'yes', expected true or false"),
    ('from = "clap"\nto = "sit"', 'from = "clap"\nto = "clap"', 7, "'clap' has no way out"),
    ("limit = 30", 'limit = 30\nleave_to = "bed"', 7, "leave_to of 'clap' is no other state"),
    ("gain = 0.5", "gain = -0.5", 29, "gain is -0.5, expected a number, 0 to 1000"),
    ("gain = 0.5", "gian = 0.5", 29, "unknown key 'gian'; did you mean gain"),
    ("[responses.cue.own]", "[responses.queue.own]", 28, "event is 'queue'; known: goal"),
    ("[responses.cue.own]", "[responses.cue.mine]", 28, "side is 'mine'; known: own"),
]


@pytest.mark.parametrize(("good", "bad", "line", "cause"), BROKEN)
def test_a_broken_table_says_where_and_why(good: str, bad: str, line: int, cause: str) -> None:
    assert good in GOOD
    with pytest.raises(AssetError, match=re.escape(cause)) as caught:
        table_from_toml(GOOD.replace(good, bad, 1), "crowd.toml")
    assert caught.value.place == f"line {line}"
    assert "crowd.toml" in str(caught.value)


def test_states_that_lead_nowhere_or_are_never_reached_are_reported() -> None:
    lost = GOOD + '\n[states.lost]\n\n[[rules]]\nfrom = "lost"\nto = "sit"\n'
    with pytest.raises(AssetError, match="line 31: no way leads to state 'lost'"):
        table_from_toml(lost)
    alone = '[states.sit]\n[[rules]]\nfrom = "sit"\nto = "sit"\n'
    with pytest.raises(AssetError, match="line 1: state 'sit' has no way out"):
        table_from_toml(alone)
    with pytest.raises(AssetError, match="there are no states"):
        table_from_toml("")


def test_machines_are_apart() -> None:
    other = GOOD + '\n[states.talk]\nmachine = "head"\n\n[[rules]]\nfrom = "talk"\nto = "sit"\n'
    with pytest.raises(AssetError, match="'talk' and 'sit' are of different machines"):
        table_from_toml(other)


def test_machines_have_the_names_of_what_they_move() -> None:
    with pytest.raises(AssetError, match="machine is 'legs', expected one of: body, head, arms"):
        table_from_toml(GOOD + '\n[states.stroll]\nmachine = "legs"\n')


def test_a_star_is_every_other_state_of_the_machine() -> None:
    table = load_table("sport")
    bodies = {state.name for state in table.states if state.machine == "body"}
    assert {r.origin for r in table.rules if r.target == "struck"} == bodies - {"struck"}


def test_tables_in_files(tmp_path: Path) -> None:
    file = tmp_path / "crowd.toml"
    file.write_text(GOOD, "utf-8")
    assert load_table(file).name == "crowd"
    file.write_bytes(b"\xff\xfe")
    with pytest.raises(AssetError, match="can't be read as text"):
        load_table(file)
    with pytest.raises(AssetError, match="there is no such file; tables shipped: sport"):
        load_table("spot")


def test_missing_clips_are_stood_in_for_and_that_is_said(factories: ModuleType) -> None:
    library = sort_motions(factories.make_character().clips)
    compiled = compile_table(table_from_toml(GOOD), library)
    look = compiled.looks[compiled.number("clap")]
    names = [library.names[motion] for motion in look.motion]
    assert names == ["clap", "clap"]
    assert look.variant.tolist() == [0, 1]
    assert look.chance.tolist() == [0.5, 1.0]
    assert compiled.notes == ("clap 2: no clip no_such; clap stands in",)
    sit = compiled.looks[compiled.number("sit")]
    assert [library.names[motion] for motion in sit.motion] == ["sit_idle", "sit_idle_2"]
    assert sit.chance.tolist() == [0.5, 0.5], "a variant's chance is shared among its clips"


def test_a_table_in_code_is_checked_too(factories: ModuleType) -> None:
    library = sort_motions(factories.make_character().clips)
    table = BehaviourTable("mine", (State("a"), State("b")), (Rule("a", "b"),))
    with pytest.raises(ValueError, match="table 'mine': state 'b' has no way out"):
        compile_table(table, library)
