/// Runs a published study through a store and its workers. What the store has is not run again, so
/// a study that was interrupted, or killed, goes on where it was when it is asked for again.
#pragma once

#include <cstddef>
#include <functional>
#include <stop_token>
#include <string_view>

#include "server/jobs/workers.hpp"
#include "server/studies/study_result.hpp"

namespace repose::server {

/// Told after each trial: the part of the study, done and all of it, and whether the store had it.
using StudyObserver =
    std::function<void(std::string_view part, std::size_t done, std::size_t all, bool stored)>;

/// Where it was asked to stop, what was complete by then: missing counts the rest, and there is no
/// search.
StudyResult run_study(const PublishedStudy& study,
                      StudySize size,
                      Workers& workers,
                      const std::stop_token& stop,
                      const StudyObserver& observer);

}  // namespace repose::server
