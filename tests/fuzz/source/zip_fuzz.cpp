// Whatever an archive says, its members land in the folder, under numbers, within the limits, and
// nothing stays when it is refused.
#include <cstdlib>
#include <filesystem>

#include "core/source/zip.h"
#include "tests/fuzz/source/read_bytes.h"
#include "tests/support/temp_folder.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace fs = std::filesystem;
  static const citymesh::TempFolder folder;
  const citymesh::source::MemoryFile file(data, size);
  citymesh::ReadLimits limits;
  limits.max_file_bytes = 1u << 20;
  const auto members = citymesh::source::unpack_zip(file.path(), folder.path(), limits);
  std::uint64_t bytes = 0;
  if (members) {
    const std::string* last = nullptr;
    for (const auto& member : *members) {
      if (member.path.parent_path() != folder.path() || (last && *last > member.name)) abort();
      last = &member.name;
      bytes += fs::file_size(member.path);
      fs::remove(member.path);
    }
  }
  if (bytes > limits.max_file_bytes || !fs::is_empty(folder.path())) abort();
  return 0;
}
