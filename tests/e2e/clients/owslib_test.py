"""The OGC client that Debian has, and that knows nothing of us: it finds our processes and executes one."""
import unittest

from service import LIMIT_S, SMALL, ServiceTest

try:
    from owslib.ogcapi.processes import Processes
    from owslib.util import http_post
except ImportError as error:
    raise unittest.SkipTest(f"owslib is not installed (apt-get install python3-owslib): {error}") from None

EXECUTE = "http://www.opengis.net/def/rel/ogc/1.0/execute"
RESULTS = "http://www.opengis.net/def/rel/ogc/1.0/results"


class Owslib(ServiceTest):
    def setUp(self):
        self.client = Processes(self.service.url)

    def link(self, document, relation):
        return next(link["href"] for link in document["links"] if link["rel"] == relation)

    def test_discovers_the_service(self):
        self.assertIn("http://www.opengis.net/spec/ogcapi-processes-1/1.0/conf/core", self.client.conformance()["conformsTo"])
        self.assertIn("/processes/validate/execution", self.client.api()["paths"])
        summaries = {process["id"]: process for process in self.client.processes()["processes"]}
        self.assertLessEqual({"export-for-simulation", "heal", "validate"}, summaries.keys())
        for process in summaries:
            description = self.client.process(process)
            self.assertEqual(description["id"], process)
            self.assertTrue(description["inputs"] and description["outputs"])

    def test_unknown_process_is_an_error(self):
        with self.assertRaises(RuntimeError) as caught:
            self.client.process("paint")
        self.assertIn("no-such-process", str(caught.exception))

    def test_executes_a_process_that_it_found(self):
        address = self.link(self.client.process("validate"), EXECUTE)
        answer = http_post(address, request='{"inputs": {"bbox": {"bbox": %s}}}' % SMALL["bbox"],
                           headers={"Content-Type": "application/json"}, timeout=LIMIT_S)
        self.assertEqual(answer.status_code, 200, answer.text)
        self.assertGreater(answer.json()["counts"]["requested"], 0)

    def test_follows_a_job(self):
        address = self.link(self.client.process("export-for-simulation"), EXECUTE)
        accepted = http_post(address, request='{"inputs": {"bbox": {"bbox": %s}}}' % SMALL["bbox"],
                             headers={"Content-Type": "application/json"}, timeout=LIMIT_S)
        self.assertEqual(accepted.status_code, 201, accepted.text)
        status = self.service.wait(accepted.headers["Location"])
        self.assertEqual(status["status"], "successful")
        results = self.client._request(self.link(status, RESULTS))
        self.assertIn("obj", results)


if __name__ == "__main__":
    unittest.main()
