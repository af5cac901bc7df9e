#include "server/cli.hpp"

int main(int argc, char** argv) { return repose::server::run_command_line(argc, argv); }
