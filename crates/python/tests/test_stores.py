"""Archives in object stores and on web servers: the numbers of the same files in a folder, whatever the store does on the way."""

import http.server
import os
import re
import shlex
import shutil
import signal
import subprocess
import threading
import time
import urllib.parse
import urllib.request
from collections import Counter
from email.utils import formatdate
from pathlib import Path

import boto3
import hovertone.dask
import hovertone.ray
import pyarrow.parquet
import pytest
from moto.server import ThreadedMotoServer
from testkit import rotor, write_wave

FLAGS = ["--blades", "2", "--rotors", "1"]
BUCKET = "flights"


@pytest.fixture
def archive(program):
    """A folder of recordings, one of them empty, and its rows."""
    for number in range(8):
        place = Path(f"archive/day {number % 2}/{number}.wav")
        place.parent.mkdir(parents=True, exist_ok=True)
        write_wave(place, rotor(61.3 + number, 2.0))
    Path("archive/empty.wav").write_bytes(b"")
    Path("archive/notes.txt").write_text("no recording")
    assert program("batch", "archive", "-o", "expected", *FLAGS).returncode == 3
    return rows("expected")


@pytest.fixture
def bucket(archive, monkeypatch):
    """A server that speaks S3, on this machine, with the archive in a bucket."""
    server = ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
    server.start()
    host, port = server.get_host_and_port()
    endpoint = f"http://{host}:{port}"
    for name, value in {"AWS_ENDPOINT_URL": endpoint, "AWS_ACCESS_KEY_ID": "any", "AWS_SECRET_ACCESS_KEY": "any", "AWS_REGION": "eu-north-1"}.items():
        monkeypatch.setenv(name, value)
    client = boto3.client("s3", endpoint_url=endpoint, region_name="eu-north-1")
    client.create_bucket(Bucket=BUCKET, CreateBucketConfiguration={"LocationConstraint": "eu-north-1"})
    for path in Path("archive").rglob("*.*"):
        client.upload_file(str(path), BUCKET, path.as_posix())
    yield client
    # the next server in this process would have the same buckets
    urllib.request.urlopen(urllib.request.Request(f"{endpoint}/moto-api/reset", method="POST"))
    server.stop()


def rows(out):
    return pyarrow.parquet.read_table(f"{out}/recordings.parquet")


def same(heard, expected, root):
    """Whether the rows are equal but for the names, which are addresses."""
    assert heard["file"].to_pylist() == [f"{root}/{file}" for file in expected["file"].to_pylist()]
    return heard.drop_columns("file").equals(expected.drop_columns("file"))


def test_a_bucket_has_the_rows_of_its_folder(bucket, archive, program):
    run = program("batch", f"s3://{BUCKET}/archive", "-o", "out", *FLAGS)
    assert run.returncode == 3, run.stderr
    assert same(rows("out"), archive, f"s3://{BUCKET}")
    again = program("batch", f"s3://{BUCKET}/archive", "-o", "out", *FLAGS)
    assert "analysed in this run: 0" in again.stdout, again.stdout + again.stderr
    # one that changed is heard again, one that is gone loses its row
    write_wave(Path("other.wav"), rotor(90.0, 2.0))
    bucket.upload_file("other.wav", BUCKET, "archive/day 0/0.wav")
    bucket.delete_object(Bucket=BUCKET, Key="archive/empty.wav")
    changed = program("batch", f"s3://{BUCKET}/archive", "-o", "out", *FLAGS)
    assert "analysed in this run: 1" in changed.stdout and ", 0 failed" in changed.stdout, changed.stdout + changed.stderr
    assert rows("out")["speed_rev_s"][0].as_py() == pytest.approx(90.0, abs=0.1)


def test_a_listing_of_several_pages_is_read_to_its_end(bucket, archive, program):
    # the store tells a thousand names at once; the recordings of day 1 are behind these
    for number in range(1005):
        bucket.put_object(Bucket=BUCKET, Key=f"archive/day 0/note {number:04}.txt", Body=b"no recording")
    assert program("batch", f"s3://{BUCKET}/archive", "-o", "out", *FLAGS).returncode == 3
    assert same(rows("out"), archive, f"s3://{BUCKET}")


def test_one_recording_and_a_list_of_addresses(bucket, archive, program):
    assert program("batch", f"s3://{BUCKET}/archive/day 1/3.wav", "-o", "one", *FLAGS).returncode == 0
    assert rows("one")["file"].to_pylist() == [f"s3://{BUCKET}/archive/day 1/3.wav"]
    bucket.put_object(Bucket=BUCKET, Key="archive/list.txt", Body=b"day 0/2.wav\nday 1/3.wav\ngone.wav\n")
    assert program("batch", f"s3://{BUCKET}/archive/list.txt", "-o", "of_list", *FLAGS).returncode == 3
    found = rows("of_list").to_pandas().set_index("file")
    assert found.loc[f"s3://{BUCKET}/archive/gone.wav", "error_class"] == "not_found"
    known = archive.to_pandas().set_index("file")
    for name in ("archive/day 0/2.wav", "archive/day 1/3.wav"):
        assert found.loc[f"s3://{BUCKET}/{name}", "speed_rev_s"] == known.loc[name, "speed_rev_s"]


def test_a_killed_batch_goes_on(bucket, archive):
    command = [os.environ["HOVERTONE_PROGRAM"], "batch", f"s3://{BUCKET}/archive", "-o", "out", *FLAGS, "--threads", "1"]
    kills = 0
    while kills < 3:
        run = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        before = len(list(Path("out").rglob("*.part")))
        until = time.monotonic() + 60
        while run.poll() is None and len(list(Path("out").rglob("*.part"))) == before and time.monotonic() < until:
            time.sleep(0.005)
        if run.poll() is not None:
            break
        run.send_signal(signal.SIGKILL)
        run.wait()
        kills += 1
    assert kills == 3, "it was stopped in the middle"
    assert subprocess.run(command, check=False).returncode == 3
    assert same(rows("out"), archive, f"s3://{BUCKET}")
    assert len(list(Path("out").rglob("*.part"))) == archive.num_rows


def test_clusters_read_addresses(bucket, archive):
    found = hovertone.dask.speeds(f"s3://{BUCKET}/archive", blades=2, rotors=1).compute(scheduler="threads")
    assert found["file"].tolist() == [f"s3://{BUCKET}/{file}" for file in archive["file"].to_pylist()]
    assert found["speed_rev_s"].reset_index(drop=True).equals(archive.to_pandas()["speed_rev_s"])


def test_what_is_not_there_is_one_clear_line(bucket, program):
    for words, code, told in [
        ([f"s3://{BUCKET}/nothing"], 1, "there are no recordings at this address"),
        (["s3://no-such-bucket/archive"], 1, "nothing is at this address"),
        (["az://container/archive"], 1, "an environment variable of the store is missing, or has a wrong value: Account must be specified"),
        (["ftp://host/archive"], 2, "this is no address in a store"),
        (["s3://"], 2, "names no bucket"),
        (["https://name:word@host/a.wav"], 2, "an address may not contain a password"),
        (["https://host/a.wav?key=1"], 2, "may not end with a query"),
    ]:
        run = program("batch", *words, "-o", "out", *FLAGS)
        assert run.returncode == code and told in run.stderr, (words, run.returncode, run.stderr)
        assert len(run.stderr.strip().splitlines()) <= 2 and not Path("out").exists(), run.stderr


def test_the_lines_of_the_document_run(bucket, program):
    document = (Path(__file__).parents[3] / "docs" / "batch.md").read_text(encoding="utf-8")
    section = document.split("## Object stores and the web")[1].split("\n## ")[0]
    lines = re.findall(r"^\$ hovertone (.*)$", section, re.MULTILINE)
    bucket.put_object(Bucket=BUCKET, Key="archive/list.txt", Body=b"day 0/2.wav\nday 1/3.wav\n")
    here = [line for line in lines if "# needs " not in line]
    assert (len(here), len(lines)) == (3, 6)
    for line in here:
        run = program(*shlex.split(line))
        assert run.returncode in (0, 3) and Path(shlex.split(line)[3], "recordings.parquet").exists(), (line, run.stderr)


class Faulty(http.server.BaseHTTPRequestHandler):
    """Answers with parts of files; what the first folder of a name says goes wrong with the first attempts, or with all."""

    protocol_version = "HTTP/1.1"
    seen: Counter = Counter()

    def log_message(self, *_):
        pass

    def do_HEAD(self):
        self.answered(None)

    def do_GET(self):
        self.answered(self.headers.get("Range"))

    def answered(self, asked):
        fault, name = urllib.parse.unquote(self.path).strip("/").split("/", 1)
        place = Path(self.server.folder) / name
        if not place.is_file():
            return self.told(404)
        whole = place.read_bytes()
        if self.command == "HEAD":
            return self.headed(200, len(whole))
        first, last = map(int, asked.removeprefix("bytes=").split("-"))
        part = whole[first : last + 1]
        attempt = Faulty.seen[self.path, first]
        Faulty.seen[self.path, first] += 1
        if fault == "busy" and attempt < 2:
            return self.told(503 if attempt else 500)
        if fault == "broken":
            return self.told(503)
        self.headed(206, len(part), f"bytes {first}-{first + len(part) - 1}/{len(whole)}")
        if fault == "cut" and attempt < 2 or fault == "always_cut":
            self.wfile.write(part[: len(part) // 2])
            self.close_connection = True
            return None
        pieces = 4 if fault == "slow" else 1
        size = -(-len(part) // pieces)
        for begin in range(0, len(part), size):
            time.sleep(0.2 if fault == "slow" else 0.0)
            self.wfile.write(part[begin : begin + size])
        return None

    def told(self, status):
        self.send_response(status)
        self.send_header("Content-Length", "0")
        self.end_headers()

    def headed(self, status, length, part=None):
        self.send_response(status)
        self.send_header("Content-Length", str(length))
        self.send_header("Last-Modified", formatdate(0, usegmt=True))
        if part:
            self.send_header("Content-Range", part)
        self.end_headers()


@pytest.fixture
def faulty(archive):
    Faulty.seen.clear()
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Faulty)
    server.folder = Path.cwd()
    server.daemon_threads = True
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}"
    server.shutdown()
    server.server_close()


def test_a_faulty_server_is_asked_again_or_told_in_the_row(faulty, archive, program):
    shutil.copy("archive/day 0/0.wav", "flight.wav")
    expected = archive.to_pandas().set_index("file").loc["archive/day 0/0.wav"]
    names = ["good", "busy", "cut", "slow", "broken", "always_cut"]
    Path("list.txt").write_text("".join(f"{faulty}/{name}/flight.wav\n" for name in names))
    run = program("batch", "list.txt", "-o", "out", *FLAGS)
    assert run.returncode == 3, run.stderr
    found = rows("out").to_pandas().set_index("file")
    for name in names:
        row = found.loc[f"{faulty}/{name}/flight.wav"]
        if name in ("broken", "always_cut"):
            assert (row["status"], row["error_class"]) == ("error", "unreadable"), name
            assert ("503" if name == "broken" else "sent fewer bytes than hovertone asked for") in row["reason"], row["reason"]
        else:
            assert row["status"] == "ok" and row["speed_rev_s"] == expected["speed_rev_s"], name
            assert row["recording"]["sha256"] == expected["recording"]["sha256"], name
    assert Faulty.seen["/busy/flight.wav", 0] == 3 and Faulty.seen["/cut/flight.wav", 0] == 3


def test_the_web_has_recordings_and_lists(faulty, archive, program):
    Path("archive/list.txt").write_text("day 0/2.wav\nday%201/3.wav\n")
    assert program("batch", f"{faulty}/good/archive/list.txt", "-o", "out", *FLAGS).returncode == 0
    known = archive.to_pandas().set_index("file")["speed_rev_s"]
    assert rows("out")["speed_rev_s"].to_pylist() == [known["archive/day 0/2.wav"], known["archive/day 1/3.wav"]]
    run = program("batch", f"{faulty}/good/archive/", "-o", "of_folder", *FLAGS)
    assert run.returncode == 1 and "the server does not list folders" in run.stderr, run.stderr
