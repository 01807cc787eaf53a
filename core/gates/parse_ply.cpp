#include <algorithm>
#include <array>

#include "core/gates/body_table.h"
#include "core/gates/byte_source.h"
#include "core/gates/parse.h"

namespace citymesh {
namespace {

constexpr std::uint64_t kVertexBytes = 24;
constexpr std::uint64_t kFaceBytes = 1 + 3 * 4 + 4 + 1;

struct Header {
  std::vector<BodyRecord> bodies{};
  std::vector<std::string> types{};
  std::uint64_t vertices = 0, faces = 0, bytes = 0;
};

/// The lines of the header, read in pieces.
class Lines {
 public:
  explicit Lines(const ByteSource& source) : source_(source) {}

  Result<std::string_view> next() {
    for (;;) {
      const auto end = piece_.find('\n', at_);
      if (end != std::string::npos) {
        const std::string_view line = std::string_view(piece_).substr(at_, end - at_);
        at_ = end + 1;
        return line;
      }
      start_ += at_;
      const std::uint64_t want =
          std::min<std::uint64_t>(source_.size() - start_, (piece_.size() - at_) + kPiece);
      if (want <= piece_.size() - at_ || want > kLongestLine)
        return fail(ErrorCode::DataLoss, "the header has no end at byte " + std::to_string(start_));
      at_ = 0;
      if (auto read = source_.read(start_, want, "header", piece_); !read) return read.error();
    }
  }
  std::uint64_t offset() const { return start_ + at_; }

 private:
  static constexpr std::uint64_t kPiece = 1 << 16;

  const ByteSource& source_;
  std::string piece_{};
  std::uint64_t start_ = 0;
  std::size_t at_ = 0;
};

bool cut_prefix(std::string_view& line, std::string_view prefix) {
  if (!line.starts_with(prefix)) return false;
  line.remove_prefix(prefix.size());
  return true;
}

bool count_of(std::string_view text, std::uint64_t& count) {
  if (text.empty() || text.size() > 12) return false;
  count = 0;
  for (const char c : text) {
    if (c < '0' || c > '9') return false;
    count = count * 10 + static_cast<std::uint64_t>(c - '0');
  }
  return true;
}

Result<Header> read_header(const ByteSource& source) {
  // What stands between the comments, in order.
  constexpr std::array<std::string_view, 8> kExpected{"property double x",
                                                      "property double y",
                                                      "property double z",
                                                      "element face ",
                                                      "property list uchar int vertex_indices",
                                                      "property int body",
                                                      "property uchar surface_type",
                                                      "end_header"};
  Header header;
  Lines lines(source);
  for (const std::string_view expected : {"ply", "format binary_little_endian 1.0"}) {
    const auto line = lines.next();
    if (!line) return line.error();
    if (*line != expected)
      return fail(ErrorCode::DataLoss,
                  "expected " + in_quotes(expected) + " instead of " + in_quotes(*line));
  }
  for (;;) {
    const auto next = lines.next();
    if (!next) return next.error();
    std::string_view line = *next;
    if (cut_prefix(line, "comment body ")) {
      if (auto added = append_body_record(line, header.bodies); !added) return added.error();
    } else if (cut_prefix(line, "comment surface_type ")) {
      auto types = parse_legend(line);
      if (!types) return types.error();
      header.types = std::move(*types);
    } else if (cut_prefix(line, "element vertex ")) {
      if (!count_of(line, header.vertices))
        return fail(ErrorCode::DataLoss, in_quotes(line) + " is no number of vertices");
      break;
    } else if (!line.starts_with("comment ")) {
      return fail(ErrorCode::DataLoss, "unknown line " + in_quotes(line));
    }
  }
  for (std::size_t i = 0; i < kExpected.size(); ++i) {
    const auto next = lines.next();
    if (!next) return next.error();
    std::string_view line = *next;
    if (i == 3 ? !(cut_prefix(line, kExpected[i]) && count_of(line, header.faces))
               : line != kExpected[i])
      return fail(ErrorCode::DataLoss,
                  "expected " + in_quotes(kExpected[i]) + " instead of " + in_quotes(*next));
  }
  header.bytes = lines.offset();
  return header;
}

Result<void> read_body(const BodyRecord& record, std::uint64_t number, std::uint64_t first_vertex,
                       std::string_view vertices, std::string_view faces,
                       const std::vector<std::string>& types, ParsedBody& body) {
  body.name = record.name;
  for (std::size_t at = 0; at < vertices.size(); at += kVertexBytes)
    body.points.push_back({number_at<double>(vertices, at), number_at<double>(vertices, at + 8),
                           number_at<double>(vertices, at + 16)});
  for (std::size_t at = 0; at < faces.size(); at += kFaceBytes) {
    const auto refuse = [&](const std::string& what) {
      return fail(ErrorCode::DataLoss, "body " + in_quotes(record.name) + ": triangle " +
                                           std::to_string(at / kFaceBytes) + " " + what);
    };
    if (faces[at] != 3) return refuse("has not three corners");
    Triangle& triangle = body.triangles.emplace_back();
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint64_t index = number_at<std::uint32_t>(faces, at + 1 + 4 * corner);
      if (index < first_vertex || index - first_vertex >= record.points)
        return refuse("uses vertex " + std::to_string(index) + ", which is not of its body");
      triangle[corner] = static_cast<std::uint32_t>(index - first_vertex);
    }
    if (number_at<std::uint32_t>(faces, at + 13) != number) return refuse("is of another body");
    const auto type = static_cast<unsigned char>(faces[at + 17]);
    if (type >= types.size()) return refuse("has surface type " + std::to_string(type));
    body.patches.push_back(types[type]);
  }
  return {};
}

Result<void> parse(const ByteSource& source, const ParsedBodySink& sink) {
  auto header = read_header(source);
  if (!header) return header.error();
  const std::uint64_t whole =
      header->bytes + kVertexBytes * header->vertices + kFaceBytes * header->faces;
  if (whole != source.size())
    return fail(ErrorCode::DataLoss, std::to_string(source.size()) + " bytes: expected " +
                                         std::to_string(whole) + " for " +
                                         std::to_string(header->vertices) + " vertices and " +
                                         std::to_string(header->faces) + " faces");
  std::uint64_t vertices = 0, triangles = 0, number = 0;
  std::string vertex_bytes, face_bytes;
  for (const BodyRecord& record : header->bodies) {
    if (record.points > header->vertices - vertices || record.triangles > header->faces - triangles)
      return fail(ErrorCode::DataLoss,
                  "body " + in_quotes(record.name) + " has more than the file has left");
    if (auto r = source.read(header->bytes + kVertexBytes * vertices, kVertexBytes * record.points,
                             "vertices", vertex_bytes);
        !r)
      return r;
    if (auto r =
            source.read(header->bytes + kVertexBytes * header->vertices + kFaceBytes * triangles,
                        kFaceBytes * record.triangles, "faces", face_bytes);
        !r)
      return r;
    ParsedBody body;
    if (auto r =
            read_body(record, number++, vertices, vertex_bytes, face_bytes, header->types, body);
        !r)
      return r;
    if (auto r = sink(std::move(body)); !r) return r;
    vertices += record.points;
    triangles += record.triangles;
  }
  if (vertices != header->vertices || triangles != header->faces)
    return fail(ErrorCode::DataLoss, "vertices or faces that belong to no body");
  return {};
}

}  // namespace

Result<void> parse_ply_text(std::string_view text, const ParsedBodySink& sink) {
  return parse(ByteSource(text), sink);
}

Result<void> parse_ply_file(const std::filesystem::path& file, const ParsedBodySink& sink) {
  const auto source = ByteSource::open(file);
  return source ? parse(*source, sink) : source.error();
}

}  // namespace citymesh
