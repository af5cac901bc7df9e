/// The command line of the laboratory: bench laboratory, bench fidelity, trends, explain.
#pragma once

#include <functional>
#include <string>

#include "server/cli/commands.hpp"

namespace CLI {
class App;
}

namespace repose::server {

struct LaboratoryOptions {
  Form costs = Form::text;
  LaboratoryCommand fidelity;
  LaboratoryCommand trends;
  std::string explained;
};

/// `bench` is the command that measures. What is read is kept in `options`; `work` becomes what to
/// do.
void add_laboratory(CLI::App& app,
                    CLI::App& bench,
                    LaboratoryOptions& options,
                    std::function<int()>& work);

}  // namespace repose::server
