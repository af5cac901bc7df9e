/// Answers that say what went wrong (RFC 9457, application/problem+json).
#pragma once

#include <string>

#include "server/api/route.hpp"
#include "server/json/problem.hpp"

namespace repose::server {

struct Refusal;

Reply problem_reply(int status, std::string detail, Problems errors = {});

/// The status that a refusal of the service has in HTTP.
Reply problem_reply(const Refusal& refusal);

}  // namespace repose::server
