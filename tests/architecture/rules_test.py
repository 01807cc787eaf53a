"""Every rule must be able to fail: a small house that keeps them all, and one snippet per way to break one."""
import tempfile
import unittest
from pathlib import Path

from rules import violations

HOUSE = {
    "core/README.md": "| room | does | may use |\n| --- | --- | --- |\n| base | words | - |\n| geometry | numbers | base |\n"
                      "| heal | ladder | base, geometry |\n| gates | judge | base |\n| pipeline | flow | all of the above |\n",
    "core/base/CMakeLists.txt": "citymesh_library(base SOURCES result.cpp)",
    "core/base/result.h": "#pragma once\n#include <string>\n",
    "core/base/result.cpp": '#include "core/base/result.h"\n',
    "core/geometry/CMakeLists.txt": "citymesh_library(geometry SOURCES a.cpp USES base PRIVATE_USES CGAL::CGAL)",
    "core/geometry/a.cpp": '#include <CGAL/Kernel.h>\n#include "core/base/result.h"\n',
    "core/heal/CMakeLists.txt": "citymesh_library(heal SOURCES heal.cpp USES geometry)",
    "core/heal/heal.h": '#pragma once\n#include "core/base/result.h"\n',
    "core/gates/CMakeLists.txt": "citymesh_library(gates SOURCES gates.cpp USES base)",
    "core/gates/gates.h": "#pragma once\n",
    "core/pipeline/CMakeLists.txt": "citymesh_library(pipeline SOURCES p.cpp USES heal gates)",
    "core/pipeline/pipeline.h": '#pragma once\n#include "core/heal/heal.h"\n',
    "services/README.md": "| room | does | may use |\n| --- | --- | --- |\n| jobs | jobs | - |\n| rest | HTTP | jobs |\n| rpc | gRPC | jobs |\n",
    "services/jobs/job.h": '#pragma once\n#include "core/pipeline/pipeline.h"\n',
    "services/rest/server.cpp": '#include <boost/beast.hpp>\n#include "services/jobs/job.h"\n',
    "services/rpc/server.cpp": '#include "citymesh/v1/jobs.grpc.pb.h"\n',
    "tests/unit/heal/CMakeLists.txt": "citymesh_test(unit_heal KIND unit SOURCES a.cpp USES heal)",
}


def judged(changes=None):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in {**HOUSE, **(changes or {})}.items():
            if text is None:
                continue
            path = Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        return violations(folder)


class Rules(unittest.TestCase):
    def expect(self, rule, part, changes):
        found = judged(changes)
        self.assertTrue(any(rule in line and part in line for line in found), found)

    def test_a_good_house_keeps_all_rules(self):
        self.assertEqual(judged(), [])

    def test_a_room_that_includes_a_later_room_is_found(self):
        self.expect("rooms_use_only", "core/geometry/b.cpp", {"core/geometry/b.cpp": '#include "core/heal/heal.h"\n'})

    def test_gates_that_share_code_with_healing_are_found(self):
        self.expect("rooms_use_only", "gates may use base", {"core/gates/b.cpp": '#  include "core/heal/heal.h"\n'})

    def test_a_room_without_a_line_in_the_table_is_found(self):
        self.expect("rooms_use_only", "core/attic", {"core/attic/attic.h": "#pragma once\n"})

    def test_two_types_of_one_name_are_found(self):
        one = "#pragma once\nnamespace citymesh {\nstruct Edge {\n};\n}  // namespace citymesh\n"
        hidden = "namespace citymesh {\nnamespace {\nstruct Edge {\n};\n}  // namespace\n}  // namespace citymesh\n"
        other = one.replace("citymesh", "citymesh::jobs")
        self.expect("no_two_types", "citymesh::Edge is defined in core/heal/edge.h and in services/jobs/edge.h",
                    {"core/heal/edge.h": one, "services/jobs/edge.h": one.replace("struct Edge", "class Edge final : public Base")})
        self.assertEqual(judged({"core/heal/edge.h": one, "core/heal/b.cpp": hidden, "services/jobs/edge.h": other}), [])

    def test_a_core_that_knows_services_is_found(self):
        self.expect("the_core_knows", "services/jobs/job.h", {"core/heal/b.cpp": '#include "services/jobs/job.h"\n'})

    def test_a_core_that_knows_messages_sql_logs_or_the_console_is_found(self):
        for header in ("citymesh/v1/jobs.pb.h", "sqlite3.h", "spdlog/spdlog.h", "iostream", "boost/asio.hpp"):
            self.expect("the_core_knows", header, {"core/heal/b.cpp": f"#include <{header}>\n"})

    def test_rest_that_includes_rpc_and_the_reverse_are_found(self):
        self.expect("wire_formats", "rpc/x.h", {"services/rest/b.cpp": '#include "services/rpc/x.h"\n'})
        self.expect("wire_formats", "rest/x.h", {"services/rpc/b.cpp": '#include "services/rest/x.h"\n'})

    def test_messages_outside_of_rpc_are_found(self):
        self.expect("wire_formats", "services/jobs/b.cpp", {"services/jobs/b.cpp": '#include "citymesh/v1/jobs.pb.h"\n'})

    def test_a_third_party_header_in_a_header_is_found(self):
        for header in ("nlohmann/json.hpp", "zlib.h", "CGAL/Kernel.h"):
            self.expect("third_party", header, {"core/heal/b.h": f"#pragma once\n#include <{header}>\n"})

    def test_an_include_relative_to_its_own_folder_is_found(self):
        self.expect("from_the_root", "heal.h", {"core/heal/b.cpp": '#include "heal.h"\n'})

    def test_a_header_without_pragma_once_is_found(self):
        self.expect("read_once", "core/heal/b.h", {"core/heal/b.h": "int f();\n"})

    def test_a_stage_without_its_door_is_found(self):
        self.expect("door", "core/gates", {"core/gates/gates.h": None})

    def test_a_link_that_the_table_forbids_is_found(self):
        self.expect("link_lists", "links heal", {"core/gates/CMakeLists.txt": "citymesh_library(gates SOURCES gates.cpp USES base heal)"})

    def test_an_include_without_its_link_is_found(self):
        self.expect("link_lists", "does not link base", {"core/heal/CMakeLists.txt": "citymesh_library(heal SOURCES heal.cpp)"})

    def test_a_test_of_another_kind_is_found(self):
        self.expect("kind", "golden", {"tests/unit/heal/CMakeLists.txt": "citymesh_test(a KIND golden SOURCES a.cpp)"})
        self.expect("kind", "none", {"tests/unit/heal/CMakeLists.txt": "citymesh_test(a SOURCES a.cpp)"})

    def test_a_test_without_a_label_is_found(self):
        self.expect("kind", "no label", {"tests/e2e/a/CMakeLists.txt": "add_test(NAME a COMMAND b)"})

    def test_a_path_of_one_machine_is_found(self):
        self.expect("machine", "scripts/a.sh:1", {"scripts/a.sh": "cd /" + "home/someone\n"})

    def test_an_open_task_without_an_owner_is_found(self):
        self.expect("owner", "core/heal/b.cpp:1", {"core/heal/b.cpp": "// TODO: later\n"})
        self.assertEqual(judged({"core/heal/b.cpp": "// TODO(anna): say it better\n"}), [])


if __name__ == "__main__":
    unittest.main()
