#include "server/report/study_report.hpp"

#include <catch2/catch.hpp>

#include "server/cli/study_summary.hpp"
#include "server/json/published_study_json.hpp"
#include "server/report/study_words.hpp"
#include "server/report/svg.hpp"

using namespace repose;
using namespace repose::server;
using Catch::Contains;

namespace {

/// The soybean study with three replicates that lie so far above the paper's means.
StudyResult sample_result(double above) {
  StudyResult result;
  result.study = find_published_study("boac2010");
  REQUIRE(result.study != nullptr);
  const auto sample = [&](double mean) {
    Sample three;
    three.values = {mean + above - 0.1, mean + above, mean + above + 0.1};
    three.grain_steps = 1e8;
    three.simulated_seconds = 2.0;
    return three;
  };
  for (const StudyRun& run : result.study->runs) {
    result.runs[run.run][result.study->drop_experiment] = sample(0.6 - above);
    for (const auto& [experiment, printed] : run.printed) {
      result.runs[run.run][experiment] = sample(printed.mean);
    }
  }
  for (const StudyVariant& variant : result.study->variants) {
    VariantResult tried{variant.variant, {}};
    for (const std::string& experiment : variant.experiments) {
      tried.samples[experiment] = sample(600.0);
    }
    result.variants.push_back(tried);
  }
  SearchResult search{study_search(*result.study, StudySize::quick), {}, {}};
  search.samples = result.runs.at(result.study->best);
  result.search = search;
  return result;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++found;
  return found;
}

}  // namespace

TEST_CASE("the study's report stands alone and shows every run, variant and chart", "[server]") {
  const StudyResult result = sample_result(30.0);
  const std::string html = print_study_report(result, {"repose study <boac2010>", "today"});
  for (const char* foreign : {"<script", "http://", "https://", "<boac2010>"}) {
    CHECK(count(html, foreign) == 0);
  }
  for (const StudyRun& run : result.study->runs) CHECK(count(html, ">" + run.run) > 0);
  for (const StudyVariant& variant : result.study->variants) {
    CHECK(count(html, escaped(variant.meaning)) > 0);
  }
  CHECK(count(html, "<svg class=\"chart\"") == 10);  // five kinds, two experiments each
  CHECK(count(html, "<tr>") == count(html, "</tr>"));
  CHECK(count(html, "<section") == count(html, "</section>"));
  CHECK(count(html, "nan<") == 0);
}

TEST_CASE("what agrees in every change is said to agree, whatever the offset", "[server]") {
  const std::string text = print_study_summary(sample_result(30.0));
  CHECK_THAT(text, Contains("Over 26 runs our bulk density is 30.0 kg/m3 above the paper's"));
  CHECK_THAT(text,
             Contains("Table 8, bulk density: the change against the base has the paper's sign in "
                      "13 of 13 runs"));
  // Static friction 0.35 has the base's angle in the paper: there is no sign to compare.
  CHECK_THAT(text,
             Contains("Table 8, static angle: the change against the base has the paper's sign in "
                      "12 of 12 runs"));
  CHECK_THAT(text, !Contains("opposite"));
}

TEST_CASE("a sample says how it failed", "[server]") {
  Sample sample;
  CHECK(sample_text(sample) == "-");
  sample.failed = 2;
  CHECK(sample_text(sample) == "failed");
  sample.values = {700.04};
  CHECK(sample_text(sample) == "700.0 *");
  CHECK(signed_text(0.04, 1) == "0.0");
  CHECK(signed_text(0.06, 1) == "+0.1");
}
