"""What people read runs: the notebook, and the lines of docs/python.md."""

import os
import re
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

REPOSITORY = Path(__file__).parents[3]
NOTEBOOK = REPOSITORY / "crates" / "python" / "examples" / "paper.ipynb"
BLOCKS = re.findall(r"```python\n(.*?)```", (REPOSITORY / "docs" / "python.md").read_text(encoding="utf-8"), re.DOTALL)


def test_the_notebook_redoes_the_paper(tmp_path):
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    assert all(not cell.get("outputs") for cell in notebook.cells), "it is committed without outputs"
    done = NotebookClient(notebook, timeout=600, resources={"metadata": {"path": str(tmp_path)}}).execute()
    kinds = {kind for cell in done.cells for output in cell.get("outputs", []) for kind in output.get("data", {})}
    assert {"text/html", "image/png"} <= kinds
    texts = "".join(output.get("text", "") for cell in done.cells for output in cell.get("outputs", []))
    assert "truth 2.8" in texts and "motorConstant" in texts
    if place := os.environ.get("HOVERTONE_NOTEBOOK_OUT"):
        nbformat.write(done, place)


@pytest.mark.parametrize("block", BLOCKS, ids=[block.strip().splitlines()[-1][:50] for block in BLOCKS])
def test_the_lines_of_the_document_run(block, demo):
    folder = demo.parent
    for name in ("hover.wav", "experiment.toml", "stand.csv"):
        if not (folder / name).exists() and Path(name).exists():
            (folder / name).write_bytes(Path(name).read_bytes())
    (folder / "stand.csv").write_text("rpm,thrust_g\n3000,70\n4000,125\n5000,194\n6000,281\n")
    environment = os.environ | {"MPLBACKEND": "Agg"}
    run = subprocess.run([sys.executable, "-c", block], cwd=folder, capture_output=True, text=True, env=environment, check=False)
    assert run.returncode == 0, run.stderr
    # what a comment behind a line says is what is printed
    expected = re.findall(r"^print\(.*\)  # (.*)$", block, re.MULTILINE)
    assert all(line in run.stdout for line in expected), (expected, run.stdout)


def test_the_document_has_lines():
    assert len(BLOCKS) >= 6
