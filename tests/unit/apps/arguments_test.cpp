#include "services/apps/arguments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "services/apps/output_folder.h"
#include "services/apps/progress_bar.h"
#include "services/config/serve_options.h"
#include "tests/support/temp_folder.h"

namespace citymesh {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const ProcessSpec& export_process() { return *find_process("export-for-simulation"); }

TEST(Bbox, IsTheOgcObjectOfItsText) {
  EXPECT_EQ(*bbox_json("13.1,52.4,13.2,52.5"), R"({"bbox":[13.1,52.4,13.2,52.5]})");
  EXPECT_EQ(*bbox_json("390000,5819000,392000,5820000@EPSG:25833"),
            R"({"bbox":[390000.0,5819000.0,392000.0,5820000.0],"crs":"EPSG:25833"})");
  EXPECT_EQ(*bbox_json("1,2,-3,4,5,6e1"), R"({"bbox":[1.0,2.0,-3.0,4.0,5.0,60.0]})");
}

TEST(Bbox, RefusesWhatIsNoBox) {
  for (const auto* text : {"", "1,2,3", "1,2,3,4,5", "1,2,3,x", "1,2,3,4@", "1,,3,4", "1,2,3,nan",
                           "1,2,3,1e999", "1,2,3,4,", " 1,2,3,4"}) {
    const auto box = bbox_json(text);
    ASSERT_FALSE(box) << text;
    EXPECT_THAT(box.error().message, HasSubstr("expected minx,miny,maxx,maxy"));
  }
}

TEST(Inputs, TakeTheirTypeFromTheTable) {
  const auto inputs = inputs_of(
      export_process(), {.formats = {"stl", "obj"},
                         .bbox = "1,2,3,4@EPSG:25833",
                         .settings = {"lod=2,1", "snap_tolerance_m=0.002", "on_failure=drop",
                                      R"(object_ids=["a,b","c"])", "unite_neighbours=false"}});
  ASSERT_TRUE(inputs) << inputs.error().message;
  EXPECT_THAT(inputs->json,
              AllOf(HasSubstr(R"("formats":["stl","obj"])"), HasSubstr(R"("lod":["2","1"])"),
                    HasSubstr(R"("snap_tolerance_m":0.002)"),
                    HasSubstr(R"("object_ids":["a,b","c"])"), HasSubstr(R"("on_failure":"drop")")));
}

TEST(Inputs, SayWhatIsWrongWithASetting) {
  const auto message = [](std::vector<std::string> settings) {
    const auto inputs =
        inputs_of(export_process(), {.formats = {}, .bbox = {}, .settings = settings});
    return inputs ? std::string("accepted") : inputs.error().message;
  };
  EXPECT_THAT(message({"lod"}), HasSubstr("name=value"));
  EXPECT_THAT(message({"=1"}), HasSubstr("name=value"));
  EXPECT_THAT(message({"colour=red"}), AllOf(HasSubstr("colour"), HasSubstr("lod")));
  EXPECT_THAT(message({"snap_tolerance_m=wide"}), AllOf(HasSubstr("wide"), HasSubstr("number")));
  EXPECT_THAT(message({"unite_neighbours=maybe"}), HasSubstr("true or false"));
  EXPECT_THAT(message({"lod=2", "lod=1"}), HasSubstr("given twice"));
  EXPECT_THAT(message({"formats=docx"}), AllOf(HasSubstr("docx"), HasSubstr("obj")));
  EXPECT_THAT(message({"bbox=1,2,3"}), HasSubstr("expected minx"));
  EXPECT_THAT(message({"lod=[["}), HasSubstr("lod"));
}

TEST(OutputFolder, RefusesAFolderWithFilesUnlessToldToOverwrite) {
  const TempFolder folder;
  std::ofstream(folder / "mine.txt") << "x";
  std::ofstream(folder / "model.stl") << "of an earlier run";
  const auto refused = OutputFolder::open(folder.path(), false);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::FailedPrecondition);
  EXPECT_THAT(refused.error().message, HasSubstr("--overwrite"));

  auto opened = OutputFolder::open(folder.path(), true);
  ASSERT_TRUE(opened);
  std::ofstream(opened->staged() / "model.obj") << "new";
  ASSERT_TRUE(opened->publish({"model.obj"}));
  EXPECT_TRUE(std::filesystem::exists(folder / "model.obj"));
  EXPECT_TRUE(std::filesystem::exists(folder / "mine.txt"));
  EXPECT_FALSE(std::filesystem::exists(folder / "model.stl"));
}

TEST(OutputFolder, LeavesNothingOfARunThatDidNotFinish) {
  const TempFolder folder;
  {
    const auto opened = OutputFolder::open(folder / "a/b", false);
    ASSERT_TRUE(opened);
    std::ofstream(opened->staged() / "model.obj") << "half";
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder / "a/b"));
}

TEST(OutputFolder, NamesAFolderThatCannotBeMade) {
  const TempFolder folder;
  std::ofstream(folder / "file") << "x";
  const auto opened = OutputFolder::open(folder / "file" / "out", false);
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().message, HasSubstr("file/out"));
}

TEST(ProgressLine, ShowsStageShareAndRate) {
  EXPECT_EQ(progress_line({"heal", 50, 200}, 2.0),
            "heal     [#######.......................] 50/200  25 %, 25/s");
  EXPECT_EQ(progress_line({"source", 0, 0}, 2.0), "source");
}

TEST(Endpoints, AreReadAsHostAndPort) {
  EXPECT_EQ(to_string(*parse_endpoint("0.0.0.0:80")), "0.0.0.0:80");
  EXPECT_EQ(to_string(*parse_endpoint("[::1]:8080")), "[::1]:8080");
  EXPECT_EQ(to_string(*parse_endpoint("8080")), "127.0.0.1:8080");
  EXPECT_EQ(to_string(*parse_endpoint("localhost:0")), "127.0.0.1:0");
  for (const auto* text : {"", ":80", "host:", "host:x", "host:70000", "::1:80", "a:b:80"})
    EXPECT_FALSE(parse_endpoint(text)) << text;
}

TEST(ServeOptions, ADatabaseTakesThePlaceOfAFolder) {
  ServeOptions options;
  options.source = "postgresql://anna@db.test/city";
  EXPECT_TRUE(check(options));
  options.data = "/srv/city";
  EXPECT_THAT(check(options).error().message, HasSubstr("both given"));
  options.data.clear();
  options.source = "mysql://anna:secret@db.test/city";
  const auto refused = check(options);
  EXPECT_THAT(refused.error().message, HasSubstr("--source is 'mysql://anna:***@db.test/city'"));
  options.source = "postgresql://db.test/city";
  options.source_connections = 0;
  EXPECT_THAT(check(options).error().message, HasSubstr("--source_connections is 0"));
}

TEST(ServeOptions, PasswordsAreNotShown) {
  EXPECT_EQ(without_passwords("source=\"postgresql://anna:se:cr@t@db.test:5432/city\"\nworkers=1"),
            "source=\"postgresql://anna:***@db.test:5432/city\"\nworkers=1");
  EXPECT_EQ(
      without_passwords("postgresql://db.test/city?user=anna&password=secret&sslmode=require"),
      "postgresql://db.test/city?user=anna&password=***&sslmode=require");
  EXPECT_EQ(without_passwords("http://127.0.0.1:8080/ and anna@db.test"),
            "http://127.0.0.1:8080/ and anna@db.test");
}

TEST(ServeOptions, NameTheSettingThatCannotBeUsed) {
  ServeOptions options;
  EXPECT_THAT(check(options).error().message, HasSubstr("--data"));
  options.data = "/does/not/exist";
  EXPECT_THAT(check(options).error().message, HasSubstr("/does/not/exist"));
  const TempFolder folder;
  options.data = folder.path();
  EXPECT_TRUE(check(options));
  options.lease_s = -1;
  EXPECT_THAT(check(options).error().message, HasSubstr("--lease_s is -1"));
  options.lease_s = 30;
  options.result_cache = "maybe";
  EXPECT_THAT(check(options).error().message,
              HasSubstr("--result_cache is maybe, expected on or off"));
  options.result_cache = "off";
  EXPECT_TRUE(check(options));
}

TEST(ServeOptions, WebOriginsAreWhatBrowsersSend) {
  const TempFolder folder;
  ServeOptions options;
  options.data = folder.path();
  for (const auto* list : {"", "*", "https://portal.example", "http://localhost:3000",
                           "https://a.example, http://[::1]:8000"}) {
    options.cors_allow_origin = list;
    EXPECT_TRUE(check(options)) << list;
  }
  for (const auto* list :
       {"portal.example", "https://portal.example/", "https://Portal.example", "https://",
        "https://*.example", "null", "*,https://a.example", "https://a.example:443", "ftp://a"}) {
    options.cors_allow_origin = list;
    ASSERT_FALSE(check(options)) << list;
    EXPECT_THAT(check(options).error().message, HasSubstr("--cors_allow_origin"));
  }
}

TEST(ServeOptions, TheNetworkIsServedWithAuthenticationOrWhenThatIsMeantOnly) {
  const TempFolder folder;
  ServeOptions options;
  options.data = folder.path();
  for (auto* endpoint : {&options.listen, &options.grpc}) {
    *endpoint = {"0.0.0.0", 80};
    ASSERT_FALSE(check(options));
    EXPECT_THAT(
        check(options).error().message,
        testing::AllOf(HasSubstr("0.0.0.0:80"), HasSubstr("--api_keys"), HasSubstr("--insecure")));
    options.insecure = true;
    EXPECT_TRUE(check(options));
    options.insecure = false;
    options.api_keys = "keys";
    EXPECT_TRUE(check(options));
    options.api_keys.clear();
    *endpoint = {"::1", 80};
  }
  EXPECT_TRUE(check(options));
}

TEST(ServeOptions, TokensAreCheckedForIssuerAndAudience) {
  const TempFolder folder;
  ServeOptions options;
  options.data = folder.path();
  options.oidc_jwks = "keys.json";
  EXPECT_THAT(check(options).error().message, HasSubstr("--oidc_issuer"));
  options.oidc_issuer = "https://login.test";
  EXPECT_THAT(check(options).error().message, HasSubstr("--oidc_audience"));
  options.oidc_audience = "citymesh";
  EXPECT_TRUE(check(options));
  options.insecure = true;
  EXPECT_THAT(check(options).error().message, HasSubstr("--insecure"));
  options.insecure = false;
  options.oidc_jwks.clear();
  EXPECT_THAT(check(options).error().message, HasSubstr("--oidc_jwks"));
}

}  // namespace
}  // namespace citymesh
