"""A private PostgreSQL with PostGIS for a test, by the script that the C++ tests use."""
import os
import subprocess
import unittest
from urllib.parse import quote

from service import ROOT

LOADER = os.environ.get("CITYMESH_CITYDB_LOAD", "citymesh_citydb_load")


class Cluster:
    def __init__(self):
        self.process = subprocess.Popen(["bash", ROOT / "tests" / "support" / "citydb" / "cluster.sh"], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, text=True)
        state, _, rest = self.process.stdout.readline().strip().partition(" ")
        if state != "ready":
            self.close()
            if state == "missing":
                raise unittest.SkipTest(f"PostgreSQL with PostGIS is not installed: {rest}")
            raise AssertionError(f"the private PostgreSQL did not start: {state} {rest}")
        self.folder = rest

    def url(self, database):
        return f"postgresql:///{database}?host={quote(self.folder, safe='')}&user=citymesh"

    def make(self, database, version, srid, copies, *files):
        """A database with `copies` copies of the buildings of some files."""
        subprocess.run(["createdb", "-h", self.folder, "-U", "citymesh", database], check=True)
        subprocess.run([LOADER, self.url(database), version, str(srid), str(copies), *map(str, files)], check=True,
                       stdout=subprocess.DEVNULL)
        return self.url(database)

    def sql(self, database, *statements):
        """What the last statement answers."""
        commands = [part for statement in statements for part in ("-c", statement)]
        return subprocess.run(["psql", "-X", "-At", "-v", "ON_ERROR_STOP=1", self.url(database), *commands], check=True,
                              capture_output=True, text=True).stdout.strip().split("\n")[-1]

    def tell(self, command):
        """`stop`, `kill` or `start`."""
        self.process.stdin.write(command + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline().strip()
        assert answer == "done", answer

    def close(self):
        self.process.stdin.close()
        self.process.wait(60)
        self.process.stdout.close()
