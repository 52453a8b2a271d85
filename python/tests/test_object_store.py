"""A study whose workers write into an object store: the results are those of one process, to the byte."""

import json
import os
import pathlib
import shutil
import subprocess
import sys

import fsspec
import pytest
from moto.server import ThreadedMotoServer

STUDY = """
title = "two frames of ARGON"
scenario = "argon"
seed = 9
frames = "2000..2002"
[stop]
cases = 8
[[vary]]
path = "psf.sigma_px"
distribution = { kind = "uniform", min = 0.6, max = 1.0 }
"""
BUCKET = "boresight-test"
URL = f"s3://{BUCKET}/studies/one"
SHARDS = 4


@pytest.fixture(scope="module")
def program():
    """The program as a path: that of BORESIGHT_PROGRAM, or the one that was installed with the package."""
    beside = pathlib.Path(sys.executable).parent
    return os.environ.get("BORESIGHT_PROGRAM") or shutil.which("boresight", path=str(beside))


@pytest.fixture
def store(monkeypatch):
    """An S3 server on this machine with a bucket; its files by fsspec. The environment directs this process
    and its children to it."""
    server = ThreadedMotoServer(ip_address="127.0.0.1", port=0)
    server.start()
    host, port = server.get_host_and_port()
    for name, value in {
        "FSSPEC_S3_ENDPOINT_URL": f"http://{host}:{port}",
        "AWS_ACCESS_KEY_ID": "testing",
        "AWS_SECRET_ACCESS_KEY": "testing",
        "AWS_DEFAULT_REGION": "us-east-1",
    }.items():
        monkeypatch.setenv(name, value)
    files = fsspec.filesystem("s3", endpoint_url=f"http://{host}:{port}", use_listings_cache=False, skip_instance_cache=True)
    files.mkdir(BUCKET)
    yield files
    # The next server of this process would have it.
    files.rm(BUCKET, recursive=True)
    server.stop()


@pytest.fixture
def study(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(STUDY)
    return path


def on_dask(program, study, url=URL):
    plan = subprocess.run(
        [program, "--json", "study", "plan", study, "--shards", str(SHARDS)], capture_output=True, check=True
    ).stdout
    words = [sys.executable, "-m", "boresight.dask_engine", "--program", program, "--out", url, "--workers", "2"]
    return subprocess.run(words, input=plan, capture_output=True, timeout=600)


def shards(files):
    """Name and time of every shard in the store."""
    return {entry["name"]: entry["LastModified"] for entry in files.ls(f"{URL}/shards", detail=True)}


def test_results_in_an_object_store_are_those_of_one_process(program, study, store, tmp_path):
    done = on_dask(program, study)
    assert done.returncode == 0, done.stderr.decode()
    whole = tmp_path / "whole"
    words = [program, "study", "run", study, "--out", whole, "--shards", str(SHARDS)]
    subprocess.run(words, capture_output=True, check=True)
    names = ["plan.json", "cases.parquet", "summary.json", "study.json", "SHA256SUMS"]
    for name in names + [f"shards/{path.name}" for path in (whole / "shards").iterdir()]:
        assert store.cat_file(f"{URL}/{name}") == (whole / name).read_bytes(), name
    assert store.exists(f"{URL}/report.html")

    # A second run keeps complete shards and makes a damaged one again.
    before = shards(store)
    first, *others = sorted(before)
    content = store.cat_file(first)
    store.pipe_file(first, content[:-1] + bytes([content[-1] ^ 1]))
    done = on_dask(program, study)
    assert done.returncode == 0, done.stderr.decode()
    assert store.cat_file(first) == content
    assert {name: shards(store)[name] for name in others} == {name: before[name] for name in others}


def test_a_store_that_holds_another_study_is_refused(program, study, store):
    assert on_dask(program, study).returncode == 0
    before = store.cat_file(f"{URL}/plan.json")
    study.write_text(STUDY.replace("seed = 9", "seed = 10"))
    done = on_dask(program, study)
    assert done.returncode == 1 and b"the folder contains another study" in done.stderr, done.stderr.decode()
    assert store.cat_file(f"{URL}/plan.json") == before and json.loads(before)["shards"] == SHARDS


def test_a_bucket_that_is_not_there_is_named(program, study, store):
    done = on_dask(program, study, "s3://no-such-bucket/study")
    last = done.stderr.decode().splitlines()[-1]
    assert done.returncode == 1 and last.endswith("s3://no-such-bucket/study: The specified bucket does not exist"), last
