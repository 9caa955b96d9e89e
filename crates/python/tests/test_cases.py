"""Cases: reading, setting, faults, plans."""

import doctest
import pathlib

import numpy as np
import pytest

import piola
from piola import _piola

from helpers import program


def test_a_dict_is_the_text_of_a_case(table, tmp_path):
    case = piola.Case(table)
    file = tmp_path / "case.toml"
    file.write_text(case.toml)
    again = piola.Case.load(file)
    assert again.toml == case.toml
    assert case.title == "a column of water"
    assert 'title = "a column of water"' in case.toml
    assert case.faults() == []


def test_values_of_numpy_tuples_and_paths_are_values(table, tmp_path):
    plain = piola.Case(table).toml
    table["body"][0]["spacing"] = np.float64(0.25)
    table["body"][0]["shape"]["max"] = np.array([1.0, 2.0])
    table["probe"][0]["at"] = (0.5, 2.0)
    table["dimension"] = np.int32(2)
    assert piola.Case(table).toml == plain
    points = tmp_path / "points.csv"
    points.write_text("x,y,volume\n0,0,1\n1,0,1\n0,1,1\n1,1,1\n")
    table["body"][0] = {
        "name": "water",
        "shape": {"kind": "points", "file": pathlib.Path("points.csv")},
        "material": table["body"][0]["material"],
    }
    table["boundary"], table["probe"] = [], []
    case = piola.Case(table, folder=tmp_path)
    assert case.check().bodies[0]["particles"] == 4
    # Without the folder the file is not found, and the message says where it was looked for.
    (fault,) = piola.Case(table, folder=tmp_path / "other").faults()
    assert "there is no file" in fault.message and fault.help.startswith("paths are relative")


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [
        (object(), TypeError, "a case has numbers, strings, booleans, lists, dicts, functions, arrays and clouds, not `object`: in `time.end`"),
        (None, TypeError, "not `NoneType`: in `time.end`"),
        (1 << 70, ValueError, "the whole number is too large: in `time.end`"),
        ({1: 2}, TypeError, "keys of a case must be strings, not `int`: in `time.end`"),
        (1j, TypeError, "not `complex`: in `time.end`"),
    ],
)
def test_what_no_case_can_have_is_refused(table, value, error, text):
    table["time"]["end"] = value
    with pytest.raises(error) as caught:
        piola.Case(table)
    assert text in str(caught.value)


def test_a_list_that_holds_itself_is_refused(table):
    table["body"].append(table["body"])
    with pytest.raises(ValueError, match="nested too deeply"):
        piola.Case(table)


def test_set_is_the_override_of_the_command_line(case):
    assert case.set("body.water.spacing", 0.5) is case
    assert case.check().bodies[0]["spacing"] == [0.5, 0.5]
    case.set("load+", {"kind": "body_force", "acceleration": ["0", "-9.81"]})
    assert '[[load]]' in case.toml
    case.set("load", None)
    assert '[[load]]' not in case.toml
    # A key that the case itself does not have is set, and taken away again.
    case.set("body.water.initial", {"velocity": ["0", "-2"]}).set("body.water.initial", None)
    assert "initial" not in case.toml
    case.set("body.water.initial.velocity", ["0", "0"])
    assert case.start().energy["kinetic"] == 0.0
    with pytest.raises(ValueError, match="not the path of a key"):
        case.set("time.end=1", 2)


def test_a_key_that_is_set_again_is_set_once(case):
    for spacing in (0.5, 1.0, 0.25):
        case.set("time.end", spacing).set("body.water.spacing", spacing)
    assert repr(case) == "<Case of a dict, time.end=0.25, body.water.spacing=0.25>"
    assert case.check().bodies[0]["spacing"] == [0.25, 0.25]
    # Whatever words are in a value.
    case.set("title", "a column without a name").set("title", "a column")
    assert "without" not in repr(case)


def test_what_depends_on_a_key_that_is_set_again_stays(case):
    force = {"kind": "body_force", "acceleration": ["0", "1"]}
    # Two are appended.
    case.set("load+", force).set("load+", force)
    assert case.toml.count("[[load]]") == 2
    # Both are removed, one after the other.
    case.set("load.0", None).set("load.0", None)
    assert "[[load]]" not in case.toml
    # What is called for the second time is another one.
    case.set("load", [force, force, force]).set("load.1.acceleration", ["0", "2"])
    case.set("load.0", None).set("load.1.acceleration", ["0", "3"])
    assert [text in case.toml for text in ('"1"', '"2"', '"3"')] == [False, True, True]
    # A table is as it was set, whatever has been changed in it before.
    whole = {"velocity": ["0", "0"]}
    case.set("body.water.initial", whole).set("body.water.initial.velocity", ["0", "4"])
    assert '"4"' in case.toml
    assert '"4"' not in case.set("body.water.initial", whole).toml
    # By its name a body has been found.
    case.set("body.0.name", "sea").set("body.sea.spacing", 0.5).set("body.0.name", "lake")
    assert case.check().bodies[0]["name"] == "lake"


def test_faults_have_the_text_and_places_of_the_program(table, tmp_path):
    table["body"][0]["spacing"] = -1.0
    table["scheme"]["kernl"] = "gauss"
    case = piola.Case(table)
    faults = case.faults()
    assert len(faults) == 2
    with pytest.raises(piola.CaseError) as caught:
        case.start()
    error = caught.value
    assert isinstance(error, ValueError)
    assert [fault.message for fault in error.faults] == [fault.message for fault in faults]
    # The same text in a file gets the same text from the program.
    assert str(error).count("--> case:") == 2
    (tmp_path / "case.toml").write_text(case.text)
    shown = program("check", "case.toml", cwd=tmp_path)
    assert shown.returncode == 2
    assert shown.stderr.startswith(str(error).replace("--> case:", "--> case.toml:"))
    fault = next(fault for fault in faults if "spacing" in fault.message)
    line = case.text.splitlines()[fault.line - 1]
    assert line[fault.column - 1 :] == "-1.0"
    assert (fault.source, fault.label) == ("case", "must be above 0")


def test_faults_of_set_point_into_what_was_set(case):
    case.set("time.cfl", "fast")
    (fault,) = case.faults()
    assert fault.source == "command line"
    # The text of the value stands in quotes.
    assert (fault.line, fault.column) == (1, len('--set time.cfl="') + 1)
    assert "Fault command line:1:" in repr(fault)


def test_nan_in_a_case_is_a_fault_with_its_place(case):
    case.set("time.end", float("nan"))
    (fault,) = case.faults()
    assert fault.message == "expected a finite number, got NaN"


def test_what_only_particles_show_is_a_fault(case):
    case.set("boundary.floor.where.point", [0.0, -5.0])
    (fault,) = case.faults()
    assert fault.message == "this region selects no particle"
    assert case.text.splitlines()[fault.line - 1] == "[boundary.where]"
    with pytest.raises(piola.CaseError):
        case.check()


def test_files_that_are_not_there(tmp_path):
    with pytest.raises(piola.CaseError, match="cannot be read") as caught:
        piola.Case.load(tmp_path / "none.toml")
    (fault,) = caught.value.faults
    assert (fault.line, fault.column) == (None, None)
    bad = tmp_path / "case.toml"
    bad.write_text("version = 1\ntitle = ")
    # What is wrong in a file is said when it is asked for.
    case = piola.Case.load(bad)
    assert "a value is missing here" in case.faults()[0].message
    assert "a value is missing here" in case._repr_html_()
    with pytest.raises(piola.CaseError):
        case.title  # noqa: B018


def test_settings_and_variants(tmp_path):
    assert program("new", "mine", cwd=tmp_path).returncode == 0
    file = tmp_path / "mine" / "case.toml"
    fine, coarse = piola.Case.load(file), piola.Case.load(file, level="coarse")
    assert (fine.check().bodies[0]["particles"], coarse.check().bodies[0]["particles"]) == (231, 66)
    with pytest.raises(ValueError, match='level must be "case", "coarse" or "paper", not "rough"'):
        piola.Case.load(file, level="rough")
    with pytest.raises(piola.CaseError, match="nothing"):
        piola.Case.load(file, variant="nothing").check()


def test_the_plan_is_that_of_the_program(case, tmp_path):
    plan = case.check()
    (tmp_path / "case.toml").write_text(case.toml)
    shown = program("check", "case.toml", cwd=tmp_path)
    # What was measured differs.
    kept = [
        [line for line in text.splitlines() if not line.startswith("wall time")]
        for text in (str(plan), shown.stdout)
    ]
    assert kept[0] == kept[1] and len(kept[0]) > 8
    (body,) = plan.bodies
    assert body == {
        "name": "water",
        "particles": 45,
        "volume": 2.0,
        "exact_volume": 2.0,
        "finest": 1.0,
        "spacing": [0.25, 0.25],
    }
    assert plan.limits[0]["step"] == plan.step and plan.limits[0]["name"] == plan.limiter == "acoustic"
    assert plan.steps == int(np.ceil(0.2 / plan.step - 1e-9))
    assert plan.neighbors["least"] <= plan.neighbors["mean"] <= plan.neighbors["most"]
    assert plan.seconds > 0 and plan.memory > 45 * 8 and plan.evaluations_per_second > 0
    assert plan.notes == plan.warnings == [] and len(plan.outputs) == 2
    html = plan._repr_html_()
    assert html.startswith("<table>") and "45 particles" in html and html.count("<tr>") == len(kept[0]) - 1


def test_a_stiff_solid_in_a_fluid_is_told_its_viscosity(tmp_path):
    def body(name, low, high, material, rest=""):
        lattice = "lattice = { on = 'cells' }"
        shape = f"shape = {{ kind = 'box', min = {low}, max = {high} }}"
        return f"[[body]]\nname = '{name}'\n{shape}\n{lattice}\nmaterial = {{ {material} }}\n{rest}\n"

    fluid = "kind = 'weakly_compressible', density = 1000.0, wave_speed = 30.0"
    solid = "kind = 'saint_venant_kirchhoff', density = 1100.0, young_modulus = 5e8, poisson_ratio = 0.3"
    text = "".join(
        [
            "version = 1\ntitle = 'Plate'\ndimension = 2\n",
            body("water", [0.0, 0.0], [0.5, 0.5], fluid, "spacing = 0.05"),
            body("floor", [0.0, -0.15], [0.65, 0.0], fluid, "spacing = 0.05\nwall = {}"),
            body("plate", [0.5, 0.0], [0.65, 0.6], solid, "spacing = 0.025\nsystem = 'plate'"),
            "[scheme]\nkind = 'transport_velocity'\nfree_surface = true\n",
            "[[system]]\nname = 'plate'\nscheme = { kind = 'total_lagrangian' }\n",
            "[time]\nend = 0.001\n",
        ]
    )
    path = tmp_path / "plate.toml"
    path.write_text(text)
    case = piola.Case.load(path)
    (note,) = case.check().notes
    assert "system `plate`" in note and "`scheme.viscosity` is" in note
    run = case.start().run()
    assert run.notes == [note]


def test_the_plan_of_several_ranks(table):
    assert piola.Case(table).check().ranks == [] and piola.Case(table).check().efficiency == 1.0
    table["compute"] = {"ranks": 2}
    table["time"]["integrator"] = "ssp_rk3"
    plan = piola.Case(table).check()
    # Whole chunks of 16.
    assert [rank["particles"] for rank in plan.ranks] in ([16, 29], [32, 13])
    for rank in plan.ranks:
        assert rank["partners"] == 1 and rank["copies"] > 0
        # Three evaluations of the rates in a step.
        assert rank["step_bytes"] == 3 * rank["bytes"] > 0
        assert 0 < rank["efficiency"] < 1
    assert sum(rank["load"] for rank in plan.ranks) == pytest.approx(2)
    assert 0 < plan.efficiency < 1
    assert sum("copies of" in line for line in str(plan).splitlines()) == 2


def test_a_case_in_a_notebook_is_escaped(table):
    table["title"] = "<b>&"
    html = piola.Case(table)._repr_html_()
    assert "<caption>&lt;b&gt;&amp;</caption>" in html and "<b>" not in html


@pytest.mark.parametrize("module", [piola, _piola])
def test_examples_in_docstrings_run(module):
    finder = doctest.DocTestFinder(exclude_empty=True)
    runner = doctest.DocTestRunner()
    examples = 0
    for name, member in [("", module), *vars(module).items()]:
        if getattr(member, "__doc__", None) and not name.startswith("__"):
            for test in finder.find(member, name or module.__name__, module=False):
                examples += len(test.examples)
                runner.run(test)
    assert runner.summarize().failed == 0
    assert examples >= 3


def test_all_that_is_public_has_a_docstring():
    for name in piola.__all__:
        if name == "__version__":
            continue
        member = getattr(piola, name)
        assert member.__doc__, name
        for attribute, value in getattr(member, "__dict__", {}).items():
            if not attribute.startswith("_"):
                assert value.__doc__, f"{name}.{attribute}"


def test_the_stubs_name_all_there_is():
    import ast  # noqa: PLC0415

    folder = pathlib.Path(piola.__file__).parent
    assert (folder / "py.typed").exists()
    tree = ast.parse((folder / "_piola.pyi").read_text())
    stubs = {node.name: node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
    for name in [name for name in vars(_piola) if not name.startswith("__")]:
        assert name in stubs, name
        node = stubs[name]
        if not isinstance(node, ast.ClassDef):
            continue
        known = {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
        known |= {item.target.id for item in node.body if isinstance(item, ast.AnnAssign)}
        there = {key for key in vars(getattr(_piola, name)) if not key.startswith("__")}
        there |= {key for key in ("__getitem__", "__setitem__", "__len__", "__iter__", "__next__", "__enter__")
                  if key in vars(getattr(_piola, name))}
        there -= {"_repr_html_"}
        assert there <= known, (name, there - known)
        # What the stubs promise is there; attributes of exceptions are set when they are raised.
        if not name.endswith("Error"):
            assert {key for key in known if not key.startswith("__")} <= there, (name, known - there)
