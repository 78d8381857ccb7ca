"""The recipes of packaging/ have the version of the project and say whether they were run."""

import json
import os
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
VERSION = re.search(r"project\(exitance VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)
RECIPES = ("apptainer/exitance.def", "vcpkg/exitance/vcpkg.json", "conda-forge/meta.yaml", "homebrew/exitance.rb",
           "nix/default.nix")


def test_recipes_have_the_version_of_the_project_and_say_whether_they_were_run():
    for name in RECIPES:
        text = (ROOT / "packaging" / name).read_text()
        versions = re.findall(r'(?:[Vv]ersion\b[" :={]*(?:set version = )?")(\d+\.\d+\.\d+)"|Version (\d+\.\d+\.\d+)', text)
        assert versions and all(VERSION in found for found in versions), name
        assert re.search(r"was (not )?run", text), name
    readme = (ROOT / "packaging/README.md").read_text()
    for name in RECIPES:
        assert f"packaging/{name.split('/')[0]}" in readme, name


def test_recipes_can_be_parsed():
    port = json.loads((ROOT / "packaging/vcpkg/exitance/vcpkg.json").read_text())
    assert port["name"] == "exitance" and "embree" in port["dependencies"]
    subprocess.run(["bash", "-n", ROOT / "packaging/conda-forge/build.sh"], check=True)


def test_recipes_name_options_of_the_build():
    cmake = "".join(path.read_text() for path in [ROOT / "CMakeLists.txt", *(ROOT / "cmake").glob("*.cmake")])
    for path in (ROOT / "packaging").rglob("*.*"):
        for option in re.findall(r"-D ?(EXITANCE_\w+)=", path.read_text()):
            assert re.search(rf"\b{option}\b", cmake), f"{path}: {option}"


def test_the_citation_key_of_every_source_in_the_paper_exists():
    paper = (ROOT / "paper.md").read_text()
    entries = set(re.findall(r"^@\w+\{([^,\s]+),", (ROOT / "paper.bib").read_text(), flags=re.M))
    named = set(re.findall(r"@([A-Za-z]\w*\d\w*)", paper.split("---", 2)[2]))
    assert named and named == entries
    for picture in re.findall(r"!\[[^]]*\]\(([^)]+)\)", paper):
        assert (ROOT / picture).exists(), picture


def test_the_weekly_benchmark_appends_to_its_history(tmp_path):
    history = tmp_path / "history.csv"
    command = [ROOT / "bench/weekly", "--program", os.environ["EXITANCE_PROGRAM"], "--history", history, "--runs", "1",
               "--scenes", "complex"]
    for runs in (1, 2):
        assert "complex" in subprocess.run(command, check=True, capture_output=True, text=True).stdout
        rows = history.read_text().splitlines()
        assert len(rows) == 1 + 2 * runs and rows[0].startswith("date,commit,scene")
