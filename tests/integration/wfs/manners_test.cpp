// Servers that page in their own way, that have limits, and that misbehave.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stop_token>
#include <thread>

#include "tests/integration/wfs/reading.h"

namespace citymesh::wfs_support {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

const std::filesystem::path kBerlin =
    std::filesystem::path(CITYMESH_TEST_DATA) / "berlin/3910_5817.gml";

class WfsManners : public testing::Test {
 protected:
  static constexpr std::size_t kAll = 166;

  static BuildingQuery box() {
    return {.bbox = RequestBox{391600, 5817650, 391750, 5817800, std::nullopt, Crs{"EPSG:25833"}}};
  }
  void gives_all(Manners manners) {
    const TestWfs server(kBerlin, std::move(manners));
    const auto wfs = read_wfs(server, {});
    EXPECT_EQ(wfs.error.message, "");
    EXPECT_EQ(wfs.buildings, read_file(kBerlin, {}).buildings);
    EXPECT_THAT(wfs.buildings, SizeIs(kAll));
    EXPECT_EQ(wfs.selection.inputs.at(0).buildings, kAll);
    requests_ = server.requests();
  }
  static Error error_of(Manners manners) {
    const TestWfs server(kBerlin, std::move(manners));
    return read_wfs(server, box()).error;
  }

  std::vector<std::map<std::string, std::string>> requests_{};
};

TEST_F(WfsManners, LinksLeadFromPageToPage) {
  gives_all({});
  EXPECT_THAT(requests_, SizeIs((kAll + 6) / 7));
}

TEST_F(WfsManners, WithoutLinksPagesAreCounted) {
  gives_all({.links_next = false});
  EXPECT_THAT(requests_, SizeIs((kAll + 6) / 7));
}

TEST_F(WfsManners, LinksElsewhereAreNotFollowed) {
  gives_all({.next_origin = "http://192.0.2.1:81"});
}

TEST_F(WfsManners, HowManyThereAreNeedNotBeKnown) {
  gives_all({.links_next = false, .knows_matched = false});
  gives_all({.links_next = true, .knows_matched = false});
}

TEST_F(WfsManners, PagesNeedNotBeAnnounced) { gives_all({.says_pages = std::nullopt}); }

TEST_F(WfsManners, SmallerPagesThanAskedForAreNotTheEnd) {
  gives_all({.count_default = 5, .links_next = false});
  gives_all({.secret_limit = 5, .links_next = false});
  gives_all({.secret_limit = 5, .links_next = false, .knows_matched = false});
}

TEST_F(WfsManners, AFeatureOnTwoPagesComesOnce) {
  gives_all({.overlaps = true});
  gives_all({.links_next = false, .knows_matched = false, .overlaps = true});
}

TEST_F(WfsManners, WithoutPagesAllComesAtOnce) {
  gives_all({.says_pages = false});
  EXPECT_THAT(requests_, SizeIs(1));
  EXPECT_FALSE(requests_.at(0).contains("COUNT"));
}

TEST_F(WfsManners, ALimitWithoutPagesIsNoSilentLoss) {
  const auto error = error_of({.says_pages = false, .count_default = 5});
  EXPECT_EQ(error.code, ErrorCode::ResourceExhausted);
  EXPECT_THAT(error.message, AllOf(HasSubstr("gives 5 of"), HasSubstr("smaller `bbox`")));
  EXPECT_EQ(error_of({.says_pages = false, .count_default = 5, .knows_matched = false}).code,
            ErrorCode::ResourceExhausted);
}

TEST_F(WfsManners, TheSamePageForEverEndsWithAnError) {
  for (const bool links : {true, false})
    for (const bool matched : {true, false}) {
      const auto error =
          error_of({.links_next = links, .knows_matched = matched, .knows_start = false});
      EXPECT_EQ(error.code, ErrorCode::ResourceExhausted);
      EXPECT_THAT(error.message, HasSubstr("repeats a page"));
    }
}

TEST_F(WfsManners, ABusyServerIsAskedAgain) { gives_all({.busy = 1}); }

TEST_F(WfsManners, AServerThatStaysBusyIsUnavailable) {
  const auto error = error_of({.busy = 1000});
  EXPECT_EQ(error.code, ErrorCode::Unavailable);
  EXPECT_THAT(error.message, AllOf(HasSubstr("503"), HasSubstr("come back later")));
}

TEST_F(WfsManners, AnExceptionIsToldInTheServersWords) {
  const auto error = error_of({.exception = true});
  EXPECT_EQ(error.code, ErrorCode::FailedPrecondition);
  EXPECT_THAT(error.message, AllOf(HasSubstr("InvalidParameterValue"),
                                   HasSubstr("(typeNames) no such type <here>")));
}

TEST_F(WfsManners, AWebPageIsNoCityModel) {
  const auto error = error_of({.html = true});
  EXPECT_EQ(error.code, ErrorCode::FailedPrecondition);
  EXPECT_THAT(error.message, HasSubstr("'Down for maintenance'"));
}

TEST_F(WfsManners, RedirectsAreNotFollowed) {
  const auto error = error_of({.redirects = true});
  EXPECT_EQ(error.code, ErrorCode::FailedPrecondition);
  EXPECT_THAT(error.message, HasSubstr("redirect (302)"));
}

TEST_F(WfsManners, AnAnswerThatIsCutIsNoModel) {
  EXPECT_EQ(error_of({.cut = true}).code, ErrorCode::Unavailable);
  EXPECT_EQ(error_of({.cut_unnoticed = true}).code, ErrorCode::DataLoss);
}

TEST_F(WfsManners, EntitiesAreNotExpanded) {
  EXPECT_EQ(error_of({.entities = true}).code, ErrorCode::FailedPrecondition);
}

TEST_F(WfsManners, ASlowServerEndsWithTheTime) {
  const TestWfs server(kBerlin, {.slow = true});
  auto options = options_for(server);
  const auto factory = open_wfs(options);
  ASSERT_TRUE(factory) << factory.error().message;
  options.timeout_s = 0.2;
  const auto hasty = open_wfs(options);
  ASSERT_TRUE(hasty) << hasty.error().message;
  const auto selection = (*(*hasty)(WfsUse::Reading))->select({}, {});
  ASSERT_FALSE(selection);
  EXPECT_EQ(selection.error().code, ErrorCode::DeadlineExceeded);
}

TEST_F(WfsManners, AStopEndsTheWaiting) {
  const TestWfs server(kBerlin, {.slow = true});
  const auto factory = open_wfs(options_for(server));
  ASSERT_TRUE(factory) << factory.error().message;
  std::stop_source stop;
  RunContext context{.stop = stop.get_token()};
  std::jthread dismisses([&] {
    while (server.requests().empty()) std::this_thread::yield();
    stop.request_stop();
  });
  const auto selection = (*(*factory)(WfsUse::Reading))->select({}, context);
  ASSERT_FALSE(selection);
  EXPECT_EQ(selection.error().code, ErrorCode::Cancelled);
}

TEST_F(WfsManners, LimitsAreKept) {
  const TestWfs server(kBerlin);
  auto options = options_for(server);
  options.max_answer_bytes = 20'000;
  auto error = read_wfs(options, {}).error;
  EXPECT_EQ(error.code, ErrorCode::ResourceExhausted);
  EXPECT_THAT(error.message, HasSubstr("max_answer_bytes"));
  options = options_for(server);
  options.max_download_bytes = 200'000;
  error = read_wfs(options, {}).error;
  EXPECT_EQ(error.code, ErrorCode::ResourceExhausted);
  EXPECT_THAT(error.message, HasSubstr("max_download_bytes"));
  options = options_for(server);
  options.max_features = 100;
  error = read_wfs(options, {}).error;
  EXPECT_EQ(error.code, ErrorCode::ResourceExhausted);
  EXPECT_THAT(error.message, HasSubstr("166 features"));
}

TEST_F(WfsManners, SecretsAreInNoMessage) {
  Manners locked;
  locked.locked = true;
  for (const auto& manners : {Manners{.html = true}, Manners{.exception = true}, locked,
                              Manners{.cut = true}, Manners{.busy = 1000}}) {
    const TestWfs server(kBerlin, manners);
    auto options = options_for(server);
    options.url = server.url_with_password();
    const auto error = read_wfs(options, {}).error;
    EXPECT_THAT(error.message, AllOf(HasSubstr(server.url()), Not(HasSubstr("s3cret"))));
  }
}

TEST_F(WfsManners, TheUserIsToldToTheSameServerOnlyOnEveryPage) {
  const TestWfs server(kBerlin);
  auto options = options_for(server);
  options.url = server.url_with_password();
  EXPECT_EQ(read_wfs(options, {}).error.message, "");
  EXPECT_THAT(server.last_header(), HasSubstr("Authorization: Basic"));
}

TEST_F(WfsManners, OpeningSaysWhatIsWrongWithTheServer) {
  const auto opened = [](const Manners& manners, auto change) {
    const TestWfs server(kBerlin, manners);
    auto options = options_for(server);
    change(options);
    const auto factory = open_wfs(options);
    return factory ? Error{} : factory.error();
  };
  const auto as_it_is = [](WfsOptions&) {};
  auto error = opened({.version = "1.1.0"}, as_it_is);
  EXPECT_EQ(error.code, ErrorCode::FailedPrecondition);
  EXPECT_THAT(error.message, HasSubstr("'1.1.0', expected 2.0"));
  error = opened({}, [](WfsOptions& options) { options.type_names = "tran:Road"; });
  EXPECT_EQ(error.code, ErrorCode::FailedPrecondition);
  EXPECT_THAT(error.message, HasSubstr("expected one of veg:PlantCover, bldg:Building"));
  error = opened({}, [](WfsOptions& options) { options.output_format = "text/csv"; });
  EXPECT_THAT(error.message, HasSubstr("'application/json'"));
  error = opened({.default_crs = "urn:nobody:knows"}, as_it_is);
  EXPECT_THAT(error.message, HasSubstr("'urn:nobody:knows' is not understood"));
  Manners locked;
  locked.locked = true;
  EXPECT_EQ(opened(locked, as_it_is).code, ErrorCode::PermissionDenied);
}

TEST_F(WfsManners, OnlyWebAddressesAreTaken) {
  for (const char* url :
       {"ftp://user:s3cret@host/wfs", "file:///etc/passwd", "not an address", ""}) {
    const auto factory = open_wfs({.url = url});
    ASSERT_FALSE(factory);
    EXPECT_EQ(factory.error().code, ErrorCode::InvalidArgument);
    EXPECT_THAT(factory.error().message, Not(HasSubstr("s3cret")));
  }
}

TEST_F(WfsManners, ParametersOfACopiedAddressAreReplaced) {
  const TestWfs server(kBerlin);
  auto options = options_for(server);
  options.url += "?Service=WFS&request=GetCapabilities&version=1.0.0&map=berlin";
  EXPECT_EQ(read_wfs(options, box()).error.message, "");
  EXPECT_EQ(server.requests().at(0).at("VERSION"), "2.0.2");
  EXPECT_EQ(server.requests().at(0).at("MAP"), "berlin");
}

TEST_F(WfsManners, ATypeIsFoundByItsNameWithoutPrefix) {
  const TestWfs server(kBerlin);
  auto options = options_for(server);
  options.type_names = "Building";
  EXPECT_EQ(read_wfs(options, box()).error.message, "");
  EXPECT_EQ(server.requests().at(0).at("TYPENAMES"), "bldg:Building");
  EXPECT_EQ(server.requests().at(0).at("NAMESPACES"),
            "xmlns(bldg,http://www.opengis.net/citygml/building/2.0)");
}

TEST_F(WfsManners, NobodyThereIsUnavailable) {
  std::uint16_t port = 0;
  {
    const TestWfs server(kBerlin);
    port = server.port();
  }
  const auto factory =
      open_wfs({.url = "http://127.0.0.1:" + std::to_string(port) + "/wfs", .retry_pause_s = 0.01});
  ASSERT_FALSE(factory);
  EXPECT_EQ(factory.error().code, ErrorCode::Unavailable);
}

}  // namespace
}  // namespace citymesh::wfs_support
