#include "server/json/calibrator_bench_json.hpp"

#include "server/json/text.hpp"

namespace repose::server {

namespace {

Json count_or_null(const std::optional<int>& count) { return count ? Json(*count) : Json(); }

}  // namespace

std::string print_calibrator_bench(std::span<const BenchCase> cases) {
  Json list = Json::array();
  for (const BenchCase& one : cases) {
    Json methods = Json::array();
    for (const BenchMethod& method : one.methods) {
      methods.push_back({{"name", method.name},
                         {"median", count_or_null(method.median)},
                         {"p90", count_or_null(method.p90)},
                         {"share_within_40", method.share_within_40}});
    }
    list.push_back({{"case", one.name}, {"methods", std::move(methods)}});
  }
  return to_text(list.size() == 1 ? list.front() : list, 2);
}

}  // namespace repose::server
