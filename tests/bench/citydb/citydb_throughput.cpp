// citydb_throughput URL [SCHEMA] [RUNS]: how long all buildings of a 3DCityDB take from the request
// to the last building in memory, against COPY (the same SELECTs) TO STDOUT (FORMAT binary) thrown
// away. Medians of runs that take turns, and the peak of memory.
#include <libpq-fe.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "services/citydb/citydb.h"
#include "services/citydb/schema.h"
#include "tests/support/citydb/database.h"

namespace {

using namespace citymesh;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kChunk = 500;  // as CityDbOptions

double since_s(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

[[noreturn]] void give_up(const std::string& why) {
  std::fprintf(stderr, "%s\n", why.c_str());
  std::exit(2);
}

/// What a run of ours sends to the database, as COPY statements.
std::vector<std::string> copies(const std::string& url, const std::string& schema_name) {
  auto connection = postgres::Connection::open({.url = url});
  if (!connection) give_up(connection.error().message);
  const auto set_path =
      "SET search_path TO " + citydb_support::identifier(schema_name) + ", public";
  const std::vector<postgres::Statement> path{{set_path.c_str()}};
  if (const auto set = connection->run(path, {}); !set) give_up(set.error().message);
  const auto instance = citydb::look_at(*connection, schema_name, {});
  if (!instance) give_up(instance.error().message);
  const auto schema = citydb::schema_of(*instance);

  std::vector<std::string> all;
  const auto add = [&all](const postgres::Statement& statement) {
    all.push_back("COPY (" + citydb_support::with_literals(statement.sql, statement.parameters) +
                  ") TO STDOUT (FORMAT binary)");
  };
  const auto candidates = schema->candidates(*instance, std::nullopt);
  add(candidates);
  const auto rows = connection->run(candidates, {});
  if (!rows) give_up(rows.error().message);
  std::vector<std::int64_t> ids;
  for (int row = 0; row < rows->size(); ++row) ids.push_back(rows->integer(row, 0));
  for (std::size_t first = 0; first < ids.size(); first += kChunk) {
    const auto begin = ids.begin() + static_cast<std::ptrdiff_t>(first);
    const std::vector<std::int64_t> chunk(
        begin, begin + static_cast<std::ptrdiff_t>(std::min(kChunk, ids.size() - first)));
    add(schema->members(*instance, chunk));
    const auto tables = schema->fetch(*connection, *instance, chunk, {});
    if (!tables) give_up(tables.error().message);
    for (const auto& statement : tables->sent) add(statement);
  }
  return all;
}

double copy_s(PGconn* connection, const std::vector<std::string>& statements) {
  const auto begin = Clock::now();
  for (const auto& sql : statements) {
    auto* result = PQexec(connection, sql.c_str());
    if (PQresultStatus(result) != PGRES_COPY_OUT) give_up(PQerrorMessage(connection));
    PQclear(result);
    for (char* bytes = nullptr; PQgetCopyData(connection, &bytes, 0) > 0;) PQfreemem(bytes);
    while ((result = PQgetResult(connection)) != nullptr) PQclear(result);
  }
  return since_s(begin);
}

double read_s(CitySource& source, std::uint64_t& buildings) {
  const auto begin = Clock::now();
  const auto selection = source.select({}, {});
  if (!selection) give_up(selection.error().message);
  buildings = 0;
  const auto read =
      source.read({}, *selection, [&](Building&&) { return ++buildings, Result<void>{}; }, {});
  if (!read) give_up(read.error().message);
  return since_s(begin);
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) give_up("usage: citydb_throughput URL [SCHEMA] [RUNS]");
  const std::string url = arguments[1], schema = count > 2 ? arguments[2] : "citydb";
  const int runs = count > 3 ? std::max(1, std::atoi(arguments[3])) : 5;
  const auto statements = copies(url, schema);
  auto* connection = PQconnectdb(url.c_str());
  PQclear(
      PQexec(connection,
             ("SET search_path TO " + citydb_support::identifier(schema) + ", public").c_str()));
  const auto factory = open_citydb({.url = url, .schema = schema});
  if (!factory) give_up(factory.error().message);
  const auto source = (*factory)();

  std::vector<double> copied, read;
  std::uint64_t buildings = 0;
  for (int run = 0; run < runs; ++run) {
    copied.push_back(copy_s(connection, statements));
    read.push_back(read_s(**source, buildings));
  }
  PQfinish(connection);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("%llu buildings, median of %d: COPY %.3f s, read %.3f s, ratio %.2f; peak %ld MB\n",
              static_cast<unsigned long long>(buildings), runs, median(copied), median(read),
              median(read) / median(copied), usage.ru_maxrss / 1024);
  return 0;
}
