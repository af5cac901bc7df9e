// The site that is shipped, on a socket file in place of a port and without its certificate.

#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/api.hpp"
#include "tests/support/not_tried.hpp"
#include "tests/support/wire.hpp"

namespace {

using namespace repose::tests;

std::string read(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// nginx in front of a service, as long as it lives.
class Proxy {
 public:
  Proxy(const TemporaryFolder& folder, int port) : socket_(folder / "nginx.sock") {
    std::string site = read(REPOSE_SOURCE_DIR "/server/deploy/nginx-repose.conf");
    const auto replace = [&](const char* what, const std::string& with) {
      REQUIRE(std::regex_search(site, std::regex(what)));
      site = std::regex_replace(site, std::regex(what), with);
    };
    replace("listen 443 ssl http2;", "listen unix:" + socket_ + ";");
    replace("ssl_[a-z_]* [^;]*;", "");
    replace("127.0.0.1:8080", "127.0.0.1:" + std::to_string(port));
    replace("repose.example", "localhost");
    const std::string here = folder.path().string();
    std::ofstream(folder / "nginx.conf")
        << "daemon off; worker_processes 1; pid " << here << "/pid; error_log " << here
        << "/error.log;\nevents { worker_connections 1024; }\nhttp { access_log off;\n"
        << "client_body_temp_path " << here << "/t1; proxy_temp_path " << here
        << "/t2; fastcgi_temp_path " << here << "/t3; uwsgi_temp_path " << here
        << "/t4; scgi_temp_path " << here << "/t5;\n"
        << site << "}\n";
    child_ = fork();
    if (child_ == 0) {
      const std::string configuration = folder / "nginx.conf";
      const std::string log = here + "/error.log";
      execl("/usr/sbin/nginx",
            "nginx",
            "-p",
            here.c_str(),
            "-e",
            log.c_str(),
            "-c",
            configuration.c_str(),
            nullptr);
      _exit(127);
    }
  }
  ~Proxy() {
    kill(child_, SIGTERM);
    waitpid(child_, nullptr, 0);
  }
  Proxy(const Proxy&) = delete;
  Proxy& operator=(const Proxy&) = delete;

  /// A connection, once nginx listens; the test ends where it does not.
  [[nodiscard]] Wire connect() const {
    while (waitpid(child_, nullptr, WNOHANG) == 0) {
      const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
      sockaddr_un address{};
      address.sun_family = AF_UNIX;
      socket_.copy(address.sun_path, sizeof address.sun_path - 1);
      if (::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
        return Wire::of(socket);
      }
      close(socket);
    }
    throw std::runtime_error("nginx did not start");
  }
  [[nodiscard]] std::string talk(const std::string& request) const {
    const Wire wire = connect();
    wire.send(request);
    return wire.rest();
  }

 private:
  std::string socket_;
  pid_t child_ = -1;
};

}  // namespace

TEST_CASE("the unit that is shipped answers for the name that the site passes on", "[end_to_end]") {
  const std::string site = read(REPOSE_SOURCE_DIR "/server/deploy/nginx-repose.conf");
  const std::string unit = read(REPOSE_SOURCE_DIR "/server/deploy/repose.service");
  std::smatch passed_on, answered_for;
  REQUIRE(std::regex_search(site, passed_on, std::regex("server_name ([^;]+);")));
  REQUIRE(std::regex_search(
      unit, answered_for, std::regex("\nExecStart=[^\n]* serve [^\n]*--name ([^ \n]+)")));
  CHECK(passed_on[1] == answered_for[1]);
}

TEST_CASE("every token that the shipped files make is made beside the database that is served",
          "[end_to_end]") {
  for (const char* name : {"nginx-repose.conf", "repose.service"}) {
    INFO(name);
    const std::string text = read(REPOSE_SOURCE_DIR "/server/deploy/" + std::string(name));
    CHECK(std::regex_search(text, std::regex("repose token create [^\n]* --db [^\n]+")));
  }
}

TEST_CASE("the site that is shipped serves, streams, and limits", "[end_to_end][slow]") {
  if (access("/usr/sbin/nginx", X_OK) != 0) {
    not_tried("nginx is not installed");
    return;
  }
  const TemporaryFolder folder;
  Api api(folder);
  const Proxy proxy(folder, api.port());
  const std::string head = " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n";

  const std::string alive = proxy.talk("GET /livez" + head + "\r\n");
  CHECK(has(alive, "200 OK"));
  CHECK(has(alive, "X-Request-Id: "));
  CHECK(has(proxy.talk("GET /v1/nothing" + head + "\r\n"), "application/problem+json"));
  CHECK(has(proxy.talk("POST /v1/calibrations" + head + "Content-Length: 1048577\r\n\r\n"), "413"));
  CHECK(has(proxy.talk("POST /v1/calibrations" + head +
                       "Content-Length: 6\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n"),
            "400"));

  const Wire stream = proxy.connect();
  stream.send("GET /v1/events?after=0 HTTP/1.1\r\nHost: localhost\r\n\r\n");
  CHECK(has(stream.until("retry: 2000"), "text/event-stream"));
  api.submit(read(REPOSE_SOURCE_DIR "/schemas/examples/valid/drop-minimal.json"));
  CHECK(has(stream.until("calibration.done"), "calibration.done"));

  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    refused += has(status_line(proxy.talk("GET /livez" + head + "\r\n")), "429") ? 1 : 0;
  }
  CHECK(refused > 0);
}
