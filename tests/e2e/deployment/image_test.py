"""deploy/Dockerfile against the list of packages, the program and its settings."""
import re
import shutil
import subprocess
import unittest
from pathlib import Path

import settings
from settings import PROGRAM, ROOT

SANITIZERS = {"libasan8", "libubsan1", "liblsan0", "libtsan2"}
NOT_LINKED = {"ca-certificates", "curl"}


def packages(group):
    found, inside = set(), False
    for line in (ROOT / "deploy" / "packages.txt").read_text(encoding="utf-8").splitlines():
        words = line.split("#")[0].split()
        if words and words[0].startswith("["):
            inside = words[0] == f"[{group}]"
        elif words and inside:
            found.add(words[0])
    return found


def owners(paths):
    """The Debian packages of libraries; those below /lib may be known below /usr/lib, and the other way round."""
    spellings = {}
    for path in paths:
        real = str(Path(path).resolve()).removeprefix("/usr")
        for name in (str(path).removeprefix("/usr"), real):
            spellings.update({name: path, "/usr" + name: path})
    listing = subprocess.run(["dpkg-query", "-S", *spellings], capture_output=True, text=True).stdout
    found = {spellings[file]: package.split(":")[0] for package, file in re.findall(r"^(\S+): (.+)$", listing, re.MULTILINE)}
    assert found.keys() == set(spellings.values()), set(spellings.values()) - found.keys()
    return set(found.values())


class Image(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        text = (ROOT / "deploy" / "Dockerfile").read_text(encoding="utf-8")
        lines = [line for line in re.sub(r"\\\n", " ", text).splitlines() if line and not line.startswith("#")]
        cls.instructions = [(line.split()[0], line.split(None, 1)[1]) for line in lines]
        last = max(i for i, (name, _) in enumerate(cls.instructions) if name == "FROM")
        cls.last_stage = cls.instructions[last:]

    def values(self, name, stage=None):
        return [value for key, value in (stage or self.instructions) if key == name]

    def test_packages_are_those_of_the_list(self):
        installs = [value for value in self.values("RUN") if "install_packages.sh" in value]
        self.assertEqual([re.search(r"install_packages.sh (\w+)", value).group(1) for value in installs], ["build", "run"])
        self.assertFalse([value for value in self.values("RUN") if "apt-get" in value])

    def test_every_stage_starts_from_the_same_base(self):
        self.assertEqual(self.values("ARG")[0], "BASE=debian:bookworm-slim")
        self.assertEqual({value.split()[0] for value in self.values("FROM")}, {"${BASE}"})

    def test_nobody_is_root(self):
        self.assertEqual(self.values("USER", self.last_stage), ["10001:10001"])

    def test_every_setting_exists(self):
        used = set(re.findall(r"(CITYMESH_\w+)=", " ".join(self.values("ENV", self.last_stage))))
        self.assertGreaterEqual(len(used), 3)
        self.assertLessEqual(used, settings.names())

    def test_without_keys_it_refuses_to_start(self):
        environment = dict(re.findall(r"(CITYMESH_\w+)=(\S+)", " ".join(self.values("ENV", self.last_stage))))
        ran = subprocess.run([PROGRAM, "serve", "--print_config", "--source", "postgresql://citydb/citydb"], env=environment,
                             capture_output=True, text=True)
        self.assertEqual(ran.returncode, 2)
        self.assertIn("--api_keys", ran.stderr)

    def test_health_is_asked_for_where_it_listens(self):
        environment = dict(re.findall(r"(\w+)=(\S+)", " ".join(self.values("ENV", self.last_stage))))
        self.assertIn(":" + environment["CITYMESH_LISTEN"].split(":")[1] + "/healthz", environment["HEALTH_URL"])
        self.assertIn('curl', self.values("HEALTHCHECK")[0])
        self.assertIn("curl", packages("run"))

    def test_what_the_build_needs_reaches_it(self):
        kept = [line[1:] for line in (ROOT / ".dockerignore").read_text(encoding="utf-8").splitlines() if line.startswith("!")]
        for name in ("CMakeLists.txt", "CMakePresets.json", "cmake", "core", "proto", "services", "scripts", "LICENSE", "deploy/packages.txt"):
            self.assertIn(name, kept)
        for name in kept:
            self.assertTrue((ROOT / name).exists(), name)
        self.assertNotIn("deploy", kept)  # secrets are below it

    @unittest.skipUnless(shutil.which("dpkg-query") and shutil.which("readelf"), "this is not Debian, or binutils are missing")
    def test_the_list_names_the_libraries_that_the_program_is_linked_with(self):
        linked = dict(re.findall(r"(\S+) => (/\S+)", subprocess.run(["ldd", PROGRAM], check=True, capture_output=True, text=True).stdout))
        direct = re.findall(r"NEEDED.*\[(.+)\]", subprocess.run(["readelf", "-d", PROGRAM], check=True, capture_output=True, text=True).stdout)
        needed = owners([linked[name] for name in direct if name in linked])
        if not needed & SANITIZERS:  # with them a program is linked with all that its build names, used or not
            self.assertEqual(needed - packages("run"), set())
        self.assertEqual(packages("run") - NOT_LINKED - owners(linked.values()), set())


if __name__ == "__main__":
    unittest.main()
