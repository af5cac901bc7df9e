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

std::string print_honesty(std::span<const HonestyOfCase> cases) {
  Json list = Json::array();
  for (const auto& [name, honesty] : cases) {
    list.push_back({{"case", name},
                    {"studies", honesty.studies},
                    {"parameters", honesty.parameters},
                    {"posterior_90", number_or_null(honesty.posterior_90)},
                    {"profile_95", number_or_null(honesty.profile_95)},
                    {"misfit_ratio", number_or_null(honesty.misfit_ratio)},
                    {"declared_hits", honesty.declared},
                    {"false_hits", honesty.false_hits}});
  }
  return to_text(list, 2);
}

std::string print_warm_start(std::span<const WarmStartOfCase> cases) {
  Json list = Json::array();
  for (const WarmStartOfCase& one : cases) {
    list.push_back({{"case", one.name},
                    {"stored", one.stored},
                    {"median", count_or_null(one.median)},
                    {"p90", count_or_null(one.p90)}});
  }
  return to_text(list, 2);
}

}  // namespace repose::server
