#include "server/api/metrics.hpp"

#include <cstdio>

namespace repose::server {

namespace {

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return text.data();
}

void describe(std::string& page,
              std::string_view name,
              std::string_view kind,
              std::string_view what) {
  page.append("# HELP ").append(name).append(" ").append(what).append("\n");
  page.append("# TYPE ").append(name).append(" ").append(kind).append("\n");
}

/// Counts by the one label of theirs, whose values are ours.
template <class Counts>
void counts_by(std::string& page,
               std::string_view name,
               std::string_view kind,
               std::string_view what,
               std::string_view label,
               const Counts& counts) {
  describe(page, name, kind, what);
  for (const auto& [value, count] : counts) {
    page.append(name).append("{").append(label).append("=\"").append(value).append("\"} ");
    page.append(std::to_string(count)).append("\n");
  }
}

void gauge(std::string& page, std::string_view name, std::string_view what, double value) {
  describe(page, name, "gauge", what);
  page.append(name).append(" ").append(number(value)).append("\n");
}

void counter(std::string& page, std::string_view name, std::string_view what, double value) {
  describe(page, name, "counter", what);
  page.append(name).append(" ").append(number(value)).append("\n");
}

void print_service(std::string& page, const ServiceFigures& figures) {
  describe(page, "repose_build_info", "gauge", "The engine's version.");
  page += "repose_build_info{engine_version=\"" + figures.engine_version + "\"} 1\n";
  counts_by(page, "repose_calibrations", "gauge", "Calibrations by state.", "state", figures.jobs);
  counts_by(page,
            "repose_attempts_total",
            "counter",
            "Attempts at evaluations by how they ended.",
            "end",
            figures.attempts);
  counter(page,
          "repose_evaluations_total",
          "Evaluations in the store.",
          static_cast<double>(figures.store.evaluations));
  counter(
      page, "repose_evaluation_seconds_total", "Wall time that they took.", figures.store.seconds);
  counter(page,
          "repose_events_total",
          "Events in the store.",
          static_cast<double>(figures.store.events));
  gauge(page,
        "repose_database_bytes",
        "Size of the database.",
        static_cast<double>(figures.store.database_bytes));
  gauge(page,
        "repose_database_log_bytes",
        "Size of its write-ahead log.",
        static_cast<double>(figures.store.log_bytes));
}

/// A value of a label: what a user has named may hold anything.
std::string label(std::string_view text) {
  std::string result;
  for (const char letter : text) {
    if (letter == '\n') {
      result += "\\n";
      continue;
    }
    if (letter == '"' || letter == '\\') result += '\\';
    result += letter;
  }
  return result;
}

void print_drift(std::string& page, const ServiceFigures& figures) {
  counter(page,
          "repose_drift_alarms_total",
          "Nights that told of a quantity that drifts.",
          static_cast<double>(figures.drift_alarms));
  const auto print = [&](std::string_view name, std::string_view what, double DriftFigure::*value) {
    describe(page, name, "gauge", what);
    for (const DriftFigure& figure : figures.drift) {
      page.append(name).append("{schedule=\"" + std::to_string(figure.schedule) + "\",quantity=\"" +
                               label(figure.quantity) + "\"} " + number(figure.*value) + "\n");
    }
  };
  print("repose_drift_level", "Of each quantity's control chart.", &DriftFigure::level);
  print("repose_drift_limit",
        "Of that level, from zero: beyond it is an alarm.",
        &DriftFigure::limit);
}

void print_webhooks(std::string& page, const db::WebhookFigures& figures) {
  counts_by(page, "repose_webhooks", "gauge", "Webhooks by state.", "state", figures.states);
  gauge(page,
        "repose_webhook_deliveries",
        "Events that have arrived, of the webhooks there are.",
        static_cast<double>(figures.delivered));
  gauge(page,
        "repose_webhook_failures",
        "Attempts that have failed, of the webhooks there are.",
        static_cast<double>(figures.failed));
}

void print_sockets(std::string& page, const TransportFigures& sockets) {
  gauge(page, "repose_connections", "Open connections.", static_cast<double>(sockets.connections));
  gauge(page, "repose_event_streams", "Open event streams.", static_cast<double>(sockets.streams));
  gauge(page,
        "repose_requests_waiting",
        "Requests that wait for a thread.",
        static_cast<double>(sockets.waiting));
}

}  // namespace

void Metrics::count(std::string_view method, std::string_view pattern, int status, double seconds) {
  const std::scoped_lock hold(mutex_);
  // Paths and methods that we do not have are one, or a scanner would fill the memory.
  std::string route = pattern.empty() ? "none" : std::string(method).append(" ").append(pattern);
  ++counts_[{std::move(route), status}];
  for (std::size_t i = 0; i < Times::bounds.size(); ++i) {
    if (seconds <= Times::bounds[i]) ++times_.within[i];
  }
  ++times_.all;
  times_.seconds += seconds;
}

std::string Metrics::print(const ServiceFigures& service, const TransportFigures& sockets) const {
  std::string page;
  print_service(page, service);
  print_drift(page, service);
  print_webhooks(page, service.webhooks);
  print_sockets(page, sockets);
  const std::scoped_lock hold(mutex_);
  describe(page, "repose_requests_total", "counter", "Requests by route and status.");
  for (const auto& [key, count] : counts_) {
    page += "repose_requests_total{route=\"" + key.first + "\",status=\"" +
            std::to_string(key.second) + "\"} " + std::to_string(count) + "\n";
  }
  describe(page, "repose_request_seconds", "histogram", "Time to work out an answer.");
  for (std::size_t i = 0; i < Times::bounds.size(); ++i) {
    page += "repose_request_seconds_bucket{le=\"" + number(Times::bounds[i]) + "\"} " +
            std::to_string(times_.within[i]) + "\n";
  }
  page += "repose_request_seconds_bucket{le=\"+Inf\"} " + std::to_string(times_.all) + "\n";
  page += "repose_request_seconds_sum " + number(times_.seconds) + "\n";
  page += "repose_request_seconds_count " + std::to_string(times_.all) + "\n";
  return page;
}

}  // namespace repose::server
