#include <string>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/citymodel/issue.h"
#include "core/source/soup.h"
#include "core/source/soup_readers.h"

namespace citymesh::source {
namespace {

class ObjReader {
 public:
  ObjReader(ByteReader& bytes, const DocumentOptions& options, DocumentFacts& facts)
      : input_(bytes, options.limits.max_building_bytes),
        options_(options),
        facts_(facts),
        soup_(options) {}

  Result<void> read(const FeatureSink& sink) {
    facts_.format = "OBJ";
    std::string line;
    for (;;) {
      if (options_.stop.stop_requested()) return reading_stopped();
      const auto more = next_line(line);
      if (!more) {
        fail_reading(facts_, more.error().message);
        return {};
      }
      if (!*more) return soup_.deliver(GeometryType::MultiSurface, sink);
      if (read_line(line)) continue;
      return too_many_points_ ? soup_.deliver_too_large(sink) : Result<void>{};
    }
  }

 private:
  /// A name and the faces that stand below it.
  struct Part {
    std::uint32_t building = kNone;
    std::optional<SurfaceType> type{};
  };
  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

  // A backslash at the end of a line joins it with the next.
  Result<bool> next_line(std::string& line) {
    const auto joined = [&] {
      while (!line.empty() && line.back() == '\r') line.pop_back();
      if (line.empty() || line.back() != '\\') return false;
      line.back() = ' ';
      return true;
    };
    const auto more = input_.next_line(line);
    if (!more || !*more) return more;
    std::string rest;
    while (joined()) {
      const auto next = input_.next_line(rest);
      if (!next) return next;
      if (!*next) break;
      line += rest;
      if (line.size() > options_.limits.max_building_bytes)
        return fail(ErrorCode::ResourceExhausted,
                    "line " + std::to_string(input_.line()) +
                        ": with the lines that it continues more than max_building_bytes = " +
                        std::to_string(options_.limits.max_building_bytes) + " bytes");
    }
    return true;
  }

  bool fail_here(const std::string& what) {
    fail_at_line(facts_, input_.line(), what);
    return false;
  }

  // false: reading ends.
  bool read_line(std::string_view line) {
    const std::string_view keyword = next_word(line);
    if (keyword == "v") return read_vertex(line);
    if (keyword == "f" || keyword == "fo") return read_face(line);
    if (keyword == "o") {
      object_ = trimmed(line);
      group_.clear();
      in_object_ = true;
      part_ = {};
    } else if (keyword == "g") {
      group_ = next_word(line);
      part_ = {};
    } else if (keyword == "surf") {
      soup_.report(current().building, issue_code::kUnreadableGeometry,
                   "line " + std::to_string(input_.line()) + ": free-form surfaces are not read");
    }
    return true;
  }

  bool read_vertex(std::string_view line) {
    const auto point = point_from(line);
    if (!point) return fail_here("a vertex ('v') needs three numbers");
    too_many_points_ = !soup_.add_point(*point);
    return !too_many_points_;
  }

  bool read_face(std::string_view line) {
    const Part& part = current();
    soup_.begin_face(part.building, part.type);
    for (auto word = next_word(line); !word.empty() && word.front() != '#';
         word = next_word(line)) {
      const auto stated = number_from<std::int64_t>(word.substr(0, word.find('/')));
      if (!stated)
        return fail_here("'" + std::string(word.substr(0, 60)) + "' is no vertex of a face ('f')");
      const auto count = static_cast<std::int64_t>(soup_.point_count());
      const std::int64_t index = *stated > 0                        ? *stated - 1
                                 : *stated < 0 && *stated >= -count ? count + *stated
                                                                    : -1;
      soup_.add_corner(index, *stated);
    }
    return true;
  }

  // An object names the building as soon as there is one; before, the group does.
  const Part& current() {
    if (part_.building != kNone) return part_;
    const PatchName group = split_patch_name(group_);
    const PatchName name = in_object_ ? split_patch_name(object_) : group;
    part_.type = group.type ? group.type : name.type;
    const auto found = buildings_.find(name.building);
    if (found != buildings_.end()) {
      part_.building = found->second;
    } else {
      part_.building = soup_.add_building(std::string(name.building));
      buildings_.emplace(name.building, part_.building);
    }
    return part_;
  }

  Input input_;
  const DocumentOptions& options_;
  DocumentFacts& facts_;
  Soup soup_;
  std::string object_{}, group_{};
  bool in_object_ = false;
  Part part_{};
  TextMap<std::uint32_t> buildings_{};
  bool too_many_points_ = false;
};

}  // namespace

Result<void> read_obj(ByteReader& bytes, const DocumentOptions& options, DocumentFacts& facts,
                      const FeatureSink& sink) {
  return ObjReader(bytes, options, facts).read(sink);
}

}  // namespace citymesh::source
