// Events reach the addresses that want them: signed, in order, each until it has arrived.
#include <arpa/inet.h>
#include <chrono>
#include <fstream>
#include <future>
#include <netinet/in.h>
#include <set>
#include <stdexcept>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "db/event_store.hpp"
#include "db/schedule_store.hpp"
#include "db/webhook_store.hpp"
#include "server/access/secret.hpp"
#include "server/json/webhook_json.hpp"
#include "server/webhooks/address.hpp"
#include "server/webhooks/deliver.hpp"
#include "tests/support/captured_log.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace repose;
using namespace repose::server;
using repose::tests::CapturedLog;
using repose::tests::TemporaryFolder;

namespace {

constexpr std::int64_t second = 1'000'000;  // microseconds

/// A store, and a receiver that answers as it is told to.
struct Scene {
  Scene() : store(folder / "a.db", db::Access::write), webhooks(store) {}

  std::int64_t add(const std::vector<std::string>& kinds = {"calibration.*"}) {
    return webhooks.add("https://receiver.example/x", print_kinds(kinds), secret, 0);
  }
  /// So many events, each of a new calibration.
  void happen(int count) {
    for (int i = 0; i < count; ++i) store.add_calibration("study", "{}", "digest", 0);
  }
  void deliver(std::int64_t now) {
    deliver_due(
        store,
        [this](const Message& message, const std::stop_token&) {
          got.push_back(message);
          return answer;
        },
        [now] { return now; },
        {},
        failures);
  }
  [[nodiscard]] std::vector<std::string> ids() const {
    std::vector<std::string> result;
    for (const auto& message : got) result.push_back(field(message, "webhook-id"));
    return result;
  }
  [[nodiscard]] db::WebhookRecord row() const { return webhooks.webhooks().front(); }
  static std::string field(const Message& message, std::string_view name) {
    for (const auto& [key, value] : message.fields) {
      if (key == name) return value;
    }
    return {};
  }

  TemporaryFolder folder;
  FailureLog failures;
  db::Store store;
  db::WebhookStore webhooks;
  std::string secret = "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw";
  Posted answer{.status = 204};
  std::vector<Message> got;
};

using Ids = std::vector<std::string>;

}  // namespace

TEST_CASE("every event after its making arrives once, in order", "[server]") {
  Scene scene;
  scene.happen(2);
  scene.add();
  scene.happen(3);
  scene.deliver(1);
  scene.deliver(2);
  scene.happen(1);
  scene.deliver(3);
  CHECK(scene.ids() == Ids{"event_3", "event_4", "event_5", "event_6"});
  CHECK(scene.row().delivered == 4);
  CHECK(scene.got[0].body.find(R"({"type":"calibration.queued","timestamp":")") == 0);
  CHECK(scene.got[0].body.find(R"("data":{"calibration":3,)") != std::string::npos);
}

TEST_CASE("a receiver gets what it asked for, and a long row of other events costs one write",
          "[server]") {
  Scene scene;
  scene.add({"promotion", "calibration.cancelled"});
  scene.happen(150);
  scene.store.finish(150, "cancelled", {}, {}, {}, 1);
  scene.deliver(1);
  CHECK(scene.got.empty());
  CHECK(scene.row().last_event == 100);
  scene.deliver(2);
  CHECK(scene.ids() == Ids{"event_151"});
}

TEST_CASE("a signature is that of another implementation", "[server]") {
  // Of Python's hmac and base64 modules.
  CHECK(base64(signature(from_base64("MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw"),
                         "msg_p5jXN8AQM9LWM0D4loKWxJek.1614265330.{\"test\": 2432232314}")) ==
        "g0hM9SsE+OTPJTGt/tmIKtSyZlE3uFJELVlNIOLJ1OE=");
  Scene scene;
  scene.add();
  scene.happen(1);
  scene.deliver(7 * second + 1);
  const Message& message = scene.got.at(0);
  CHECK(Scene::field(message, "webhook-timestamp") == "7");
  CHECK(Scene::field(message, "webhook-signature") ==
        "v1," + base64(signature(from_base64("MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw"),
                                 "event_1.7." + message.body)));
}

TEST_CASE("a former secret signs beside the new one, until its day is over", "[server]") {
  Scene scene;
  const std::int64_t id = scene.add();
  scene.webhooks.replace(id, "https://b.example/", R"(["calibration.*"])", "whsec_AAAA", 100, 0);
  scene.happen(1);
  scene.deliver(99);
  scene.happen(1);
  scene.deliver(100);
  const std::string both = Scene::field(scene.got.at(0), "webhook-signature");
  const std::string one = Scene::field(scene.got.at(1), "webhook-signature");
  CHECK(scene.got[0].url == "https://b.example/");
  CHECK(both.find(" v1,") != std::string::npos);
  CHECK(one.find(' ') == std::string::npos);
  CHECK(one == "v1," + base64(signature(from_base64("AAAA"), "event_2.0." + scene.got[1].body)));
}

TEST_CASE("what does not arrive is sent again at its times, and then waits for somebody",
          "[server]") {
  Scene scene;
  const std::int64_t id = scene.add();
  scene.happen(2);
  scene.answer = {.status = 503};
  std::int64_t now = 0;
  scene.deliver(now);
  for (std::size_t i = 0; i < delivery_waits.size(); ++i) {
    const std::int64_t next = now + second * delivery_waits.at(i);
    scene.deliver(next - 1);
    CHECK(scene.got.size() == i + 1);
    CHECK(scene.row().state == "active");
    scene.deliver(next);
    CHECK(scene.got.size() == i + 2);
    now = next;
  }
  CHECK(scene.ids() == Ids(delivery_waits.size() + 1, "event_1"));
  CHECK(scene.row().state == "parked");
  CHECK(scene.row().account == "it answered with status 503");
  scene.happen(1);
  scene.deliver(now + 1'000'000 * second);
  CHECK(scene.got.size() == delivery_waits.size() + 1);

  scene.answer = {.status = 200};
  scene.got.clear();
  scene.webhooks.replace(id, "https://c.example/", R"(["calibration.*"])", {}, 0, now);
  scene.deliver(now);
  CHECK(scene.ids() == Ids{"event_1", "event_2", "event_3"});
}

TEST_CASE("each event has all its attempts", "[server]") {
  Scene scene;
  scene.add();
  scene.happen(2);
  scene.answer = {.status = 0, .account = "nobody there"};
  scene.deliver(0);
  CHECK(scene.row().account == "nobody there");
  scene.answer = {.status = 200};
  scene.deliver(second * delivery_waits[0]);
  CHECK(scene.row().failures == 0);
  CHECK(scene.ids() == Ids{"event_1", "event_1", "event_2"});
  CHECK_FALSE(scene.row().account.has_value());
}

TEST_CASE("a receiver that is gone is told nothing more, and a redirect is no arrival",
          "[server]") {
  Scene scene;
  scene.add();
  scene.happen(1);
  scene.answer = {.status = 302};
  scene.deliver(0);
  CHECK(scene.row().delivered == 0);
  scene.answer = {.status = 410};
  scene.deliver(second * delivery_waits[0]);
  CHECK(scene.row().state == "disabled");
  scene.deliver(1'000'000 * second);
  CHECK(scene.got.size() == 2);
}

TEST_CASE("a service that dies after an event has arrived sends it again under its number",
          "[server]") {
  Scene scene;
  scene.add();
  scene.happen(2);
  const Post dying = [&](const Message& message, const std::stop_token&) -> Posted {
    scene.got.push_back(message);
    throw std::runtime_error("killed");
  };
  deliver_due(
      scene.store, dying, [] { return 0; }, {}, scene.failures);
  scene.deliver(0);
  CHECK(scene.ids() == Ids{"event_1", "event_1", "event_2"});
  CHECK(scene.got[0].body == scene.got[1].body);
}

TEST_CASE("one deaf receiver does not keep the others waiting", "[server]") {
  Scene scene;
  scene.webhooks.add("https://deaf.example/", R"(["calibration.*"])", scene.secret, 0);
  scene.add();
  scene.happen(2);
  std::promise<void> others_told;
  auto others = others_told.get_future();
  bool waited_in_vain = false;
  deliver_due(
      scene.store,
      [&](const Message& message, const std::stop_token&) -> Posted {
        if (message.url.find("deaf") != std::string::npos) {
          waited_in_vain = others.wait_for(std::chrono::minutes(1)) != std::future_status::ready;
          return {.account = "no answer"};
        }
        scene.got.push_back(message);
        if (scene.got.size() == 2) others_told.set_value();
        return {.status = 200};
      },
      [] { return 0; },
      {},
      scene.failures);
  CHECK(scene.ids() == Ids{"event_1", "event_2"});
  CHECK_FALSE(waited_in_vain);
}

TEST_CASE("a slow receiver has some seconds a round, and each message the time at which it is sent",
          "[server]") {
  Scene scene;
  const std::int64_t id = scene.add();
  scene.happen(4);
  std::int64_t now = 0;
  const auto deliver = [&](int status, std::int64_t seconds) {
    deliver_due(
        scene.store,
        [&](const Message& message, const std::stop_token&) -> Posted {
          scene.got.push_back(message);
          now += seconds * second;
          return {.status = status};
        },
        [&] { return now; },
        {},
        scene.failures);
  };
  deliver(200, 2);
  CHECK(scene.ids() == Ids{"event_1", "event_2", "event_3"});
  std::vector<std::string> times;
  for (const Message& message : scene.got) {
    times.push_back(Scene::field(message, "webhook-timestamp"));
  }
  CHECK(times == std::vector<std::string>{"0", "2", "4"});
  now = 100 * second;
  deliver(503, 9);
  CHECK(scene.webhooks.webhook(id)->next_at == (109 + delivery_waits[0]) * second);
}

TEST_CASE("a webhook that fails here is told in the log once, and keeps no other one waiting",
          "[server]") {
  const CapturedLog log;
  Scene scene;
  scene.webhooks.add("https://broken.example/", R"(["calibration.*"])", scene.secret, 0);
  scene.add();
  scene.happen(2);
  for (const std::int64_t now : {0, 1}) {
    deliver_due(
        scene.store,
        [&](const Message& message, const std::stop_token&) -> Posted {
          if (message.url.find("broken") != std::string::npos) {
            throw std::runtime_error("libcurl does not start");
          }
          scene.got.push_back(message);
          return {.status = 200};
        },
        [now] { return now; },
        {},
        scene.failures);
  }
  CHECK(scene.ids() == Ids{"event_1", "event_2"});
  CHECK(log.text() == "repose: webhook 1 failed: libcurl does not start\n");
}

TEST_CASE("a quantity that drifts is told", "[server]") {
  Scene scene;
  scene.add({"night.*"});
  db::ScheduleStore schedules(scene.store);
  const auto night = schedules.begin_night(schedules.add("s", "{}", 0), 1, 1);
  REQUIRE(night.has_value());
  schedules.end_night(
      *night, {.state = "done", .outcome = "moved", .result = R"({"alarms":["x"]})"}, 2);
  scene.deliver(3);
  REQUIRE(scene.got.size() == 2);
  // One change makes both, in whatever order.
  std::set<std::string> types;
  for (const auto& message : scene.got) {
    const auto body = nlohmann::json::parse(message.body);
    types.insert(body["type"]);
    CHECK(message.body.find(R"("alarms":["x"])") != std::string::npos);
  }
  CHECK(types == std::set<std::string>{"night.drift", "night.moved"});
  CHECK(db::EventStore(scene.store).drift_alarms() == 1);
}

namespace {

/// Of either family, as a socket would be opened to it.
bool is_public_in_digits(const char* digits) {
  sockaddr_in four{};
  four.sin_family = AF_INET;
  if (inet_pton(AF_INET, digits, &four.sin_addr) == 1) {
    return is_public(reinterpret_cast<const sockaddr&>(four));
  }
  sockaddr_in6 six{};
  six.sin6_family = AF_INET6;
  REQUIRE(inet_pton(AF_INET6, digits, &six.sin6_addr) == 1);
  return is_public(reinterpret_cast<const sockaddr&>(six));
}

}  // namespace

TEST_CASE("an address within a network is told from a public one", "[server]") {
  for (const char* inside : {"127.0.0.1",
                             "127.255.255.255",
                             "0.0.0.0",
                             "10.1.2.3",
                             "172.16.0.1",
                             "172.31.255.255",
                             "192.168.1.1",
                             "169.254.169.254",
                             "100.64.0.1",
                             "224.0.0.1",
                             "255.255.255.255",
                             "192.0.2.1",
                             "198.19.255.255",
                             "::1",
                             "::",
                             "fe80::1",
                             "fd00::1",
                             "ff02::1",
                             "::ffff:127.0.0.1",
                             "::ffff:8.8.8.8",
                             "64:ff9b::7f00:1",
                             "2002:7f00:1::",
                             "2001::1",
                             "2001:db8::1"}) {
    INFO(inside);
    CHECK_FALSE(is_public_in_digits(inside));
  }
  for (const char* outside : {"8.8.8.8",
                              "172.15.0.1",
                              "172.32.0.1",
                              "100.63.255.255",
                              "198.20.0.1",
                              "223.255.255.255",
                              "2a00:1450:4001::1",
                              "2001:200::1",
                              "2606:4700::1"}) {
    INFO(outside);
    CHECK(is_public_in_digits(outside));
  }
}

TEST_CASE("a webhook with problems is refused with all of them", "[server]") {
  const auto problems = [](std::string_view text, const std::vector<std::string>& hosts = {}) {
    const auto read = parse_webhook(text, hosts);
    std::vector<std::string> pointers;
    if (!read) {
      for (const auto& problem : read.error()) pointers.push_back(problem.pointer);
    }
    return pointers;
  };
  using Pointers = std::vector<std::string>;
  CHECK(problems(R"({"url":"https://a.example/x"})").empty());
  CHECK(problems(R"({"url":"http://a.example/x"})") == Pointers{"/url"});
  CHECK(problems(R"({"url":"http://a.example/x"})", {"a.example"}).empty());
  for (const char* url : {"ftp://a.example/",
                          "file:///etc/passwd",
                          "https://user:word@a.example/",
                          "a.example",
                          "https://",
                          ""}) {
    INFO(url);
    CHECK(problems(std::string(R"({"url":")") + url + "\"}") == Pointers{"/url"});
  }
  CHECK(problems(R"({"events":["night.*","x"],"new_secret":1,"colour":"red"})") ==
        Pointers{"/url", "/colour", "/events/1", "/new_secret"});
  CHECK(problems(R"({"url":"https://a.example/","events":[]})") == Pointers{"/events"});
}

TEST_CASE("the schema of webhooks names the kinds of events that the program knows", "[server]") {
  std::ifstream file(REPOSE_SOURCE_DIR "/schemas/webhook.schema.json");
  const auto schema = nlohmann::json::parse(file);
  const auto named = schema["properties"]["events"]["items"]["enum"];
  CHECK(named == nlohmann::json(std::vector<std::string>(event_kinds.begin(), event_kinds.end())));
}
