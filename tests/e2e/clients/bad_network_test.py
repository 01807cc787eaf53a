"""The Python client behind a proxy that does what networks do: one job and whole files all the same."""
import http.server
import tempfile
import threading
import unittest
import uuid
from pathlib import Path
from unittest import mock

import citymesh_client
from bad_proxy import BadProxy, Fault
from citymesh_client import Client, job as job_module, transport
from service import SEA, SMALL, ServiceTest

EXECUTION = "/execution"


class BadNetwork(ServiceTest):
    def setUp(self):
        self.proxy = BadProxy(self.service.url)
        self.addCleanup(self.proxy.close)
        self.client = Client(self.proxy.url, retries=2)
        folder = tempfile.TemporaryDirectory(prefix="citymesh-client-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        # Pauses are noted, not made.
        self.pauses = []
        patch = mock.patch.object(transport.time, "sleep", self.pauses.append)
        patch.start()
        self.addCleanup(patch.stop)

    def done_job(self):
        """A finished job, and its mesh as the service has it."""
        job = self.client.submit("export-for-simulation", {"bbox": SMALL})
        job.wait()
        return job, self.service.get(f"/jobs/{job.id}/results/obj").body

    def ids(self):
        return {status.job_id for status in Client(self.service.url).jobs()}

    def test_answer_that_is_lost_does_not_make_a_second_job(self):
        before = self.ids()
        self.proxy.faults.append(Fault("POST", EXECUTION, drop_answer=True))
        job = self.client.submit("export-for-simulation", {"bbox": SEA})
        self.assertEqual(len(self.proxy.sent("POST", EXECUTION)), 2)
        self.assertEqual(self.ids() - before, {job.id})

    def test_turned_away_waits_as_long_as_told(self):
        self.proxy.faults.append(Fault("POST", EXECUTION, status=429, headers={"Retry-After": "7"}))
        self.proxy.faults.append(Fault("POST", EXECUTION, status=503, headers={"Retry-After": "11"}))
        self.client.submit("export-for-simulation", {"bbox": SEA})
        self.assertEqual(len(self.pauses), 2)
        self.assertTrue(7 <= self.pauses[0] < 11 <= self.pauses[1], self.pauses)
        keys = {headers["Idempotency-Key"] for headers in self.proxy.sent("POST", EXECUTION)}
        self.assertEqual(len(keys), 1)

    def test_turned_away_for_ever_is_an_error(self):
        self.proxy.faults.append(Fault("POST", EXECUTION, times=3, status=429, headers={"Retry-After": "1"}))
        with self.assertRaises(citymesh_client.TooManyRequests) as caught:
            self.client.submit("export-for-simulation", {"bbox": SEA})
        self.assertEqual(caught.exception.retry_after_s, 1)
        self.proxy.faults.append(Fault("POST", EXECUTION, status=503, headers={"Retry-After": "3600"}))
        with self.assertRaises(citymesh_client.ServiceUnavailable):
            self.client.submit("export-for-simulation", {"bbox": SEA})
        self.assertEqual(len(self.pauses), 2, "nobody wants to wait for an hour")
        self.proxy.faults.append(Fault("GET", "/processes", times=3, drop_answer=True))
        with self.assertRaises(citymesh_client.Unreachable):
            self.client.processes()

    def test_refusal_is_not_tried_again(self):
        with self.assertRaises(citymesh_client.InvalidRequest):
            self.client.submit("export-for-simulation", {"formats": ["dxf"]})
        self.assertEqual(len(self.proxy.sent("POST", EXECUTION)), 1)

    def test_download_goes_on_where_it_broke(self):
        job, mesh = self.done_job()
        third = len(mesh) // 3
        self.proxy.faults += [Fault("GET", "/results/obj", cut_after=third) for _ in range(2)]
        told = []
        path = job.download("obj", self.folder / "model.obj", progress=lambda done, total: told.append((done, total)))
        self.assertEqual(path.read_bytes(), mesh)
        self.assertEqual([headers.get("Range") for headers in self.proxy.sent("GET", "/results/obj")],
                         [None, f"bytes={third}-", f"bytes={2 * third}-"])
        self.assertEqual(told[-1], (len(mesh), len(mesh)))
        self.assertEqual([path.name for path in self.folder.iterdir()], ["model.obj"])

    def test_next_run_goes_on_with_the_download_of_the_last(self):
        job, mesh = self.done_job()
        self.proxy.faults.append(Fault("GET", "/results/obj", cut_after=1000))
        self.proxy.faults.append(Fault("GET", "/results/obj", times=3, drop_answer=True))
        with self.assertRaises(citymesh_client.DownloadFailed):
            job.download("obj", self.folder)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["model.obj.part", "model.obj.part.etag"])
        self.assertEqual(Client(self.proxy.url).job(job.id).download("obj", self.folder).read_bytes(), mesh)
        self.assertEqual(self.proxy.sent("GET", "/results/obj")[-1]["Range"], "bytes=1000-")
        self.assertEqual([path.name for path in self.folder.iterdir()], ["model.obj"])

    def test_beginning_of_another_file_is_not_gone_on_with(self):
        job, mesh = self.done_job()
        for there in (b"of another job", b"x" * (len(mesh) + 5)):
            (self.folder / "model.obj.part").write_bytes(there)
            (self.folder / "model.obj.part.etag").write_text('"of-another-job-1"')
            self.assertEqual(job.download("obj", self.folder).read_bytes(), mesh)
            (self.folder / "model.obj").unlink()
        (self.folder / "model.obj.part").write_bytes(b"of which version is not known")
        self.assertEqual(job.download("obj", self.folder).read_bytes(), mesh)

    def test_complete_file_that_was_not_renamed_is_fetched_again(self):
        job, mesh = self.done_job()
        (self.folder / "model.obj.part").write_bytes(mesh)
        (self.folder / "model.obj.part.etag").write_text(self.service.get(f"/jobs/{job.id}/results/obj").headers["ETag"])
        self.assertEqual(job.download("obj", self.folder).read_bytes(), mesh)

    def test_stream_of_events_that_breaks_is_taken_up_again(self):
        self.proxy.faults.append(Fault("GET", "/events", times=1, cut_after=150))
        job = self.client.submit("export-for-simulation", {"bbox": SMALL})
        self.assertEqual(job.wait().state, "successful")

    def test_without_events_the_state_is_asked_for(self):
        self.proxy.faults.append(Fault("GET", "/events", times=100, status=404))
        job = self.client.submit("export-for-simulation", {"bbox": SMALL})
        self.assertEqual(job.wait().state, "successful")
        self.assertLessEqual(len(self.proxy.sent("GET", "/events")), job_module.MOST_FRUITLESS_STREAMS)

    def test_key_is_sent_with_every_request_and_to_nobody_else(self):
        others = []

        class Other(http.server.BaseHTTPRequestHandler):
            def do_GET(self):
                others.append(dict(self.headers))
                self.send_response(200)
                self.end_headers()
                self.wfile.write(b'{"processes": []}')

            def log_message(self, *_):
                pass

        other = http.server.HTTPServer(("127.0.0.1", 0), Other)
        threading.Thread(target=other.serve_forever, daemon=True).start()
        self.addCleanup(other.server_close)
        self.addCleanup(other.shutdown)

        secret = str(uuid.uuid4())
        for client, name, value in ((Client(self.proxy.url, api_key=secret), "X-API-Key", secret),
                                    (Client(self.proxy.url, token=secret), "Authorization", f"Bearer {secret}")):
            del self.proxy.requests[:], others[:]
            job = client.submit("validate", {"bbox": SEA})
            job.wait()
            job.download("report", self.folder)
            for _, path, headers in self.proxy.requests:
                self.assertEqual({key.lower(): text for key, text in headers.items()}.get(name.lower()), value, path)
            elsewhere = f"http://127.0.0.1:{other.server_address[1]}/processes"
            self.proxy.faults.append(Fault("GET", "/processes", status=302, headers={"Location": elsewhere}))
            client.processes()
            self.assertEqual(len(others), 1)
            self.assertNotIn(secret, str(others))


if __name__ == "__main__":
    unittest.main()
