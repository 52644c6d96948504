"""Exports of logs, read back with the libraries of their formats, and imports."""

import csv
import json
import math
import sys
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory
from pyarrow import parquet
from typer.testing import CliRunner

from fwk.cli.commands import app
from fwk.lcm.event_log import LogError
from fwk.log_tools.columns import columns_of
from fwk.log_tools.export import Exported, Format, export, import_log
from fwk.log_tools.plain import json_schema, of_plain, plain
from fwk.log_tools.selection import Selection
from fwk.recording.log_info import log_info
from lcmtypes.core import frame_events_t, log_t, picture_t, transform_t, transforms_t
from lcmtypes.robot import gps_fix_t, joint_state_t, laser_scan_t, odometry_t
from lcmtypes.soccer import obstacle_percepts_t, obstacle_t, pose_t, world_model_t
from tests.fwk.log_tools.log_tools_made import PLAIN, heard, recording
from tests.fwk.recording.recording_made import PERIOD_US, odometry, write


def exported(log: Path, form: Format, *channels: str) -> tuple[Path, Exported]:
    out = log.with_name(f"out.{form}")
    return out, export(log, out, form, Selection(channels))


def topics(path: Path) -> dict[str, list[tuple[str, Any]]]:
    """Returns the messages of an MCAP file by topic, each with the name of its schema, checked by its check sums."""
    found: dict[str, list[tuple[str, Any]]] = defaultdict(list)
    with open(path, "rb") as file:
        for schema, channel, message in make_reader(file, validate_crcs=True).iter_messages():
            decode = DecoderFactory().decoder_for(channel.message_encoding, schema) or json.loads
            found[channel.topic].append((schema.name if schema else "", decode(message.data)))
    return found


def test_columns_follow_the_members_of_a_type() -> None:
    names = [column.name for column in columns_of(world_model_t)]
    assert names[:7] == [f"header.{each}" for each in ("tick", "sequence", "time_us", "stage", "writer")] + [
        "localized", "x_m",
    ]  # fmt: skip
    assert {"ball.x_m", "ball.covariance.3.0", "mates", "ball_holder"} <= set(names)
    message = world_model_t()
    message.ball.covariance[3][0] = 7.5
    (column,) = [column for column in columns_of(world_model_t) if column.name == "ball.covariance.3.0"]
    assert (column.value(message), column.kind) == (7.5, "double")


def test_csv_has_a_file_for_each_channel(tmp_path: Path) -> None:
    out, done = exported(recording(tmp_path / "log", ticks=3), Format.CSV, "cyan1/*", PLAIN)
    assert done.messages == 3 * 3 + 1, "the plan as well"
    rows = list(csv.DictReader((out / "cyan1" / "odometry.csv").read_text().splitlines()))
    assert [(row["log_time_us"], row["header.sequence"], row["x_m"]) for row in rows] == [
        ("50000", "1", "0.05"),
        ("100000", "2", "0.1"),
        ("150000", "3", "0.15000000000000002"),
    ]
    models = csv.DictReader((out / "cyan1" / "world_model.csv").read_text().splitlines())
    assert json.loads(next(models)["mates"])[0]["name"] == "cyan2"
    titles, first, *_ = (out / "arm" / "times.csv").read_text().splitlines()
    assert titles == "log_time_us,header.tick,header.sequence,header.time_us,header.stage,header.writer,n,bucket,count"
    assert first == "50000,1,1,0,0,,0,[],[]", "the stamp is the header"


def test_parquet_has_typed_columns_and_lists(tmp_path: Path) -> None:
    out, _ = exported(recording(tmp_path / "log", ticks=3), Format.PARQUET, "cyan1/*")
    table = parquet.read_table(out / "cyan1" / "world_model.parquet")
    kinds = {name: str(table.schema.field(name).type) for name in ("log_time_us", "ball.known", "ball.x_m")}
    assert kinds == {"log_time_us": "int64", "ball.known": "bool", "ball.x_m": "double"}
    row = table.to_pylist()[2]
    assert (row["ball.x_m"], row["mates"][0]["name"]) == (pytest.approx(0.3), "cyan2")


def test_parquet_keeps_lists_of_texts(tmp_path: Path) -> None:
    joints = joint_state_t(n_joints=2, names=["hip", "knee"], positions=[0.0] * 2, velocities=[0.0] * 2)
    joints.efforts = [0.0] * 2
    out, _ = exported(write(tmp_path / "log", [("arm/joints", joints.encode(), PERIOD_US)]), Format.PARQUET)
    table = parquet.read_table(out / "arm" / "joints.parquet")
    assert str(table.schema.field("names").type) == "list<element: string>"
    assert table.to_pylist()[0]["names"] == ["hip", "knee"]


def test_json_lines_have_channel_type_and_message(tmp_path: Path) -> None:
    out, _ = exported(recording(tmp_path / "log", ticks=1), Format.JSONL, "cyan1/odometry")
    rows = [json.loads(line) for line in out.read_text().splitlines()]
    assert (rows[1]["channel"], rows[1]["type"], rows[1]["log_time_us"]) == (
        "cyan1/odometry",
        "robot.odometry_t",
        50_000,
    )
    assert rows[1]["message"]["x_m"] == 0.05
    assert rows[1]["message"]["header"]["writer"] == "cyan1/base"


def test_json_keeps_every_value() -> None:
    message = odometry(3, 1)
    message.x_m, message.y_m, message.heading_rad = math.nan, math.inf, -math.inf
    text = json.dumps(plain(message), allow_nan=False)
    back = of_plain(odometry_t, json.loads(text))
    assert (math.isnan(back.x_m), back.y_m, back.heading_rad) == (True, math.inf, -math.inf)
    picture = picture_t()
    picture.n, picture.data = 3, b"\0\xff7"
    assert plain(picture)["data"] == "AP83"
    assert of_plain(picture_t, plain(picture)).data == b"\0\xff7"
    assert json_schema(frame_events_t)["properties"]["frame"] == {"type": "array", "items": {"type": "integer"}}


def test_an_mcap_file_becomes_the_same_log_again(tmp_path: Path) -> None:
    log = recording(tmp_path / "log")
    out, done = exported(log, Format.MCAP)
    assert done.views > 0
    back = import_log(out, tmp_path / "back")
    assert back.left_out == {}
    assert (tmp_path / "back").read_bytes() == log.read_bytes()
    assert log_info(tmp_path / "back").from_index


def test_unknown_types_stay_bytes_in_mcap(tmp_path: Path) -> None:
    log = write(tmp_path / "log", [("JOYSTICK", b"12345678 whatever", 50_000), ("JOYSTICK", b"", 100_000)])
    out, done = exported(log, Format.MCAP)
    assert done.undecodable == {"JOYSTICK": 2}
    import_log(out, tmp_path / "back")
    assert (tmp_path / "back").read_bytes() == log.read_bytes()


def test_own_types_have_a_json_schema_in_mcap(tmp_path: Path) -> None:
    out, _ = exported(recording(tmp_path / "log", ticks=1), Format.MCAP, "cyan1/odometry")
    with open(out, "rb") as file:
        summary = make_reader(file).get_summary()
    assert summary
    (schema,) = [each for each in summary.schemas.values() if each.name == "robot.odometry_t"]
    assert schema.encoding == "jsonschema"
    properties = json.loads(schema.data)["properties"]
    assert properties["x_m"] == {"type": "number"}
    assert properties["header"]["properties"]["tick"] == {"type": "integer"}


def views(tmp_path: Path, channel: str, message: Any) -> dict[str, tuple[str, Any]]:
    """Returns the views of a message by topic."""
    out, _ = exported(write(tmp_path / "log", [(channel, message.encode(), PERIOD_US)]), Format.MCAP)
    return {topic: found[0] for topic, found in topics(out).items() if topic.startswith("view/")}


def test_images_are_foxglove_images(tmp_path: Path) -> None:
    picture = picture_t()
    picture.camera, picture.format, picture.data, picture.n = "cyan1/image", "png", b"png", 3
    name, image = views(tmp_path, "fwk/frame", picture)["view/cyan1/image"]
    assert (name, image.format, image.data, image.timestamp.nanos) == (
        "foxglove.CompressedImage",
        "png",
        b"png",
        50_000_000,
    )
    (tmp_path / "out.mcap").unlink()
    picture.format, picture.width_px, picture.height_px, picture.channels, picture.n = "raw", 1, 1, 3, 3
    name, image = views(tmp_path, "fwk/frame", picture)["view/cyan1/image"]
    assert (name, image.encoding, image.step, image.data) == ("foxglove.RawImage", "bgr8", 3, b"png")


def test_a_pose_is_a_pose_and_the_frame_of_its_robot(tmp_path: Path) -> None:
    pose = pose_t()
    pose.x_m, pose.heading_rad, pose.localized = 2.0, math.pi / 2, True
    found = views(tmp_path, "cyan1/pose", pose)
    name, shown = found["view/cyan1/pose"]
    assert (name, shown.frame_id, shown.pose.position.x) == ("foxglove.PoseInFrame", "world", 2.0)
    assert shown.pose.orientation.w == pytest.approx(math.sqrt(0.5))
    name, frames = found["view/cyan1/pose/frame"]
    assert (name, frames.transforms[0].parent_frame_id, frames.transforms[0].child_frame_id) == (
        "foxglove.FrameTransforms", "world", "cyan1/robot",
    )  # fmt: skip


def test_a_robot_that_is_lost_has_no_pose(tmp_path: Path) -> None:
    assert [*views(tmp_path, "cyan1/pose", pose_t())] == ["view/cyan1/pose/scene"]


def test_positions_are_markers_in_the_frame_of_their_comment(tmp_path: Path) -> None:
    percepts, obstacle = obstacle_percepts_t(), obstacle_t()
    obstacle.x_m, obstacle.radius_m = 1.5, 0.25
    percepts.n, percepts.obstacles = 1, [obstacle]
    name, scene = views(tmp_path, "cyan1/obstacle_percepts", percepts)["view/cyan1/obstacle_percepts/scene"]
    (entity,) = scene.entities
    (cylinder,) = entity.cylinders
    assert (name, entity.frame_id, cylinder.pose.position.x, cylinder.size.x) == (
        "foxglove.SceneUpdate", "cyan1/robot", 1.5, 0.5,
    )  # fmt: skip
    assert len(scene.deletions) == 1


def test_scans_and_places_on_the_earth_have_views(tmp_path: Path) -> None:
    scan = laser_scan_t(angle_min_rad=-0.5, angle_step_rad=0.25, n_ranges=5, ranges_m=[1.0, 2.0, math.inf, 4.0, 5.0])
    name, shown = views(tmp_path, "cyan1/scan", scan)["view/cyan1/scan"]
    assert (name, shown.frame_id, shown.start_angle, shown.end_angle, list(shown.ranges)) == (
        "foxglove.LaserScan", "cyan1/sensor", -0.5, 0.5, [1.0, 2.0, math.inf, 4.0, 5.0],
    )  # fmt: skip
    (tmp_path / "out.mcap").unlink()
    fix = gps_fix_t(latitude_deg=50.5, longitude_deg=6.25, covariance_m2=[[4.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0] * 3])
    name, shown = views(tmp_path, "cyan1/gps", fix)["view/cyan1/gps/location"]
    assert (name, shown.latitude, shown.longitude, shown.position_covariance[0]) == (
        "foxglove.LocationFix", 50.5, 6.25, 4.0,
    )  # fmt: skip
    (tmp_path / "out.mcap").unlink()
    _, shown = views(tmp_path, "cyan1/gps", gps_fix_t())["view/cyan1/gps/location"]
    assert list(shown.position_covariance) in ([], [0.0] * 9)


def test_transforms_and_log_lines_have_views(tmp_path: Path) -> None:
    message, one = transforms_t(), transform_t()
    one.parent, one.child, one.time_us, one.x_m, one.qw = "world", "cyan1/robot", PERIOD_US, 3.0, 1.0
    message.n, message.transforms = 1, [one]
    name, shown = views(tmp_path, "cyan1/transforms", message)["view/cyan1/transforms"]
    assert (name, shown.transforms[0].translation.x) == ("foxglove.FrameTransforms", 3.0)
    (tmp_path / "out.mcap").unlink()
    line = log_t()
    line.level, line.text, line.component = log_t.WARNING, "wheels are hot", "cyan1/base"
    name, shown = views(tmp_path, "fwk/log", line)["view/fwk/log"]
    assert (name, shown.level, shown.message, shown.name) == ("foxglove.Log", 3, "wheels are hot", "cyan1/base")


def test_foreign_topics_are_left_out_by_name(tmp_path: Path) -> None:
    from mcap.writer import Writer

    with open(tmp_path / "in.mcap", "wb") as file:
        writer = Writer(file)
        writer.start()
        other = writer.register_schema("ros.Pose", "jsonschema", b"{}")
        for topic, encoding, schema in (("/pose", "json", other), ("/cdr", "cdr", other), ("RAW", "lcm", 0)):
            writer.add_message(writer.register_channel(topic, encoding, schema), 1000, b"{}", 1000)
        writer.finish()  # type: ignore[no-untyped-call]
    result = CliRunner().invoke(app, ["import", str(tmp_path / "in.mcap"), "-o", str(tmp_path / "log"), "--json"])
    assert result.exit_code == 1
    told = json.loads(result.stdout)
    assert (told["events"], told["left_out"]) == (
        1, {"/pose": "no LCM type 'ros.Pose' in lcmtypes/", "/cdr": "its encoding is cdr, not json or lcm"},
    )  # fmt: skip


def test_logs_of_lcm_logger_are_imported_as_they_are(tmp_path: Path) -> None:
    log = heard(tmp_path / "heard")
    assert import_log(log, tmp_path / "log").events == 10
    assert (tmp_path / "log").read_bytes() == log.read_bytes()


@pytest.mark.parametrize("content", [b"hello", b"\x89MCAP0\r\n"])
def test_a_file_that_is_not_mcap_is_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "in").write_bytes(content)
    with pytest.raises(LogError, match="in: cannot be read as MCAP"):
        import_log(tmp_path / "in", tmp_path / "log")
    assert [path.name for path in tmp_path.iterdir()] == ["in"]


@pytest.mark.parametrize("form", Format)
def test_a_file_that_is_not_a_log_is_not_exported(tmp_path: Path, form: Format) -> None:
    (tmp_path / "in").write_bytes(b"this is not a log")
    with pytest.raises(LogError, match="in: not an LCM log: no event in it; it has 17 bytes"):
        export(tmp_path / "in", tmp_path / "out", form, Selection())
    assert [path.name for path in tmp_path.iterdir()] == ["in"]


@pytest.mark.parametrize(
    ("form", "missing"), [("mcap", "mcap.writer"), ("mcap", "foxglove.messages"), ("parquet", "pyarrow")]
)
def test_a_missing_library_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, form: str, missing: str) -> None:
    for name in ("fwk.log_tools.mcap_export", "fwk.log_tools.views"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    monkeypatch.setitem(sys.modules, missing, None)
    log = recording(tmp_path / "log", ticks=1)
    result = CliRunner().invoke(app, ["export", str(log), "--to", form, "-o", str(tmp_path / "out")])
    library = missing.partition(".")[0]
    assert (result.exit_code, result.stderr) == (
        2,
        f"error: {library} is not installed; type: pip install 'fwk[export]'\n",
    )
    assert [path.name for path in tmp_path.iterdir()] == ["log"]


def test_the_suffix_says_the_format(tmp_path: Path) -> None:
    log = recording(tmp_path / "log", ticks=1)
    run: Callable[..., Any] = CliRunner().invoke
    told = json.loads(run(app, ["export", str(log), "-o", str(tmp_path / "a.jsonl"), "--json"]).stdout)
    assert (told["format"], told["messages"]) == ("jsonl", 5)
    unclear = run(app, ["export", str(log), "-o", str(tmp_path / "a.txt")])
    assert (unclear.exit_code, "use --to csv|jsonl|parquet|mcap" in unclear.stderr) == (2, True)


def test_a_folder_with_files_is_never_replaced(tmp_path: Path) -> None:
    log = recording(tmp_path / "log", ticks=1)
    with pytest.raises(LogError, match="a folder with files in it; choose another name, or remove it"):
        export(log, tmp_path, Format.CSV, Selection(), replace=True)
