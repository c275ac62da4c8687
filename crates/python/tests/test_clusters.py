"""Ray and Dask give the rows of batch."""

import os
import signal
import threading
import time
import uuid
from pathlib import Path

import hovertone
import hovertone.dask
import hovertone.ray
import pyarrow.parquet
import pytest
from testkit import rotor, write_wave

FLAGS = {"blades": 2, "rotors": 1}
MARK = "HOVERTONE_TEST_OF_RAY"


@pytest.fixture
def archive(program):
    """A folder of recordings, one of them broken, and the rows of batch."""
    os.mkdir("archive")
    for number in range(14):
        write_wave(Path(f"archive/{number:02}.wav"), rotor(61.3 + number, 2.0))
    Path("archive/broken.wav").write_text("no sound")
    run = program("batch", "archive", "-o", "out", "--blades", "2", "--rotors", "1")
    assert run.returncode == 3, run.stderr
    return pyarrow.parquet.read_table("out/recordings.parquet")


@pytest.fixture
def cluster(monkeypatch):
    import ray

    monkeypatch.setenv(MARK, uuid.uuid4().hex)
    monkeypatch.setenv("RAY_USAGE_STATS_ENABLED", "0")
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    yield os.environ[MARK]
    ray.shutdown()


def workers(mark):
    """The processes of this cluster that hear now."""
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            title = (folder / "cmdline").read_bytes()
            if title.startswith(b"ray::Map") and mark.encode() in (folder / "environ").read_bytes():
                yield int(folder.name)
        except OSError:
            continue


def kill_one(mark, killed):
    until = time.monotonic() + 60
    while time.monotonic() < until and not killed:
        for worker in workers(mark):
            os.kill(worker, signal.SIGKILL)
            killed.append(worker)
            return
        time.sleep(0.02)


def test_a_killed_worker_of_ray_loses_nothing(archive, cluster):
    import ray

    killed = []
    killer = threading.Thread(target=kill_one, args=(cluster, killed))
    killer.start()
    found = hovertone.ray.speeds({Path("archive").absolute()}, **FLAGS)
    tables = ray.get(found.to_arrow_refs())
    killer.join()
    assert len(killed) == 1
    heard = pyarrow.concat_tables(tables).sort_by("file")
    assert same_rows(heard, archive)


def same_rows(heard, expected):
    """Whether the rows are equal but for the folder of the names, with the units of the columns."""
    assert heard.num_rows == expected.num_rows == 15
    named = [Path(file).name for file in heard["file"].to_pylist()]
    assert named == [Path(file).name for file in expected["file"].to_pylist()]
    assert heard.schema.field("speed_rev_s").metadata == expected.schema.field("speed_rev_s").metadata
    return heard.drop_columns("file").equals(expected.drop_columns("file"))


@pytest.mark.parametrize("scheduler", ["threads", "processes"])
def test_dask(archive, scheduler):
    found = hovertone.dask.speeds((path for path in ["archive"]), **FLAGS).compute(scheduler=scheduler)
    expected = archive.to_pandas()
    assert list(found.columns) == list(expected.columns)
    assert found["file"].tolist() == expected["file"].tolist()
    assert found["speed_rev_s"].reset_index(drop=True).equals(expected["speed_rev_s"])
    assert found["status"].tolist() == ["ok"] * 14 + ["error"]


@pytest.mark.parametrize("engine", [hovertone.ray, hovertone.dask])
def test_what_means_nothing_is_refused_before_the_work(engine):
    with pytest.raises(hovertone.WrongUseError, match="--blades 0: must be a whole number"):
        engine.speeds("hover.wav", blades=0)
    with pytest.raises(hovertone.FileError, match="there is no such file or folder"):
        engine.speeds("nowhere", blades=2)
