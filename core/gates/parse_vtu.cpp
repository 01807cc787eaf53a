#include <libxml/parser.h>
#include <libxml/tree.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <memory>
#include <optional>

#include "core/gates/body_table.h"
#include "core/gates/byte_source.h"
#include "core/gates/parse.h"

namespace citymesh {
namespace {

constexpr std::uint64_t kLongestHead = 1 << 16;
constexpr std::string_view kDataStart = "<AppendedData encoding=\"raw\">\n_";
constexpr std::string_view kDataEnd = "\n</AppendedData>\n</VTKFile>\n";

struct Array {
  std::string type{};
  std::uint64_t offset = 0;  ///< of its first byte in the file, behind the count
};

struct Head {
  std::map<std::string, Array, std::less<>> arrays{};
  std::uint64_t points = 0, cells = 0, data = 0;
};

std::optional<std::string> attribute(const xmlNode* node, const char* name) {
  const std::unique_ptr<xmlChar, void (*)(void*)> value(
      xmlGetProp(node, reinterpret_cast<const xmlChar*>(name)), xmlFree);
  if (!value) return {};
  return std::string(reinterpret_cast<const char*>(value.get()));
}

std::optional<std::uint64_t> number_attribute(const xmlNode* node, const char* name) {
  const auto text = attribute(node, name);
  std::uint64_t value = 0;
  if (!text || text->size() > 15) return {};
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
  if (error != std::errc{} || end != text->data() + text->size()) return {};
  return value;
}

/// Takes every Piece and DataArray below a node; the depth is what VTK's schema has.
bool collect(const xmlNode* node, int depth, Head& head) {
  for (; node; node = node->next) {
    if (node->type != XML_ELEMENT_NODE) continue;
    const std::string_view name(reinterpret_cast<const char*>(node->name));
    if (name == "Piece") {
      const auto points = number_attribute(node, "NumberOfPoints");
      const auto cells = number_attribute(node, "NumberOfCells");
      if (!points || !cells) return false;
      head.points = *points;
      head.cells = *cells;
    } else if (name == "DataArray" && attribute(node, "format") == "appended") {
      const auto array = attribute(node, "Name"), type = attribute(node, "type");
      const auto offset = number_attribute(node, "offset");
      if (!array || !type || !offset) return false;
      head.arrays[*array] = {*type, *offset};
    }
    if (depth < 5 && !collect(node->children, depth + 1, head)) return false;
  }
  return true;
}

Result<Head> read_head(const ByteSource& source) {
  std::string text;
  if (auto r = source.read(0, std::min(source.size(), kLongestHead), "head", text); !r)
    return r.error();
  const auto start = text.find(kDataStart);
  if (start == std::string::npos)
    return fail(ErrorCode::DataLoss, "no raw appended data behind the head");
  text.resize(start);
  const std::string xml = text + "</VTKFile>";
  const std::unique_ptr<xmlDoc, void (*)(xmlDocPtr)> document(
      xmlReadMemory(xml.data(), static_cast<int>(xml.size()), nullptr, nullptr,
                    XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING),
      xmlFreeDoc);
  if (!document) return fail(ErrorCode::DataLoss, "the head is no well-formed XML");
  Head head;
  const xmlNode* root = xmlDocGetRootElement(document.get());
  if (attribute(root, "type") != "UnstructuredGrid" ||
      attribute(root, "byte_order") != "LittleEndian" ||
      attribute(root, "header_type") != "UInt64" || !collect(root->children, 1, head))
    return fail(ErrorCode::DataLoss,
                "expected a little-endian UnstructuredGrid with arrays in appended data");
  head.data = start + kDataStart.size();
  return head;
}

/// The arrays of a file by name, each of the type and size that it must have.
class Arrays {
 public:
  Arrays(const ByteSource& source, const Head& head) : source_(source), head_(head) {}

  /// The place of the first byte and the number of bytes. `bytes`: how many there must be.
  Result<std::pair<std::uint64_t, std::uint64_t>> find(std::string_view name, std::string_view type,
                                                       std::optional<std::uint64_t> bytes) {
    const auto array = head_.arrays.find(name);
    if (array == head_.arrays.end() || array->second.type != type)
      return fail(ErrorCode::DataLoss,
                  "expected an array " + in_quotes(name) + " of type " + std::string(type));
    std::string count;
    const std::uint64_t at = head_.data + array->second.offset;
    if (auto r = source_.read(at, sizeof(std::uint64_t), name, count); !r) return r.error();
    const auto size = number_at<std::uint64_t>(count, 0);
    if (bytes && size != *bytes)
      return fail(ErrorCode::DataLoss, "array " + in_quotes(name) + " has " + std::to_string(size) +
                                           " bytes, expected " + std::to_string(*bytes));
    if (size > source_.size()) return fail(ErrorCode::DataLoss, "array " + in_quotes(name));
    end_ = std::max(end_, at + sizeof(std::uint64_t) + size);
    return std::pair{at + sizeof(std::uint64_t), size};
  }

  std::uint64_t end() const { return end_; }

 private:
  const ByteSource& source_;
  const Head& head_;
  std::uint64_t end_ = 0;
};

struct Grid {
  std::vector<BodyRecord> bodies{};
  std::vector<std::string> types{};
  std::uint64_t points_at = 0, corners_at = 0, offsets_at = 0, cell_types_at = 0, body_at = 0,
                surface_type_at = 0;
};

Result<Grid> read_grid(const ByteSource& source, const Head& head) {
  Grid grid;
  Arrays arrays(source, head);
  struct Wanted {
    std::string_view name, type;
    std::uint64_t bytes;
    std::uint64_t& at;
  };
  for (const Wanted& wanted : {Wanted{"Points", "Float64", 24 * head.points, grid.points_at},
                               Wanted{"connectivity", "Int64", 24 * head.cells, grid.corners_at},
                               Wanted{"offsets", "Int64", 8 * head.cells, grid.offsets_at},
                               Wanted{"types", "UInt8", head.cells, grid.cell_types_at},
                               Wanted{"body", "Int32", 4 * head.cells, grid.body_at},
                               Wanted{"surface_type", "UInt8", head.cells, grid.surface_type_at}}) {
    const auto found = arrays.find(wanted.name, wanted.type, wanted.bytes);
    if (!found) return found.error();
    wanted.at = found->first;
  }
  std::string text;
  const auto legend = arrays.find("surface_types", "UInt8", {});
  if (!legend) return legend.error();
  if (auto r = source.read(legend->first, legend->second, "surface_types", text); !r)
    return r.error();
  auto types = parse_legend(text);
  if (!types) return types.error();
  grid.types = std::move(*types);

  const auto bodies = arrays.find("bodies", "UInt8", {});
  if (!bodies) return bodies.error();
  if (auto r = source.read(bodies->first, bodies->second, "bodies", text); !r) return r.error();
  auto read = for_each_line(std::string_view(text), [&](std::string_view line, std::uint64_t) {
    return append_body_record(line, grid.bodies);
  });
  if (!read) return read.error();

  if (auto r = source.read(arrays.end(), kDataEnd.size(), "end", text); !r) return r.error();
  if (text != kDataEnd || arrays.end() + kDataEnd.size() != source.size())
    return fail(ErrorCode::DataLoss, "expected the end of the file behind the last array");
  return grid;
}

class BodyReader {
 public:
  BodyReader(const ByteSource& source, const Grid& grid) : source_(source), grid_(grid) {}

  Result<ParsedBody> next(const BodyRecord& record) {
    struct Part {
      std::uint64_t at, first, count, width;
      std::string& bytes;
    };
    for (const Part& part :
         {Part{grid_.points_at, points_, record.points, 24, point_bytes_},
          Part{grid_.corners_at, cells_, record.triangles, 24, corner_bytes_},
          Part{grid_.offsets_at, cells_, record.triangles, 8, offset_bytes_},
          Part{grid_.cell_types_at, cells_, record.triangles, 1, cell_type_bytes_},
          Part{grid_.body_at, cells_, record.triangles, 4, body_bytes_},
          Part{grid_.surface_type_at, cells_, record.triangles, 1, surface_type_bytes_}})
      if (auto r = source_.read(part.at + part.first * part.width, part.count * part.width,
                                record.name, part.bytes);
          !r)
        return r.error();

    ParsedBody body;
    body.name = record.name;
    for (std::size_t i = 0; i < record.points; ++i)
      body.points.push_back({number_at<double>(point_bytes_, 24 * i),
                             number_at<double>(point_bytes_, 24 * i + 8),
                             number_at<double>(point_bytes_, 24 * i + 16)});
    for (std::size_t i = 0; i < record.triangles; ++i) {
      const auto refuse = [&](std::string_view what) {
        return fail(ErrorCode::DataLoss, "body " + in_quotes(record.name) + ": cell " +
                                             std::to_string(i) + " " + std::string(what));
      };
      constexpr char kTriangleCell = 5;
      if (cell_type_bytes_[i] != kTriangleCell ||
          number_at<std::uint64_t>(offset_bytes_, 8 * i) != 3 * (cells_ + i + 1))
        return refuse("is no triangle");
      if (number_at<std::uint32_t>(body_bytes_, 4 * i) != number_)
        return refuse("is of another body");
      const auto type = static_cast<unsigned char>(surface_type_bytes_[i]);
      if (type >= grid_.types.size()) return refuse("has an unknown surface type");
      Triangle& triangle = body.triangles.emplace_back();
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const auto index = number_at<std::uint64_t>(corner_bytes_, 24 * i + 8 * corner);
        if (index < points_ || index - points_ >= record.points)
          return refuse("uses a point that is not of its body");
        triangle[corner] = static_cast<std::uint32_t>(index - points_);
      }
      body.patches.push_back(grid_.types[type]);
    }
    points_ += record.points;
    cells_ += record.triangles;
    ++number_;
    return body;
  }

  std::uint64_t points() const { return points_; }
  std::uint64_t cells() const { return cells_; }

 private:
  const ByteSource& source_;
  const Grid& grid_;
  std::uint64_t points_ = 0, cells_ = 0, number_ = 0;
  std::string point_bytes_{}, corner_bytes_{}, offset_bytes_{}, cell_type_bytes_{}, body_bytes_{},
      surface_type_bytes_{};
};

Result<void> parse(const ByteSource& source, const ParsedBodySink& sink) {
  const auto head = read_head(source);
  if (!head) return head.error();
  const auto grid = read_grid(source, *head);
  if (!grid) return grid.error();
  BodyReader reader(source, *grid);
  for (const BodyRecord& record : grid->bodies) {
    if (record.points > head->points - reader.points() ||
        record.triangles > head->cells - reader.cells())
      return fail(ErrorCode::DataLoss,
                  "body " + in_quotes(record.name) + " has more than the file has left");
    auto body = reader.next(record);
    if (!body) return body.error();
    if (auto taken = sink(std::move(*body)); !taken) return taken;
  }
  if (reader.points() != head->points || reader.cells() != head->cells)
    return fail(ErrorCode::DataLoss, "points or cells that belong to no body");
  return {};
}

}  // namespace

Result<void> parse_vtu_text(std::string_view text, const ParsedBodySink& sink) {
  return parse(ByteSource(text), sink);
}

Result<void> parse_vtu_file(const std::filesystem::path& file, const ParsedBodySink& sink) {
  const auto source = ByteSource::open(file);
  return source ? parse(*source, sink) : source.error();
}

}  // namespace citymesh
