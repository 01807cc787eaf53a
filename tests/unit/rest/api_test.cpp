#include "services/rest/api.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "services/offer/offer.h"
#include "tests/unit/rest/rest_api.h"

namespace citymesh {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

TEST_F(RestApi, LandingPageLinksWhatTheStandardAsksForWithAbsoluteUrls) {
  const auto landing = document(get("/"));
  EXPECT_THAT(links(landing, "self"), ElementsAre("http://citymesh.test:8080/"));
  EXPECT_THAT(links(landing, "service-desc"), ElementsAre("http://citymesh.test:8080/api"));
  EXPECT_THAT(links(landing, "http://www.opengis.net/def/rel/ogc/1.0/conformance"),
              ElementsAre("http://citymesh.test:8080/conformance"));
  EXPECT_THAT(links(landing, "http://www.opengis.net/def/rel/ogc/1.0/processes"),
              ElementsAre("http://citymesh.test:8080/processes"));
  EXPECT_THAT(links(landing, "http://www.opengis.net/def/rel/ogc/1.0/job-list"),
              ElementsAre("http://citymesh.test:8080/jobs"));
}

TEST_F(RestApi, EveryLinkOfTheLandingPageResolves) {
  const auto landing = document(get("/"));
  for (const auto& link : landing["links"]) {
    const auto href = link["href"].get<std::string>();
    EXPECT_EQ(get(href.substr(std::string("http://citymesh.test:8080").size())).status, 200)
        << href;
  }
}

TEST_F(RestApi, LinksBeginWithThePublicUrlWhenThereIsOne) {
  const Api behind_proxy(service_.jobs(), service_.metrics(),
                         {.public_url = "https://maps.example/citymesh/"});
  const auto landing = document(behind_proxy.handle({"GET", "/", {}, {}}));
  EXPECT_THAT(links(landing, "self"), ElementsAre("https://maps.example/citymesh/"));
}

TEST_F(RestApi, ProcessListIsPagedByLimit) {
  const auto all = document(get("/processes"));
  EXPECT_EQ(all["processes"].size(), offered_processes().size());
  const auto first = document(get("/processes?limit=1"));
  ASSERT_EQ(first["processes"].size(), 1U);
  EXPECT_EQ(first["processes"][0]["jobControlOptions"], json({"async-execute", "dismiss"}));
  ASSERT_EQ(links(first, "next").size(), 1U);
  const auto second = document(get("/processes?limit=1&offset=1"));
  EXPECT_NE(second["processes"][0]["id"], first["processes"][0]["id"]);
  for (const auto* wrong : {"0", "-1", "x", "1.5", "99999999999", ""})
    EXPECT_THAT(detail(get(std::string("/processes?limit=") + wrong), 400), HasSubstr("`limit`"));
}

TEST_F(RestApi, ProcessDescriptionHasASchemaForEveryInputOfTheOptionTable) {
  for (const auto& process : offered_processes()) {
    const auto described = document(get("/processes/" + std::string(process.id)));
    for (const auto& option : process.inputs) {
      const auto& input = described["inputs"][std::string(option.name)];
      EXPECT_EQ(input["description"], option.description);
      const auto& schema = input["schema"];
      if (option.kind == OptionKind::BoundingBox) {
        EXPECT_EQ(schema["allOf"][0]["format"], "ogc-bbox");
      } else {
        EXPECT_EQ(schema.value("default", json()), json::parse(option.default_json)) << option.name;
      }
      if (option.minimum < option.maximum) {
        EXPECT_EQ(schema["maximum"], option.maximum);
      }
      const auto& texts = option.kind == OptionKind::TextList ? schema["items"] : schema;
      if (!option.choices.empty()) {
        EXPECT_EQ(texts["enum"].size(), option.choices.size());
      }
    }
    for (const auto& output : process.outputs)
      EXPECT_EQ(described["outputs"][std::string(output.id)]["schema"]["contentMediaType"],
                output.media_type);
  }
}

TEST_F(RestApi, OpenApiDefinitionDescribesEveryRouteAndEveryReferenceResolves) {
  const auto response = get("/api");
  EXPECT_EQ(response.headers.get("Content-Type"), "application/vnd.oai.openapi+json;version=3.0");
  const auto api = document(response);
  EXPECT_EQ(api["openapi"], "3.0.3");
  EXPECT_EQ(api["servers"][0]["url"], "http://citymesh.test:8080");
  for (const auto* path : {"/", "/conformance", "/processes", "/processes/{processID}", kExecution,
                           "/jobs", "/jobs/{jobID}", "/jobs/{jobID}/results",
                           "/jobs/{jobID}/results/{output}", "/healthz", "/readyz", "/metrics"})
    EXPECT_TRUE(api["paths"].contains(path)) << path;
  EXPECT_TRUE(api["components"]["schemas"]["execute-export-for-simulation"]["properties"]["inputs"]
                 ["properties"]
                     .contains("snap_tolerance_m"));
  const auto flat = api.flatten();
  for (const auto& [pointer, value] : flat.items())
    if (pointer.ends_with("/$ref")) {
      EXPECT_TRUE(api.contains(json::json_pointer(value.get<std::string>().substr(1)))) << value;
    }
}

TEST_F(RestApi, ExampleRequestOfTheOpenApiDefinitionIsAccepted) {
  const auto api = document(get("/api"));
  for (const auto& process : offered_processes()) {
    const auto name = "execute-" + std::string(process.id);
    const auto response =
        send("POST", "/processes/" + std::string(process.id) + "/execution",
             api["components"]["schemas"][name]["example"].dump(), {{"Prefer", "respond-async"}});
    EXPECT_EQ(response.status, 201) << text(response);
  }
}

TEST_F(RestApi, ExecutionAnswersWithAnAbsoluteLocationAndTheStatusOfTheJob) {
  const auto response = send("POST", kExecution, kBox);
  EXPECT_EQ(response.status, 201);
  const auto status = document(response);
  EXPECT_EQ(response.headers.get("Location"),
            "http://citymesh.test:8080/jobs/" + status["jobID"].get<std::string>());
  EXPECT_EQ(status["status"], "accepted");
  EXPECT_EQ(status["type"], "process");
  EXPECT_EQ(status["processID"], "export-for-simulation");
  EXPECT_THAT(status["created"].get<std::string>(),
              ::testing::MatchesRegex("....-..-..T..:..:..\\.[0-9]+Z"));
  EXPECT_EQ(links(status, "monitor"), links(status, "self"));
  EXPECT_FALSE(response.headers.has("Preference-Applied"));
}

TEST_F(RestApi, BoxReachesTheJobAsItWasGiven) {
  const auto id = submit(
      R"({"inputs":{"bbox":{"bbox":[52.5,13.4,52.51,13.41],"crs":"http://www.opengis.net/def/crs/EPSG/0/4326"}}})");
  const auto inputs = json::parse(must(service_.jobs().get(id)).spec.inputs_json);
  EXPECT_EQ(inputs["bbox"]["bbox"], json({52.5, 13.4, 52.51, 13.41}));
  EXPECT_EQ(inputs["bbox"]["crs"], "http://www.opengis.net/def/crs/EPSG/0/4326");
}

TEST_F(RestApi, StatusTellsStageAndCountsWhileTheJobRuns) {
  const auto id = submit();
  service_.start();
  const auto status = document(get("/jobs/" + id));
  EXPECT_EQ(status["status"], "running");
  EXPECT_EQ(status["stage"], "heal");
  EXPECT_EQ(status["done"], 3);
  EXPECT_EQ(status["total"], 12);
  EXPECT_EQ(status["progress"], 25);
  EXPECT_TRUE(status.contains("started"));
  EXPECT_FALSE(status.contains("finished"));
}

TEST_F(RestApi, ResultsOfAnOpenJobAreNotReady) {
  const auto id = submit();
  for (const auto* path : {"/results", "/results/obj"})
    EXPECT_EQ(problem(get("/jobs/" + id + path), 404)["type"], kExceptions + "result-not-ready");
}

TEST_F(RestApi, ResultsOfAPlainRequestAreADocumentOfLinks) {
  const auto id = finished(kBox);
  const auto response = get("/jobs/" + id + "/results");
  EXPECT_EQ(response.headers.get("Content-Type"), "application/json");
  const auto results = document(response);
  EXPECT_EQ(results["obj"]["href"], "http://citymesh.test:8080/jobs/" + id + "/results/model.obj");
  EXPECT_EQ(results["obj"]["type"], "model/obj");
  EXPECT_EQ(results["report"]["href"],
            "http://citymesh.test:8080/jobs/" + id + "/results/report.json");
  for (const auto& [output, link] : results.items())
    EXPECT_THAT((std::vector<std::string>{"report", "obj", "stl_binary"}), Contains(output));
}

TEST_F(RestApi, OutputsThatAreAbsentAreTheReportAndTheFormats) {
  auto files = JobService::export_files();
  files.push_back({"errors_glb", "errors.glb", "model/gltf-binary", "glTF"});
  const auto response =
      send("POST", "/processes/heal/execution", kBox, {{"Prefer", "respond-async"}});
  const std::string id = document(response)["jobID"];
  service_.succeed(service_.start(), files);
  const auto results = document(get("/jobs/" + id + "/results"));
  EXPECT_TRUE(results.contains("report"));
  EXPECT_TRUE(results.contains("obj"));
  EXPECT_FALSE(results.contains("errors_glb"));
  EXPECT_EQ(text(get("/jobs/" + id + "/results/errors_glb")), "glTF");
}

TEST_F(RestApi, RawResultOfOneValueIsTheFileItself) {
  const auto id = finished(R"({"outputs":{"obj":{}}})");
  const auto response = get("/jobs/" + id + "/results");
  EXPECT_EQ(response.headers.get("Content-Type"), "model/obj");
  EXPECT_EQ(response.headers.get("Content-Disposition"), "attachment; filename=\"model.obj\"");
  EXPECT_FALSE(response.headers.has("Link"));
  EXPECT_EQ(text(response), "o b_1\nv 0 0 0\n");
}

TEST_F(RestApi, RawResultsByReferenceAreLinkHeadersWithoutABody) {
  const auto id = finished(
      R"({"outputs":{"obj":{"transmissionMode":"reference"},"report":{"transmissionMode":"reference"}}})");
  const auto response = get("/jobs/" + id + "/results");
  EXPECT_EQ(response.status, 204);
  EXPECT_TRUE(response.body.empty());
  const auto links = response.headers.get("Link");
  EXPECT_THAT(links, HasSubstr("/results/model.obj>;"));
  EXPECT_THAT(links, HasSubstr("/results/report.json>;"));
}

TEST_F(RestApi, RawResultsOfSeveralValuesAreMultipart) {
  const auto id = finished(
      R"({"outputs":{"obj":{},"report":{},"stl_binary":{"transmissionMode":"reference"}}})");
  const auto response = get("/jobs/" + id + "/results");
  EXPECT_THAT(response.headers.get("Content-Type"), StartsWith("multipart/related; boundary="));
  const auto body = text(response);
  EXPECT_EQ(body.size(), body_bytes(response));
  EXPECT_THAT(body, HasSubstr("Content-ID: <obj>\r\nContent-Type: model/obj\r\n"));
  EXPECT_THAT(body, HasSubstr("\r\n\r\no b_1\nv 0 0 0\n\r\n--citymesh-" + id));
  EXPECT_THAT(body, HasSubstr("{\"counts\":{\"requested\":12}}\r\n"));
  EXPECT_THAT(body, HasSubstr("Content-Location: http://citymesh.test:8080/jobs/" + id +
                              "/results/model_binary.stl\r\n"));
  EXPECT_THAT(body, ::testing::EndsWith("--citymesh-" + id + "--\r\n"));
}

TEST_F(RestApi, RawResultsOfSeveralValuesAreLinksForAClientThatTakesJsonOnly) {
  const auto id = finished(R"({"outputs":{"obj":{},"report":{}}})");
  const auto results = document(get("/jobs/" + id + "/results", {{"Accept", "application/json"}}));
  EXPECT_THAT(results["obj"]["href"].get<std::string>(), HasSubstr("/results/model.obj"));
}

TEST_F(RestApi, DocumentHoldsValuesInTheFormThatFitsTheirMediaType) {
  const auto id =
      finished(R"({"response":"document","outputs":{"obj":{},"report":{},"stl_binary":{}}})");
  const auto results = document(get("/jobs/" + id + "/results"));
  EXPECT_EQ(results["obj"], "o b_1\nv 0 0 0\n");
  EXPECT_EQ(results["report"]["mediaType"], "application/json");
  EXPECT_EQ(results["report"]["value"]["counts"]["requested"], 12);
  EXPECT_EQ(results["stl_binary"]["encoding"], "base64");
  EXPECT_EQ(results["stl_binary"]["value"], "AAECAw==");
}

TEST_F(RestApi, DocumentGivesLinksForValuesThatAreTooLargeToInline) {
  const Api small(service_.jobs(), service_.metrics(),
                  {.public_url = "http://c", .max_inline_bytes = 4});
  const auto id = finished(R"({"response":"document","outputs":{"obj":{},"report":{}}})");
  const auto results = document(small.handle({"GET", "/jobs/" + id + "/results", {}, {}}));
  EXPECT_TRUE(results["obj"].contains("href"));
  EXPECT_TRUE(results["report"].contains("value")) << "JSON is streamed, whatever its size";
}

TEST_F(RestApi, ResultFilesAreServedByOutputAndByNameCutOffFromTheRestOfTheSite) {
  const auto id = finished(kBox);
  EXPECT_EQ(text(get("/jobs/" + id + "/results/report")), R"({"counts":{"requested":12}})");
  EXPECT_EQ(text(get("/jobs/" + id + "/results/run.json")), R"({"threads":1})");
  const auto page = get("/jobs/" + id + "/results/report.html");
  EXPECT_EQ(page.headers.get("Content-Type"), "text/html");
  EXPECT_THAT(page.headers.get("Content-Security-Policy"),
              ::testing::AllOf(HasSubstr("default-src 'none'"), HasSubstr("sandbox"),
                               Not(HasSubstr("allow-same-origin"))));
  EXPECT_EQ(page.headers.get("X-Content-Type-Options"), "nosniff");
}

TEST_F(RestApi, NothingInARequestReachesTheFileSystemAsAPath) {
  const auto id = finished(kBox);
  for (const auto* name :
       {"..%2F..%2Fjobs.sqlite", "%2Fetc%2Fpasswd", "..", "nothing.obj", "%2e%2e"})
    EXPECT_EQ(problem(get("/jobs/" + id + "/results/" + name), 404)["type"],
              kExceptions + "no-such-output");
  for (const auto* job : {"..%2Fx", "..", "%2e", "' or 1=1 --", "0"})
    EXPECT_EQ(problem(get(std::string("/jobs/") + encode_segment(job)), 404)["type"],
              kExceptions + "no-such-job");
}

TEST_F(RestApi, FailedJobSaysWhyInItsStatusAndInsteadOfResults) {
  const auto id = submit();
  service_.fail_job(service_.start(), {ErrorCode::InvalidArgument, "the features have 2 CRSs"});
  const auto status = document(get("/jobs/" + id));
  EXPECT_EQ(status["status"], "failed");
  EXPECT_EQ(status["exception"]["detail"], "the features have 2 CRSs");
  EXPECT_EQ(links(status, "http://www.opengis.net/def/rel/ogc/1.0/exceptions").size(), 1U);
  EXPECT_EQ(detail(get("/jobs/" + id + "/results"), 400), "the features have 2 CRSs");
}

TEST_F(RestApi, JobOfADeadWorkerFailsAsTheServersFault) {
  const auto id = submit();
  service_.fail_job(service_.start(), {ErrorCode::Internal, "its worker died 3 times"});
  EXPECT_EQ(detail(get("/jobs/" + id + "/results"), 500), "its worker died 3 times");
}

TEST_F(RestApi, DismissEndsAQueuedJobAndMayBeRepeated) {
  const auto id = submit();
  for (int i = 0; i < 2; ++i) {
    const auto response = send("DELETE", "/jobs/" + id);
    EXPECT_EQ(response.status, 200);
    EXPECT_EQ(document(response)["status"], "dismissed");
  }
  EXPECT_EQ(problem(get("/jobs/" + id + "/results"), 404)["type"],
            kExceptions + "result-not-available");
}

TEST_F(RestApi, DismissOfASuccessfulJobIsAConflictAndKeepsItsResults) {
  const auto id = finished(kBox);
  EXPECT_THAT(detail(send("DELETE", "/jobs/" + id), 409), HasSubstr("successful"));
  EXPECT_EQ(get("/jobs/" + id + "/results").status, 200);
}

TEST_F(RestApi, ResultsThatHaveExpiredAreNeitherServedNorLinked) {
  const auto id = finished(kBox);
  service_.expire_results();
  for (const auto* path : {"/results", "/results/obj", "/results/model.obj", "/results/none"}) {
    const auto expired = problem(get("/jobs/" + id + path), 404);
    EXPECT_EQ(expired["type"], kExceptions + "result-not-available") << path;
    EXPECT_THAT(expired["detail"].get<std::string>(), HasSubstr("results have expired"));
  }
  const auto status = document(get("/jobs/" + id));
  EXPECT_EQ(status["status"], "successful");
  EXPECT_EQ(status["message"], "results have expired");
  EXPECT_THAT(links(status, "http://www.opengis.net/def/rel/ogc/1.0/results"), IsEmpty());
  EXPECT_THAT(links(status, "item"), IsEmpty());
  const auto page = text(get("/jobs/" + id, {{"Accept", "text/html"}}));
  EXPECT_THAT(page, HasSubstr("results have expired"));
  EXPECT_THAT(page, Not(HasSubstr("<h2>Results</h2>")));
}

TEST_F(RestApi, UnknownJobIsNoSuchJobForEveryVerb) {
  const std::string job = "/jobs/00000000-0000-4000-8000-000000000000";
  for (const auto& path : {job, job + "/results", job + "/results/obj"})
    EXPECT_EQ(problem(get(path), 404)["type"], kExceptions + "no-such-job");
  EXPECT_EQ(problem(send("DELETE", job), 404)["type"], kExceptions + "no-such-job");
}

TEST_F(RestApi, JobListIsNewestFirstFilteredAndPagedWithoutGaps) {
  std::vector<std::string> ids;
  for (int i = 0; i < 5; ++i) ids.insert(ids.begin(), submit());
  service_.succeed(service_.start(), JobService::export_files());  // the oldest

  std::vector<std::string> seen;
  for (std::string next = "/jobs?limit=2"; !next.empty();) {
    const auto page = document(get(next));
    EXPECT_LE(page["jobs"].size(), 2U);
    for (const auto& job : page["jobs"]) seen.push_back(job["jobID"]);
    const auto more = links(page, "next");
    next = more.empty() ? "" : more[0].substr(std::string("http://citymesh.test:8080").size());
  }
  std::ranges::sort(ids);
  std::ranges::sort(seen);
  EXPECT_EQ(seen, ids);

  EXPECT_EQ(document(get("/jobs?status=successful"))["jobs"].size(), 1U);
  EXPECT_EQ(document(get("/jobs?status=accepted,running&type=process"))["jobs"].size(), 4U);
  EXPECT_EQ(document(get("/jobs?processID=validate"))["jobs"].size(), 0U);
  EXPECT_EQ(document(get("/jobs?datetime=2000-01-01T00:00:00Z/.."))["jobs"].size(), 5U);
  EXPECT_EQ(document(get("/jobs?datetime=../2000-01-01T00:00:00Z"))["jobs"].size(), 0U);
  EXPECT_EQ(document(get("/jobs?minDuration=3600"))["jobs"].size(), 0U);
  EXPECT_EQ(document(get("/jobs?maxDuration=3600"))["jobs"].size(), 1U) << "only one has started";
}

TEST_F(RestApi, JobListNamesTheParameterThatIsWrong) {
  EXPECT_THAT(detail(get("/jobs?status=done"), 400), HasSubstr("`status` is 'done', expected"));
  EXPECT_THAT(detail(get("/jobs?type=service"), 400), HasSubstr("`type`"));
  EXPECT_THAT(detail(get("/jobs?datetime=yesterday"), 400), HasSubstr("`datetime`"));
  EXPECT_THAT(detail(get("/jobs?datetime=2024-02-30T00:00:00Z"), 400), HasSubstr("`datetime`"));
  EXPECT_THAT(detail(get("/jobs?minDuration=-1"), 400), HasSubstr("`minDuration`"));
  EXPECT_THAT(detail(get("/jobs?maxDuration=nan"), 400), HasSubstr("`maxDuration`"));
  EXPECT_THAT(detail(get("/jobs?limit=100000"), 400), HasSubstr("`limit`"));
  EXPECT_THAT(detail(get("/jobs?colour=red"), 400), HasSubstr("`colour` is not known"));
}

TEST_F(RestApi, UnknownProcessNamesThoseThatExist) {
  for (const auto& response :
       {get("/processes/paint"), send("POST", "/processes/paint/execution", kBox)}) {
    const auto parsed = problem(response, 404);
    EXPECT_EQ(parsed["type"], kExceptions + "no-such-process");
    EXPECT_THAT(parsed["detail"].get<std::string>(), HasSubstr("export-for-simulation"));
  }
}

TEST_F(RestApi, BadInputsAreNamedWithTheirValueAndWhatWasExpected) {
  const auto refused = [&](std::string body) {
    return detail(send("POST", kExecution, body), 400);
  };
  EXPECT_THAT(refused("{\"inputs\":"), HasSubstr("not valid JSON"));
  EXPECT_THAT(refused(std::string(100'000, '[')), HasSubstr("nested deeper"));
  EXPECT_THAT(refused(R"({"inputs":{"colour":"red"}})"), HasSubstr("`colour`"));
  EXPECT_THAT(refused(R"({"inputs":{"formats":["dxf"]}})"), HasSubstr("dxf"));
  EXPECT_THAT(refused(R"({"inputs":{"snap_tolerance_m":"wide"}})"), HasSubstr("wide"));
  EXPECT_THAT(refused(R"({"inputs":{"snap_tolerance_m":1e300}})"), HasSubstr("from 0.0001 to 1"));
  EXPECT_THAT(refused(R"({"inputs":{"bbox":[1,2,3,4]}})"), HasSubstr("`bbox`"));
  EXPECT_THAT(refused(R"({"inputs":{"bbox":{"bbox":[1,2,3]}}})"), HasSubstr("`bbox`"));
  EXPECT_THAT(refused(R"({"inputs":{"bbox":{"bbox":[1,2,3,4],"crs":"EPSG:nowhere"}}})"),
              HasSubstr("nowhere"));
  EXPECT_THAT(refused(R"({"outputs":{"dxf":{}}})"), HasSubstr("dxf"));
}

TEST_F(RestApi, QueueThatIsFullAsksToTryAgainLater) {
  for (int i = 0; i < 100; ++i)
    must(service_.jobs().submit({.process = "validate", .inputs_json = "{}"}));
  const auto response = send("POST", kExecution, kBox);
  EXPECT_TRUE(response.headers.has("Retry-After"));
  EXPECT_THAT(detail(response, 429), HasSubstr("100"));
}

TEST_F(RestApi, WrongMethodNamesThePossibleOnes) {
  const auto response = send("PUT", "/jobs/x");
  EXPECT_EQ(response.headers.get("Allow"), "GET, HEAD, DELETE, OPTIONS");
  EXPECT_THAT(detail(response, 405), HasSubstr("PUT"));
  EXPECT_EQ(send("GET", kExecution).headers.get("Allow"), "POST, OPTIONS");
}

TEST_F(RestApi, WrongMediaTypeIsRefusedNamingTheRightOne) {
  const auto response =
      send("POST", kExecution, kBox, {{"Content-Type", "application/x-www-form-urlencoded"}});
  EXPECT_THAT(detail(response, 415), HasSubstr("expected application/json"));
}

TEST_F(RestApi, UnknownResourceAndBadTargetAndBadHostAreProblems) {
  EXPECT_THAT(detail(get("/nothing/here"), 404), HasSubstr("/nothing/here"));
  EXPECT_THAT(detail(get("/jobs/%zz"), 400), HasSubstr("percent-encoded"));
  EXPECT_THAT(detail(get("/", {{"Host", "evil\"><script>"}}), 400), HasSubstr("Host"));
}

TEST_F(RestApi, ProblemsArePlainJsonForAClientThatNamesOnlyThat) {
  const auto content_type = [&](std::string accept) {
    return get("/processes/paint", {{"Accept", std::move(accept)}}).headers.get("Content-Type");
  };
  EXPECT_EQ(content_type("application/json"), "application/json");
  EXPECT_EQ(content_type("application/json, application/problem+json"), "application/problem+json");
  EXPECT_EQ(content_type("*/*"), "application/problem+json");
  EXPECT_THAT(content_type("text/html,application/xhtml+xml,*/*;q=0.8"), StartsWith("text/html"));
}

TEST_F(RestApi, BrowsersGetPagesInWhichForeignTextIsEscaped) {
  const auto id = submit(R"({"inputs":{"object_ids":["<script>alert(1)</script>"]}})");
  service_.succeed(service_.start(), JobService::export_files());
  const std::string browser = "text/html,application/xhtml+xml,application/xml;q=0.9,*/*;q=0.8";
  for (const auto& path : {std::string("/"), std::string("/conformance"), std::string("/processes"),
                           std::string("/processes/export-for-simulation"), std::string("/jobs"),
                           "/jobs/" + id, "/jobs/" + id + "/results", std::string("/api")}) {
    const auto response = get(path, {{"Accept", browser}});
    EXPECT_EQ(response.status, 200);
    EXPECT_THAT(response.headers.get("Content-Type"), StartsWith("text/html")) << path;
    EXPECT_THAT(response.headers.get("Content-Security-Policy"), HasSubstr("default-src 'none'"));
    EXPECT_THAT(text(response), Not(HasSubstr("<script"))) << path;
  }
  const auto page = text(get("/jobs/" + id + "?f=html"));
  EXPECT_THAT(page, HasSubstr("/results/picture.svg\""));
  EXPECT_THAT(page, HasSubstr("/results/report.html\""));
  EXPECT_THAT(page, Not(HasSubstr("http-equiv=\"refresh\"")));
}

TEST_F(RestApi, PageOfAnOpenJobReloadsItself) {
  const auto page = text(get("/jobs/" + submit() + "?f=html"));
  EXPECT_THAT(page, HasSubstr("http-equiv=\"refresh\""));
}

TEST_F(RestApi, QueryParameterOverridesTheAcceptHeader) {
  EXPECT_EQ(get("/?f=json", {{"Accept", "text/html"}}).headers.get("Content-Type"),
            "application/json");
  EXPECT_THAT(detail(get("/?f=xml"), 400), HasSubstr("expected html or json"));
}

TEST_F(RestApi, HealthReadinessAndMetricsAreServed) {
  EXPECT_EQ(text(get("/healthz")), "ok\n");
  EXPECT_EQ(text(get("/readyz")), "ready\n");
  send("A-METHOD-OF-SOME-CLIENT-THAT-NOBODY-KNOWS", "/healthz");
  const auto metrics = text(get("/metrics"));
  for (const auto* method : {"GET", "other"})
    EXPECT_THAT(metrics, HasSubstr("citymesh_http_requests_total{method=\"" + std::string(method) +
                                   "\",route=\"/healthz\""));
}

}  // namespace
}  // namespace citymesh
