#include <algorithm>
#include <cstdint>
#include <iostream>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "server/access/tokens.hpp"
#include "server/api/api.hpp"
#include "server/api/http_server.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/exit_code.hpp"
#include "server/cli/input.hpp"
#include "server/cli/interrupt.hpp"
#include "server/service.hpp"

namespace repose::server {

namespace {

bool is_loopback(std::string_view host) {
  return host == "localhost" || host == "::1" || host.starts_with("127.");
}

/// The first of its names that others reach it by: its own, or that of a proxy in front.
std::optional<std::string> public_name(const ServeCommand& command) {
  if (!is_loopback(command.host)) return command.host;
  const auto name = std::ranges::find_if_not(command.names, is_loopback);
  if (name == command.names.end()) return std::nullopt;
  return *name;
}

}  // namespace

int serve_command(const ServeCommand& command) {
  ServiceOptions options;
  options.database = command.database;
  options.workers = command.workers;
  options.program = own_program();
  options.run_jobs = true;
  options.webhook_hosts = command.webhook_hosts;
  options.evaluation_time_limit = command.time_limit;
  options.evaluation_memory_limit = static_cast<std::uint64_t>(command.memory_limit * (1U << 30U));
  Tokens tokens(Tokens::file_for(command.database));
  const bool open = tokens.all().empty();
  if (const auto name = public_name(command); open && name) {
    std::cerr << "repose: " << *name
              << " can be reached by others, and there are no tokens yet;\n"
                 "  make one with `repose token create NAME --scope submit`, or serve on "
                 "127.0.0.1 without --name\n";
    return exit_code::misused;
  }
  const Interrupt interrupt;
  Service service(options);
  Api api(service, &tokens);
  HttpServer server(api, {.host = command.host, .port = command.port, .names = command.names});
  const std::stop_callback stop(interrupt.token(), [&server] { server.stop(); });
  if (open) std::cerr << "repose: there are no tokens: every user of this machine may use it\n";
  std::cout << "http://" << command.host << ":" << server.port() << "/" << std::endl;
  server.run();
  std::cerr << "repose: stopped; unfinished calibrations go on at the next start\n";
  return exit_code::done;
}

}  // namespace repose::server
