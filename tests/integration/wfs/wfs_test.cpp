// A model read from a WFS is the model of the file that the WFS serves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>

#include "tests/integration/wfs/reading.h"
#include "tests/support/temp_folder.h"

namespace citymesh::wfs_support {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

const fs::path kData = CITYMESH_TEST_DATA;
const fs::path kBerlin = kData / "berlin/3910_5817.gml";

/// In EPSG:25833, with some of Berlin's buildings.
RequestBox berlin_box() {
  return {391600, 5817650, 391750, 5817800, std::nullopt, Crs{"EPSG:25833"}};
}

void expect_same(const Reading& wfs, const Reading& file) {
  ASSERT_EQ(wfs.error.message, "");
  ASSERT_EQ(file.error.message, "");
  EXPECT_EQ(wfs.selection.crs.id, file.selection.crs.id);
  EXPECT_EQ(wfs.selection.origin, file.selection.origin);
  EXPECT_EQ(wfs.selection.buildings, file.selection.buildings);
  EXPECT_EQ(wfs.selection.missing_ids, file.selection.missing_ids);
  EXPECT_EQ(wfs.buildings, file.buildings);
}

/// Temporary files go here as long as it lives.
class TemporaryPlace {
 public:
  TemporaryPlace() {
    if (const char* before = std::getenv("TMPDIR")) before_ = before;
    ::setenv("TMPDIR", folder_.path().c_str(), 1);
  }
  ~TemporaryPlace() {
    if (before_)
      ::setenv("TMPDIR", before_->c_str(), 1);
    else
      ::unsetenv("TMPDIR");
  }
  std::vector<fs::path> content() const {
    return {fs::directory_iterator(folder_.path()), fs::directory_iterator()};
  }

 private:
  TempFolder folder_{};
  std::optional<std::string> before_{};
};

TEST(Wfs, EverythingIsWhatTheFileHas) {
  for (const char* name : {"berlin/3920_5820.gml", "citygml2/building_lod3.gml",
                           "citygml2/delft_lod1.gml", "fzk-haus/fzk_haus_lod2_v2.gml"}) {
    SCOPED_TRACE(name);
    const TestWfs server(kData / name);
    const auto wfs = read_wfs(server, {});
    EXPECT_THAT(wfs.buildings, Not(IsEmpty()));
    expect_same(wfs, read_file(kData / name, {}));
  }
}

TEST(Wfs, ABoxChoosesAsInAFileByEveryRule) {
  const TestWfs server(kBerlin);
  for (const auto rule : {BboxRule::Intersects, BboxRule::Centre, BboxRule::Within}) {
    SCOPED_TRACE(static_cast<int>(rule));
    const BuildingQuery query{.bbox = berlin_box(), .bbox_rule = rule};
    const auto wfs = read_wfs(server, query);
    EXPECT_THAT(wfs.buildings, SizeIs(::testing::AllOf(::testing::Gt(7u), ::testing::Lt(100u))));
    expect_same(wfs, read_file(kBerlin, query));
  }
}

TEST(Wfs, ABoxInAnotherCrsIsBroughtToTheServers) {
  const TestWfs server(kBerlin);
  const BuildingQuery query{.bbox = RequestBox{13.4075, 52.4985, 13.4105, 52.5005}};
  const auto file = read_file(kBerlin, query);
  EXPECT_THAT(file.buildings, Not(IsEmpty()));
  expect_same(read_wfs(server, query), file);
  EXPECT_THAT(server.requests().front().at("BBOX"), HasSubstr("EPSG::25833"));
  const BuildingQuery elsewhere{.bbox = berlin_box(), .crs = Crs{"EPSG:25832"}};
  expect_same(read_wfs(server, elsewhere), read_file(kBerlin, elsewhere));
}

TEST(Wfs, ABoxWithHeightsChoosesByThem) {
  const TestWfs server(kBerlin);
  BuildingQuery query{.bbox = berlin_box()};
  query.bbox->z_range_m = {{0, 30}};
  expect_same(read_wfs(server, query), read_file(kBerlin, query));
}

TEST(Wfs, ABoxWithNothingInItGivesNothingInTheServersCrs) {
  const TestWfs server(kBerlin);
  BuildingQuery query{
      .bbox = RequestBox{392500, 5819500, 392600, 5819600, std::nullopt, Crs{"EPSG:25833"}}};
  const auto wfs = read_wfs(server, query);
  EXPECT_THAT(wfs.buildings, IsEmpty());
  expect_same(wfs, read_file(kBerlin, query));
}

TEST(Wfs, ACompoundCrsIsAskedForByItsHorizontalPart) {
  const auto file = kData / "citygml2/building_lod2.gml";
  const TestWfs server(file);
  const BuildingQuery query{
      .bbox = RequestBox{458860, 5438340, 458890, 5438360, std::nullopt, Crs{"EPSG:25832"}}};
  expect_same(read_wfs(server, query), read_file(file, query));
  EXPECT_THAT(server.requests().front().at("BBOX"),
              ::testing::EndsWith(",urn:ogc:def:crs:EPSG::25832"));
}

TEST(Wfs, OfSeveralCrsTheProjectedOneIsAskedFor) {
  const TestWfs server(kBerlin, {.default_crs = "urn:ogc:def:crs:EPSG::4258",
                                 .other_crs = {"urn:ogc:def:crs:EPSG::25833"}});
  const BuildingQuery query{.bbox = berlin_box()};
  expect_same(read_wfs(server, query), read_file(kBerlin, query));
  EXPECT_EQ(server.requests().front().at("SRSNAME"), "urn:ogc:def:crs:EPSG::25833");
}

TEST(Wfs, ABoxInDegreesHasTheOrderOfTheRegistry) {
  const TestWfs server(kBerlin, {.default_crs = "urn:ogc:def:crs:EPSG::4258"});
  EXPECT_EQ(read_wfs(server, {.bbox = RequestBox{13.40, 52.49, 13.41, 52.50}}).error.message, "");
  const auto box = server.requests().front().at("BBOX");
  EXPECT_THAT(box, ::testing::StartsWith("52.4"));
  EXPECT_THAT(box, ::testing::EndsWith(",urn:ogc:def:crs:EPSG::4258"));
}

TEST(Wfs, IdsAreAskedForByThemselves) {
  const TestWfs server(kBerlin);
  const BuildingQuery query{.object_ids = {"BLDG_00030008004010f2", "nowhere"}};
  const auto wfs = read_wfs(server, query);
  ASSERT_EQ(wfs.error.message, "");
  EXPECT_THAT(wfs.buildings, SizeIs(1));
  EXPECT_THAT(wfs.selection.missing_ids, ElementsAre("nowhere"));
  ASSERT_THAT(server.requests(), SizeIs(1));
  EXPECT_THAT(server.requests().front().at("RESOURCEID"), HasSubstr("BLDG_00030008004010f2"));
}

TEST(Wfs, IdsThatTheServerRefusesAreMissing) {
  const TestWfs server(kBerlin, {.missing_id_is_error = true});
  const BuildingQuery query{.object_ids = {"BLDG_00030008004010f2", "nowhere"}};
  const auto wfs = read_wfs(server, query);
  ASSERT_EQ(wfs.error.message, "");
  EXPECT_THAT(wfs.buildings, SizeIs(1));
  EXPECT_THAT(wfs.selection.missing_ids, ElementsAre("nowhere"));
}

TEST(Wfs, IdsAndABoxMustBothHoldAndOnlyUnknownIdsAreMissing) {
  const TestWfs server(kBerlin);
  BuildingQuery query{.bbox = berlin_box()};
  const auto inside = read_file(kBerlin, query);
  ASSERT_THAT(inside.selection.object_ids, Not(IsEmpty()));
  std::string outside;
  for (const auto& id : read_file(kBerlin, {}).selection.object_ids)
    if (id.starts_with("BLDG_") &&
        std::ranges::find(inside.selection.object_ids, id) == inside.selection.object_ids.end())
      outside = id;
  query.object_ids = {inside.selection.object_ids.front(), outside, "nowhere"};
  const auto wfs = read_wfs(server, query);
  EXPECT_THAT(wfs.buildings, SizeIs(1));
  expect_same(wfs, read_file(kBerlin, query));
}

TEST(Wfs, CityJsonIsReadToo) {
  const auto file = kData / "cityjson/rotterdam_subset.json";
  std::ifstream in(file);
  const TestWfs server(kBerlin, {.default_crs = "urn:ogc:def:crs:EPSG::7415",
                                 .json = {std::istreambuf_iterator<char>(in), {}}});
  auto options = options_for(server);
  options.output_format = "application/json";
  const auto wfs = read_wfs(options, {});
  EXPECT_THAT(wfs.buildings, Not(IsEmpty()));
  // The document states no CRS: it is the server's.
  expect_same(wfs, read_file(file, {.source_crs = Crs{"EPSG:7415"}}));
  EXPECT_EQ(server.requests().front().at("OUTPUTFORMAT"), "application/json");
}

TEST(Wfs, TheReportNamesOneInputWithoutSecrets) {
  const TestWfs server(kBerlin);
  auto options = options_for(server);
  options.url = server.url_with_password();
  const auto wfs = read_wfs(options, {.bbox = berlin_box()});
  ASSERT_EQ(wfs.error.message, "");
  ASSERT_THAT(wfs.selection.inputs, SizeIs(1));
  const auto& input = wfs.selection.inputs.front();
  EXPECT_EQ(input.file, server.url());
  EXPECT_EQ(input.format, "WFS 2.0.2");
  EXPECT_EQ(input.state, "read");
  EXPECT_EQ(input.crs, "EPSG:25833");
  // Still the server is told who asks.
  EXPECT_THAT(server.last_header(), HasSubstr("Authorization: Basic cmVhZGVyOnMzY3JldA=="));
  EXPECT_EQ(server.requests().front().at("KEY"), "s3cret-too");
}

TEST(Wfs, DownloadsArePrivateAndGoneWithTheSelection) {
  const TemporaryPlace place;
  const TestWfs server(kBerlin);
  const auto factory = open_wfs(options_for(server));
  ASSERT_TRUE(factory) << factory.error().message;
  const auto source = (*factory)(WfsUse::Reading);
  ASSERT_TRUE(source);
  const BuildingQuery query{.bbox = berlin_box()};
  {
    const auto selection = (*source)->select(query, {});
    ASSERT_TRUE(selection) << selection.error().message;
    ASSERT_THAT(place.content(), SizeIs(1));
    EXPECT_EQ(fs::status(place.content().front()).permissions(), fs::perms::owner_all);
    std::size_t read = 0;
    const auto done = (*source)->read(query, *selection,
                                      [&](Building&&) -> Result<void> {
                                        ++read;
                                        return {};
                                      },
                                      {});
    EXPECT_TRUE(done) << done.error().message;
    EXPECT_EQ(read, selection->buildings);
  }
  EXPECT_THAT(place.content(), IsEmpty());
}

TEST(Wfs, DownloadsAreGoneAfterAFailure) {
  const TemporaryPlace place;
  const TestWfs server(kBerlin, {.cut_unnoticed = true});
  EXPECT_NE(read_wfs(server, {}).error.message, "");
  EXPECT_THAT(place.content(), IsEmpty());
}

TEST(Wfs, SelectionsOfOthersAreRefused) {
  const TestWfs server(kBerlin);
  const auto factory = open_wfs(options_for(server));
  ASSERT_TRUE(factory);
  const auto source = (*factory)(WfsUse::Reading);
  const auto done = (*source)->read({}, {}, [](Building&&) -> Result<void> { return {}; }, {});
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::FailedPrecondition);
}

TEST(Wfs, AWrongBoxIsRefusedBeforeTheServerIsAsked) {
  const TestWfs server(kBerlin);
  auto box = berlin_box();
  std::swap(box.min_x, box.max_x);
  EXPECT_EQ(read_wfs(server, {.bbox = box}).error.code, ErrorCode::InvalidArgument);
  EXPECT_THAT(server.requests(), IsEmpty());
}

Result<Selection> counted(const TestWfs& server, const BuildingQuery& query) {
  const auto factory = open_wfs(options_for(server));
  if (!factory) return factory.error();
  const auto source = (*factory)(WfsUse::Counting);
  if (!source) return source.error();
  auto selection = (*source)->select(query, {});
  if (selection && !selection->details) {
    const auto read =
        (*source)->read(query, *selection, [](Building&&) { return Result<void>{}; }, {});
    EXPECT_FALSE(read);
    EXPECT_EQ(read ? ErrorCode::Internal : read.error().code, ErrorCode::FailedPrecondition);
  }
  return selection;
}

TEST(WfsCounts, AreTheServersWithoutABuildingOnTheWay) {
  const TestWfs server(kBerlin);
  for (const auto& query : {BuildingQuery{.bbox = berlin_box()}, BuildingQuery{}}) {
    const auto file = read_file(kBerlin, query);
    const auto found = counted(server, query);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_GE(found->buildings, file.selection.buildings);
    EXPECT_LE(found->buildings, file.selection.buildings * 3 / 2);
    EXPECT_EQ(found->crs.id, file.selection.crs.id);
    EXPECT_FALSE(found->expected_triangles);
    EXPECT_THAT(found->warnings, IsEmpty());
    ASSERT_THAT(found->inputs, SizeIs(1));
    EXPECT_EQ(found->inputs.front().buildings, found->buildings);
  }
  ASSERT_THAT(server.requests(), SizeIs(2));
  for (const auto& request : server.requests()) EXPECT_EQ(request.at("RESULTTYPE"), "hits");
}

TEST(WfsCounts, SayWhereFewerWillBeChosen) {
  const TestWfs server(kBerlin);
  const auto found = counted(server, {.bbox = berlin_box(), .bbox_rule = BboxRule::Within});
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_THAT(found->warnings, ElementsAre(HasSubstr("fewer will be chosen")));
}

TEST(WfsCounts, AreMadeByDownloadWhereTheServerDoesNotSayOrForIds) {
  Manners manners;
  manners.knows_matched = false;
  const TestWfs silent(kBerlin, manners);
  const BuildingQuery box{.bbox = berlin_box()};
  const auto whole = counted(silent, box);
  ASSERT_TRUE(whole) << whole.error().message;
  const auto file = read_file(kBerlin, box);
  EXPECT_EQ(whole->buildings, file.selection.buildings);

  const TestWfs server(kBerlin);
  const auto one = counted(server, {.object_ids = {file.selection.object_ids.front(), "nobody"}});
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_EQ(one->buildings, 1u);
  EXPECT_THAT(one->missing_ids, ElementsAre("nobody"));
}

TEST(WfsCounts, KeepTheLimitOfAJob) {
  const TestWfs server(kBerlin);
  auto options = options_for(server);
  options.max_features = 10;
  const auto factory = open_wfs(options);
  ASSERT_TRUE(factory) << factory.error().message;
  const auto refused = (*(*factory)(WfsUse::Counting))->select({.bbox = berlin_box()}, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::ResourceExhausted);
  EXPECT_THAT(refused.error().message, HasSubstr("at most 10 may be"));
}

}  // namespace
}  // namespace citymesh::wfs_support
