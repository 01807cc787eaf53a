#include "services/rest/openapi.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "services/offer/offer.h"
#include "tests/unit/rest/rest_api.h"

namespace citymesh {
namespace {

using nlohmann::json;
using ::testing::UnorderedElementsAreArray;

const std::set<std::string> kVerbs = {"get", "head", "post", "put", "delete", "options", "patch"};

class OpenApi : public RestApi {
 protected:
  using Visit = std::function<void(const std::string& place, const json& value)>;

  /// Every operation with its place, as `get /jobs`.
  void for_each_operation(const std::function<void(const std::string& path, const std::string& verb,
                                                   const json&)>& visit) const {
    for (const auto& [path, item] : definition_["paths"].items())
      for (const auto& [verb, operation] : item.items()) visit(path, verb, operation);
  }
  static void for_each_value(const json& value, const std::string& place, const Visit& visit) {
    visit(place, value);
    if (value.is_structured())
      for (const auto& [key, child] : value.items())
        for_each_value(child, place + "/" + key, visit);
  }
  json resolved(const json& value) const {
    if (!value.contains("$ref")) return value;
    return definition_.at(json::json_pointer(value["$ref"].get<std::string>().substr(1)));
  }

  /// What the keywords of a schema of OpenAPI 3.0 ask of each other.
  static void check_schema(const std::string& place, const json& schema) {
    static const std::set<std::string> kTypes = {"object", "array",   "string",
                                                 "number", "integer", "boolean"};
    static const std::set<std::string> kKeywords = {"$ref",
                                                    "type",
                                                    "format",
                                                    "title",
                                                    "description",
                                                    "properties",
                                                    "required",
                                                    "items",
                                                    "enum",
                                                    "default",
                                                    "minimum",
                                                    "maximum",
                                                    "minItems",
                                                    "maxItems",
                                                    "oneOf",
                                                    "anyOf",
                                                    "allOf",
                                                    "example",
                                                    "additionalProperties"};
    ASSERT_TRUE(schema.is_object()) << place;
    for (const auto& [keyword, value] : schema.items())
      EXPECT_TRUE(kKeywords.contains(keyword)) << place << " has " << keyword;
    if (schema.contains("$ref")) {
      EXPECT_EQ(schema.size(), 1U) << place << ": siblings of $ref are ignored";
      return;
    }
    if (schema.contains("type")) {
      EXPECT_TRUE(kTypes.contains(schema["type"])) << place;
    }
    EXPECT_EQ(schema.value("type", "") == "array", schema.contains("items")) << place;
    for (const auto& name : schema.value("required", json::array()))
      EXPECT_TRUE(schema["properties"].contains(name)) << place << " requires " << name;
    const auto fallback = schema.find("default");
    if (fallback != schema.end() && schema.contains("enum")) {
      EXPECT_NE(std::ranges::find(schema["enum"], *fallback), schema["enum"].end()) << place;
    }
    if (fallback != schema.end() && schema.contains("minimum")) {
      EXPECT_GE(fallback->get<double>(), schema["minimum"].get<double>()) << place;
    }
    if (fallback != schema.end() && schema.contains("maximum")) {
      EXPECT_LE(fallback->get<double>(), schema["maximum"].get<double>()) << place;
    }
    for (const auto* list : {"oneOf", "anyOf", "allOf"})
      for (const auto& part : schema.value(list, json::array()))
        check_schema(place + "/" + list, part);
    if (schema.contains("items")) check_schema(place + "/items", schema["items"]);
    const auto properties = schema.value("properties", json::object());
    for (const auto& [name, property] : properties.items())
      check_schema(place + "/" + name, property);
  }

  const json definition_ = json::parse(openapi_json("https://maps.example/citymesh"));
};

TEST_F(OpenApi, IsServedUnderBothNamesAndBySameWordsAsTheProgramPrints) {
  for (const auto* path : {"/api", "/openapi.json"}) {
    const auto response = get(path);
    EXPECT_EQ(response.headers.get("Content-Type"), "application/vnd.oai.openapi+json;version=3.0");
    EXPECT_EQ(text(response), openapi_json("http://citymesh.test:8080"));
  }
  EXPECT_EQ(definition_["openapi"], "3.0.3");
  EXPECT_EQ(definition_["servers"], json::parse(R"([{"url":"https://maps.example/citymesh"}])"));
}

TEST_F(OpenApi, EveryOperationHasAnIdOfItsOwnADeclaredTagASummaryAndAnswers) {
  std::set<std::string> ids, tags;
  for (const auto& tag : definition_["tags"]) tags.insert(tag["name"]);
  for_each_operation([&](const auto& path, const auto& verb, const json& operation) {
    const auto place = verb + " " + path;
    EXPECT_TRUE(kVerbs.contains(verb)) << place;
    EXPECT_TRUE(ids.insert(operation["operationId"]).second) << place;
    for (const auto& tag : operation["tags"]) EXPECT_TRUE(tags.contains(tag)) << place;
    EXPECT_FALSE(operation["summary"].get<std::string>().empty()) << place;
    EXPECT_FALSE(operation["description"].get<std::string>().empty()) << place;
    bool success = false;
    for (const auto& [status, answer] : operation["responses"].items()) {
      EXPECT_TRUE(std::regex_match(status, std::regex("[1-5]([0-9][0-9]|XX)"))) << place;
      EXPECT_TRUE(resolved(answer).contains("description")) << place << " " << status;
      success = success || status[0] == '2';
    }
    EXPECT_TRUE(success && operation["responses"].contains("4XX")) << place;
  });
}

TEST_F(OpenApi, ParametersOfAPathAreThoseOfItsTemplate) {
  for_each_operation([&](const auto& path, const auto& verb, const json& operation) {
    std::set<std::string> in_template, declared, seen;
    static const std::regex kBraces("\\{([^}]*)\\}");
    for (std::sregex_iterator found(path.begin(), path.end(), kBraces), end; found != end; ++found)
      in_template.insert((*found)[1]);
    for (const auto& given : operation.value("parameters", json::array())) {
      const auto parameter = resolved(given);
      const auto in = parameter["in"].template get<std::string>();
      EXPECT_TRUE(in == "path" || in == "query" || in == "header") << in;
      EXPECT_TRUE(parameter.contains("schema") && parameter.contains("description")) << path;
      EXPECT_TRUE(seen.insert(in + parameter["name"].template get<std::string>()).second) << path;
      if (in != "path") continue;
      EXPECT_EQ(parameter["required"], true) << path;
      declared.insert(parameter["name"]);
    }
    EXPECT_EQ(declared, in_template) << verb << " " << path;
  });
}

TEST_F(OpenApi, EveryReferenceResolvesAndEveryComponentIsUsed) {
  std::set<std::string> used;
  for_each_value(definition_, "", [&](const std::string& place, const json& value) {
    if (!place.ends_with("/$ref")) return;
    const auto target = value.get<std::string>();
    ASSERT_TRUE(target.starts_with("#/")) << place;
    EXPECT_TRUE(definition_.contains(json::json_pointer(target.substr(1))))
        << place << ": " << target;
    used.insert(target);
  });
  for (const auto& [kind, components] : definition_["components"].items())
    for (const auto& [name, component] : components.items())
      EXPECT_TRUE(used.contains("#/components/" + kind + "/" + name)) << kind << "/" << name;
}

TEST_F(OpenApi, SchemasAreSound) {
  int schemas = 0;
  for (const auto& [name, schema] : definition_["components"]["schemas"].items())
    check_schema(name, schema);
  for_each_value(definition_["paths"], "", [&](const std::string& place, const json& value) {
    if (!place.ends_with("/schema")) return;
    check_schema(place, value);
    ++schemas;
  });
  EXPECT_GT(schemas, 50);
}

TEST_F(OpenApi, ContentHasMediaTypes) {
  for_each_value(definition_, "", [&](const std::string& place, const json& value) {
    if (!place.ends_with("/content") || !value.is_object()) return;
    EXPECT_FALSE(value.empty()) << place;
    for (const auto& [media_type, description] : value.items()) {
      EXPECT_THAT(media_type, ::testing::HasSubstr("/")) << place;
      EXPECT_TRUE(description.contains("schema")) << place;
    }
  });
}

TEST_F(OpenApi, DescribesWhatTheServerAnswers) {
  const auto job = finished(kBox);
  for_each_operation([&](const std::string& path, const std::string& verb, const json& operation) {
    if (verb != "get") return;
    auto target = path;
    const std::map<std::string, std::string> values = {
        {"{processID}", "heal"}, {"{jobID}", job}, {"{output}", "obj"}};
    for (const auto& [brace, value] : values)
      if (const auto at = target.find(brace); at != std::string::npos)
        target.replace(at, brace.size(), value);
    const auto response = get(target);
    ASSERT_TRUE(operation["responses"].contains(std::to_string(response.status))) << target;
    const auto& content = operation["responses"][std::to_string(response.status)]["content"];
    const auto type = response.headers.get("Content-Type");
    EXPECT_TRUE(content.contains(type) || content.contains("*/*") ||
                content.contains(type.substr(0, type.find(';'))))
        << target << " is " << type;
    EXPECT_EQ(send("OPTIONS", target).status, 204);
  });
}

TEST_F(OpenApi, OutputsThatAreJsonAreDescribedAsJsonAndOthersAsBytes) {
  const auto& file = definition_["paths"]["/jobs/{jobID}/results/{output}"]["get"]["responses"];
  const auto& content = file["200"]["content"];
  EXPECT_EQ(content["*/*"]["schema"]["format"], "binary");
  EXPECT_EQ(content["application/json"]["schema"], json::object());
  EXPECT_EQ(content["application/city+json"]["schema"], json::object());
  EXPECT_FALSE(content.contains("model/obj"));
  EXPECT_EQ(file["206"]["content"].size(), 1U) << "a piece of JSON is none";
}

TEST_F(OpenApi, InputsMayBePlainOrQualified) {
  const auto& input = definition_["components"]["schemas"]["execute-heal"]["properties"]["inputs"]
                                 ["properties"]["snap_tolerance_m"];
  EXPECT_EQ(input["default"], 0.001);
  EXPECT_EQ(input["oneOf"][0]["type"], "number");
  EXPECT_EQ(input["oneOf"][1]["$ref"], "#/components/schemas/qualifiedValue");
}

TEST_F(OpenApi, ProcessesAreDescribedWithTheirOwnWaysOfExecution) {
  for (const auto& process : offered_processes()) {
    const auto id = std::string(process.id);
    const auto& post = definition_["paths"]["/processes/" + id + "/execution"]["post"];
    // Without a job: results that were waited for, and estimates.
    const bool estimates = find_process(process.id) != nullptr;
    EXPECT_EQ(post["responses"].contains("200"), !process.async_only || estimates) << id;
    EXPECT_EQ(post["responses"].contains("204"), !process.async_only) << id;
    EXPECT_EQ(post["responses"]["200"].dump().find("schemas/estimate") != std::string::npos,
              estimates)
        << id;
    EXPECT_TRUE(post["responses"]["201"]["headers"].contains("Location")) << id;
    const auto& inputs =
        definition_["components"]["schemas"]["execute-" + id]["properties"]["inputs"]["properties"];
    std::vector<std::string> described, named;
    for (const auto& [name, schema] : inputs.items()) described.push_back(name);
    for (const auto& option : process.inputs) {
      named.emplace_back(option.name);
      EXPECT_EQ(inputs[std::string(option.name)]["description"], option.description);
    }
    EXPECT_THAT(described, UnorderedElementsAreArray(named)) << id;
  }
}

}  // namespace
}  // namespace citymesh
