"""The manifests of Kubernetes: that they fit together, the image and the program's settings. No cluster."""
import re
import unittest

import settings
from settings import ROOT

try:
    import yaml
except ImportError:
    yaml = None

FOLDER = ROOT / "deploy" / "kubernetes"


@unittest.skipUnless(yaml, "python3-yaml is not installed")
class Kubernetes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.kustomization = yaml.safe_load((FOLDER / "kustomization.yaml").read_text(encoding="utf-8"))
        names = [*cls.kustomization["resources"], "secret.example.yaml"]
        cls.objects = {}
        for name in names:
            for found in yaml.safe_load_all((FOLDER / name).read_text(encoding="utf-8")):
                cls.objects[found["kind"]] = found
        cls.pod = cls.objects["StatefulSet"]["spec"]["template"]["spec"]
        cls.container = cls.pod["containers"][0]
        cls.settings = cls.objects["ConfigMap"]["data"]
        cls.dockerfile = (ROOT / "deploy" / "Dockerfile").read_text(encoding="utf-8")

    def test_every_file_is_used(self):
        there = {path.name for path in FOLDER.glob("*.yaml")}
        self.assertEqual(there, {*self.kustomization["resources"], "kustomization.yaml", "secret.example.yaml"})
        self.assertEqual(set(self.objects), {"ConfigMap", "StatefulSet", "Service", "NetworkPolicy", "Secret"})

    def test_the_program_accepts_the_settings(self):
        self.assertLessEqual(set(self.settings), settings.names())
        secret = self.objects["Secret"]["stringData"]
        files = {"/etc/citymesh/" + name: content for name, content in secret.items()}
        accepted = settings.accepted(self.settings, files)
        for name in self.settings.keys() - {"CITYMESH_CONFIG"}:
            self.assertEqual(accepted[name.removeprefix("CITYMESH_").lower()], self.settings[name])
        self.assertEqual(accepted["source"], "postgresql://citymesh:***@citydb:5432/citydb")
        self.assertIn("REPLACE", secret["citymesh.toml"])

    def test_all_speak_of_the_same_objects(self):
        labels = self.objects["StatefulSet"]["spec"]["template"]["metadata"]["labels"]
        self.assertEqual(self.objects["StatefulSet"]["spec"]["selector"]["matchLabels"], labels)
        self.assertEqual(self.objects["Service"]["spec"]["selector"], labels)
        self.assertEqual(self.objects["NetworkPolicy"]["spec"]["podSelector"]["matchLabels"], labels)
        self.assertEqual(self.objects["StatefulSet"]["spec"]["serviceName"], self.objects["Service"]["metadata"]["name"])
        self.assertEqual(self.container["envFrom"], [{"configMapRef": {"name": self.objects["ConfigMap"]["metadata"]["name"]}}])
        volumes = {volume["name"]: volume for volume in self.pod["volumes"]}
        self.assertEqual(volumes["secrets"]["secret"]["secretName"], self.objects["Secret"]["metadata"]["name"])
        claims = {claim["metadata"]["name"] for claim in self.objects["StatefulSet"]["spec"]["volumeClaimTemplates"]}
        self.assertEqual({mount["name"] for mount in self.container["volumeMounts"]}, volumes.keys() | claims)
        self.assertIn({"name": self.container["image"], "newTag": self.kustomization["images"][0]["newTag"]}, self.kustomization["images"])

    def test_selectors_stay_as_they_are_written(self):
        for labels in self.kustomization["labels"]:
            self.assertIs(labels["includeSelectors"], False)

    def test_the_tag_is_the_version(self):
        version = re.search(r"project\(citymesh VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")).group(1)
        self.assertEqual(self.kustomization["images"][0]["newTag"], version)

    def test_ports_are_those_that_it_listens_on(self):
        ports = {port["name"]: port["containerPort"] for port in self.container["ports"]}
        self.assertEqual(ports, {"http": int(self.settings["CITYMESH_LISTEN"].split(":")[1]),
                                 "grpc": int(self.settings["CITYMESH_GRPC"].split(":")[1])})
        for port in self.objects["Service"]["spec"]["ports"]:
            self.assertIn(port["targetPort"], ports)
        for rule in self.objects["NetworkPolicy"]["spec"]["ingress"]:
            self.assertEqual({port["port"] for port in rule["ports"]}, ports.keys())

    def test_probes_ask_what_operators_are_told_to_ask(self):
        documented = (ROOT / "docs" / "operations.md").read_text(encoding="utf-8")
        probes = {name: self.container[name]["httpGet"] for name in ("startupProbe", "livenessProbe", "readinessProbe")}
        self.assertEqual({name: probe["path"] for name, probe in probes.items()},
                         {"startupProbe": "/healthz", "livenessProbe": "/healthz", "readinessProbe": "/readyz"})
        for probe in probes.values():
            self.assertIn(f"`{probe['path']}`", documented)
            self.assertEqual(probe["port"], "http")

    def test_it_may_do_little(self):
        user = int(re.search(r"^USER (\d+)", self.dockerfile, re.MULTILINE).group(1))
        pod = self.pod["securityContext"]
        self.assertEqual((pod["runAsNonRoot"], pod["runAsUser"], pod["fsGroup"]), (True, user, user))
        self.assertEqual(pod["seccompProfile"], {"type": "RuntimeDefault"})
        self.assertEqual(self.container["securityContext"], {"allowPrivilegeEscalation": False, "readOnlyRootFilesystem": True,
                                                             "capabilities": {"drop": ["ALL"]}})
        self.assertIs(self.pod["automountServiceAccountToken"], False)
        self.assertEqual(set(self.objects["NetworkPolicy"]["spec"]["policyTypes"]), {"Ingress", "Egress"})
        self.assertLessEqual({"cpu", "memory"}, self.container["resources"]["limits"].keys())

    def test_only_volumes_are_written_to(self):
        mounts = {mount["name"]: mount for mount in self.container["volumeMounts"]}
        self.assertEqual(mounts["state"]["mountPath"], self.settings["CITYMESH_STATE"])
        self.assertIn("VOLUME " + mounts["state"]["mountPath"], self.dockerfile)
        self.assertTrue(mounts["secrets"]["readOnly"])

    def test_one_replica_owns_the_state(self):
        self.assertEqual(self.objects["StatefulSet"]["spec"]["replicas"], 1)

    def test_variables_of_service_links_are_not_taken_for_settings(self):
        self.assertIs(self.pod["enableServiceLinks"], False)


if __name__ == "__main__":
    unittest.main()
