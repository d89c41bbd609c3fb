"""Scenes are read by the reader of the program, whether of files, texts or dicts."""

import copy
import inspect
import os
import pickle
import warnings
from concurrent.futures import ProcessPoolExecutor
from importlib.metadata import version
from multiprocessing import get_context

import numpy as np
import pytest

import tabray

BALL = """look_at eye { pixeldim 8 6  position 0 0 9  target 0 0 0  angle 40 }
material red { ambient 0.2 0 0  diffuse 1 0 0 }
let size 2
sphere ball { material red  center 0 0 0  radius "size" }
light lamp { location 2 5 9  emissivity 1 1 1 }
"""

AS_DICTS = {
    "look_at": {"eye": {"pixeldim": [8, 6], "position": [0, 0, 9], "target": np.zeros(3), "angle": 40}},
    "material": {"red": {"ambient": [0.2, 0, 0], "diffuse": (1, 0, 0)}},
    "sphere": {"ball": {"material": "red", "center": np.zeros(3, np.float32), "radius": np.float64(2)}},
    "light": {"lamp": {"location": [2, 5, 9], "emissivity": [1, 1, 1]}},
}


def test_dicts_make_the_scene_of_the_text():
    of_text, of_dicts = tabray.parse(BALL), tabray.scene(AS_DICTS)
    assert np.array_equal(of_text.render().array, of_dicts.render().array)
    assert of_dicts.objects == ["ball"] and of_dicts.size == (8, 6)


def test_entities_make_dicts_with_help_from_the_tables():
    ball = tabray.entities.sphere("ball", material="red", center=[0, 0, 0], radius=2)
    assert ball == {"sphere": {"ball": {"material": "red", "center": [0, 0, 0], "radius": 2}}}
    rest = {kind: named for kind, named in AS_DICTS.items() if kind != "sphere"}
    assert tabray.scene([rest, ball]).objects == ["ball"]
    assert "radius" in tabray.entities.sphere.__doc__ and "positive" in tabray.entities.sphere.__doc__
    assert "sphere" in dir(tabray.entities)
    with pytest.raises(AttributeError, match="there is no entity type `spehre`"):
        tabray.entities.spehre


@pytest.mark.parametrize("kind", tabray.entities.__all__)
def test_each_entity_describes_all_of_its_attributes(kind):
    function = getattr(tabray.entities, kind)
    assert function.__doc__ and function.__name__ == kind


def test_values_are_set_beside_a_text():
    hits = tabray.parse(BALL, set={"size": 3}).hits([0, 0, 9], [0, 0, -1])
    assert hits.t[0] == 6
    moved = tabray.parse(BALL, set={"ball.center": np.array([0, 0, 1.0]), "eye.pixeldim": [4, 3]})
    assert moved.hits([0, 0, 9], [0, 0, -1]).t[0] == 6 and moved.size == (4, 3)


def test_an_error_is_the_message_of_the_command_line_with_its_places_as_data():
    with pytest.raises(tabray.SceneError) as caught:
        tabray.parse(BALL.replace("radius", "raduis").replace("ambient", "ambiant"))
    error = caught.value
    assert isinstance(error, ValueError)
    assert str(error).startswith("error: material `red` has no attribute `ambiant`\n --> <text>:2:16")
    assert "did you mean `radius`?" in str(error)
    assert [(fault.line, fault.column, fault.is_error) for fault in error.faults] == [(2, 16, True), (4, 43, True)]
    first = error.faults[0]
    assert first.path == "<text>" and first.help and BALL.replace("ambient", "ambiant")[slice(*first.span)] == "ambiant"
    again = pickle.loads(pickle.dumps(error))
    assert str(again) == str(error) and again.faults == error.faults


def test_an_error_in_dicts_names_the_entity_and_the_attribute():
    wrong = {**AS_DICTS, "sphere": {"ball": {"material": "red", "center": [0, 0], "radius": -1}}}
    with pytest.raises(tabray.SceneError) as caught:
        tabray.scene(wrong)
    assert len(caught.value.faults) == 2
    assert all("`ball`" in fault.message for fault in caught.value.faults)
    assert "`center`" in caught.value.faults[0].message
    paths = [fault.path for fault in caught.value.faults]
    assert paths == ['scene["sphere"]["ball"]["center"]', 'scene["sphere"]["ball"]["radius"]'], paths
    told = str(caught.value)
    assert f" --> {paths[1]}" in told and "radius = -1" not in told and "[sphere" not in told, told
    with pytest.raises(tabray.SceneError) as caught:
        tabray.scene([{"let": {"n": 1}}, tabray.entities.sphere("ball", raduis=1)])
    assert ' --> scene[1]["sphere"]["ball"]["raduis"]: did you mean `radius`?' in str(caught.value)
    assert all(fault.line is None and fault.span is None for fault in caught.value.faults)
    for wrong in [{"sphere": 5}, {"sphere": {"ball": 5}}, {"sphere": {"ball": {"radius": object()}}}]:
        with pytest.raises(TypeError):
            tabray.scene(wrong)


def test_files_that_are_missing_are_told_as_such(tmp_path):
    for name in ["none.ray", "none.obj"]:
        with pytest.raises(FileNotFoundError):
            tabray.load(tmp_path / name)


def test_names_of_files_are_relative_to_the_scene(scenes):
    assert tabray.load(scenes / "entities" / "mesh.ray").objects
    assert tabray.load(str(scenes / "toml" / "tables.toml")).objects


def test_a_warning_is_a_warning_of_python():
    with pytest.warns(tabray.SceneWarning):
        tabray.parse(BALL.replace("ambient 0.2 0 0", "ambient 200 0 0"))
    bright = {**AS_DICTS, "material": {"red": {"ambient": [200, 0, 0]}}}
    with pytest.warns(tabray.SceneWarning, match="scene.*material.*red") as warned:
        tabray.scene(bright)
    assert warned[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        tabray.parse(BALL)


def test_a_scene_without_a_camera_is_asked_about_rays_alone():
    scene = tabray.parse("material red { }  sphere ball { material red  center 0 0 0  radius 2 }")
    assert not scene.has_camera and scene.size is None and scene._repr_png_() is None
    assert scene.hits([[0, 0, 9]], [[0, 0, -1]]).t[0] == 7
    with pytest.raises(ValueError, match="no camera"):
        scene.render()
    with pytest.raises(ValueError, match="no camera"):
        scene.verify()


def test_the_syntax_can_be_named():
    assert tabray.parse(BALL, syntax="ray").objects == ["ball"]
    with pytest.raises(tabray.SceneError):
        tabray.parse(BALL, syntax="toml")
    with pytest.raises(ValueError, match="there is no syntax"):
        tabray.parse(BALL, syntax="yaml")


def test_a_surface_has_parameters():
    scene = tabray.surface("x^2 + y^2 + z^2 - r^2", r=1.5, width=32, height=24)
    hits = scene.hits([0, 0, 5], [0, 0, -1])
    assert hits.t_low[0] <= 3.5 <= hits.t_high[0]
    assert scene.render(samples=1, objects=True).objects[12, 16] == 0
    assert tabray.surface("z", box=[0, 0, -1, 1, 1, 1], width=8, height=6).objects == ["surface"]
    with pytest.raises(tabray.SceneError) as caught:
        tabray.surface("x^2 + y^2 + z^2 - q")
    assert " --> formula, at `q`" in str(caught.value), caught.value
    with pytest.raises(tabray.SceneError) as caught:
        tabray.surface("x + a", a="2 +")
    assert " --> a" in str(caught.value) and "[let]" not in str(caught.value), caught.value
    with pytest.raises(tabray.SceneError) as caught:
        tabray.surface("x", width=-3)
    assert " --> width" in str(caught.value), caught.value
    with pytest.raises(ValueError, match="six numbers"):
        tabray.surface("z", box=[1, 2])


def test_reprs_say_what_there_is():
    scene = tabray.parse(BALL)
    assert repr(scene) == "<tabray.Scene `<text>`: 1 object, 1 light, 8 x 6 pixels>"
    assert repr(scene.render()) == "<tabray.Image of 8 x 6 pixels>"
    assert repr(scene.verify()).startswith("<tabray.Proof of 48 pixels: ")


def test_a_scene_is_pickled_as_its_text(tmp_path, monkeypatch, scenes):
    bright = BALL.replace("ambient 0.2 0 0", "ambient 200 0 0")
    with pytest.warns(tabray.SceneWarning):
        warned = tabray.parse(bright, set={"size": 3})
    bare = tabray.parse("material red { }  sphere ball { material red  center 0 0 0  radius 2 }")
    mesh = tabray.load(os.path.relpath(scenes / "models" / "knot.obj"))
    pickled = [pickle.dumps(scene) for scene in [warned, tabray.scene(AS_DICTS), bare, mesh]]
    # File names are relative to the folder of the scene, wherever it is made again.
    monkeypatch.chdir(tmp_path)
    for text, scene in zip(pickled, [warned, tabray.scene(AS_DICTS), bare, mesh]):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            again = pickle.loads(text)
        assert repr(again) == repr(scene)
        hits, others = [each.hits([0, 0, 90], [0.01, 0, -1]) for each in (scene, again)]
        assert hits.t.tolist() == others.t.tolist() or np.isnan(hits.t).all()
    assert np.array_equal(pickle.loads(pickled[0]).render().array, warned.render().array)
    assert copy.copy(warned) is warned and copy.deepcopy(warned) is warned


def distance(scene):
    """Return how far away the scene is."""
    return float(scene.hits([0, 0, 9], [0, 0, -1]).t[0])


def test_other_processes_take_scenes():
    scenes = [tabray.parse(BALL, set={"size": size}) for size in (1, 2, 3)]
    with ProcessPoolExecutor(2, get_context("spawn")) as pool:
        assert list(pool.map(distance, scenes)) == [8, 7, 6]


def test_the_package_says_its_version():
    assert tabray.__version__ == version("tabray")


def test_functions_of_entities_are_typed_by_their_names():
    """The stub is made from the tables by tests/scene/python.rs."""
    with open(os.path.join(os.path.dirname(tabray.__file__), "entities.pyi")) as stub:
        text = stub.read()
    for kind in tabray.entities.__all__:
        own = text.split(f"\ndef {kind}(")[1].split(")")[0]
        for name in inspect.signature(getattr(tabray.entities, kind)).parameters:
            assert f"    {name}: " in own, (kind, name)
