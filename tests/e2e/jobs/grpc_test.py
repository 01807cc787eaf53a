"""The job cycle over gRPC, with stubs generated from proto/ as any client would."""
import json
import shutil
import subprocess
import sys
import tempfile
import unittest

from service import CITY, LIMIT_S, ROOT, SEA, ServiceTest, delivered_names, is_closed, make_big_city, read_obj

try:
    import grpc
except ImportError:
    grpc = None
PROTOC, PLUGIN = shutil.which("protoc"), shutil.which("grpc_python_plugin")


@unittest.skipUnless(grpc and PROTOC and PLUGIN,
                     "python3-grpcio, protobuf-compiler and protobuf-compiler-grpc are not installed")
class GrpcTest(ServiceTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        stubs = tempfile.TemporaryDirectory(prefix="citymesh-e2e-stubs-")
        cls.addClassCleanup(stubs.cleanup)
        subprocess.run([PROTOC, f"-I{ROOT / 'proto'}", f"--python_out={stubs.name}", f"--grpc_out={stubs.name}",
                        f"--plugin=protoc-gen-grpc={PLUGIN}", "citymesh/v1/jobs.proto"], check=True)
        sys.path.insert(0, stubs.name)
        cls.addClassCleanup(sys.path.remove, stubs.name)
        from citymesh.v1 import jobs_pb2, jobs_pb2_grpc
        cls.pb = jobs_pb2
        channel = grpc.insecure_channel(cls.service.grpc, options=[("grpc.max_receive_message_length", 1 << 20)])
        cls.addClassCleanup(channel.close)
        cls.jobs = jobs_pb2_grpc.JobsStub(channel)

    def submit(self, inputs, outputs=(), process="export-for-simulation"):
        request = self.pb.SubmitRequest(process=process, inputs_json=json.dumps(inputs), outputs=outputs)
        return self.jobs.Submit(request, timeout=LIMIT_S)

    def watch(self, job):
        """All states up to the final one."""
        return list(self.jobs.Watch(self.pb.GetRequest(job_id=job.job_id), timeout=LIMIT_S))

    def fetch(self, job, output):
        chunks = self.jobs.FetchResult(self.pb.FetchResultRequest(job_id=job.job_id, output=output), timeout=LIMIT_S)
        return b"".join(chunk.data for chunk in chunks)

    def assert_refused(self, code, call, *words):
        with self.assertRaises(grpc.RpcError) as raised:
            call()
        self.assertEqual(raised.exception.code(), code)
        for word in words:
            self.assertIn(word, raised.exception.details())


class JobCycle(GrpcTest):
    def test_trace_of_a_call_is_that_of_its_job_in_the_log(self):
        trace = "4bf92f3577b34da6a3ce929d0e0e4736"
        request = self.pb.SubmitRequest(process="export-for-simulation", inputs_json=json.dumps({"bbox": SEA}))
        job = self.jobs.Submit(request, timeout=LIMIT_S, metadata=[("traceparent", f"00-{trace}-00f067aa0ba902b7-01")])
        self.watch(job)
        lines = self.service.logged(job_id=job.job_id)
        self.assertLessEqual({"job_accepted", "job_started"}, {line["event"] for line in lines})
        self.assertEqual({line["trace_id"] for line in lines}, {trace})

    def test_submit_watch_and_fetch(self):
        states = self.watch(self.submit({"bbox": CITY}))
        job = states[-1]
        self.assertEqual(job.state, self.pb.SUCCESSFUL, job)
        self.assertEqual(job.percent, 100)
        self.assertEqual([state.updated_ms for state in states], sorted(state.updated_ms for state in states))
        report = json.loads(self.fetch(job, "report"))
        obj = self.fetch(job, "obj")
        bodies = read_obj(obj.decode())
        self.assertGreater(report["counts"]["delivered"], 0)
        self.assertTrue(delivered_names(report) <= bodies.keys())
        self.assertTrue(all(is_closed(faces) for faces in bodies.values()))
        sizes = {file.file_name: file.bytes for file in job.results}
        self.assertEqual(sizes["model.obj"], len(obj))

    def test_rest_and_grpc_see_the_same_job_and_the_same_bytes(self):
        job = self.watch(self.submit({"bbox": CITY}))[-1]
        status = self.service.get(f"/jobs/{job.job_id}").json()
        self.assertEqual((status["status"], status["message"]), ("successful", job.message))
        over_rest = self.service.execute({"bbox": CITY})
        self.assertEqual(self.service.wait(over_rest)["status"], "successful")
        for name in ("model.obj", "report.json"):
            self.assertEqual(self.fetch(job, name), self.service.get(f"{over_rest}/results/{name}").body)

    def test_heal_gives_the_city_model_back(self):
        job = self.watch(self.submit({"bbox": CITY}, process="heal"))[-1]
        self.assertEqual(job.state, self.pb.SUCCESSFUL, job)
        report, model = json.loads(self.fetch(job, "report")), json.loads(self.fetch(job, "cityjson"))
        delivered = {building["gml_id"] for building in report["buildings"] if building["outcome"] == "delivered"}
        self.assertTrue(delivered and delivered <= model["CityObjects"].keys())

    def test_box_without_buildings_is_a_success(self):
        job = self.watch(self.submit({"bbox": SEA}))[-1]
        self.assertEqual(job.state, self.pb.SUCCESSFUL)
        self.assertEqual(json.loads(self.fetch(job, "report"))["counts"]["requested"], 0)

    def test_bad_requests_are_explained_and_the_next_one_works(self):
        code = grpc.StatusCode
        nobody = self.pb.GetRequest(job_id="00000000-0000-4000-8000-000000000000")
        self.assert_refused(code.INVALID_ARGUMENT, lambda: self.submit({"formats": ["dxf"]}), "dxf")
        self.assert_refused(code.INVALID_ARGUMENT, lambda: self.submit({"colour": "red"}), "colour")
        self.assert_refused(code.INVALID_ARGUMENT,
                            lambda: self.jobs.Submit(self.pb.SubmitRequest(process="validate", inputs_json="{")), "JSON")
        self.assert_refused(code.NOT_FOUND, lambda: self.jobs.Submit(self.pb.SubmitRequest(process="paint")), "paint")
        for verb in (self.jobs.Get, self.jobs.Dismiss):
            self.assert_refused(code.NOT_FOUND, lambda: verb(nobody))
        self.assert_refused(code.NOT_FOUND, lambda: list(self.jobs.Watch(nobody)))
        job = self.watch(self.submit({"bbox": SEA}))[-1]
        self.assert_refused(code.NOT_FOUND, lambda: self.fetch(job, "../jobs.sqlite"))
        self.assertEqual(self.service.get("/healthz").status, 200)


class LongJobs(GrpcTest):
    options = ("--workers", "1", "--threads", "1")

    @classmethod
    def setUpClass(cls):
        city = tempfile.TemporaryDirectory(prefix="citymesh-e2e-city-")
        cls.addClassCleanup(city.cleanup)
        cls.data = make_big_city(city.name)
        super().setUpClass()

    def test_watch_shows_progress_and_dismissal_ends_it(self):
        running, queued = self.submit({}), self.submit({})
        request = self.pb.GetRequest(job_id=running.job_id)
        states = []
        for state in self.jobs.Watch(request, timeout=LIMIT_S):
            states.append(state)
            if state.state == self.pb.RUNNING and state.done > 0 and len(states) > 2:
                self.jobs.Dismiss(self.pb.GetRequest(job_id=queued.job_id), timeout=LIMIT_S)
                self.jobs.Dismiss(request, timeout=LIMIT_S)
        self.assertEqual(states[-1].state, self.pb.DISMISSED)
        self.assertTrue(any(state.total > state.done > 0 for state in states))
        self.assertEqual(self.jobs.Get(self.pb.GetRequest(job_id=queued.job_id)).state, self.pb.DISMISSED)
        self.assert_refused(grpc.StatusCode.FAILED_PRECONDITION, lambda: self.fetch(running, "obj"))
        self.assertEqual(self.watch(self.submit({"bbox": SEA}))[-1].state, self.pb.SUCCESSFUL)


if __name__ == "__main__":
    unittest.main()
