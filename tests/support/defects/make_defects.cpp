// Writes a city of defective houses as CityJSON, and what each of them should be as a table.
#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <string_view>

#include "core/base/text.h"
#include "tests/support/defects/city_files.h"

int main(int count, char** words) {
  using namespace citymesh::testing;
  CityPlan plan;
  std::string city_file, truth_file;
  for (int i = 1; i < count; ++i) {
    const std::string_view word = words[i];
    const auto number = [&](std::string_view name, auto& value) {
      if (!word.starts_with(name)) return false;
      const auto parsed = citymesh::number_from<std::uint64_t>(word.substr(name.size()));
      if (parsed) value = *parsed;
      return parsed.has_value();
    };
    if (number("--seed=", plan.seed) || number("--sound=", plan.sound) ||
        number("--singles=", plan.singles) || number("--pairs=", plan.pairs))
      continue;
    if (!word.starts_with("--") && city_file.empty()) {
      city_file = word;
    } else if (!word.starts_with("--") && truth_file.empty()) {
      truth_file = word;
    } else {
      fmt::print(stderr, "{}: not understood\n", word);
      return 2;
    }
  }
  if (truth_file.empty()) {
    fmt::print(stderr,
               "usage: citymesh_make_defects [--seed=1] [--sound=1] [--singles=1] [--pairs=1] "
               "CITY.json TRUTH.tsv\n"
               "sound houses per shape, singles per shape and defect, pairs per shape and pair of "
               "defects\n");
    return 2;
  }
  const auto city = make_city(plan);
  std::ofstream model(city_file), truth(truth_file);
  write_city(city, model);
  write_truth(city, truth);
  model.close(), truth.close();
  if (!model || !truth) {
    fmt::print(stderr, "{} or {} cannot be written\n", city_file, truth_file);
    return 1;
  }
  return 0;
}
