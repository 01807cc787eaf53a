// main() for fuzz targets in builds without libFuzzer: runs every corpus file and deterministic
// mutations of it, so that the sanitizers of the ordinary test run see each parser on broken input.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kLargestSeed = 64 * 1024;  // of larger files the head is used
constexpr std::size_t kMutationsPerSeed = 100;

Bytes read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  Bytes bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  bytes.resize(std::min(bytes.size(), kLargestSeed));
  return bytes;
}

std::vector<std::filesystem::path> corpus(int count, char** arguments) {
  std::vector<std::filesystem::path> files;
  for (int i = 1; i < count; ++i) {
    const std::filesystem::path path = arguments[i];
    if (!std::filesystem::is_directory(path)) {
      files.push_back(path);
      continue;
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path))
      if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

void mutate(Bytes& bytes, std::mt19937& random) {
  static constexpr std::string_view kTokens[] = {
      "nan", "1e999", "-9223372036854775808", "<", "/>", "&a;", "<!DOCTYPE a>", "{", "[[[[",
      "\"",  "\xff"};
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  for (std::size_t edits = 1 + below(4); edits > 0; --edits) {
    const std::size_t at = bytes.empty() ? 0 : below(bytes.size());
    const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    const std::size_t length = bytes.empty() ? 0 : std::min(bytes.size() - at, 1 + below(64));
    const auto end = place + static_cast<std::ptrdiff_t>(length);
    switch (below(5)) {
      case 0:  // flip a bit
        if (!bytes.empty()) *place = static_cast<std::uint8_t>(*place ^ (1U << below(8)));
        break;
      case 1:  // cut the end
        bytes.resize(at);
        break;
      case 2:  // drop a stretch
        bytes.erase(place, end);
        break;
      case 3: {  // repeat a stretch
        const Bytes stretch(place, end);
        bytes.insert(place, stretch.begin(), stretch.end());
        break;
      }
      default: {  // put in something parsers are known to trip over
        const std::string_view token = kTokens[below(std::size(kTokens))];
        bytes.insert(place, token.begin(), token.end());
      }
    }
  }
}

}  // namespace

int main(int count, char** arguments) {
  const auto files = corpus(count, arguments);
  std::size_t runs = 0;
  const auto run = [&](const Bytes& bytes) {
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    ++runs;
  };
  run({});
  for (const auto& file : files) {
    const Bytes seed = read(file);
    run(seed);
    std::mt19937 random(static_cast<std::uint32_t>(seed.size()));
    for (std::size_t i = 0; i < kMutationsPerSeed; ++i) {
      Bytes mutant = seed;
      mutate(mutant, random);
      run(mutant);
    }
  }
  std::printf("%zu inputs from %zu corpus files\n", runs, files.size());
  return files.empty() ? 2 : 0;
}
