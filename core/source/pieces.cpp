#include "core/source/pieces.h"
#include "core/source/citygml_shapes.h"

#include <algorithm>
#include <limits>
#include <mutex>
#include <set>
#include <span>
#include <utility>

#include "core/base/parallel.h"
#include "core/source/byte_reader.h"
#include "core/source/citygml.h"
#include "core/source/cityjson.h"

namespace citymesh::source {
namespace {

constexpr std::uint64_t kPieceBytes = 1u << 20;  ///< a longer piece is one building
constexpr std::uint64_t kMaxGapBytes = 1u
                                       << 15;  ///< of others; cheaper to parse than to start anew
constexpr std::size_t kPiecesPerThread = 4;    ///< in memory at a time
constexpr int kMaxHops = 8;  ///< of geometry that borrows from geometry that borrows …

Error changed(const FileRecord& file) {
  return fail(ErrorCode::FailedPrecondition,
              "'" + file.name +
                  "' is not what it was when it was looked at: it has changed or is "
                  "gone; index the folder again, or start anew");
}

std::string piece_text(const RandomReader& bytes, const Envelope& envelope, const ByteRange& range,
                       Result<void>& read) {
  std::string text = envelope.before;
  const std::size_t at = text.size(), size = range.end - range.begin;
  text.resize(at + size);
  read = bytes.read(range.begin, size, text.data() + at);
  text += envelope.after;
  return text;
}

/// Buildings that are parsed together.
struct Piece {
  ByteRange bytes{};
  std::span<const BuildingRecord> chosen{};
};

std::vector<Piece> cut(std::span<const BuildingRecord> chosen) {
  std::vector<Piece> pieces;
  std::size_t first = 0;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const BuildingRecord& building = chosen[i];
    const bool fits = !pieces.empty() && building.envelope == chosen[first].envelope &&
                      building.bytes.begin >= pieces.back().bytes.begin &&
                      building.bytes.end >= pieces.back().bytes.end &&
                      building.bytes.begin <= pieces.back().bytes.end + kMaxGapBytes &&
                      (building.bytes.end - pieces.back().bytes.begin <= kPieceBytes ||
                       building.bytes == pieces.back().bytes);
    if (!fits) {
      pieces.push_back({building.bytes, {}});
      first = i;
    }
    pieces.back().bytes.end = building.bytes.end;
    pieces.back().chosen = chosen.subspan(first, i + 1 - first);
  }
  return pieces;
}

class PieceReader {
 public:
  PieceReader(const FileRecord& file, const RandomReader& bytes, const ReadLimits& limits,
              const RunContext& context)
      : file_(file), bytes_(bytes), limits_(limits), context_(context) {}

  Result<std::vector<Building>> read(const Piece& piece, BuildingMaker& maker) const {
    const BuildingRecord& first = piece.chosen.front();
    auto shared = shared_geometry(piece);
    if (!shared) return shared.error();
    DocumentOptions options = options_for(first.envelope);
    options.buildings_before = first.number - first.nth_of_piece;
    options.shared = shared->get();

    std::vector<Building> buildings;
    auto next = piece.chosen.begin();
    std::uint64_t number = options.buildings_before;
    DocumentFacts facts = empty_facts();
    auto parsed = parse(piece.bytes, first.envelope, [&](ByteReader& text) {
      const FeatureSink sink = [&](Feature& feature) -> Result<void> {
        if (next == piece.chosen.end() || number++ != next->number) return {};
        if (feature.objects.front().gml_id != next->gml_id) return changed(file_);
        ++next;
        buildings.push_back(maker.make(feature));
        return {};
      };
      return *file_.format == Format::CityGml ? read_citygml(text, options, facts, sink)
                                              : read_cityjson_seq(text, options, facts, sink);
    });
    if (!parsed) return parsed.error();
    // A reading limit of a whole file is none of a piece; anything else that ends a piece early
    // means that the file is another one.
    if (next != piece.chosen.end()) return changed(file_);
    return buildings;
  }

 private:
  DocumentOptions options_for(std::uint32_t envelope) const {
    return {.limits = limits_,
            .stem = file_stem(file_.name),
            .stop = context_.stop,
            .piece = &file_.facts.envelopes[envelope]};
  }

  // CRS names keep their numbers.
  DocumentFacts empty_facts() const {
    DocumentFacts facts;
    facts.srs_names = file_.facts.srs_names;
    return facts;
  }

  template <class Action>
  Result<void> parse(const ByteRange& range, std::uint32_t envelope, Action&& action) const {
    Result<void> read;
    ByteReader text =
        ByteReader::over(piece_text(bytes_, file_.facts.envelopes[envelope], range, read));
    if (!read) return changed(file_);
    return action(text);
  }

  /// What the buildings of a piece borrow: kept since the first pass, or read again.
  Result<std::shared_ptr<const SharedGeometry>> shared_geometry(const Piece& piece) const {
    if (file_.shared) return file_.shared;
    std::set<std::string, std::less<>> wanted;
    for (const BuildingRecord& building : piece.chosen)
      wanted.insert(building.borrowed.begin(), building.borrowed.end());
    auto shared = std::make_shared<SharedGeometry>();
    for (int hop = 0; hop < kMaxHops && !wanted.empty(); ++hop) {
      std::set<std::pair<std::uint64_t, std::uint64_t>> done;
      DocumentFacts facts = empty_facts();
      for (const std::string& id : wanted) {
        const auto place = file_.shared_places.find(id);
        if (place == file_.shared_places.end() || shared->by_id.contains(id)) continue;
        const ByteRange& range = place->second.bytes;
        if (!done.emplace(range.begin, range.end).second) continue;
        const std::uint32_t envelope = place->second.envelope;
        const DocumentOptions options = options_for(envelope);
        auto collected = parse(range, envelope, [&](ByteReader& text) {
          return collect_shared_geometry(text, options, wanted, facts, *shared);
        });
        if (!collected) return collected.error();
      }
      if (done.empty()) break;
      wanted = std::move(facts.unresolved);
    }
    return std::shared_ptr<const SharedGeometry>(std::move(shared));
  }

  const FileRecord& file_;
  const RandomReader& bytes_;
  const ReadLimits& limits_;
  const RunContext& context_;
};

/// Makers are taken by threads in turn.
class MakerPool {
 public:
  explicit MakerPool(const MakerFactory& factory) : factory_(factory) {}

  std::unique_ptr<BuildingMaker> take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<BuildingMaker>(factory_());
    auto maker = std::move(free_.back());
    free_.pop_back();
    return maker;
  }
  void give_back(std::unique_ptr<BuildingMaker> maker) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(maker));
  }

 private:
  const MakerFactory& factory_;
  std::mutex mutex_{};
  std::vector<std::unique_ptr<BuildingMaker>> free_{};
};

Result<void> read_in_pieces(const FileRecord& file, const RandomReader& bytes,
                            const std::vector<BuildingRecord>& chosen,
                            const MakerFactory& new_maker, const ReadLimits& limits,
                            const BuildingSink& sink, const RunContext& context) {
  const std::vector<Piece> pieces = cut(chosen);
  const PieceReader reader(file, bytes, limits, context);
  MakerPool makers(new_maker);
  const unsigned threads = std::max(1u, context.threads);
  const std::size_t at_a_time = threads == 1 ? 1 : threads * kPiecesPerThread;
  for (std::size_t first = 0; first < pieces.size(); first += at_a_time) {
    if (context.stopped()) return fail(ErrorCode::Cancelled, "reading was stopped");
    const std::size_t count = std::min(at_a_time, pieces.size() - first);
    std::vector<Result<std::vector<Building>>> read(count, std::vector<Building>{});
    parallel_for(count, threads, [&](std::size_t i) {
      auto maker = makers.take();
      read[i] = reader.read(pieces[first + i], *maker);
      makers.give_back(std::move(maker));
    });
    for (auto& buildings : read) {
      if (!buildings) return buildings.error();
      for (Building& building : *buildings)
        if (auto taken = sink(std::move(building)); !taken) return taken;
    }
  }
  return {};
}

Result<void> read_from_the_front(const FileRecord& file, const std::vector<BuildingRecord>& chosen,
                                 const MakerFactory& new_maker, const ReadLimits& limits,
                                 const BuildingSink& sink, const RunContext& context) {
  DocumentFacts facts;
  facts.srs_names = file.facts.srs_names;
  DocumentOptions options{.limits = limits, .stem = file_stem(file.name), .stop = context.stop};
  SharedGeometry collected;
  if (!file.shared && !file.facts.unresolved.empty() && *file.format == Format::CityGml) {
    auto text = ByteReader::open(file.text, limits.max_file_bytes);
    if (!text) return changed(file);
    if (auto done =
            collect_shared_geometry(*text, options, file.facts.unresolved, facts, collected);
        !done)
      return done;
  }
  options.shared = file.shared ? file.shared.get() : &collected;

  BuildingMaker maker = new_maker();
  auto next = chosen.begin();
  std::uint64_t number = 0;
  bool complete = false;
  auto done =
      read_document(file.text, *file.format, options, facts, [&](Feature& feature) -> Result<void> {
        if (number++ != next->number) return {};
        if (feature.objects.front().gml_id != next->gml_id ||
            facts.srs_names.size() != file.facts.srs_names.size())
          return changed(file);
        if (auto taken = sink(maker.make(feature)); !taken) return taken;
        complete = ++next == chosen.end();
        return complete ? Result<void>(fail(ErrorCode::Cancelled, "that was the last"))
                        : Result<void>();
      });
  if (complete) return {};
  return done ? Result<void>(changed(file)) : done;
}

}  // namespace

Result<void> read_buildings(const FileRecord& file, const std::vector<BuildingRecord>& chosen,
                            const MakerFactory& new_maker, const ReadLimits& limits,
                            const BuildingSink& sink, const RunContext& context) {
  if (chosen.empty()) return {};
  if (file.stamp && FileStamp::of(file.path) != file.stamp) return changed(file);
  const bool in_pieces =
      std::all_of(chosen.begin(), chosen.end(), [&](const BuildingRecord& building) {
        return building.bytes.known() && building.envelope < file.facts.envelopes.size();
      });
  if (!in_pieces) return read_from_the_front(file, chosen, new_maker, limits, sink, context);
  // What lies beyond max_file_bytes has not been looked at, so none of it is chosen.
  const auto bytes = RandomReader::open(file.text, std::numeric_limits<std::uint64_t>::max());
  if (!bytes) return changed(file);
  return read_in_pieces(file, *bytes, chosen, new_maker, limits, sink, context);
}

}  // namespace citymesh::source
