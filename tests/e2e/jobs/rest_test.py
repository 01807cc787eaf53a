"""The job cycle over REST against the real program, and what it does with bad requests."""
import http.client
import json
import shutil
import socket
import tempfile
import unittest
from pathlib import Path
from urllib.parse import urlsplit

from service import (BERLIN, CITY, EXCEPTIONS, EXECUTION, LIMIT_S, OPEN, SEA, SMALL, ServiceTest, delivered_names, is_closed, make_big_city,
                     read_obj)


class JobCycle(ServiceTest):
    def test_lists_and_describes_processes(self):
        landing = self.service.get("/").json()
        relations = {link["rel"]: link["href"] for link in landing["links"]}
        for relation in ("service-desc", "http://www.opengis.net/def/rel/ogc/1.0/conformance",
                         "http://www.opengis.net/def/rel/ogc/1.0/processes"):
            self.assertEqual(self.service.get(relations[relation]).status, 200)
        processes = self.service.get("/processes").json()["processes"]
        self.assertIn("export-for-simulation", [process["id"] for process in processes])
        for process in processes:
            href = next(link["href"] for link in process["links"] if link["rel"] == "self")
            self.assertIn("inputs", self.service.get(href).json())

    def test_box_becomes_a_closed_mesh_and_a_report_that_adds_up(self):
        created = self.service.send("POST", EXECUTION, {"inputs": {"bbox": CITY, "formats": ["obj", "stl"]}},
                                    {"Prefer": "respond-async"})
        self.assertEqual(created.status, 201)
        self.assertEqual(created.headers["Preference-Applied"], "respond-async")
        job = created.headers["Location"]
        self.assertTrue(job.startswith(self.service.url + "/jobs/"))
        self.assertEqual(created.json()["jobID"], job.rsplit("/", 1)[1])

        status = self.service.wait(job)
        self.assertEqual(status["status"], "successful", status)
        self.assertEqual(status["progress"], 100)
        self.assertLessEqual(status["created"], status["started"])
        self.assertLessEqual(status["started"], status["finished"])

        relation = "http://www.opengis.net/def/rel/ogc/1.0/results"
        results = self.service.get(next(link["href"] for link in status["links"] if link["rel"] == relation)).json()
        report = self.service.get(results["report"]["href"]).json()
        counts = report["counts"]
        self.assertGreater(counts["requested"], 100)
        self.assertEqual(counts["requested"], counts["delivered"] + counts["merged"] + counts["dropped"])
        self.assertEqual(len(report["buildings"]), counts["requested"])
        for building in report["buildings"]:
            self.assertTrue(building["outcome"] != "dropped" or building["reason"], building)

        download = self.service.get(results["obj"]["href"])
        self.assertEqual(download.headers["Content-Type"], "model/obj")
        self.assertIn("model.obj", download.headers["Content-Disposition"])
        bodies = read_obj(download.body.decode())
        self.assertGreaterEqual(len(bodies), counts["delivered"])
        self.assertTrue(delivered_names(report) <= bodies.keys(), delivered_names(report) - bodies.keys())
        self.assertEqual([name for name, faces in bodies.items() if not is_closed(faces)], [])

        files = {link["title"] for link in status["links"] if link["rel"] == "item"}
        self.assertLessEqual({"model.obj", "model.stl", "report.json", "report.html", "picture.svg", "run.json"}, files)
        page = self.service.get(job + "/results/report.html")
        self.assertIn("default-src 'none'", page.headers["Content-Security-Policy"])
        self.assertIn(b"<svg", self.service.get(job + "/results/picture.svg").body)

    def test_same_request_gives_the_same_bytes(self):
        jobs = [self.service.execute({"bbox": CITY}) for _ in range(2)]
        for job in jobs:
            self.assertEqual(self.service.wait(job)["status"], "successful")
        for name in ("model.obj", "report.json", "report.html", "picture.svg"):
            first, second = (self.service.get(f"{job}/results/{name}").body for job in jobs)
            self.assertEqual(first, second, name)

    def test_heal_gives_the_city_model_back(self):
        created = self.service.send("POST", "/processes/heal/execution", {"inputs": {"bbox": CITY}},
                                    {"Prefer": "respond-async"})
        self.assertEqual(created.status, 201, created.body)
        job = created.headers["Location"]
        status = self.service.wait(job)
        self.assertEqual(status["status"], "successful")
        results = self.service.get(job + "/results").json()
        self.assertEqual(set(results), {"report", "cityjson"})
        report, model = (self.service.get(results[name]["href"]).json() for name in ("report", "cityjson"))
        self.assertEqual(report["process"], "heal")
        delivered = {building["gml_id"] for building in report["buildings"] if building["outcome"] == "delivered"}
        self.assertTrue(delivered and delivered <= model["CityObjects"].keys())
        self.assertIn("errors.glb", {link["title"] for link in status["links"] if link["rel"] == "item"})
        self.assertEqual(self.service.get(job + "/results/errors_glb").body[:4], b"glTF")

    def test_heal_and_validate_answer_at_once(self):
        report = self.service.send("POST", "/processes/validate/execution", {"inputs": {"bbox": SMALL}})
        self.assertEqual(report.status, 200, report.body)
        self.assertEqual(report.json()["process"], "validate")
        results = self.service.get(report.headers["Content-Location"]).json()
        self.assertEqual(self.service.get(results["report"]["href"]).body, report.body)
        healed = self.service.send("POST", "/processes/heal/execution", {"inputs": {"bbox": SMALL}})
        self.assertEqual(healed.status, 200, healed.body)
        values = healed.json()
        self.assertEqual(set(values), {"report", "cityjson"})
        self.assertEqual(values["cityjson"]["value"]["type"], "CityJSON")

    def test_events_tell_of_a_job_until_it_has_ended(self):
        job = self.service.execute({"bbox": CITY})
        events = self.service.get(job + "/events")
        self.assertEqual(events.headers["Content-Type"], "text/event-stream")
        states = [json.loads(line[6:]) for line in events.body.decode().splitlines() if line.startswith("data: ")]
        self.assertEqual(states[-1]["status"], "successful")
        self.assertEqual(states[-1]["progress"], 100)
        last = [line[4:] for line in events.body.decode().splitlines() if line.startswith("id: ")][-1]
        self.assertEqual(self.service.get(job + "/events", {"Last-Event-ID": last}).status, 204)

    def test_errors_glb_is_a_result_where_the_process_writes_it(self):
        job = self.service.execute({"bbox": CITY}, process="validate", outputs={"errors_glb": {}})
        self.assertEqual(self.service.wait(job)["status"], "successful")
        self.assertEqual(self.service.get(job + "/results").body[:4], b"glTF")
        exported = self.service.execute({"bbox": CITY})
        status = self.service.wait(exported)
        self.assertNotIn("errors.glb", {link["title"] for link in status["links"]})
        self.assertEqual(self.service.get(exported + "/results/errors_glb").status, 404)

    def test_results_by_value_in_every_form(self):
        raw = self.service.execute({"bbox": CITY}, outputs={"obj": {}})
        several = self.service.execute({"bbox": CITY}, outputs={"obj": {}, "report": {}})
        document = self.service.execute({"bbox": CITY}, outputs={"obj": {}, "report": {}}, response="document")
        for job in (raw, several, document):
            self.assertEqual(self.service.wait(job)["status"], "successful")
        obj = self.service.get(raw + "/results").body
        self.assertTrue(read_obj(obj.decode()))
        multipart = self.service.get(several + "/results")
        self.assertTrue(multipart.headers["Content-Type"].startswith("multipart/related"))
        self.assertIn(obj, multipart.body)
        values = self.service.get(document + "/results").json()
        self.assertEqual(values["obj"].encode(), obj)
        self.assertGreater(values["report"]["value"]["counts"]["requested"], 0)

    def test_box_without_buildings_is_a_success_with_a_warning(self):
        job = self.service.execute({"bbox": SEA})
        status = self.service.wait(job)
        self.assertEqual(status["status"], "successful", status)
        report = self.service.get(job + "/results/report").json()
        for outcome in ("requested", "delivered", "merged", "dropped"):
            self.assertEqual(report["counts"][outcome], 0)
        self.assertTrue(report["warnings"])

    def test_job_pages_are_readable_in_a_browser(self):
        job = self.service.execute({"bbox": SEA})
        self.service.wait(job)
        for path in ("/", "/processes", "/processes/export-for-simulation", "/jobs", job, "/api"):
            page = self.service.get(path, {"Accept": "text/html"})
            self.assertTrue(page.headers["Content-Type"].startswith("text/html"), path)
            self.assertIn(b"</html>", page.body)

    def test_every_job_is_in_the_list(self):
        jobs = {self.service.execute({"bbox": SEA}).rsplit("/", 1)[1] for _ in range(3)}
        seen, page = set(), self.service.url + "/jobs?limit=2"
        while page:
            document = self.service.get(page).json()
            seen |= {job["jobID"] for job in document["jobs"]}
            page = next((link["href"] for link in document["links"] if link["rel"] == "next"), None)
        self.assertLessEqual(jobs, seen)

    def test_bad_requests_are_explained_and_the_server_stays_healthy(self):
        def refused(status, body, *words, path=EXECUTION, method="POST", headers=None):
            answer = self.service.send(method, path, body, headers)
            self.assertEqual(answer.status, status, answer.body)
            self.assertEqual(answer.headers["Content-Type"], "application/problem+json")
            for word in words:
                self.assertIn(word, answer.json()["detail"])
            self.assertEqual(self.service.get("/healthz").status, 200)
            return answer.json()

        refused(400, b'{"inputs": {', "not valid JSON", "line 1")
        refused(400, b"[" * 100_000, "nested")
        refused(400, {"inputs": {"colour": "red"}}, "colour")
        refused(400, {"inputs": {"formats": ["dxf"]}}, "dxf", "obj")
        refused(400, {"inputs": {"bbox": {"bbox": [1, 2, "x", 4]}}}, "bbox")
        refused(400, {"inputs": {"bbox": {"bbox": [2, 2, 1, 1]}}}, "bbox")
        refused(400, b'{"inputs": {"bbox": {"bbox": [1e999, 0, 1, 1]}}}', "1e999")
        refused(400, {"inputs": {"bbox": CITY | {"crs": "EPSG:0"}}}, "EPSG:0")
        refused(413, b" " * (2 << 20))
        refused(415, b"<xml/>", "application/json", headers={"Content-Type": "text/xml"})
        refused(405, None, "PUT", path="/jobs", method="PUT")
        self.assertEqual(refused(404, {}, "paint", path="/processes/paint/execution")["type"],
                         EXCEPTIONS + "no-such-process")
        self.assertEqual(refused(404, None, path="/jobs/..%2F..%2Fetc", method="GET")["type"], EXCEPTIONS + "no-such-job")

    def test_errors_are_plain_json_for_a_client_that_names_only_that(self):
        answer = self.service.send("POST", EXECUTION, b"{", {"Accept": "application/json"})
        self.assertEqual((answer.status, answer.headers["Content-Type"]), (400, "application/json"))

    def test_connection_survives_garbage_from_others(self):
        address = urlsplit(self.service.url)
        kept = http.client.HTTPConnection(address.hostname, address.port, timeout=LIMIT_S)
        for garbage in (b"\x16\x03\x01\x02\x00\x01\x00", b"GET /\r\n\r\n", b"\0" * 5000, b"A" * 100_000):
            with socket.create_connection((address.hostname, address.port), timeout=LIMIT_S) as other:
                try:
                    other.sendall(garbage)
                    other.shutdown(socket.SHUT_WR)
                    while other.recv(65536):
                        pass
                except OSError:
                    pass  # the server may hang up first
            kept.request("GET", "/healthz")
            self.assertEqual(kept.getresponse().read(), b"ok\n")
        kept.close()

    def test_trace_of_a_request_is_that_of_its_job_in_the_log(self):
        def traces_of(headers):
            answer = self.service.send("POST", EXECUTION, {"inputs": {"bbox": SEA}}, headers)
            self.assertEqual(answer.status, 201)
            job = answer.json()["jobID"]
            self.service.wait(answer.headers["Location"])
            lines = self.service.logged(job_id=job)
            self.assertLessEqual({"job_accepted", "job_started"}, {line["event"] for line in lines})
            return {line["trace_id"] for line in lines}

        trace = "4bf92f3577b34da6a3ce929d0e0e4736"
        self.assertEqual(traces_of({"traceparent": f"00-{trace}-00f067aa0ba902b7-01"}), {trace})
        made = traces_of({"traceparent": f"00-{trace}-not-one"})
        self.assertEqual(len(made), 1)
        self.assertRegex(made.pop(), "^(?!" + trace + ")[0-9a-f]{32}$")

    def test_metrics_count_requests_and_jobs(self):
        self.service.wait(self.service.execute({"bbox": SEA}))
        metrics = self.service.get("/metrics").body.decode()
        self.assertIn('route="/jobs/{id}"', metrics)
        self.assertIn("export-for-simulation", metrics)


class AskedBefore(ServiceTest):
    result_cache = "on"

    @classmethod
    def setUpClass(cls):
        data = tempfile.TemporaryDirectory(prefix="citymesh-e2e-data-")
        cls.addClassCleanup(data.cleanup)
        cls.data = Path(data.name)
        shutil.copy(BERLIN / "3910_5817.gml", cls.data)
        super().setUpClass()

    def done(self, inputs):
        status = self.service.wait(self.service.execute(inputs))
        self.assertEqual(status["status"], "successful", status)
        files = {link["title"]: self.service.get(link["href"]) for link in status["links"] if link["rel"] == "item"}
        self.assertEqual({answer.status for answer in files.values()}, {200})
        return status, {name: answer.body for name, answer in files.items()}

    def test_same_request_is_answered_from_the_results_of_the_first_until_the_data_change(self):
        first, files = self.done({"bbox": SMALL})
        self.assertNotIn("cached", first)
        again, same_files = self.done({"bbox": SMALL})
        self.assertIs(again["cached"], True)
        self.assertIn("earlier job", again["message"])
        self.assertEqual(same_files, files)
        self.assertNotIn("cached", self.done({"bbox": SMALL, "formats": ["stl"]})[0])
        self.assertIn("citymesh_result_cache_hits_total 1", self.service.get("/metrics").body.decode())

        (self.data / "3910_5817.gml").touch()
        self.assertNotIn("cached", self.done({"bbox": SMALL})[0])


class LongJobs(ServiceTest):
    """Over a city that takes a while, one thread, one worker."""

    options = ("--workers", "1", "--threads", "1")

    @classmethod
    def setUpClass(cls):
        city = tempfile.TemporaryDirectory(prefix="citymesh-e2e-city-")
        cls.addClassCleanup(city.cleanup)
        cls.data = make_big_city(city.name)
        super().setUpClass()

    def test_progress_results_not_ready_and_dismissal(self):
        running, queued = (self.service.execute({}) for _ in range(2))
        status = self.service.wait(running, lambda status: status.get("done", 0) > 0 or status["status"] not in OPEN)
        self.assertEqual(status["status"], "running", status)
        self.assertGreater(status["total"], status["done"])
        self.assertTrue(status["stage"])
        early = self.service.get(running + "/results")
        self.assertEqual((early.status, early.json()["type"]), (404, EXCEPTIONS + "result-not-ready"))

        for job in (queued, running):
            answer = self.service.send("DELETE", job)
            self.assertEqual(answer.status, 200, answer.body)
            self.assertEqual(self.service.wait(job)["status"], "dismissed")
            self.assertEqual(self.service.get(job + "/results").status, 404)

        # The worker is free again: a small job is not kept waiting by the dismissed ones.
        self.assertEqual(self.service.wait(self.service.execute({"bbox": SEA}))["status"], "successful")

    def test_stop_in_mid_job_is_clean(self):
        job = self.service.execute({})
        self.service.wait(job, lambda status: status["status"] != "accepted")
        self.assertEqual(self.service.stop(), 0)
        events = [json.loads(line).get("event") for line in self.service.log.read_text().splitlines() if line.startswith("{")]
        self.assertIn("stopped", events)


if __name__ == "__main__":
    unittest.main()
