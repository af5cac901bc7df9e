/// Metrics: how many requests there were and how long they took, and the page of figures (the text
/// format of Prometheus, version 0.0.4).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "server/api/transport.hpp"
#include "server/service.hpp"

namespace repose::server {

class Metrics {
 public:
  /// `pattern` is the route's; empty where there was none.
  void count(std::string_view method, std::string_view pattern, int status, double seconds);

  /// The page: of the service, of the sockets, of the requests so far.
  [[nodiscard]] std::string print(const ServiceFigures& service,
                                  const TransportFigures& sockets) const;

 private:
  struct Times {
    static constexpr std::array<double, 9> bounds{
        0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.5, 2.5};  // s
    std::array<std::uint64_t, bounds.size()> within{};            // each holds those before it
    std::uint64_t all = 0;
    double seconds = 0.0;
  };
  mutable std::mutex mutex_;
  std::map<std::pair<std::string, int>, std::uint64_t> counts_;  ///< by "METHOD pattern", status
  Times times_;
};

}  // namespace repose::server
