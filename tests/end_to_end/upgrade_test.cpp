// The program's file is replaced while a service runs, as a package manager does it.
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/example.hpp"
#include "tests/support/served.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fs = std::filesystem;
using Json = nlohmann::json;
using repose::tests::example;
using repose::tests::repose_program;
using repose::tests::Served;
using repose::tests::TemporaryFolder;

namespace {

std::string drop_study() { return example("valid/drop-minimal.json"); }

/// Puts a program of another version in the place of that one.
void replace(const fs::path& program) {
  const fs::path next = program.string() + ".next";
  std::ofstream(next) << "#!/bin/sh\n'" << repose_program
                      << R"(' answer | sed 's/"engine_version":"/&other-/')"
                      << "\n";
  fs::permissions(next, fs::perms::owner_all);
  fs::rename(next, program);
}

}  // namespace

TEST_CASE("a service whose program is replaced goes on with the one that it is", "[end_to_end]") {
  const TemporaryFolder folder;
  const fs::path program = folder / "repose";
  fs::copy_file(repose_program, program);
  // The shell takes the words of the service for its own, the program's name among them.
  const Served service((folder / "a.db").string(),
                       {"sh", "-c", "exec '" + program.string() + "' \"$@\""});
  replace(program);
  const auto client = service.client();
  REQUIRE(client->Post("/v1/calibrations", drop_study(), "application/json")->status == 202);
  Json document;
  do {
    document = Json::parse(client->Get("/v1/calibrations/1")->body);
    std::this_thread::yield();
  } while (document["finished_at"].is_null());
  CHECK(document["state"] == "done");
  CHECK(document["fit"]["parameters"].size() == 1);
  const std::string metrics = client->Get("/metrics")->body;
  CHECK(metrics.find("end=\"refused\"") == std::string::npos);
}
