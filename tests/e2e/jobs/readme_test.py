"""The README's first requests, run as they stand there against a service on other ports."""
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from service import LIMIT_S, ROOT, ServiceTest, read_obj

RUN = {"sh": ["bash", "-euo", "pipefail", "-c"], "python": [sys.executable, "-c"]}


def first_requests():
    """(language, code) of every block in the section, in order."""
    section = re.search(r"^## The first request\n(.*?)^## ", (ROOT / "README.md").read_text(), re.DOTALL | re.MULTILINE)
    return re.findall(r"^```(\w+)\n(.*?)^```", section.group(1), re.DOTALL | re.MULTILINE)


class Readme(ServiceTest):
    def run_block(self, language, code):
        code = code.replace("http://127.0.0.1:8080", self.service.url).replace("127.0.0.1:50051", self.service.grpc)
        folder = Path(self.folder.name) / "checkout"
        if not folder.exists():
            folder.mkdir()
            (folder / "proto").symlink_to(ROOT / "proto")
        done = subprocess.run(RUN[language] + [code], cwd=folder, timeout=LIMIT_S, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1"})
        self.assertEqual(done.returncode, 0, f"{code}\n{done.stdout}")
        return folder

    def test_first_requests_deliver_a_mesh_each(self):
        blocks = first_requests()
        self.assertTrue(any("curl" in code for _, code in blocks), "the README's first request is one with curl")
        meshes = set()
        for language, code in blocks:
            if "grpc" in code and (shutil.which("grpc_python_plugin") is None or not has_grpc()):
                continue
            with self.subTest(code=code):
                folder = self.run_block(language, code)
                meshes |= set(folder.glob("out/**/model.obj"))
        self.assertGreaterEqual(len(meshes), 2)
        for mesh in meshes:
            self.assertTrue(read_obj(mesh.read_text()), mesh)


def has_grpc():
    try:
        import grpc  # noqa: F401
        return True
    except ImportError:
        return False
