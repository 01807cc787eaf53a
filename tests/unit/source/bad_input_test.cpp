// Bad input: the message names what is wrong, and the other buildings are delivered.
#include <sys/types.h>
#include <unistd.h>

#include <filesystem>

#include "tests/unit/source/reading.h"

namespace citymesh {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const std::string kGood = simple_building("good", 0, 0);
const std::string kLast = simple_building("last", 40, 0);

/// A document of three buildings of which the middle one is bad; its neighbours must arrive.
Building between_good_ones(const std::string& bad, const FileSourceOptions& options = {}) {
  const Reading reading = read_text("a.gml", city_model(kGood + bad + kLast), {}, options);
  EXPECT_FALSE(reading.error);
  EXPECT_EQ(reading.input().state, "read") << reading.input().message;
  EXPECT_THAT(reading.ids(), ElementsAre("good", "bad", "last"));
  for (const std::size_t i : {0u, 2u}) {
    if (i < reading.buildings.size()) {
      EXPECT_THAT(reading.buildings[i].geometries, SizeIs(1));
      EXPECT_THAT(reading.buildings[i].source_issues, IsEmpty());
    }
  }
  return reading.buildings.size() > 1 ? reading.buildings[1] : Building{};
}

/// A document that ends early after a good building.
std::string failure_after_good(const std::string& text, const FileSourceOptions& options = {}) {
  const Reading reading = read_text("a.gml", text, {}, options);
  EXPECT_FALSE(reading.error);
  EXPECT_EQ(reading.input().state, "failed");
  EXPECT_THAT(reading.ids(), ElementsAre("good"));
  return reading.input().message;
}

std::string with_polygons(const std::string& members) {
  return building("bad", multi_surface(member(polygon("fine", square(20, 0))) + members));
}

TEST(BadXml, TruncatedFileDeliversWhatWasComplete) {
  std::string text = city_model(kGood + kLast);
  text.resize(text.find("last_g"));
  EXPECT_THAT(failure_after_good(text), HasSubstr("line "));
}

TEST(BadXml, MalformedMiddleNamesTheLine) {
  EXPECT_THAT(failure_after_good(city_model(kGood + "<cityObjectMember></oops>" + kLast)),
              HasSubstr("line 4"));
}

TEST(BadXml, UndefinedEntityIsAnError) {
  EXPECT_THAT(failure_after_good(city_model(kGood + building("b", "<gml:name>&boom;</gml:name>"))),
              HasSubstr("boom"));
}

TEST(BadXml, EntityBombIsRefusedBeforeAnythingIsExpanded) {
  const std::string bomb =
      "<?xml version=\"1.0\"?>\n<!DOCTYPE CityModel [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b "
      "\"&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;\"><!ENTITY c \"&b;&b;&b;&b;&b;&b;&b;&b;&b;&b;\">]>\n"
      "<CityModel xmlns=\"http://www.opengis.net/citygml/2.0\">&c;</CityModel>";
  const Reading reading = read_text("a.gml", bomb);
  EXPECT_EQ(reading.input().state, "failed");
  EXPECT_THAT(reading.input().message, HasSubstr("DOCTYPE CityModel"));
  EXPECT_THAT(reading.buildings, IsEmpty());
}

TEST(BadXml, ExternalEntityIsRefused) {
  const Reading reading = read_text(
      "a.gml", "<!DOCTYPE CityModel SYSTEM \"file:///etc/passwd\">" + city_model(kGood).substr(22));
  EXPECT_EQ(reading.input().state, "failed");
  EXPECT_THAT(reading.input().message, HasSubstr("DOCTYPE"));
}

TEST(BadXml, DeepNestingIsRefusedNamingTheLimit) {
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "<x>";
  EXPECT_THAT(failure_after_good(city_model(kGood + deep)), HasSubstr("max_depth = 256"));
}

TEST(BadXml, OtherRootElementsAreNamed) {
  const Reading reading = read_text("a.gml", "<html xmlns=\"http://www.w3.org/1999/xhtml\"/>");
  EXPECT_EQ(reading.input().state, "failed");
  EXPECT_THAT(reading.input().message, HasSubstr("'html'"));
}

TEST(BadXml, NextFileIsReadAfterABrokenOne) {
  Documents documents;
  documents.add("broken.gml", "<CityModel");
  documents.add("good.gml", city_model(kGood));
  const Reading reading = documents.read();
  EXPECT_EQ(reading.input(0).state, "failed");
  EXPECT_EQ(reading.input(1).state, "read");
  EXPECT_THAT(reading.ids(), ElementsAre("good"));
}

TEST(BadCoordinates, NotANumber) {
  const Building bad =
      between_good_ones(with_polygons(member(polygon("p", "0 0 0 NaN 0 0 1 1 0 0 0 0"))));
  EXPECT_THAT(bad, HasIssue(issue_code::kNonFiniteCoordinate));
  EXPECT_THAT(bad.source_issues.at(0).where, HasSubstr("'NaN'"));
  EXPECT_THAT(bad.source_issues.at(0).where, HasSubstr("'p'"));
  EXPECT_THAT(bad.geometries.at(0).polygons, SizeIs(1)) << "the other polygon stays";
}

TEST(BadCoordinates, Infinite) {
  EXPECT_THAT(between_good_ones(with_polygons(member(polygon("p", "0 0 0 inf 0 0 1 1 0 0 0 0")))),
              HasIssue(issue_code::kNonFiniteCoordinate));
}

TEST(BadCoordinates, Absurd) {
  for (const auto* value : {"1e300", "-1e300", "1e400", "-9223372036854775808", "1e9"}) {
    const Building bad = between_good_ones(
        with_polygons(member(polygon("p", "0 0 0 " + std::string(value) + " 0 0 1 1 0 0 0 0"))));
    EXPECT_THAT(bad, HasIssue(issue_code::kCoordinateOutOfRange)) << value;
    EXPECT_THAT(bad.source_issues.at(0).where, HasSubstr(value));
  }
}

TEST(BadCoordinates, TooFarFromTheOriginForTheExactGrid) {
  const Building bad =
      between_good_ones(building("bad", multi_surface(member(polygon("p", square(3e6, 0))) +
                                                      member(polygon("near", square(20, 0))))));
  EXPECT_THAT(bad, HasIssue(issue_code::kCoordinateOutOfRange));
  EXPECT_THAT(bad.geometries.at(0).polygons, SizeIs(1));
}

TEST(BadCoordinates, AStrayBuildingDoesNotMoveTheOrigin) {
  std::string city;
  for (int i = 0; i < 5; ++i)
    city += simple_building("b" + std::to_string(i), 400000 + i * 20, 5e6);
  const Reading reading = read_text("a.gml", city_model(simple_building("stray", 0, 0) + city));
  EXPECT_EQ(reading.selection.origin, (Point3{400000, 5e6, 0}));
  EXPECT_THAT(reading.buildings.at(0), HasIssue(issue_code::kCoordinateOutOfRange));
  EXPECT_THAT(reading.buildings.at(0).geometries, IsEmpty());
  EXPECT_THAT(reading.buildings.at(5).geometries, SizeIs(1));
}

TEST(BadCoordinates, Garbage) {
  const Building bad =
      between_good_ones(with_polygons(member(polygon("p", "0 0 0 1O 0 0 1 1 0 0 0 0"))));
  EXPECT_THAT(bad, HasIssue(issue_code::kUnreadableRing));
  EXPECT_THAT(bad.source_issues.at(0).where, HasSubstr("'1O'"));
}

TEST(BadCoordinates, WrongCountAndEmptyRingsAndPolygons) {
  for (const std::string& text : {polygon("p", "0 0 0 1 0 0 1 1"), polygon("p", ""),
                                  std::string("<gml:Polygon gml:id=\"p\"/>"),
                                  std::string("<gml:Polygon><gml:exterior/></gml:Polygon>"),
                                  std::string("<gml:Polygon><gml:interior>") + ring(square(0, 0)) +
                                      "</gml:interior></gml:Polygon>"})
    EXPECT_THAT(between_good_ones(with_polygons(member(text))),
                HasIssue(issue_code::kUnreadableRing))
        << text;
}

TEST(BadGeometry, EmptySolidsAndSurfacesGiveABuildingWithoutGeometry) {
  const Building bad = between_good_ones(building("bad", solid("") + multi_surface("") +
                                                             "<bldg:lod1Solid/><bldg:lod2Solid>"
                                                             "<gml:Solid/></bldg:lod2Solid>"));
  EXPECT_THAT(bad.geometries, IsEmpty());
}

TEST(BadXlinks, DanglingOnesBecomeIssues) {
  for (const auto* href : {"#nowhere", "other.gml#p", "http://example.org/p", "#", "p"}) {
    const Building bad = between_good_ones(with_polygons(member_by(href)));
    EXPECT_THAT(bad.geometries.at(0).polygons, SizeIs(1));
    EXPECT_THAT(bad, HasIssue(issue_code::kDanglingXlink)) << href;
    EXPECT_THAT(bad.source_issues.at(0).where, HasSubstr(std::string("'") + href + "'"));
  }
}

TEST(BadXlinks, CyclesBecomeIssues) {
  const auto composite = [](const std::string& id, const std::string& members) {
    return "<gml:CompositeSurface gml:id=\"" + id + "\">" + members + "</gml:CompositeSurface>";
  };
  EXPECT_THAT(between_good_ones(with_polygons(member(composite("c", member_by("#c"))))),
              HasIssue(issue_code::kCyclicXlink));
  EXPECT_THAT(between_good_ones(with_polygons(member(composite("a", member_by("#b"))) +
                                              member(composite("b", member_by("#a"))))),
              HasIssue(issue_code::kCyclicXlink));
  EXPECT_THAT(between_good_ones(with_polygons(
                  member("<gml:OrientableSurface gml:id=\"o\" orientation=\"-\"><gml:baseSurface "
                         "xlink:href=\"#o\"/></gml:OrientableSurface>"))),
              HasIssue(issue_code::kCyclicXlink));
}

TEST(BadXlinks, ReferencesThatMultiplyAreStopped) {
  std::string bomb = member(polygon("p0", square(20, 0)));
  for (int i = 1; i <= 60; ++i) {
    const std::string below = member_by((i == 1 ? "#p" : "#c") + std::to_string(i - 1));
    bomb += member("<gml:CompositeSurface gml:id=\"c" + std::to_string(i) + "\">" + below + below +
                   "</gml:CompositeSurface>");
  }
  FileSourceOptions options;
  options.limits.max_points_per_building = 10'000;
  const Building bad = between_good_ones(building("bad", multi_surface(bomb)), options);
  EXPECT_THAT(bad, HasIssue(issue_code::kReadLimitExceeded));
  EXPECT_THAT(bad.geometries, IsEmpty());
}

TEST(ReadLimits, ABuildingThatIsTooLargeIsDeliveredWithoutGeometry) {
  FileSourceOptions options;
  options.limits.max_points_per_building = 100;
  std::string many;
  for (int i = 0; i < 50; ++i) many += member(polygon("p", square(20, 0)));
  Building bad = between_good_ones(building("bad", multi_surface(many)), options);
  EXPECT_THAT(bad, HasIssue(issue_code::kReadLimitExceeded));
  EXPECT_THAT(bad.geometries, IsEmpty());

  options = {};
  options.limits.max_building_bytes = 20'000;
  for (int i = 0; i < 500; ++i) many += member(polygon("p", square(20, 0)));
  bad = between_good_ones(building("bad", multi_surface(many)), options);
  EXPECT_THAT(bad, HasIssue(issue_code::kReadLimitExceeded));
}

TEST(ReadLimits, MarkupWithoutEndIsStopped) {
  FileSourceOptions options;
  options.limits.max_building_bytes = 100'000;
  EXPECT_THAT(
      failure_after_good(city_model(kGood + "<!--" + std::string(1'000'000, 'x') + "-->" + kLast),
                         options),
      HasSubstr("max_building_bytes = 100000"));
}

TEST(ReadLimits, FilesThatAreTooLongAreStopped) {
  FileSourceOptions options;
  options.limits.max_file_bytes = 8'000;
  std::string text = kGood;
  for (int i = 0; i < 100; ++i) text += "<cityObjectMember/>                                      ";
  EXPECT_THAT(failure_after_good(city_model(text + std::string(20'000, ' ')), options),
              HasSubstr("max_file_bytes = 8000"));
}

TEST(BadCrs, ABuildingInAnUnknownOneSaysSo) {
  const auto in_crs = [](const std::string& srs) {
    return building("bad", "<bldg:lod2MultiSurface><gml:MultiSurface srsName=\"" + srs + "\">" +
                               member(polygon("p", square(20, 0))) +
                               "</gml:MultiSurface></bldg:lod2MultiSurface>");
  };
  for (const auto* srs : {"EPSG:999999", "Gauss-Krueger somewhere"}) {
    const Building bad = between_good_ones(in_crs(srs));
    EXPECT_THAT(bad, HasIssue(issue_code::kUnknownCrs));
    EXPECT_THAT(bad.source_issues.at(0).where, HasSubstr(srs));
  }
}

TEST(BadFile, MissingOneIsNotFound) {
  const auto source = open_files({"/nonexistent/city.gml"}, {});
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, ErrorCode::NotFound);
  EXPECT_THAT(source.error().message, HasSubstr("/nonexistent/city.gml"));
}

TEST(BadFile, NoneNamedIsAnError) { EXPECT_FALSE(open_files({}, {})); }

TEST(BadFile, UnreadableFolderIsPermissionDenied) {
  const TempFolder folder;
  const auto closed = folder / "closed";
  std::filesystem::create_directory(closed);
  std::filesystem::permissions(closed, std::filesystem::perms::none);
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all |
                                                  std::filesystem::perms::others_exec |
                                                  std::filesystem::perms::others_read);
  const bool was_root = geteuid() == 0;
  if (was_root) {
    ASSERT_EQ(seteuid(65534), 0);
  }
  const auto source = open_files({closed}, {});
  if (was_root) {
    ASSERT_EQ(seteuid(0), 0);
  }
  std::filesystem::permissions(closed, std::filesystem::perms::owner_all);
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, ErrorCode::PermissionDenied) << source.error().message;
  EXPECT_THAT(source.error().message, HasSubstr("closed"));
}

TEST(BadFile, WhatIsNoCityModelIsNamed) {
  for (const auto& [text, reason] : {std::pair<std::string, std::string>{"", "empty"},
                                     {std::string("PK\3\4zip"), "zip"},
                                     {"x 0 0 0\nf 1 1 1\n", "unknown"},
                                     {"[1, 2]", "unknown"}}) {
    const Reading reading = read_text("a.gml", text);
    EXPECT_FALSE(reading.error);
    EXPECT_EQ(reading.input().state, "failed");
    EXPECT_THAT(reading.input().message, HasSubstr(reason));
  }
}

TEST(BadFile, DamagedGzipIsNamed) {
  Documents documents;
  const auto path =
      documents.add("a.gml.gz", city_model(kGood + std::string(100'000, ' ') + kLast));
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  const Reading reading = documents.read();
  EXPECT_EQ(reading.input().state, "failed");
  EXPECT_THAT(reading.input().message, HasSubstr("damaged"));
}

TEST(BadFile, FoldersPassOverWhatIsNoCityModelButNameBrokenOnes) {
  Documents documents;
  documents.add("b.gml", city_model(kGood));
  documents.add("a.gml", city_model(kLast));
  documents.add("codes.xml", "<Dictionary/>");
  documents.add("notes.txt", "hello");
  documents.add("z.gml", city_model("<cityObjectMember>"));
  const auto source = open_files({documents.folder()}, {});
  ASSERT_TRUE(source);
  const Reading reading = read_from(**source);
  EXPECT_THAT(reading.ids(), ElementsAre("last", "good")) << "files in the order of their names";
  ASSERT_THAT(reading.selection.inputs, SizeIs(3));
  EXPECT_EQ(reading.input(2).state, "failed");
  EXPECT_THAT(reading.selection.warnings, Contains(HasSubstr("codes.xml")));
  EXPECT_THAT(reading.selection.warnings, Contains(HasSubstr("notes.txt")));
}

TEST(Reading, EndsWithTheSinksErrorAndWithAStop) {
  Documents documents;
  const auto path = documents.add("a.gml", city_model(kGood + kLast));
  const auto source = open_files({path}, {});
  ASSERT_TRUE(source);
  const auto selection = (*source)->select({}, {});
  ASSERT_TRUE(selection);
  int taken = 0;
  const auto refused = (*source)->read({}, *selection,
                                       [&](Building&&) -> Result<void> {
                                         ++taken;
                                         return fail(ErrorCode::DataLoss, "no room");
                                       },
                                       {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "no room");
  EXPECT_EQ(taken, 1);

  std::stop_source stop;
  stop.request_stop();
  const auto stopped = (*source)->read(
      {}, *selection, [](Building&&) -> Result<void> { return {}; }, {.stop = stop.get_token()});
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::Cancelled);
}

TEST(Reading, AFileThatChangedSinceItsSelectionIsRefused) {
  Documents documents;
  const auto path = documents.add("a.gml", city_model(kGood));
  const auto source = open_files({path}, {});
  const auto selection = (*source)->select({}, {});
  ASSERT_TRUE(selection);
  documents.add("a.gml", city_model(kGood + kLast));
  const auto read =
      (*source)->read({}, *selection, [](Building&&) -> Result<void> { return {}; }, {});
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::FailedPrecondition);
  EXPECT_THAT(read_from(**source).ids(), ElementsAre("good", "last")) << "selected anew it is read";
}

TEST(BadCoordinates, AListOfTenMegabytesIsReadAndDoesNotHoldUpItsNeighbours) {
  std::string positions;
  positions.reserve(11'000'000);
  while (positions.size() < 10'000'000) positions += "390000.125 5820000.250 33.500 ";
  const Reading reading = read_text(
      "long.gml", city_model(building("long", multi_surface(member(polygon("p", positions)))) +
                             simple_building("good", 0, 0)));
  ASSERT_FALSE(reading.error);
  ASSERT_THAT(reading.ids(), ElementsAre("long", "good"));
  EXPECT_EQ(reading.buildings[0].geometries.at(0).polygons.at(0).rings.at(0).size(),
            positions.size() / 30);
}

TEST(BadCoordinates, OfTwoDimensionsAmongThreeAreAtHeightZeroOrAnIssue) {
  const auto ring_of = [](const std::string& attribute, const std::string& positions) {
    return "<gml:Polygon><gml:exterior><gml:LinearRing><gml:posList" + attribute + ">" + positions +
           "</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>";
  };
  const Reading reading = read_text(
      "mixed.gml",
      city_model(building("flat", multi_surface(member(
                                      ring_of(" srsDimension=\"2\"", "0 0 9 0 9 9 0 9 0 0")))) +
                 building("solid", multi_surface(member(ring_of("", square(20, 0, 5))))) +
                 building("odd", multi_surface(member(ring_of("", "0 0 9 0 9 9 0 9 0 0"))))));
  ASSERT_FALSE(reading.error);
  ASSERT_THAT(reading.ids(), ElementsAre("flat", "solid", "odd"));
  ASSERT_EQ(reading.buildings[0].geometries.at(0).points.size(), 4u);
  for (const Point3& point : reading.buildings[0].geometries[0].points)
    EXPECT_EQ(point.z + reading.selection.origin.z, 0);
  EXPECT_THAT(reading.buildings[1].source_issues, IsEmpty());
  EXPECT_THAT(reading.buildings[2], HasIssue(issue_code::kUnreadableRing));
}

}  // namespace
}  // namespace citymesh
