#include <iostream>
#include <stop_token>

#include "server/api/http_server.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/exit_code.hpp"
#include "server/cli/input.hpp"
#include "server/cli/interrupt.hpp"
#include "server/service.hpp"

namespace repose::server {

int serve_command(const ServeCommand& command) {
  ServiceOptions options;
  options.database = command.database;
  options.workers = command.workers;
  options.program = own_program();
  options.run_jobs = true;
  const Interrupt interrupt;
  Service service(options);
  HttpServer server(service, {.host = command.host, .port = command.port, .names = command.names});
  const std::stop_callback stop(interrupt.token(), [&server] { server.stop(); });
  std::cout << "http://" << command.host << ":" << server.port() << "/" << std::endl;
  server.run();
  std::cerr << "repose: stopped; unfinished calibrations go on at the next start\n";
  return exit_code::done;
}

}  // namespace repose::server
