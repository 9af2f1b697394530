"""The whole vision: what the program writes is what Python gets, for files and for arrays."""
import json
import os
import subprocess
import threading

import numpy as np
import pytest

import tassilo
from conftest import DATA
from tassilo import Camera, Field, Frame, Vision

CLIP = DATA / "d01_approach"


@pytest.fixture(scope="module")
def vision(colors):
    return Vision(colors, CLIP / "camera.yaml", "msl98")


def without_times(scene):
    return {**scene, "timing_ms": sorted(set(scene["timing_ms"]) - {"decode"})}


def without_history(scene):
    """What the frame shows by itself: no pose and no tracks, which need the frames before."""
    lines = [{key: value for key, value in line.items() if key != "model"} for line in scene["lines"]]
    why = {subject: reason for subject, reason in scene["why"].items() if subject != "pose"}
    return {**scene, "pose": None, "tracks": [], "lines": lines, "why": why}


def test_scenes_are_the_lines_of_the_program(vision, colors, tmp_path):
    colors.save(tmp_path / "colors.yaml")
    subprocess.run([os.environ["TASSILO_PROGRAM"], "run", "--robot", CLIP / "robot.yaml", "--colors", tmp_path / "colors.yaml",
                    "--source", CLIP / "video.mkv", "--output", tmp_path / "scenes.jsonl", "--quiet"], check=True)
    lines = (tmp_path / "scenes.jsonl").read_text().splitlines()
    robot = Vision.from_robot(CLIP / "robot.yaml", colors=tmp_path / "colors.yaml")
    frames = list(tassilo.open_source(CLIP / "video.mkv"))
    assert len(lines) == len(frames)
    for line, frame in zip(lines, frames):
        # The program knows the frames before; here each frame is seen by itself.
        expected, *seen = [without_times(scene) for scene in (json.loads(line), vision(frame), robot(frame))]
        assert all(list(scene) == list(expected) for scene in seen)
        pose, *poses = [scene["pose"] for scene in (expected, *seen)]
        assert [without_history(scene) for scene in seen] == [without_history(expected)] * 2
        for other in poses:
            assert other is None or abs(other["x"] - pose["x"]) < .1 and abs(other["y"] - pose["y"]) < .1


def test_arrays_are_seen_as_the_video_is(vision, frame):
    yuv = frame.to_yuv()
    copy = Frame.yuv422p(np.ascontiguousarray(yuv[:, :, 0]), np.ascontiguousarray(yuv[:, ::2, 1]),
                         np.ascontiguousarray(yuv[:, ::2, 2]), t=frame.t, index=frame.index)
    assert without_times(vision(copy)) == without_times(vision(frame))


def test_without_a_camera_everything_stays_in_the_image(colors, frame):
    scene = Vision(colors)(frame)
    assert scene["balls"] and scene["balls"][0]["x"] is None and scene["free_space"] is None


def test_parts_are_objects_or_files(colors, frame, tmp_path):
    colors.save(tmp_path / "c.yaml")
    camera, field = Camera.load(CLIP / "camera.yaml"), Field.load("msl98")
    a, b = Vision(colors, camera, field), Vision(tmp_path / "c.yaml", str(CLIP / "camera.yaml"), "msl98")
    assert without_times(a(frame)) == without_times(b(frame))


def test_options_are_those_of_the_robot_file(colors, frame):
    options = {info["key"]: info for info in tassilo.vision_options()}
    assert options["free_space_sector"]["unit"] == "deg"
    few = Vision(colors, CLIP / "camera.yaml", options={"free_space_sector": 10, "ball_max": 1})(frame)
    assert few["free_space"]["angle_increment"] == pytest.approx(np.radians(10)) and len(few["balls"]) <= 1
    for bad in ({"ball_maximum": 1}, {"ball_max": 0}, {"ball_max": 1.5}, {"ball_max": "1"}, {"line_slant": float("nan")}):
        with pytest.raises(ValueError, match="options: .*(must be|did you mean)"):
            Vision(colors, options=bad)


def test_stages_are_chosen_by_name(colors, frame):
    stages = {stage["key"]: stage for stage in tassilo.stages()}
    assert [a["name"] for a in stages["field_boundary"]["alternatives"]] == ["subpixel", "skeleton"]
    assert stages["surface"]["alternatives"] == [] and all(stage["meaning"] for stage in stages.values())
    listed = [option["key"] for stage in stages.values() for option in stage["options"]]
    assert sorted(listed) == sorted(option["key"] for option in tassilo.vision_options())
    for stage in stages.values():
        for alternative in stage["alternatives"]:
            vision = Vision(colors, CLIP / "camera.yaml", options={stage["key"]: alternative["name"]})
            assert vision(frame)["balls"]
    for bad in ({"field_boundary": "skeletom"}, {"field_boundary": 1}, {"localization": None}):
        with pytest.raises(ValueError, match="options: vision.*must be (subpixel or skeleton|model or boundary)"):
            Vision(colors, options=bad)


def test_a_robot_file_brings_alternatives(colors, frame, tmp_path):
    colors.save(tmp_path / "colors.yaml")
    robot = tmp_path / "robot.yaml"
    robot.write_text(f"colors: colors.yaml\nplugins: [{os.environ['TASSILO_PLUGIN']}]\nvision: {{balls: blind}}\n")
    for _ in range(2):  # read again, in one process
        scene = Vision.from_robot(robot)(frame)
        assert scene["balls"] == [] and scene["why"]["balls"] == "blind"
    robot.write_text("colors: colors.yaml\nplugins: [none.so]\n")
    with pytest.raises(tassilo.Error, match="robot.yaml: names .*none.so as a plug-in, which does not exist"):
        Vision.from_robot(robot)


def test_wrong_types_are_type_errors(colors):
    for call in (lambda: Vision(3), lambda: Vision(None), lambda: Vision(colors, 3), lambda: Vision(colors, field=None),
                 lambda: Vision(colors)(3), lambda: Vision(colors, options=[1])):
        with pytest.raises(TypeError):
            call()


def test_frames_that_do_not_fit_are_refused(vision, colors):
    small = np.zeros((4, 4, 3), np.uint8)
    with pytest.raises(tassilo.Error, match="4x4"):
        vision(Frame.rgb(small))
    with pytest.raises(tassilo.Error, match="full"):
        vision(Frame.rgb(small, range="full"))
    with pytest.raises(ValueError, match="must be at most 32000"):
        Vision(colors)(Frame.rgb(np.zeros((1, 32600, 3), np.uint8)))
    assert Vision(colors)(Frame.rgb(np.zeros((1, 32000, 3), np.uint8)))["balls"] == []
    assert Vision(colors)(Frame.rgb(np.zeros((1, 1, 3), np.uint8)))["balls"] == []


def test_one_vision_serves_many_threads(vision):
    frames = list(tassilo.open_source(CLIP / "video.mkv"))[:8]
    expected = [without_times(vision(f)) for f in frames]
    results = {}

    def see(k):
        results[k] = [without_times(vision(f)) for f in frames]

    threads = [threading.Thread(target=see, args=(k,)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(results[k] == expected for k in range(4))


def test_pictures_show_what_was_seen(vision, frame, tmp_path):
    scene = vision(frame)
    with_view, alone = vision.draw(frame, scene), vision.draw(frame, scene, scale=2, bird_view=False)
    assert with_view.dtype == np.uint8 and with_view.shape[1] > alone.shape[1] >= 2 * frame.width
    tassilo.write_png(tmp_path / "scene.png", with_view)
    for bad in (17, -1):
        with pytest.raises(ValueError, match="scale"):
            vision.draw(frame, scene, scale=bad)
    with pytest.raises(tassilo.Error, match="scene"):
        vision.draw(frame, {"balls": []})


def test_cameras_map_pixels_to_metres():
    camera = Camera.load(CLIP / "camera.yaml")
    assert (camera.width, camera.height) == (384, 172) and camera.mount["z"] > 0.4
    x, y = camera.floor_point(190, 120)
    column, row = camera.project(x, y)
    assert (column, row) == (pytest.approx(190, abs=1e-6), pytest.approx(120, abs=1e-6))
    assert camera.floor_point(190, 0) is None and camera.project(-1, 0) is None
    assert repr(Camera.from_yaml(camera.to_yaml())) == repr(camera) == "<tassilo.Camera: 384x172, division, mounted>"
    lens = Camera.from_yaml(camera.to_yaml().partition("camera_pose_in_robot")[0])
    for call in (lambda: lens.floor_point(1, 1), lambda: Vision(DATA / "none.yaml", lens)):
        with pytest.raises((ValueError, tassilo.Error)):
            call()


def test_fields_have_names():
    field = Field.load("msl98")
    assert field.name == "msl98" and field.length == 8.22 and repr(field) == "<tassilo.Field: msl98>"
    with pytest.raises(tassilo.Error, match="msl98"):
        Field.load("msl99")
    assert Field.from_yaml("{length: 3, width: 2}").width == 2
