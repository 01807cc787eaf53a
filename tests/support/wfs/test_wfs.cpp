#include "tests/support/wfs/test_wfs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <regex>
#include <stdexcept>
#include <utility>

#include "core/source/scan.h"

namespace citymesh::wfs_support {
namespace {

constexpr const char* kWfs = "http://www.opengis.net/wfs/2.0";

std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string decoded(const std::string& text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size()) {
      plain += static_cast<char>(std::strtol(text.substr(i + 1, 2).c_str(), nullptr, 16));
      i += 2;
    } else {
      plain += text[i] == '+' ? ' ' : text[i];
    }
  }
  return plain;
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const auto end = std::min(text.find(at, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::map<std::string, std::string> parameters_of(const std::string& request) {
  const auto target = split(request.substr(0, request.find("\r\n")), ' ').at(1);
  std::map<std::string, std::string> parameters;
  const auto question = target.find('?');
  if (question == std::string::npos) return parameters;
  for (const auto& part : split(target.substr(question + 1), '&')) {
    const auto equals = std::min(part.find('='), part.size());
    auto name = part.substr(0, equals);
    std::ranges::transform(name, name.begin(), [](char c) {
      return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    });
    parameters[name] = decoded(part.substr(std::min(equals + 1, part.size())));
  }
  return parameters;
}

std::string reply(const std::string& status, const std::string& type, const std::string& body) {
  return fmt::format(
      "HTTP/1.1 {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{}",
      status, type, body.size(), body);
}

std::string exception(const std::string& code, const std::string& locator,
                      const std::string& text) {
  return fmt::format(
      "<?xml version=\"1.0\"?><ows:ExceptionReport xmlns:ows=\"http://www.opengis.net/ows/1.1\" "
      "version=\"2.0.0\"><ows:Exception exceptionCode=\"{}\" locator=\"{}\"><ows:ExceptionText>{}"
      "</ows:ExceptionText></ows:Exception></ows:ExceptionReport>",
      code, locator, text);
}

std::uint64_t number(const std::map<std::string, std::string>& parameters, const char* name,
                     std::uint64_t other) {
  const auto found = parameters.find(name);
  return found == parameters.end() ? other : std::stoull(found->second);
}

}  // namespace

TestWfs::TestWfs(const std::filesystem::path& file, Manners manners)
    : manners_(std::move(manners)) {
  const auto scan = source::scan_file(source::plain_file(file), {}, false, {});
  if (!scan || !scan->facts.failure.empty() || scan->records.empty())
    throw std::runtime_error("no buildings in " + file.string());
  const auto text = content_of(file);
  for (const auto& record : scan->records)
    features_.push_back(
        {record.gml_id, text.substr(record.bytes.begin, record.bytes.end - record.bytes.begin),
         record.extent.min.x, record.extent.min.y, record.extent.max.x, record.extent.max.y});
  const auto& facts = scan->facts;
  const std::string root = facts.envelopes.at(0).before;
  const std::regex declaration(R"(xmlns(:[\w-]+)?="[^"]*")");
  for (std::sregex_iterator found(root.begin(), root.end(), declaration), end; found != end;
       ++found)
    if (namespaces_.find(found->str()) == std::string::npos) namespaces_ += " " + found->str();
  crs_ = facts.srs_names.at(scan->records.front().srs);
  if (const auto& box = facts.declared_extent; !box.is_empty())
    envelope_ = fmt::format(
        "<wfs:boundedBy><gml:Envelope srsName=\"{}\" srsDimension=\"3\"><gml:lowerCorner>{} {} {}"
        "</gml:lowerCorner><gml:upperCorner>{} {} {}</gml:upperCorner></gml:Envelope>"
        "</wfs:boundedBy>",
        facts.srs_names.at(facts.declared_srs), box.min.x, box.min.y, box.min.z, box.max.x,
        box.max.y, box.max.z);
  receiver_.answer_by([this](const std::string& request) { return respond(request); });
}

TestWfs::~TestWfs() {
  const std::scoped_lock lock(mutex_);
  ends_ = true;
  done_.notify_all();
}

std::string TestWfs::url_with_password() const {
  return fmt::format("http://reader:s3cret@127.0.0.1:{}/wfs?key=s3cret-too", receiver_.port());
}

std::vector<std::map<std::string, std::string>> TestWfs::requests() const {
  const std::scoped_lock lock(mutex_);
  return requests_;
}

std::string TestWfs::last_header() const {
  const std::scoped_lock lock(mutex_);
  return last_header_;
}

std::string TestWfs::respond(const std::string& request) {
  const auto parameters = parameters_of(request);
  {
    const std::scoped_lock lock(mutex_);
    last_header_ = request;
  }
  const auto asked = parameters.find("REQUEST");
  if (asked == parameters.end())
    return reply("400 Bad Request", "text/xml",
                 exception("MissingParameterValue", "request", "REQUEST is missing"));
  if (manners_.locked) return reply("401 Unauthorized", "text/plain", "who are you?");
  if (asked->second == "GetCapabilities") return reply("200 OK", "text/xml", capabilities());
  {
    std::unique_lock lock(mutex_);
    requests_.push_back(parameters);
    if (manners_.slow) done_.wait(lock, [this] { return ends_; });
    if (manners_.busy > 0) {
      --manners_.busy;
      return reply("503 Service Unavailable", "text/plain", "come back later");
    }
  }
  if (manners_.html)
    return reply("200 OK", "text/html",
                 "<!DOCTYPE html><html><head><title>Down for maintenance</title></head></html>");
  if (manners_.redirects)
    return "HTTP/1.1 302 Found\r\nLocation: http://192.0.2.1/wfs\r\nContent-Length: 0\r\n"
           "Connection: close\r\n\r\n";
  if (manners_.exception)
    return reply("400 Bad Request", "text/xml",
                 exception("InvalidParameterValue", "typeNames", "no such type &lt;here&gt;"));
  if (manners_.entities)
    return reply("200 OK", "text/xml",
                 fmt::format("<!DOCTYPE f [<!ENTITY a \"aaaaaaaa\"><!ENTITY b \"&a;&a;&a;\">]>"
                             "<wfs:FeatureCollection xmlns:wfs=\"{}\" numberMatched=\"&b;\"/>",
                             kWfs));
  return features(parameters);
}

std::string TestWfs::capabilities() const {
  const auto constraint = [](const char* name, const std::string& value) {
    return fmt::format(
        "<ows:Constraint name=\"{}\"><ows:NoValues/><ows:DefaultValue>{}"
        "</ows:DefaultValue></ows:Constraint>",
        name, value);
  };
  std::string crs = fmt::format("<wfs:DefaultCRS>{}</wfs:DefaultCRS>",
                                manners_.default_crs.empty() ? crs_ : manners_.default_crs);
  for (const auto& other : manners_.other_crs)
    crs += fmt::format("<wfs:OtherCRS>{}</wfs:OtherCRS>", other);
  return fmt::format(
      "<?xml version=\"1.0\"?><wfs:WFS_Capabilities xmlns:wfs=\"{0}\" "
      "xmlns:ows=\"http://www.opengis.net/ows/1.1\" version=\"{1}\"><ows:OperationsMetadata>"
      "<ows:Operation name=\"GetFeature\"><ows:Parameter name=\"outputFormat\"><ows:AllowedValues>"
      "<ows:Value>application/gml+xml; version=3.1</ows:Value><ows:Value>application/json"
      "</ows:Value></ows:AllowedValues></ows:Parameter>{3}</ows:Operation>{2}"
      "</ows:OperationsMetadata><wfs:FeatureTypeList>"
      "<wfs:FeatureType xmlns:veg=\"http://www.opengis.net/citygml/vegetation/2.0\"><wfs:Name>"
      "veg:PlantCover</wfs:Name><wfs:DefaultCRS>EPSG:4326</wfs:DefaultCRS></wfs:FeatureType>"
      "<wfs:FeatureType xmlns:bldg=\"http://www.opengis.net/citygml/building/2.0\"><wfs:Name>"
      "bldg:Building</wfs:Name>{4}</wfs:FeatureType></wfs:FeatureTypeList></wfs:WFS_Capabilities>",
      kWfs, manners_.version,
      manners_.says_pages
          ? constraint("ImplementsResultPaging", *manners_.says_pages ? "TRUE" : "FALSE")
          : std::string{},
      manners_.count_default ? constraint("CountDefault", std::to_string(*manners_.count_default))
                             : std::string{},
      crs);
}

std::vector<const TestWfs::Feature*> TestWfs::chosen(const Parameters& parameters,
                                                     std::string& problem) const {
  std::vector<const Feature*> found;
  if (const auto ids = parameters.find("RESOURCEID"); ids != parameters.end()) {
    for (const auto& id : split(ids->second, ',')) {
      const auto feature = std::ranges::find(features_, id, &Feature::id);
      if (feature != features_.end())
        found.push_back(&*feature);
      else if (manners_.missing_id_is_error)
        problem = exception("NotFound", "RESOURCEID", id);
    }
    return found;
  }
  std::array<double, 4> box{-1e9, -1e9, 1e9, 1e9};
  if (const auto stated = parameters.find("BBOX"); stated != parameters.end()) {
    const auto parts = split(stated->second, ',');
    if (parts.size() != 5)
      problem = exception("InvalidParameterValue", "BBOX", "expected four numbers and a CRS");
    for (std::size_t i = 0; i < 4 && problem.empty(); ++i) box[i] = std::stod(parts[i]);
  }
  for (const auto& feature : features_)
    if (feature.min_x <= box[2] && feature.max_x >= box[0] && feature.min_y <= box[3] &&
        feature.max_y >= box[1])
      found.push_back(&feature);
  return found;
}

std::string TestWfs::features(const Parameters& parameters) {
  std::string problem;
  const auto found = chosen(parameters, problem);
  if (!problem.empty())
    return reply(
        problem.find("NotFound") != std::string::npos ? "404 Not Found" : "400 Bad Request",
        "text/xml", problem);
  std::uint64_t start = manners_.knows_start ? number(parameters, "STARTINDEX", 0) : 0;
  if (manners_.overlaps && start > 0) --start;
  if (!manners_.json.empty())
    return reply("200 OK", "application/json",
                 start == 0
                     ? manners_.json
                     : R"({"type":"CityJSON","version":"1.0","CityObjects":{},"vertices":[]})");
  std::uint64_t count =
      std::min({number(parameters, "COUNT", UINT64_MAX),
                manners_.count_default.value_or(UINT64_MAX), manners_.secret_limit});
  start = std::min<std::uint64_t>(start, found.size());
  const bool hits = parameters.contains("RESULTTYPE") && parameters.at("RESULTTYPE") == "hits";
  const auto end = hits ? start : start + std::min<std::uint64_t>(count, found.size() - start);
  std::string next;
  if (manners_.links_next && (end < found.size() || !manners_.knows_start) && !hits) {
    const auto origin = manners_.next_origin.empty()
                            ? fmt::format("http://127.0.0.1:{}", receiver_.port())
                            : manners_.next_origin;
    next = fmt::format(" next=\"{}/wfs?", origin);
    for (const auto& [name, value] : parameters)
      if (name != "STARTINDEX") next += fmt::format("{}={}&amp;", name, value);
    next += fmt::format("STARTINDEX={}\"", end);
  }
  std::string body = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<wfs:FeatureCollection xmlns:wfs=\"{}\"{} "
      "timeStamp=\"2026-11-22T00:00:00Z\" numberMatched=\"{}\" numberReturned=\"{}\"{}>\n{}",
      kWfs, namespaces_, manners_.knows_matched ? std::to_string(found.size()) : "unknown",
      end - start, next, envelope_);
  for (auto i = start; i < end; ++i) body += "<wfs:member>" + found[i]->text + "</wfs:member>\n";
  body += "</wfs:FeatureCollection>\n";
  if (manners_.cut_unnoticed)
    return "HTTP/1.1 200 OK\r\nConnection: close\r\n\r\n" + body.substr(0, body.size() * 2 / 3);
  auto whole = reply("200 OK", "text/xml", body);
  if (manners_.cut) whole.resize(whole.size() * 2 / 3);
  return whole;
}

}  // namespace citymesh::wfs_support
