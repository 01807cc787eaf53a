#include "tests/fuzz/source/read_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  citymesh::source::read_bytes(data, size, "fuzz.json");
  return 0;
}
