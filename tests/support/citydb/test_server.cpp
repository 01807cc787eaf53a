#include "tests/support/citydb/test_server.h"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <utility>

namespace citymesh::citydb_support {
namespace {

bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
}

// What connections find without naming a schema; copies of a database do not have it.
std::string search_path(const std::string& database, const std::string& path) {
  return "ALTER DATABASE " + identifier(database) + " SET search_path TO " + path;
}

std::string srs_name(int srid) { return "urn:ogc:def:crs:EPSG::" + std::to_string(srid); }

}  // namespace

std::string with_variables(std::string_view sql,
                           const std::map<std::string, std::string, std::less<>>& variables) {
  std::string text;
  while (!sql.empty()) {
    const std::size_t colon = sql.find(':');
    if (colon == std::string_view::npos) break;
    text += sql.substr(0, colon);
    sql.remove_prefix(colon);
    const char quote = sql.size() > 1 && (sql[1] == '\'' || sql[1] == '"') ? sql[1] : '\0';
    const std::size_t first = quote ? 2 : 1;
    std::size_t end = first;
    while (end < sql.size() && is_name_character(sql[end])) ++end;
    const auto found = variables.find(sql.substr(first, end - first));
    const bool closed = !quote || (end < sql.size() && sql[end] == quote);
    if (found == variables.end() || !closed) {  // "::" begins a cast
      const std::size_t kept = sql.substr(0, 2) == "::" ? 2 : 1;
      text += sql.substr(0, kept);
      sql.remove_prefix(kept);
      continue;
    }
    text += quote == '\'' ? literal(found->second)
            : quote       ? identifier(found->second)
                          : found->second;
    sql.remove_prefix(quote ? end + 1 : end);
  }
  return text.append(sql);
}

Result<std::string> citydb_file(const std::string& name) {
  std::ifstream file(CITYMESH_TEST_CITYDB_FILES "/" + name);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) return fail(ErrorCode::NotFound, "tests/support/citydb/" + name + " cannot be read");
  return text.str();
}

Result<void> create_schema(const std::string& url, const Schema& schema) {
  const auto sql = citydb_file(schema.major == 4 ? "schema_v4.sql" : "schema_v5.sql");
  if (!sql) return sql.error();
  auto database = Database::open(url);
  if (!database) return database.error();
  const bool first = schema.minor == 0;
  const auto made = database->run(with_variables(*sql, {{"schema", schema.name},
                                                        {"srid", std::to_string(schema.srid)},
                                                        {"srs_name", srs_name(schema.srid)},
                                                        {"json", first ? "json" : "jsonb"},
                                                        {"minor", std::to_string(schema.minor)},
                                                        {"revision", first ? "0" : "3"}}));
  if (!made) return made;
  const auto name = database->value("SELECT current_database()");
  if (!name) return name.error();
  return database->run(search_path(*name, identifier(schema.name) + ", citydb_pkg, public"));
}

Result<TestServer*> TestServer::get() {
  static const Result<std::unique_ptr<TestServer>> server = start();
  if (!server) return server.error();
  return server->get();
}

Result<std::unique_ptr<TestServer>> TestServer::start() {
  auto server = std::unique_ptr<TestServer>(new TestServer());
  const char* const named = std::getenv("CITYMESH_TEST_CITYDB");
  if (named && *named) {
    server->url_ = named;
    // Connected to before it is made, so that the libraries which this needs end after it.
    if (auto reached = Database::open(server->url_); !reached) return reached.error();
    return server;
  }
  auto cluster = Cluster::start();
  if (!cluster) return cluster.error();
  server->cluster_ = std::move(*cluster);
  server->url_ = server->cluster_->url("postgres");
  return server;
}

TestServer::~TestServer() {
  if (cluster_) return;  // it goes as a whole
  auto database = Database::open(url_);
  if (!database) return;
  for (const std::string& name : databases_)
    static_cast<void>(
        database->run("DROP DATABASE IF EXISTS " + identifier(name) + " WITH (FORCE)").has_value());
}

Result<std::string> TestServer::create(const std::string& options) {
  const std::string name =
      "citymesh_test_" + std::to_string(::getpid()) + "_" + std::to_string(databases_.size());
  auto database = Database::open(url_);
  if (!database) return database.error();
  if (auto made = database->run("CREATE DATABASE " + identifier(name) + options); !made)
    return made.error();
  databases_.push_back(name);
  return name;
}

Result<std::string> TestServer::create_database() {
  auto name = create("");
  if (!name) return name;
  return with_database(url_, *name);
}

Result<std::string> TestServer::copy_database(const std::string& url) {
  auto source = Database::open(url);
  if (!source) return source.error();
  const auto name = source->value("SELECT current_database()");
  const auto path = source->value("SHOW search_path");
  if (!name || !path) return name ? path.error() : name.error();
  { const Database closed = std::move(*source); }
  const auto copy = create(" TEMPLATE " + identifier(*name));
  if (!copy) return copy;
  auto database = Database::open(url_);
  if (!database) return database.error();
  if (auto set = database->run(search_path(*copy, *path)); !set) return set.error();
  return with_database(url_, *copy);
}

Result<std::string> TestServer::create_citydb(const Schema& schema) {
  std::ostringstream key;
  key << schema.major << '.' << schema.minor << ' ' << schema.srid << ' ' << schema.name;
  std::string& pattern = templates_[key.str()];
  if (pattern.empty()) {
    auto url = create_database();
    if (!url) return url;
    if (auto made = create_schema(*url, schema); !made) return made.error();
    pattern = *url;
  }
  return copy_database(pattern);
}

}  // namespace citymesh::citydb_support
