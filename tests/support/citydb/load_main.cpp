// Fills a 3DCityDB with city models, and makes the database one before if it is empty:
//   citymesh_citydb_load URL VERSION SRID COPIES FILE...
// VERSION is 4, 5.0 or 5.1; every file is stored COPIES times on a grid.
#include <cstdio>
#include <string>

#include "core/base/text.h"
#include "tests/support/citydb/loader.h"

namespace {

using namespace citymesh;
using namespace citymesh::citydb_support;

int complain(const std::string& what) {
  std::fprintf(stderr, "%s\n", what.c_str());
  return 1;
}

}  // namespace

int main(int count, char** arguments) {
  const auto argument = [&](int i) { return std::string(i < count ? arguments[i] : ""); };
  const std::string url = argument(1), version = argument(2);
  const auto srid = number_from<int>(argument(3));
  const auto copies = number_from<std::uint32_t>(argument(4));
  if (count < 6 || (version != "4" && version != "5.0" && version != "5.1") || !srid || !copies)
    return complain("usage: citymesh_citydb_load URL 4|5.0|5.1 SRID COPIES FILE...");
  LoadOptions options{
      .schema = {.major = version == "4" ? 4 : 5, .minor = version == "5.0" ? 0 : 1, .srid = *srid},
      .copies = *copies};

  auto database = Database::open(url);
  if (!database) return complain(database.error().message);
  const auto known = database->value("SELECT to_regnamespace('citydb') IS NOT NULL");
  if (!known) return complain(known.error().message);
  if (*known == "f")
    if (const auto made = create_schema(url, options.schema); !made)
      return complain(made.error().message);

  for (int i = 5; i < count; ++i) {
    const auto report = load(url, options, arguments[i]);
    if (!report) return complain(argument(i) + ": " + report.error().message);
    std::printf("%s: %llu buildings, %llu polygons\n", arguments[i],
                static_cast<unsigned long long>(report->buildings),
                static_cast<unsigned long long>(report->polygons));
  }
  const auto analysed = database->run("ANALYZE");
  return analysed ? 0 : complain(analysed.error().message);
}
