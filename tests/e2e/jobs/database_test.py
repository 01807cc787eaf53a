"""`citymesh serve --source postgresql://…` over both versions of 3DCityDB: REST, gRPC, and a database that goes away."""
import json
import subprocess
import tempfile
import unittest
from pathlib import Path

from cluster import Cluster
from grpc_test import GrpcTest
from service import BERLIN, PROGRAM, SMALL, delivered_names, is_closed, read_obj

FILE = BERLIN / "3910_5817.gml"
SRID = 25833
COPIES = 10  # of the city, for jobs that last
# Half of the small box.
TRIANGLE = {"type": "Polygon", "coordinates": [[[13.400, 52.495], [13.405, 52.495], [13.405, 52.500], [13.400, 52.495]]]}


def meshes(obj):
    """Without comments, which name the source."""
    return "\n".join(line for line in obj.splitlines() if not line.startswith("#"))


def run_over_file(setting, value):
    with tempfile.TemporaryDirectory(prefix="citymesh-e2e-") as folder:
        subprocess.run([PROGRAM, "run", "export-for-simulation", "--input", FILE, "--output", folder, "--overwrite",
                        "--set", f"{setting}={json.dumps(value)}"], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return meshes(Path(folder, "model.obj").read_text(encoding="utf-8"))


def setUpModule():
    global cluster, from_file, triangle_from_file
    from_file, triangle_from_file = run_over_file("bbox", SMALL), run_over_file("polygon", TRIANGLE)
    cluster = Cluster()
    unittest.addModuleCleanup(cluster.close)


class FromDatabase:
    version = ""
    objects = ""  # the table of objects
    tables = ""   # all that are filled
    is_building = ""

    @classmethod
    def setUpClass(cls):
        cls.data = cluster.make("city_" + cls.version.replace(".", "_"), cls.version, SRID, COPIES, FILE)
        cls.healed = "healed_" + cls.version.replace(".", "_")
        url = cluster.make(cls.healed, cls.version, SRID, 1, FILE)
        cluster.sql(cls.healed, f"TRUNCATE {cls.tables}", "ALTER SCHEMA citydb RENAME TO healed")
        cls.options = ("--write_back_schema", "healed", "--write_back_url", url)
        super().setUpClass()

    def export_over_rest(self, inputs):
        job = self.service.execute(inputs)
        status = self.service.wait(job)
        self.assertEqual(status["status"], "successful", status)
        return self.service.get(job + "/results/report.json").json(), self.service.get(job + "/results/model.obj").body

    def export_over_grpc(self, inputs):
        job = self.watch(self.submit(inputs))[-1]
        self.assertEqual(job.state, self.pb.SUCCESSFUL, job)
        return json.loads(self.fetch(job, "report")), self.fetch(job, "obj")

    def test_a_box_gives_the_meshes_of_the_file_over_rest_and_grpc(self):
        for export in (self.export_over_rest, self.export_over_grpc):
            with self.subTest(export.__name__):
                report, obj = export({"bbox": SMALL})
                bodies = read_obj(obj.decode())
                self.assertGreater(report["counts"]["requested"], 50)
                self.assertEqual(report["counts"]["delivered"], report["counts"]["requested"])
                self.assertEqual(set(bodies), delivered_names(report))
                self.assertTrue(all(is_closed(faces) for faces in bodies.values()))
                self.assertEqual(meshes(obj.decode()), from_file)

    def test_a_job_writes_back_all_it_delivers_or_nothing(self):
        count = f"SELECT count(*) FROM healed.{self.objects} WHERE termination_date IS NULL"
        inputs = {"bbox": SMALL, "write_back": True}
        for export in (self.export_over_rest, self.export_over_grpc):
            with self.subTest(export.__name__):
                report, _ = export(inputs)
                buildings = f"{count} AND {self.is_building}"
                self.assertEqual(int(cluster.sql(self.healed, buildings)), report["counts"]["delivered"])
        before = cluster.sql(self.healed, count)
        job = self.service.execute({"write_back": True})
        self.service.wait(job, lambda status: status.get("done", 0) > 0)
        self.service.send("DELETE", job)
        self.service.wait(job)
        self.assertEqual(cluster.sql(self.healed, count), before)
        lineage = f"SELECT count(*) FROM healed.{self.objects} WHERE lineage = '{job.rsplit('/', 1)[-1]}'"
        self.assertEqual(cluster.sql(self.healed, lineage), "0")

    def test_a_polygon_gives_the_meshes_of_the_file(self):
        self.assertLess(len(triangle_from_file), 0.8 * len(from_file))
        report, obj = self.export_over_rest({"polygon": {"value": TRIANGLE}})
        self.assertGreater(report["counts"]["delivered"], 10)
        self.assertEqual(meshes(obj.decode()), triangle_from_file)
        self.assertEqual(self.export_over_grpc({"polygon": TRIANGLE})[1], obj)

    def test_a_database_that_restarts_fails_at_most_the_jobs_that_read_it(self):
        for command in ("kill", "stop"):
            with self.subTest(command):
                job = self.service.execute({})
                self.service.wait(job, lambda status: status.get("done", 0) > 0)
                cluster.tell(command)
                self.assertEqual(self.service.get("/healthz").status, 200)
                while_gone = self.service.execute({"bbox": SMALL})
                self.assertEqual(self.service.get(while_gone).status, 200)
                cluster.tell("start")
                ended = self.service.wait(job)
                self.assertIn(ended["status"], ("successful", "failed"), ended)
                if ended["status"] == "failed":
                    self.assertRegex(ended["exception"]["detail"], "database|connection|server", ended)
                self.service.wait(while_gone)
                report, obj = self.export_over_rest({"bbox": SMALL})
                self.assertEqual(meshes(obj.decode()), from_file)

    def test_a_database_that_is_gone_is_named_with_what_to_do(self):
        cluster.tell("stop")
        try:
            status = self.service.wait(self.service.execute({"bbox": SMALL}))
            self.assertEqual(status["status"], "failed")
            self.assertIn(cluster.folder, status["exception"]["detail"])
        finally:
            cluster.tell("start")
        self.export_over_grpc({"bbox": SMALL})


class Version4(FromDatabase, GrpcTest):
    version = "4"
    objects = "cityobject"
    tables = "cityobject, surface_geometry, building, thematic_surface"
    is_building = "objectclass_id = 26"


class Version5(FromDatabase, GrpcTest):
    version = "5.1"
    objects = "feature"
    tables = "feature, geometry_data, property"
    is_building = "objectclass_id = 901"


if __name__ == "__main__":
    unittest.main()
