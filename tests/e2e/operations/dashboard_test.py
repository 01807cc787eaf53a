"""The Grafana dashboard and the page about operations against the metrics of a running service."""
import json
import re
import unittest

from service import ROOT, SMALL, ServiceTest

try:
    import grpc
except ImportError:
    grpc = None

METRIC = re.compile(r"\bcitymesh_\w+")
SAMPLE = re.compile(r"^(\w+)(?:\{(.*)\})? \S+$")
PARTS = re.compile(r"_(bucket|sum|count)$")
# `metric{selectors}` with what it is grouped by, if it is.
GROUPED = re.compile(r"by \(([^)]*)\) \((?:rate\(|increase\()?(citymesh_\w+)\{")
SELECTED = re.compile(r"(citymesh_\w+)\{([^}]*)\}")
OF_SCRAPES = {"job", "instance"}  # labels that Prometheus adds


def queries_of(dashboard):
    for panel in dashboard["panels"]:
        for target in panel.get("targets", ()):
            yield panel["title"], target["expr"]
    for variable in dashboard["templating"]["list"]:
        if variable["type"] == "query":
            yield variable["name"], variable["definition"]


class Dashboard(ServiceTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        text = (ROOT / "deploy" / "grafana" / "citymesh.json").read_text(encoding="utf-8")
        cls.dashboard = json.loads(text)
        cls.queries = list(queries_of(cls.dashboard))
        # One of everything that is counted.
        cls.service.wait(cls.service.execute({"bbox": SMALL}))
        cls.service.get("/jobs")
        if grpc:
            with grpc.insecure_channel(cls.service.grpc) as channel:
                channel.unary_unary("/citymesh.v1.Jobs/Processes")(b"", timeout=60)
        cls.samples = {}  # name → its labels
        for line in cls.service.get("/metrics").body.decode().splitlines():
            match = SAMPLE.match(line)
            if match:
                labels = set(re.findall(r'(\w+)="', match.group(2) or ""))
                cls.samples.setdefault(match.group(1), set()).update(labels)

    def skip_without_grpc(self):
        if not grpc:
            self.skipTest("the metrics of gRPC appear with the first call: python3-grpcio is not installed")

    def test_every_metric_of_the_dashboard_exists(self):
        self.skip_without_grpc()
        used = {name for _, query in self.queries for name in METRIC.findall(query)}
        self.assertGreater(len(used), 5)
        self.assertEqual(used - self.samples.keys(), set())

    def test_every_label_of_the_dashboard_exists(self):
        self.skip_without_grpc()
        for title, query in self.queries:
            for labels, metric in GROUPED.findall(query):
                self.assertLessEqual({label.strip() for label in labels.split(",")}, self.samples[metric], f"{title}: {query}")
            for metric, selectors in SELECTED.findall(query):
                self.assertLessEqual(set(re.findall(r"(\w+)[=!]", selectors)) - OF_SCRAPES, self.samples[metric], f"{title}: {query}")

    def test_every_metric_is_shown_and_documented(self):
        used = {PARTS.sub("", name) for _, query in self.queries for name in METRIC.findall(query)}
        documented = set(METRIC.findall((ROOT / "docs" / "operations.md").read_text(encoding="utf-8")))
        exported = {PARTS.sub("", name) for name in self.samples}
        self.assertEqual(exported - used, set())
        self.assertEqual(exported - documented, set())

    def test_panels_can_be_told_apart(self):
        panels = self.dashboard["panels"]
        self.assertEqual(len({panel["id"] for panel in panels}), len(panels))
        taken = set()
        for panel in panels:
            place = panel["gridPos"]
            cells = {(x, y) for x in range(place["x"], place["x"] + place["w"]) for y in range(place["y"], place["y"] + place["h"])}
            self.assertFalse(cells & taken, panel["title"])
            taken |= cells


if __name__ == "__main__":
    unittest.main()
