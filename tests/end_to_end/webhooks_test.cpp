// A receiver on the loopback, told by a running service.
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "server/access/secret.hpp"
#include "server/webhooks/post.hpp"
#include "tests/support/api.hpp"
#include "tests/support/example.hpp"

namespace {

using namespace repose;
using namespace repose::tests;
using Json = nlohmann::ordered_json;

/// Keeps what is posted to it.
class Receiver {
 public:
  Receiver() {
    const auto keep = [this](const httplib::Request& request, httplib::Response& response) {
      const std::scoped_lock hold(mutex_);
      got_.push_back(request);
      response.status = answers_ > 0 ? answers_.load() : 200;
      if (answers_ == 302) response.set_header("Location", "/elsewhere");
      came_.notify_all();
    };
    server_.Post("/hook", keep);
    server_.Post("/elsewhere", keep);
    port_ = server_.bind_to_any_port("127.0.0.1");
    thread_ = std::thread([this] { server_.listen_after_bind(); });
  }
  ~Receiver() {
    server_.stop();
    thread_.join();
  }
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;

  [[nodiscard]] std::string url() const {
    return "http://127.0.0.1:" + std::to_string(port_) + "/hook";
  }
  void answer_with(int status) { answers_ = status; }
  /// The first so many, once they are there.
  std::vector<httplib::Request> first(std::size_t count) {
    std::unique_lock hold(mutex_);
    came_.wait_for(hold, std::chrono::minutes(2), [&] { return got_.size() >= count; });
    return got_;
  }

 private:
  httplib::Server server_;
  std::thread thread_;
  std::mutex mutex_;
  std::condition_variable came_;
  std::vector<httplib::Request> got_;
  std::atomic<int> answers_ = 0;
  int port_ = 0;
};

std::string study() { return example("valid/drop-minimal.json"); }

}  // namespace

TEST_CASE("a receiver is told what becomes of a calibration, and can check who says so",
          "[end_to_end]") {
  const TemporaryFolder folder;
  Receiver receiver;
  Api api(folder);
  const auto made = api.post_to(
      "/v1/webhooks",
      Json{{"url", receiver.url()}, {"events", {"calibration.queued", "calibration.done"}}}.dump());
  REQUIRE(made.status == 201);
  const std::string place = made.get_header_value("Location");
  const std::string secret = Json::parse(made.body)["secret"].get<std::string>();
  CHECK(api.get(place).body.find("secret") == std::string::npos);
  CHECK(api.get("/v1/webhooks").body.find(secret) == std::string::npos);

  api.submit(study());
  const auto got = receiver.first(2);
  REQUIRE(got.size() == 2);
  CHECK(Json::parse(got[0].body)["type"] == "calibration.queued");
  CHECK(Json::parse(got[1].body)["type"] == "calibration.done");
  CHECK(Json::parse(got[1].body)["data"]["calibration"] == 1);
  for (const auto& request : got) {
    const std::string text = request.get_header_value("webhook-id") + "." +
                             request.get_header_value("webhook-timestamp") + "." + request.body;
    const std::string key = server::from_base64(secret.substr(std::string("whsec_").size()));
    CHECK(request.get_header_value("webhook-signature") ==
          "v1," + server::base64(server::signature(key, text)));
  }
  CHECK(api.get("/metrics").body.find("repose_webhooks{state=\"active\"} 1") != std::string::npos);
  CHECK(api.remove(place).status == 200);
  CHECK(api.get(place).status == 404);
}

TEST_CASE("nobody can have the service speak to a host that only it can reach", "[end_to_end]") {
  Receiver receiver;
  const server::Message message{.url = receiver.url(), .fields = {}, .body = "{}"};
  const server::Posted refused = server::post_to_public({})(message, {});
  CHECK(refused.status == 0);
  CHECK(refused.account == "the address leads to a network that is not public");
  // A name that resolves to such a host is one too.
  server::Message named = message;
  named.url.replace(named.url.find("127.0.0.1"), 9, "localhost");
  CHECK(server::post_to_public({"127.0.0.1"})(named, {}).status == 0);
  receiver.answer_with(302);
  CHECK(server::post_to_public({"127.0.0.1"})(message, {}).status == 302);
  CHECK(receiver.first(1).size() == 1);  // the redirect was not followed
}
