#include "db/webhook_store.hpp"

#include <catch2/catch.hpp>

#include "tests/support/temporary_folder.hpp"

using namespace repose::db;
using repose::tests::TemporaryFolder;

TEST_CASE("what became of an event is kept: told, not for it, or failed", "[db]") {
  const TemporaryFolder folder;
  const Store store(folder / "a.db", Access::write);
  WebhookStore webhooks(store);
  const auto id = webhooks.add("https://a", "[]", "secret", 10);
  CHECK(webhooks.failed(*webhooks.webhook(id), "active", "it slept", 20));
  CHECK(webhooks.webhook(id)->failures == 1);
  CHECK(webhooks.webhook(id)->account == "it slept");
  CHECK(webhooks.due(19).empty());
  CHECK(webhooks.delivered(webhooks.due(20).at(0), 1));
  CHECK(webhooks.webhook(id)->failures == 0);
  CHECK_FALSE(webhooks.webhook(id)->account);
  CHECK(webhooks.passed_over(*webhooks.webhook(id), 5));
  CHECK(webhooks.webhook(id)->last_event == 5);
  CHECK(webhooks.figures().delivered == 1);
  CHECK(webhooks.figures().failed == 1);
}

TEST_CASE("what a delivery came to does not touch a webhook that was replaced meanwhile", "[db]") {
  const TemporaryFolder folder;
  const Store store(folder / "a.db", Access::write);
  WebhookStore webhooks(store);
  const auto id = webhooks.add("https://old", "[]", "secret", 10);
  const auto old = webhooks.webhook(id);
  REQUIRE(webhooks.replace(id, "https://new", "[]", std::nullopt, 0, 20));
  CHECK_FALSE(webhooks.failed(*old, "disabled", "it answered with status 410", 30));
  CHECK_FALSE(webhooks.delivered(*old, 1));
  CHECK_FALSE(webhooks.passed_over(*old, 1));
  const auto now = webhooks.webhook(id);
  CHECK(now->state == "active");
  CHECK(now->failures == 0);
  CHECK(now->failed == 0);
  CHECK(now->last_event == 0);
  CHECK(now->next_at == 20);
  CHECK_FALSE(now->account);
  CHECK(webhooks.delivered(*now, 1));

  REQUIRE(webhooks.remove(id));
  CHECK_FALSE(webhooks.failed(*now, "active", "it slept", 30));
}
