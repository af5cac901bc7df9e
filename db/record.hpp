/// Records: the rows of the store. Plain columns to find a row by, beside a document's text.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace repose::db {

/// A calibration as the store keeps it. Times are microseconds since 1970 UTC.
struct CalibrationRecord {
  std::int64_t id = 0;
  std::string name;
  std::string state;  ///< queued, running, done, failed, cancelled
  std::int64_t created_at = 0;
  std::optional<std::int64_t> started_at;
  std::optional<std::int64_t> finished_at;
  std::string request;  ///< the study document
  std::string request_digest;
  std::optional<std::string> progress;  ///< document
  std::optional<std::string> fit;       ///< document
  std::optional<double> misfit;
  std::optional<std::string> error;
};

/// A diagnosis as the store keeps it.
struct DiagnosisRecord {
  std::int64_t id = 0;
  std::int64_t calibration = 0;
  std::string state;  ///< as a calibration's
  std::int64_t created_at = 0;
  std::optional<std::int64_t> finished_at;
  std::string request;                  ///< document
  std::optional<std::string> progress;  ///< document
  std::optional<std::string> result;    ///< document
  std::optional<std::string> error;
};

/// An evaluation, named by the digest of its question.
struct EvaluationRecord {
  std::string key;
  std::string question;
  std::string answer;
  double seconds = 0.0;  ///< wall time it took
  std::string engine_version;
  std::int64_t created_at = 0;
};

/// An evaluation as one calibration used it.
struct UsedEvaluation {
  std::int64_t ordinal = 0;
  EvaluationRecord evaluation;
};

}  // namespace repose::db
