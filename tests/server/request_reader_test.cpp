#include "server/api/request_reader.hpp"

#include <random>
#include <string>

#include <catch2/catch.hpp>

namespace {

using repose::server::largest_body;
using repose::server::largest_head;
using repose::server::RequestReader;
using Progress = RequestReader::Progress;

const std::vector<std::string> no_names;
const std::string get = "GET /x HTTP/1.1\r\nHost: localhost\r\n\r\n";
const std::string post = "POST /x HTTP/1.1\r\nHost: localhost\r\nContent-Length: 3\r\n\r\nabc";

/// The status with which it is refused, 0 where it is not.
int status(const std::string& bytes) {
  RequestReader reader(no_names);
  reader.append(bytes);
  return reader.advance() == Progress::refused ? reader.refusal().status : 0;
}

}  // namespace

TEST_CASE("a request is whole at its last byte and not before", "[server]") {
  RequestReader reader(no_names);
  CHECK(reader.advance() == Progress::empty);
  for (std::size_t i = 0; i < post.size(); ++i) {
    INFO(i);
    CHECK(reader.advance() != Progress::whole);
    reader.append(post.substr(i, 1));
  }
  REQUIRE(reader.advance() == Progress::whole);
  CHECK(reader.take().text == post);
  CHECK(reader.advance() == Progress::empty);
}

TEST_CASE("requests that come in one piece are read one after the other", "[server]") {
  RequestReader reader(no_names);
  reader.append(post + "\r\n" + get + post);
  for (const std::string& expected : {post, get, post}) {
    REQUIRE(reader.advance() == Progress::whole);
    CHECK(reader.take().text == expected);
  }
  CHECK(reader.advance() == Progress::empty);
}

TEST_CASE("only fields that are read are handed on, and as they came", "[server]") {
  RequestReader reader(no_names);
  reader.append(
      "GET /a%20b?c=%0D%0A HTTP/1.1\r\nHost: localhost\r\nREMOTE_ADDR: 6.6.6.6\r\nRange: "
      "bytes=0-\r\nif-match: \"a%0D%0Ab\"\r\nIf-Match: c\r\n\r\n");
  REQUIRE(reader.advance() == Progress::whole);
  CHECK(reader.take().text ==
        "GET /a%20b?c=%0D%0A HTTP/1.1\r\nHost: localhost\r\nIf-Match: \"a%250D%250Ab\", c\r\n\r\n");
}

TEST_CASE("a client that waits for leave to send is given it once, and only then", "[server]") {
  const std::string head =
      "POST /x HTTP/1.1\r\nHost: localhost\r\nExpect: 100-continue\r\nContent-Length: 3\r\n\r\n";
  RequestReader waits(no_names);
  waits.append(head);
  CHECK(waits.advance() == Progress::body);
  CHECK(waits.take_expectation());
  CHECK_FALSE(waits.take_expectation());
  RequestReader hurries(no_names);
  hurries.append(head + "abc");
  CHECK(hurries.advance() == Progress::whole);
  CHECK_FALSE(hurries.take_expectation());
}

TEST_CASE("the connection ends where the client or its version says so", "[server]") {
  const auto keeps_alive = [](const std::string& bytes) {
    RequestReader reader(no_names);
    reader.append(bytes);
    REQUIRE(reader.advance() == Progress::whole);
    return reader.take().keeps_alive;
  };
  CHECK(keeps_alive(get));
  CHECK_FALSE(keeps_alive("GET /x HTTP/1.0\r\nHost: localhost\r\n\r\n"));
  CHECK_FALSE(keeps_alive("GET /x HTTP/1.1\r\nHost: localhost\r\nconnection: CLOSE\r\n\r\n"));
}

TEST_CASE("a head that never ends is refused at its limit", "[server]") {
  RequestReader reader(no_names);
  const std::string block(1000, 'x');
  reader.append("GET /x HTTP/1.1\r\nX: ");
  std::size_t sent = 0;
  while (reader.advance() != Progress::refused && sent < 10 * largest_head) {
    reader.append(block);
    sent += block.size();
  }
  CHECK(reader.refusal().status == 431);
  CHECK(sent <= largest_head + block.size());
  CHECK(reader.size() == 0);
}

TEST_CASE("a body is refused by what its head announces, before it comes", "[server]") {
  const auto announcing = [](std::size_t size) {
    return "POST /x HTTP/1.1\r\nHost: localhost\r\nContent-Length: " + std::to_string(size) +
           "\r\n\r\n";
  };
  CHECK(status(announcing(largest_body)) == 0);
  CHECK(status(announcing(largest_body + 1)) == 413);
  CHECK(status(announcing(999'999'999'999'999'999)) == 413);
}

TEST_CASE("whatever bytes come, in whatever pieces, a request is whole or refused or waits",
          "[server]") {
  const std::vector<std::string> words{"GET ",
                                       "POST ",
                                       "/",
                                       " HTTP/1.1",
                                       "\r\n",
                                       "\r\n\r\n",
                                       "Host: ",
                                       ":",
                                       "localhost",
                                       "Content-Length: ",
                                       "3",
                                       "Transfer-Encoding: chunked",
                                       "\0x",
                                       "\n",
                                       "\r",
                                       " ",
                                       "abc"};
  std::mt19937_64 random(7);
  int whole = 0, refused = 0;
  for (int i = 0; i < 20000; ++i) {
    RequestReader reader(no_names);
    // Half of them begin well, so that they come further.
    if (random() % 2 == 0) reader.append("GET /x HTTP/1.1\r\nHost: localhost\r\n");
    for (int k = 0; k < 12 && reader.progress() != Progress::refused; ++k) {
      reader.append(words[random() % words.size()]);
      if (reader.advance() == Progress::whole) {
        ++whole;
        CHECK(reader.take().text.find("\r\n\r\n") != std::string::npos);
      }
    }
    refused += reader.progress() == Progress::refused ? 1 : 0;
    CHECK(reader.size() <= largest_head + largest_body);
  }
  CHECK(whole > 100);
  CHECK(refused > 100);
}
