#!/usr/bin/env python3
"""Runs the shell examples of docs/formats.md and docs/processes/heal.md as they stand; only the place of the program is
replaced.

    formats_test.py CITYMESH
"""
import json
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
PAGE = ROOT / "docs/formats.md"
HEAL = ROOT / "docs/processes/heal.md"
PROGRAM = None
BLOCK = re.compile(r"```sh\n(.*?)```", re.DOTALL)
SECTION = re.compile(r"^### (.+?)$(.*?)(?=^##|\Z)", re.DOTALL | re.MULTILINE)


class Formats(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="citymesh-formats-"))
        (self.folder / "tests").symlink_to(ROOT / "tests")

    def tearDown(self):
        shutil.rmtree(self.folder, ignore_errors=True)

    def test_every_format_has_an_example(self):
        sections = SECTION.findall(PAGE.read_text(encoding="utf-8"))
        self.assertGreater(len(sections), 9)
        for title, text in sections:
            self.assertTrue(BLOCK.search(text), f"no example of {title}")

    def test_examples_run_and_deliver_buildings(self):
        text = PAGE.read_text(encoding="utf-8")
        for block in BLOCK.findall(text):
            with self.subTest(block=block):
                done = subprocess.run(["bash", "-euc", block.replace("build/release/services/apps/citymesh", str(PROGRAM))],
                                      cwd=self.folder, capture_output=True, text=True, timeout=120, stdin=subprocess.DEVNULL)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                for output in re.findall(r"--output (\S+)", block):
                    report = json.loads((self.folder / output / "report.json").read_text(encoding="utf-8"))
                    self.assertGreater(report["counts"]["delivered"], 0, output)
                    self.assertEqual(report["counts"]["dropped"], 0, output)

    def test_examples_of_heal_give_a_city_model_back(self):
        blocks = [block for block in BLOCK.findall(HEAL.read_text(encoding="utf-8")) if "curl" not in block]
        self.assertTrue(blocks)
        for block in blocks:
            done = subprocess.run(["bash", "-euc", block.replace("citymesh heal", f"{PROGRAM} heal")], cwd=self.folder,
                                  capture_output=True, text=True, timeout=120, stdin=subprocess.DEVNULL)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            for output in re.findall(r"--output (\S+)", block):
                model = json.loads((self.folder / output / "model.city.json").read_text(encoding="utf-8"))
                report = json.loads((self.folder / output / "report.json").read_text(encoding="utf-8"))
                self.assertGreater(report["counts"]["delivered"], 0)
                self.assertGreaterEqual(len(model["CityObjects"]), report["counts"]["delivered"])


if __name__ == "__main__":
    PROGRAM = Path(sys.argv.pop(1)).resolve()
    unittest.main(verbosity=2)
