from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tifo.engine.errors import GraphicsError
from tifo.engine.gl.source import compose

MAIN = """#version 330 core
#include "lib/a.glsl"
void main() {}
"""


def test_include_is_replaced_by_its_text_and_lines_know_their_file() -> None:
    source = compose(MAIN, includes={"lib/a.glsl": "float a;\nfloat b;\n"}, name="main.vert")
    assert source.text == "#version 330 core\nfloat a;\nfloat b;\nvoid main() {}\n"
    assert source.lines == (
        ("main.vert", 1),
        ("lib/a.glsl", 1),
        ("lib/a.glsl", 2),
        ("main.vert", 3),
    )


def test_a_file_is_included_only_once() -> None:
    includes = {
        "lib/a.glsl": '#include "lib/b.glsl"\nfloat a;\n',
        "lib/b.glsl": "float b;\n",
    }
    text = '#version 330 core\n#include "lib/b.glsl"\n#include "lib/a.glsl"\nfloat c;\n'
    assert compose(text, includes=includes).text.split("\n")[1:-1] == [
        "float b;",
        "float a;",
        "float c;",
    ]


def test_defines_follow_the_version_line() -> None:
    source = compose(
        "// head\n#version 330 core\nint x;\n",
        defines={"N": 3, "SCALE": 1.0, "TINY": 1e-7, "ON": True, "OFF": False, "TYPE": "vec3"},
    )
    assert source.text.split("\n")[:8] == [
        "// head",
        "#version 330 core",
        "#define N 3",
        "#define SCALE 1.0",
        "#define TINY 1e-07",
        "#define ON 1",
        "#define OFF 0",
        "#define TYPE vec3",
    ]
    assert source.location(9) == ("<text>", 3)
    assert source.location(3) == ("<defines>", 1)


@pytest.mark.parametrize(
    "defines",
    [
        {"two words": 1},
        {"1ST": 1},
        {"GL_ES": 1},
        {"a__b": 1},
        {"N": float("nan")},
        {"N": float("inf")},
        {"N": "1\n#error"},
        {"N": [1]},
    ],
)
def test_bad_defines_are_refused(defines: dict[str, int]) -> None:
    with pytest.raises(ValueError, match=next(iter(defines))):
        compose(MAIN, defines=defines, includes={"lib/a.glsl": ""})


def test_cycles_name_the_chain() -> None:
    includes = {
        "lib/a.glsl": '#include "lib/b.glsl"\n',
        "lib/b.glsl": '#include "lib/a.glsl"\n',
    }
    with pytest.raises(GraphicsError, match=r"main -> lib/a.glsl -> lib/b.glsl -> lib/a.glsl"):
        compose(MAIN, includes=includes, name="main")


def test_missing_include_names_who_asked_and_what_is_near() -> None:
    includes = {"lib/a.glsl": '\n#include "lib/quaternon.glsl"\n', "lib/quaternion.glsl": ""}
    with pytest.raises(GraphicsError) as caught:
        compose(MAIN, includes=includes, name="main")
    assert str(caught.value) == (
        "shader file 'lib/quaternon.glsl' not found (included by main -> lib/a.glsl, line 2); "
        "did you mean 'lib/quaternion.glsl'?"
    )


@pytest.mark.parametrize("name", ["../pyproject.toml", "/etc/passwd", "lib\\a.glsl", "a//b", "./a"])
def test_names_can_not_leave_the_shader_folder(name: str) -> None:
    with pytest.raises(GraphicsError, match="no shader name"):
        compose(name)


def test_missing_resource() -> None:
    with pytest.raises(GraphicsError, match=r"'no/such.vert.glsl' not found"):
        compose("no/such.vert.glsl")


def test_python_files_beside_the_shaders_are_never_suggested() -> None:
    with pytest.raises(GraphicsError) as caught:
        compose("__init_.py")
    assert "did you mean" not in str(caught.value)


@pytest.mark.parametrize("line", ["#include lib/a.glsl", "#include <a>", "#include", '#include "a'])
def test_badly_written_includes(line: str) -> None:
    with pytest.raises(GraphicsError, match=r"in quotes.* line 2"):
        compose(f"#version 330 core\n{line}\n")


def test_includes_in_comments_are_text() -> None:
    text = (
        "/* says\n"
        '#include "nothing"\n'
        "*/\n"
        "#version 330 core\n"
        '// #include "nothing"\n'
        "int a; /* one line */ // and /* no block\n"
        '#include "lib/a.glsl"\n'
    )
    assert compose(text, includes={"lib/a.glsl": "int b;"}).text.endswith("block\nint b;\n")


@pytest.mark.parametrize("text", ["int a;\n", "\n", "/* c */ int a;\n#version 330 core\n"])
def test_version_must_come_first(text: str) -> None:
    with pytest.raises(GraphicsError, match="does not start with '#version 330 core'"):
        compose(text)


def test_version_may_not_come_twice() -> None:
    with pytest.raises(GraphicsError, match=r"<text> -> lib/a.glsl, line 1"):
        compose(MAIN, includes={"lib/a.glsl": "#version 330 core\n"})


def test_line_ends_of_other_systems_and_a_byte_order_mark() -> None:
    source = compose("\ufeff#version 330 core\r\nint a;\rint b;\r\n")
    assert source.text == "#version 330 core\nint a;\nint b;\n"


@pytest.mark.parametrize(
    ("log", "expected"),
    [
        ("0:2(19): error: `x' undeclared", "lib/a.glsl:1: error: `x' undeclared\n    float a;"),
        (
            '0(3) : error C1008: undefined variable "x"',
            'main:3: error C1008: undefined variable "x"\n    void main() {}',
        ),
        (
            "ERROR: 0:2: 'x' : undeclared identifier",
            "lib/a.glsl:1: error: 'x' : undeclared identifier\n    float a;",
        ),
        ("WARNING: 0:3: unused", "main:3: warning: unused\n    void main() {}"),
        ("0:3: syntax error", "main:3: syntax error\n    void main() {}"),
        ("0:99(1): error: beyond", "0:99(1): error: beyond"),
        ("0:0(0): error: no line", "0:0(0): error: no line"),
        ("2 compilation errors. No code generated.", "2 compilation errors. No code generated."),
    ],
    ids=["mesa", "nvidia", "apple", "warning", "intel", "beyond", "zero", "other"],
)
def test_logs_of_all_drivers_point_into_the_files(log: str, expected: str) -> None:
    source = compose(MAIN, includes={"lib/a.glsl": "float a;\n"}, name="main")
    assert source.translate_log(f"{log}\n\0") == expected


def test_a_line_with_two_errors_is_quoted_once() -> None:
    source = compose(MAIN, includes={"lib/a.glsl": "float a;\n"}, name="main")
    assert source.translate_log("0:2(1): error: p\n0:2(7): error: q\n0:3(1): error: r") == (
        "lib/a.glsl:1: error: p\n    float a;\n"
        "lib/a.glsl:1: error: q\n"
        "main:3: error: r\n    void main() {}"
    )


def test_location_outside() -> None:
    source = compose("#version 330 core\nint a;\n")
    for line in (0, 3):
        with pytest.raises(ValueError, match="expected 1 to 2"):
            source.location(line)


code = st.lists(st.sampled_from(["", "int a;", "float b; // c", "#if X", "#endif"]), max_size=5)


@given(
    files=st.lists(code, min_size=1, max_size=4),
    calls=st.lists(st.tuples(st.integers(0, 4), st.integers(0, 4)), max_size=6),
)
def test_each_flat_line_is_the_line_it_claims_to_be(
    files: list[list[str]], calls: list[tuple[int, int]]
) -> None:
    # File i may include only later files, so there are no cycles.
    texts = [list(lines) for lines in files]
    for caller, callee in calls:
        if caller < callee < len(texts):
            texts[caller].append(f'#include "{callee}"')
    texts[0].insert(0, "#version 330 core")
    joined = ["\n".join(lines) + "\n" for lines in texts]
    source = compose(joined[0], includes={str(i): text for i, text in enumerate(joined)}, name="0")
    flat = source.text.split("\n")[:-1]
    assert len(flat) == len(source.lines)
    for text, (file, line) in zip(flat, source.lines, strict=True):
        assert joined[int(file)].split("\n")[line - 1] == text
    assert len(set(source.lines)) == len(source.lines)
