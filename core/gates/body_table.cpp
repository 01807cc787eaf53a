#include "core/gates/body_table.h"

#include <simdjson.h>

#include "core/gates/parse.h"

namespace citymesh {

Result<void> append_body_record(std::string_view json, std::vector<BodyRecord>& table) {
  const auto refuse = [&](std::string_view what) {
    return fail(ErrorCode::DataLoss, "body " + std::to_string(table.size()) + ": " +
                                         std::string(what) + " in " + in_quotes(json));
  };
  try {
    const simdjson::padded_string text(json);
    simdjson::ondemand::parser parser;
    simdjson::ondemand::document document = parser.iterate(text);
    if (document["body"].get_uint64() != table.size()) return refuse("another number");
    BodyRecord record;
    record.name = std::string_view(document["name"].get_string());
    record.points = document["points"].get_uint64();
    record.triangles = document["triangles"].get_uint64();
    table.push_back(std::move(record));
    return {};
  } catch (const simdjson::simdjson_error& error) {
    return refuse(error.what());
  }
}

Result<std::vector<std::string>> parse_legend(std::string_view text) {
  std::vector<std::string> types;
  for (std::string_view number = next_word(text); !number.empty(); number = next_word(text)) {
    const std::string_view name = next_word(text);
    if (number != std::to_string(types.size()) || name.empty())
      return fail(ErrorCode::DataLoss, "surface types: expected number " +
                                           std::to_string(types.size()) + " and a name at " +
                                           in_quotes(number));
    types.emplace_back(name);
  }
  return types;
}

}  // namespace citymesh
