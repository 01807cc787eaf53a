#!/usr/bin/env python3
"""The stack of docker-compose.yml (standard input, from `docker-compose config`) for a machine where containers have no network
of their own and images cannot be pulled: the same services, settings, secrets, volumes and restrictions, but

- the network is that of the machine, on the free ports that are given; names of services are addresses of this machine
- images are those that try-compose.sh built; Grafana, which Debian does not have, is left out
- databases do not wait for the disk, for nothing in them has to last
- checks of health are run by try-compose.sh, and limits of files and processes are low

    docker-compose … config | host_network.py PORTS.json PROMETHEUS.yml > compose.yml
"""
import json
import sys

import yaml

IMAGES = {"citydb": "localhost/citymesh-try-citydb", "citydb-v4": "localhost/citymesh-try-citydb",
          "load": "localhost/citymesh-try-tools", "load-v4": "localhost/citymesh-try-tools",
          "prometheus": "localhost/citymesh-try-prometheus"}
LEFT_OUT = ("grafana",)
OF_THE_NETWORK = ("ports", "networks", "depends_on", "build", "profiles")


def settings_of(name, ports):
    """The ports of a service in its own words."""
    version = "-v4" if name.endswith("-v4") else ""
    if name.startswith("citydb"):
        return {"PGPORT": str(ports[name]), "CITYDB_MAJOR": "4" if version else "5"}
    if name.startswith("load"):
        return {"CITYDB_PORT": str(ports["citydb" + version])}
    if name.startswith("citymesh"):
        rest, grpc = ports[name], ports[name + "-grpc"]
        return {"CITYMESH_LISTEN": f"127.0.0.1:{rest}", "CITYMESH_GRPC": f"127.0.0.1:{grpc}",
                "HEALTH_URL": f"http://127.0.0.1:{rest}/healthz"}
    return {}


def on_host_network(config, ports, prometheus_file):
    services = {name: service for name, service in config["services"].items() if name not in LEFT_OUT}
    srid = services["citydb"]["environment"]["SRID"]
    for name, service in services.items():
        for key in OF_THE_NETWORK:
            service.pop(key, None)
        service["network_mode"] = "host"
        service["extra_hosts"] = [f"{other}:127.0.0.1" for other in services]
        service["healthcheck"] = {"disable": True}
        service["ulimits"] = {"nofile": 1024, "nproc": 4096}
        service["image"] = IMAGES.get(name, service["image"])
        service.setdefault("environment", {}).update(settings_of(name, ports))
        if name.startswith("citydb"):
            service["command"] = ["postgres", "-c", "listen_addresses=127.0.0.1", "-c", "fsync=off", "-c", "max_wal_size=4GB"]
        if name.startswith("load"):
            service["environment"]["SRID"] = srid
        if name == "prometheus":
            service["command"] = [*service["command"], f"--web.listen-address=127.0.0.1:{ports[name]}"]
            service["volumes"] = [f"{prometheus_file}:{volume.split(':', 1)[1]}" if volume.startswith("/") else volume
                                  for volume in service["volumes"]]
    used = {secret["source"] for service in services.values() for secret in service.get("secrets", ())}
    volumes = {volume.split(":")[0] for service in services.values() for volume in service["volumes"]}
    return {"services": services, "secrets": {name: config["secrets"][name] for name in used},
            "volumes": {name: config["volumes"][name] for name in volumes & config["volumes"].keys()}}


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as file:
        ports = json.load(file)
    yaml.safe_dump(on_host_network(yaml.safe_load(sys.stdin), ports, sys.argv[2]), sys.stdout)
