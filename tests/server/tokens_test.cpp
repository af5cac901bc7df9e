#include "server/access/tokens.hpp"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>
#include <vector>

#include <catch2/catch.hpp>

#include "server/access/secret.hpp"
#include "server/api/api.hpp"
#include "server/json/token_json.hpp"
#include "server/service.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace repose::server;
using repose::tests::TemporaryFolder;

namespace {

std::string read(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("a digest, a signature and base64 are those of the standards", "[server]") {
  CHECK(digest("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  // RFC 4231, test case 2.
  CHECK(base64(signature("Jefe", "what do ya want for nothing?")) ==
        "W9zBRr9gdU5qBCQmCJV1x1oAPwidJzmDnexYuWTsOEM=");
  // RFC 4648, section 10.
  for (const auto& [bytes, text] : {std::pair{"", ""},
                                    {"f", "Zg=="},
                                    {"fo", "Zm8="},
                                    {"foo", "Zm9v"},
                                    {"foob", "Zm9vYg=="},
                                    {"foobar", "Zm9vYmFy"}}) {
    CHECK(base64(bytes) == text);
    CHECK(from_base64(text) == bytes);
  }
  CHECK(base64_url("\xfb\xff") == "-_8");
  CHECK(from_base64("no base64").empty());
  CHECK(equal_secrets("abc", "abc"));
  CHECK_FALSE(equal_secrets("abc", "abd"));
  CHECK_FALSE(equal_secrets("abc", "ab"));
}

TEST_CASE("a token is known by its secret, which is nowhere kept", "[server]") {
  const TemporaryFolder folder;
  Tokens tokens(folder / "tokens");
  CHECK(tokens.all().empty());
  const std::string text = tokens.create("ada", Scope::submit, std::nullopt, 100);
  REQUIRE(text.size() > 50);
  const auto token = tokens.find("Bearer " + text);
  REQUIRE(token);
  CHECK(token->name == "ada");
  CHECK(tokens.find("bearer " + text));
  CHECK(scope_at(*token, 200) == Scope::submit);
  const std::string secret = text.substr(13);
  CHECK(read(folder / "tokens").find(secret) == std::string::npos);
  CHECK(read(folder / "tokens").find(digest(secret)) != std::string::npos);
  CHECK((std::filesystem::status(folder / "tokens").permissions() &
         (std::filesystem::perms::group_all | std::filesystem::perms::others_all)) ==
        std::filesystem::perms::none);
  CHECK(print_token_list(tokens.all(), 0).find(digest(secret)) == std::string::npos);
  std::string wrong = text;
  wrong.back() = wrong.back() == 'A' ? 'B' : 'A';
  for (const std::string& other : std::vector<std::string>{"",
                                                           text,
                                                           "Bearer",
                                                           "Bearer ",
                                                           "Bearer " + wrong,
                                                           "Basic " + text,
                                                           "Bearer " + text + "x",
                                                           "Bearer " + text.substr(0, 13),
                                                           "bearer rps_",
                                                           "Bearer rps_x"}) {
    INFO(other);
    CHECK_FALSE(tokens.find(other));
  }
}

TEST_CASE("a token ends when it expires or is revoked, in a running service too", "[server]") {
  const TemporaryFolder folder;
  Tokens command(folder / "tokens"), service(folder / "tokens");
  const std::string expiring = command.create("ada", Scope::admin, 1000, 100);
  const std::string kept = command.create("bob", Scope::read, std::nullopt, 100);
  CHECK(scope_at(*service.find("Bearer " + expiring), 999) == Scope::admin);
  CHECK(scope_at(*service.find("Bearer " + expiring), 1000) == Scope::nothing);
  CHECK(scope_at(*service.find("Bearer " + kept), 1000) == Scope::read);
  const std::string id = service.find("Bearer " + kept)->id;
  CHECK(command.revoke(id, 2000));
  CHECK_FALSE(command.revoke(id, 2001));
  CHECK_FALSE(command.revoke("nobody", 2001));
  CHECK(scope_at(*service.find("Bearer " + kept), 2001) == Scope::nothing);
}

TEST_CASE("two commands at once lose no token", "[server]") {
  const TemporaryFolder folder;
  std::vector<std::thread> commands;
  for (int i = 0; i < 8; ++i) {
    commands.emplace_back([&] {
      Tokens tokens(folder / "tokens");
      for (int k = 0; k < 5; ++k) tokens.create("n", Scope::read, std::nullopt, k);
    });
  }
  for (std::thread& command : commands) command.join();
  CHECK(Tokens(folder / "tokens").all().size() == 40);
}

TEST_CASE("a file that holds no tokens lets nobody in", "[server]") {
  const TemporaryFolder folder;
  for (const char* text : {"", "{}", "[]", R"({"tokens":[{"id":"a"}]})", "{\"tokens\":[]"}) {
    std::ofstream(folder / "tokens") << text;
    Tokens tokens(folder / "tokens");
    CHECK_THROWS_AS(tokens.all(), std::runtime_error);
  }
}

TEST_CASE("a file of tokens that is gone lets nobody in, one that comes lets its users in",
          "[server]") {
  const TemporaryFolder folder;
  Tokens command(folder / "tokens"), service(folder / "tokens");
  CHECK(service.all().empty());
  const std::string text = command.create("ada", Scope::admin, std::nullopt, 100);
  CHECK(service.find("Bearer " + text));
  std::filesystem::rename(folder / "tokens", folder / "elsewhere");
  CHECK_THROWS_AS(service.all(), std::runtime_error);
  CHECK_THROWS_AS(service.find("Bearer " + text), std::runtime_error);
  const std::string other = Tokens(folder / "tokens").create("bob", Scope::read, std::nullopt, 100);
  CHECK(service.find("Bearer " + other));
  CHECK_FALSE(service.find("Bearer " + text));
}

TEST_CASE("an event stream ends soon after the token of its reader", "[server]") {
  const TemporaryFolder folder;
  Tokens command(folder / "tokens"), tokens(folder / "tokens");
  ServiceOptions options;
  options.database = folder / "a.db";
  Service service(options);
  Api api(service, &tokens);
  const auto follow = [&](const std::string& token) {
    Request request;
    request.method = "GET";
    request.path = "/v1/events";
    request.fields["authorization"] = "Bearer " + token;
    return api.respond(request);
  };
  const Reply open = follow("none is needed yet");
  const std::string ada = command.create("ada", Scope::read, std::nullopt, 100);
  const std::string bob = command.create("bob", Scope::read, std::nullopt, 100);
  const Reply revoked = follow(ada), kept = follow(bob);
  REQUIRE(kept.stream);
  CHECK(revoked.stream().has_value());
  REQUIRE(command.revoke(command.find("Bearer " + ada)->id, 200));
  const auto ends = [](const Reply& reply) {
    const auto patience = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (reply.stream() && std::chrono::steady_clock::now() < patience) std::this_thread::yield();
    return !reply.stream();
  };
  CHECK(ends(revoked));
  CHECK(ends(open));  // since there are tokens, everyone needs one
  CHECK(kept.stream().has_value());
}
