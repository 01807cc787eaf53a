#include "services/catalogue/unpack.h"

#include <fmt/format.h>
#include <stdlib.h>
#include <xxhash.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <memory>

#include "core/source/byte_reader.h"
#include "core/source/listing.h"
#include "core/source/zip.h"

namespace citymesh::catalogue {
namespace {

namespace fs = std::filesystem;
using namespace source;

constexpr std::size_t kChunkBytes = 1u << 20;

Error cannot(const char* what, const fs::path& path) {
  return fail(ErrorCode::Unavailable, fmt::format("cannot {} '{}'", what, path.string()));
}

Result<void> copy_unpacked(const fs::path& packed, const fs::path& copy, const ReadLimits& limits) {
  auto bytes = ByteReader::open(packed, limits.max_file_bytes);
  if (!bytes) return bytes.error();
  std::ofstream file(copy, std::ios::binary | std::ios::trunc);
  std::vector<char> chunk(kChunkBytes);
  for (;;) {
    const auto count = bytes->read(chunk.data(), chunk.size());
    if (!count) return count.error();
    if (*count == 0) break;
    if (!file.write(chunk.data(), static_cast<std::streamsize>(*count)))
      return cannot("write", copy);
  }
  file.close();
  return file ? Result<void>() : Result<void>(cannot("write", copy));
}

Result<std::vector<FileRecord>> unpack_one(const FileRecord& file, const fs::path& folder,
                                           const ReadLimits& limits) {
  FileRecord unpacked = file;
  unpacked.text = folder / "text";
  if (auto done = copy_unpacked(file.path, unpacked.text, limits); !done) return done.error();
  return std::vector{std::move(unpacked)};
}

}  // namespace

Result<std::string> content_hash(const fs::path& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rbe"),
                                                             &std::fclose);
  const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(),
                                                                              &XXH3_freeState);
  if (!file || !state) return cannot("read", path);
  XXH3_128bits_reset(state.get());
  std::vector<char> chunk(kChunkBytes);
  for (;;) {
    const std::size_t count = std::fread(chunk.data(), 1, chunk.size(), file.get());
    if (count == 0) break;
    XXH3_128bits_update(state.get(), chunk.data(), count);
  }
  if (std::ferror(file.get())) return cannot("read", path);
  const XXH128_hash_t hash = XXH3_128bits_digest(state.get());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

fs::path copies_of(const fs::path& state, const std::string& name,
                   const std::string& content_hash) {
  return state / "unpacked" /
         fmt::format("{}-{:016x}", content_hash, XXH3_64bits(name.data(), name.size()));
}

Result<std::vector<FileRecord>> unpack(const FileRecord& file, const fs::path& copies,
                                       const ReadLimits& limits) {
  const auto archive = is_zip(file.path);
  if (!archive) return archive.error();
  const auto packed = is_gzip(file.path);
  if (!packed) return packed.error();
  if (!*archive && !*packed) return std::vector{file};

  std::error_code error;
  fs::create_directories(copies.parent_path(), error);
  std::string made = copies.string() + ".XXXXXX";
  if (error || !::mkdtemp(made.data())) return cannot("make", copies);
  auto files = *archive ? unpack_archive(file, made, limits) : unpack_one(file, made, limits);
  if (!files) {
    fs::remove_all(made, error);
    return files;
  }
  fs::rename(made, copies, error);
  if (error) {  // another process was faster, with the same content
    fs::remove_all(made, error);
    if (!fs::is_directory(copies, error)) return cannot("make", copies);
  }
  for (FileRecord& unpacked : *files) unpacked.text = copies / unpacked.text.filename();
  return files;
}

}  // namespace citymesh::catalogue
