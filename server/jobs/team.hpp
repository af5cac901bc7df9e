/// Threads lent to one run: see engine/team.hpp.
#pragma once

#include "engine/team.hpp"

namespace repose::server {

/// A team of that many threads, the caller's among them; empty for one.
engine::Team team_of(unsigned threads);

}  // namespace repose::server
