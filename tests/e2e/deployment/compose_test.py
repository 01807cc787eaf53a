"""docker-compose.yml as docker-compose reads it, against the settings that the program has."""
import os
import re
import shutil
import stat
import subprocess
import tempfile
import unittest
from pathlib import Path

import settings
from settings import ROOT

try:
    import yaml
except ImportError:
    yaml = None

PROFILES = ("load", "v4", "metrics")
PASSWORD_IN_URL = re.compile(r"://[^:/@\s]+:[^@/\s]+@")
SECRET_NAME = re.compile(r"PASSWORD|SECRET|KEY|TOKEN")


def read_compose(secrets):
    command = ["docker-compose", "-f", str(ROOT / "docker-compose.yml"), "--project-directory", str(ROOT)]
    for profile in PROFILES:
        command += ["--profile", profile]
    ran = subprocess.run([*command, "config"], capture_output=True, text=True,
                         env={"PATH": os.environ["PATH"], "CITYMESH_SECRETS": secrets})
    assert ran.returncode == 0, ran.stderr
    return yaml.safe_load(ran.stdout)


def read_yaml(path):
    return yaml.safe_load(Path(path).read_text(encoding="utf-8"))


@unittest.skipUnless(yaml and shutil.which("docker-compose"), "docker-compose and python3-yaml are not installed")
class Compose(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="citymesh-deployment-")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = os.path.join(folder.name, "secrets")
        cls.secrets = settings.made_secrets(cls.folder)
        cls.config = read_compose(cls.folder)
        cls.services = cls.config["services"]
        cls.citymesh = {name: service for name, service in cls.services.items() if name.startswith("citymesh")}

    def of_each(self, *without):
        for name, service in self.services.items():
            if name not in without:
                with self.subTest(service=name):
                    yield service

    def secrets_of(self, service):
        """Content by the path in the container."""
        found = {}
        for secret in service.get("secrets", ()):
            path = "/run/secrets/" + secret.get("target", secret["source"])
            found[path] = self.secrets[os.path.basename(self.config["secrets"][secret["source"]]["file"])]
        return found

    def test_it_has_the_service_over_both_versions_the_loaders_and_the_metrics(self):
        self.assertEqual(set(self.services), {"citydb", "citydb-v4", "load", "load-v4", "citymesh", "citymesh-v4", "prometheus", "grafana"})

    def test_every_setting_exists_and_the_program_accepts_them_together(self):
        for service in self.of_each(*(self.services.keys() - self.citymesh.keys())):
            environment = service["environment"]
            used = {name for name in environment if name.startswith("CITYMESH_")}
            self.assertLessEqual(used, settings.names())
            accepted = settings.accepted(environment, self.secrets_of(service))
            for name in used - {"CITYMESH_CONFIG"}:
                self.assertEqual(accepted[name.removeprefix("CITYMESH_").lower()], environment[name])
            self.assertTrue(accepted["source"].startswith("postgresql://citymesh:***@citydb"), accepted["source"])

    def test_each_service_reads_its_own_database(self):
        for name, version in (("citymesh", ""), ("citymesh-v4", "-v4")):
            accepted = settings.accepted(self.services[name]["environment"], self.secrets_of(self.services[name]))
            self.assertEqual(accepted["source"], f"postgresql://citymesh:***@citydb{version}:5432/citydb")
            self.assertIn(f"citydb{version}", self.services[name]["depends_on"])

    def test_who_reaches_a_service_has_to_show_a_key(self):
        for service in self.of_each(*(self.services.keys() - self.citymesh.keys())):
            self.assertNotIn("CITYMESH_INSECURE", service["environment"])
            self.assertIn("citymesh_", self.secrets["prometheus_key"])
            self.assertIn(service["environment"]["CITYMESH_API_KEYS"], self.secrets_of(service))

    def test_ports_are_reachable_from_this_machine_only(self):
        published = [port for service in self.services.values() for port in service.get("ports", ())]
        self.assertGreaterEqual(len(published), 6)
        for port in published:
            address = port if isinstance(port, str) else str(port.get("host_ip", ""))
            self.assertTrue(address.startswith("127.0.0.1"), port)
        self.assertTrue(self.config["networks"]["database"]["internal"])
        for name in ("citydb", "citydb-v4", "load", "load-v4"):
            self.assertEqual(set(self.services[name]["networks"]), {"database"})

    def test_no_secret_stands_in_the_file_or_in_an_argument(self):
        text = (ROOT / "docker-compose.yml").read_text(encoding="utf-8")
        self.assertIsNone(PASSWORD_IN_URL.search(text))
        for service in self.of_each():
            for name, value in (service.get("environment") or {}).items():
                if SECRET_NAME.search(name):
                    self.assertTrue(str(value).startswith("/run/secrets/"), name)
                    self.assertIn(value, self.secrets_of(service))
            for secret in self.secrets.values():
                self.assertNotIn(secret.strip(), str(service))

    def test_secrets_are_those_that_are_made(self):
        files = {os.path.basename(secret["file"]) for secret in self.config["secrets"].values()}
        self.assertEqual(files, set(self.secrets))
        self.assertEqual(stat.S_IMODE(os.stat(self.folder).st_mode), 0o700)
        ignored = (ROOT / ".gitignore").read_text(encoding="utf-8").splitlines()
        self.assertIn("/deploy/secrets/", ignored)

    def test_secrets_that_exist_are_kept(self):
        again = subprocess.run([ROOT / "deploy" / "make-secrets.sh", "--folder", self.folder, "--citymesh", settings.PROGRAM],
                               capture_output=True, text=True)
        self.assertEqual(again.returncode, 1)
        self.assertIn("has secrets already", again.stderr)

    def test_containers_may_do_little(self):
        for service in self.of_each():
            self.assertEqual(service["cap_drop"], ["ALL"])
            self.assertIn("no-new-privileges:true", service["security_opt"])
            self.assertNotIn("privileged", service)
            self.assertIn("mem_limit", service)
            self.assertIn("pids_limit", service)
        for service in self.of_each("load", "load-v4"):
            self.assertTrue(service["read_only"])
            self.assertEqual(service["restart"], "unless-stopped")
            self.assertIn("max-size", service["logging"]["options"])

    def test_whatever_stays_up_says_how_it_is(self):
        for service in self.of_each("load", "load-v4", *self.citymesh):  # the image of citymesh has its own
            self.assertIn("test", service["healthcheck"])

    def test_what_changes_is_in_volumes_that_exist(self):
        for service in self.of_each("load", "load-v4"):
            named = [volume for volume in service["volumes"] if not volume.startswith("/")]
            self.assertEqual(len(named), 1)
            self.assertIn(named[0].split(":")[0], self.config["volumes"])
        for service in self.of_each():
            for volume in service["volumes"]:
                if volume.startswith("/"):
                    self.assertTrue(os.path.exists(volume.split(":")[0]), volume)
                    self.assertTrue(volume.endswith(":ro"), volume)

    def test_images_of_others_are_pinned(self):
        for service in self.of_each(*self.citymesh):
            self.assertRegex(service["image"], r"^[\w./-]+:v?\d+[\w.-]*\.\d+")

    def test_prometheus_scrapes_the_service_with_its_key(self):
        mounted = dict(volume.split(":")[:2] for volume in self.services["prometheus"]["volumes"])
        file = next(source for source, target in mounted.items() if target == "/etc/prometheus/prometheus.yml")
        scrape = read_yaml(file)["scrape_configs"][0]
        self.assertEqual(scrape["static_configs"][0]["targets"], ["citymesh:8080"])
        self.assertIn(scrape["authorization"]["credentials_file"], self.secrets_of(self.services["prometheus"]))
        self.assertTrue(set(self.services["prometheus"]["networks"]) & set(self.services["citymesh"]["networks"]))
        key = self.secrets["prometheus_key"].strip()
        self.assertRegex(key, r"^citymesh_[\w-]{43}$")

    def test_grafana_finds_the_dashboard_and_its_data(self):
        mounted = {volume.split(":")[1]: volume.split(":")[0] for volume in self.services["grafana"]["volumes"]}
        provisioning = mounted["/etc/grafana/provisioning"]
        provider = read_yaml(f"{provisioning}/dashboards/citymesh.yml")["providers"][0]
        self.assertIn(provider["options"]["path"] + "/citymesh.json", mounted)
        source = read_yaml(f"{provisioning}/datasources/prometheus.yml")["datasources"][0]
        self.assertEqual((source["type"], source["url"]), ("prometheus", "http://prometheus:9090"))


if __name__ == "__main__":
    unittest.main()
