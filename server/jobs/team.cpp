#include "server/jobs/team.hpp"

namespace repose::server {

engine::Team team_of(unsigned threads) {
  if (threads < 2) return {};
  return [threads](std::size_t parts, const std::function<void(std::size_t)>& work) {
  // Work never throws: the engine's hot loops have nothing to throw.
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (std::size_t part = 0; part < parts; ++part) work(part);
  };
}

}  // namespace repose::server
