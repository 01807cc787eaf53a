#pragma once

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/write/output.h"
#include "core/write/writers.h"

namespace citymesh {

/// Takes the pieces of a file in order: texts, and whole sections by number.
class SectionSink {
 public:
  virtual ~SectionSink() = default;
  virtual Result<void> text(std::string_view bytes) = 0;
  virtual Result<void> section(std::size_t number) = 0;
};

/// A file of sections that all grow with every building. They wait in spools and are joined at the
/// end, when counts and sizes are known.
template <std::size_t Sections>
class SectionedFile {
 public:
  using Texts = std::array<std::string, Sections>;
  using Sizes = std::array<std::uint64_t, Sections>;

  static Result<SectionedFile> create(const std::filesystem::path& folder,
                                      std::string_view file_name) {
    auto file = AtomicFile::create(folder / file_name);
    if (!file) return file.error();
    std::vector<Spool> spools;
    for (std::size_t i = 0; i < Sections; ++i) {
      auto spool = Spool::create(
          folder, std::string(file_name) + " (section " + std::to_string(i + 1) + ")");
      if (!spool) return spool.error();
      spools.push_back(std::move(*spool));
    }
    return SectionedFile(std::move(*file), std::move(spools));
  }

  Result<void> write(const Texts& texts) {
    for (std::size_t i = 0; i < Sections; ++i)
      if (auto written = spools_[i].write(texts[i]); !written) return written;
    return {};
  }

  /// `content.join(sizes, sink)` puts the sections together.
  template <class Content>
  Result<void> finish(const Content& content) {
    Sizes sizes{};
    for (std::size_t i = 0; i < Sections; ++i) sizes[i] = spools_[i].size();
    ToFile sink(file_, spools_);
    if (auto joined = content.join(sizes, sink); !joined) return joined;
    return file_.commit();
  }

 private:
  struct ToFile final : SectionSink {
    ToFile(AtomicFile& to, std::vector<Spool>& from) : file(to), spools(from) {}
    Result<void> text(std::string_view bytes) override { return file.write(bytes); }
    Result<void> section(std::size_t number) override { return file.append(spools[number]); }
    AtomicFile& file;
    std::vector<Spool>& spools;
  };

  SectionedFile(AtomicFile file, std::vector<Spool> spools)
      : file_(std::move(file)), spools_(std::move(spools)) {}

  AtomicFile file_;
  std::vector<Spool> spools_;
};

/// The writer of a format whose file has sections. `Content` has
///   kSections                                  how many there are
///   Content(const Scene&)
///   Result<void> append(building, sections)    adds a building's bytes to the sections
///   Result<void> join(sizes, sink) const       the whole file, with the sizes of the sections
template <class Content>
class SectionedWriter final : public BodyWriter {
 public:
  static WriterResult open(const std::filesystem::path& folder, const Format& format,
                           const Scene& scene) {
    auto file = File::create(folder, format.file_name);
    if (!file) return file.error();
    return WriterResult(std::make_unique<SectionedWriter>(std::move(*file), scene));
  }

  SectionedWriter(SectionedFile<Content::kSections> file, const Scene& scene)
      : file_(std::move(file)), scene_(scene), content_(scene) {}

  Result<std::string> encode(const BuildingBodies& building) const override {
    Content content(scene_);
    typename File::Texts texts;
    if (auto appended = content.append(building, texts); !appended) return appended.error();
    typename File::Sizes sizes{};
    for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] = texts[i].size();
    ToText sink(texts);
    if (auto joined = content.join(sizes, sink); !joined) return joined.error();
    return std::move(sink.whole);
  }

  Result<void> add(const BuildingBodies& building) override {
    for (std::string& text : texts_) text.clear();
    if (auto appended = content_.append(building, texts_); !appended) return appended;
    return file_.write(texts_);
  }

  Result<void> finish() override { return file_.finish(content_); }

 private:
  using File = SectionedFile<Content::kSections>;

  struct ToText final : SectionSink {
    explicit ToText(const typename File::Texts& all) : texts(all) {}
    Result<void> text(std::string_view bytes) override {
      whole += bytes;
      return {};
    }
    Result<void> section(std::size_t number) override { return text(texts[number]); }
    const typename File::Texts& texts;
    std::string whole{};
  };

  File file_;
  Scene scene_;
  Content content_;
  typename File::Texts texts_{};
};

/// One line of JSON that says which body a number in a file stands for: `{"body":0,"name":…,
/// "gml_id":…,"kind":…,"lod":…,"rung":…,"points":8,"triangles":12}`.
std::string body_record(std::uint64_t number, const BuildingBodies& building, const Body& body);

/// "0 Unknown 1 GroundSurface …": what numbers of surface types stand for.
std::string surface_type_legend();

}  // namespace citymesh
