#include "services/citydb/ewkb.h"

#include <bit>
#include <cmath>
#include <cstring>

namespace citymesh::citydb {
namespace {

constexpr std::uint32_t kZ = 0x80000000u, kM = 0x40000000u, kSrid = 0x20000000u;
constexpr unsigned kMaxDepth = 8;

enum Type : std::uint32_t {
  kPoint = 1,
  kLineString = 2,
  kPolygon = 3,
  kMultiPoint = 4,
  kMultiLineString = 5,
  kMultiPolygon = 6,
  kCollection = 7,
  kPolyhedralSurface = 15,
  kTin = 16,
  kTriangle = 17
};

Error damaged() {
  return fail(ErrorCode::DataLoss, "a geometry of the database is no EWKB of three dimensions");
}

class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}

  struct Head {
    std::uint32_t type = 0;
    unsigned dimension = 2;
  };

  Result<Head> head() {
    if (rest_.empty()) return damaged();
    little_ = rest_.front() == 1;
    rest_.remove_prefix(1);
    const auto code = whole();
    if (!code) return damaged();
    if ((*code & kSrid) != 0 && !whole()) return damaged();
    return Head{*code & 0xFFu, 2u + ((*code & kZ) != 0 ? 1u : 0u) + ((*code & kM) != 0 ? 1u : 0u)};
  }

  std::optional<std::uint32_t> whole() {
    std::uint32_t value = 0;
    if (rest_.size() < sizeof value) return std::nullopt;
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return little_ == (std::endian::native == std::endian::little) ? value
                                                                   : __builtin_bswap32(value);
  }

  /// A count of things that take at least `bytes_each`.
  std::optional<std::uint32_t> count(std::size_t bytes_each) {
    const auto number = whole();
    if (!number || *number > rest_.size() / bytes_each) return std::nullopt;
    return number;
  }

  bool points(std::uint32_t number, unsigned dimension, std::vector<Point3>& to) {
    if (rest_.size() / (sizeof(double) * dimension) < number) return false;
    for (std::uint32_t p = 0; p < number; ++p) {
      Point3 point{real(0), real(1), dimension > 2 ? real(2) : 0};
      rest_.remove_prefix(sizeof(double) * dimension);
      to.push_back(point);
    }
    return true;
  }

  bool skip(std::size_t bytes) {
    if (rest_.size() < bytes) return false;
    rest_.remove_prefix(bytes);
    return true;
  }

 private:
  double real(std::size_t index) const {
    std::uint64_t bits = 0;
    std::memcpy(&bits, rest_.data() + index * sizeof bits, sizeof bits);
    if (little_ != (std::endian::native == std::endian::little)) bits = __builtin_bswap64(bits);
    return std::bit_cast<double>(bits);
  }

  std::string_view rest_;
  bool little_ = true;
};

Result<void> add_rings(Reader& reader, unsigned dimension, StoredPolygons& to) {
  const auto rings = reader.count(sizeof(std::uint32_t));
  if (!rings) return damaged();
  StoredPolygon polygon{static_cast<std::uint32_t>(to.rings.size()), *rings};
  for (std::uint32_t r = 0; r < *rings; ++r) {
    const auto count = reader.count(sizeof(double) * dimension);
    const auto first = static_cast<std::uint32_t>(to.points.size());
    if (!count || !reader.points(*count, dimension, to.points)) return damaged();
    to.rings.push_back({first, *count});
  }
  if (*rings > 0) to.polygons.push_back(polygon);
  return {};
}

Result<void> add(Reader& reader, unsigned depth, StoredPolygons& to,
                 std::vector<std::uint32_t>* members) {
  const auto head = reader.head();
  if (!head || depth > kMaxDepth) return damaged();
  const auto before = to.polygons.size();
  switch (head->type) {
    case kPolygon:
    case kTriangle:
      if (auto added = add_rings(reader, head->dimension, to); !added) return added;
      break;
    case kMultiPolygon:
    case kPolyhedralSurface:
    case kTin:
    case kCollection:
    case kMultiPoint:
    case kMultiLineString: {
      const auto count = reader.count(1);
      if (!count) return damaged();
      const bool apart = head->type == kCollection && members != nullptr;
      for (std::uint32_t m = 0; m < *count; ++m) {
        const auto first = to.polygons.size();
        if (auto added = add(reader, depth + 1, to, nullptr); !added) return added;
        if (apart) members->push_back(static_cast<std::uint32_t>(to.polygons.size() - first));
      }
      if (apart) return {};
      break;
    }
    case kPoint:
      if (!reader.skip(sizeof(double) * head->dimension)) return damaged();
      break;
    case kLineString: {
      const auto count = reader.count(sizeof(double) * head->dimension);
      if (!count || !reader.skip(*count * sizeof(double) * head->dimension)) return damaged();
      break;
    }
    default:
      return damaged();
  }
  if (members != nullptr)
    members->push_back(static_cast<std::uint32_t>(to.polygons.size() - before));
  return {};
}

}  // namespace

void StoredPolygons::clear() {
  points.clear();
  rings.clear();
  polygons.clear();
}

Result<void> add_ewkb(std::string_view bytes, StoredPolygons& to,
                      std::vector<std::uint32_t>* members) {
  Reader reader(bytes);
  return add(reader, 0, to, members);
}

Result<Point3> point_of_ewkb(std::string_view bytes) {
  Reader reader(bytes);
  const auto head = reader.head();
  std::vector<Point3> point;
  if (!head || head->type != kPoint || !reader.points(1, head->dimension, point)) return damaged();
  return point.front();
}

}  // namespace citymesh::citydb
