// The commands of the service.
#include "server/cli/arguments.hpp"

namespace repose::server {

void add_serve(CLI::App& app, ServeCommand& options, Work& work) {
  CLI::App& command = *app.add_subcommand("serve", "Start the service: HTTP API and nights");
  command.add_option("--host", options.host, "Address to listen on")->capture_default_str();
  command.add_option("--port", options.port, "Port; 0 is any free one")
      ->capture_default_str()
      ->check(CLI::Range(0, 65535));
  command.add_option("--name", options.names, "Another name of this host that requests may use")
      ->type_name("HOST")
      ->expected(1)
      ->take_all();
  add_database(command, options.database);
  add_workers(command, options.workers);
  command
      .add_option("--webhook-host",
                  options.webhook_hosts,
                  "A host that is not public, and that webhooks may lead to all the same")
      ->type_name("HOST")
      ->expected(1)
      ->take_all();
  command
      .add_option("--time-limit", options.time_limit, "Seconds for one attempt at an evaluation")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 1e7));
  command
      .add_option("--memory-limit", options.memory_limit, "GiB for the process of an evaluation")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 1e4));
  does(command, options, serve_command, work);
}

void add_token(CLI::App& app, TokenCommand& options, Work& work) {
  CLI::App& token =
      *app.add_subcommand("token", "Make, list and revoke the tokens that users of the API send");
  token.require_subcommand(1);
  const auto add = [&](const char* name, const char* what, int (*run)(const TokenCommand&)) {
    CLI::App& command = *token.add_subcommand(name, what);
    add_database(command, options.database);
    does(command, options, run, work);
    return &command;
  };
  CLI::App& create = *add("create", "Make a token; it is shown this once", create_token_command);
  create.add_option("name", options.name, "Whose it is")->required();
  create.add_option("--scope", options.scope, "What it is good for")
      ->capture_default_str()
      ->check(CLI::IsMember({"read", "submit", "admin"}));
  create.add_option("--days", options.days, "Days until it expires (default: it does not)")
      ->check(CLI::Range(1, 36500));
  CLI::App& list = *add("list", "List the tokens", list_tokens_command);
  add_json(list, options.form, "One JSON object on standard output");
  CLI::App& revoke = *add("revoke", "Make a token worthless", revoke_token_command);
  revoke.add_option("id", options.id, "Which, as `repose token list` names it")->required();
}

}  // namespace repose::server
