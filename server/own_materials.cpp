#include "server/own_materials.hpp"

#include <cstdint>
#include <optional>

#include "db/material_store.hpp"
#include "db/schedule_store.hpp"
#include "server/jobs/clock.hpp"
#include "server/json/material_library.hpp"
#include "server/json/own_material_json.hpp"
#include "server/measurements.hpp"
#include "server/nightly/nights.hpp"

namespace repose::server {

using engine::Unexpected;

namespace {

Refusal published(const std::string& name) {
  return {Refusal::Kind::wrong_state,
          "what is published of " + name + " does not change; keep your own under another name",
          {}};
}

/// The first schedule whose study leaves its grain to that material.
std::optional<std::int64_t> schedule_that_needs(db::Store& store, const std::string& name) {
  for (const auto& record : db::ScheduleStore(store).schedules()) {
    const auto schedule = read_schedule(store, record.request);
    if (!schedule) continue;
    const auto study = resolve_submission(store, schedule->submission);
    if (study && study->takes_grain && study->source.material == name) return record.id;
  }
  return std::nullopt;
}

}  // namespace

bool is_name(std::string_view text) {
  constexpr std::string_view letters =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-";
  constexpr std::size_t longest = 64;
  if (text == "." || text == "..") return false;  // an address that has them is another: RFC 3986
  return !text.empty() && text.size() <= longest &&
         text.find_first_not_of(letters) == std::string_view::npos;
}

Refusal no_name(const std::string& text) {
  return {Refusal::Kind::invalid,
          "it cannot have that name",
          {{"name",
            "a name stands in addresses",
            "\"" + text.substr(0, 64) + "\"",
            "1 to 64 letters, digits, dots, underscores and hyphens; neither . nor .."}}};
}

Answer<std::string> put_material(db::Store& store,
                                 const std::string& name,
                                 std::string_view content,
                                 bool may_replace) {
  if (!is_name(name)) return Unexpected{no_name(name)};
  if (find_material(name) != nullptr) return Unexpected{published(name)};
  const auto document = parse_own_material(content);
  if (!document) {
    return Unexpected{invalid("the material", document.error())};
  }
  db::MaterialStore materials(store);
  const auto before = materials.find(name);
  if (before && before->document == *document) return print_own_material(*before);
  if (before && !may_replace) {
    return Unexpected{Refusal{Refusal::Kind::unconditional,
                              "there is a " + name + " already; name the one you replace: If-Match",
                              {}}};
  }
  materials.put({name, microseconds_now(), *document});
  return print_own_material(*materials.find(name));
}

Answer<std::string> material(db::Store& store, const std::string& name) {
  if (find_material(name) != nullptr) return print_material(name);
  const auto own = db::MaterialStore(store).find(name);
  if (own) return print_own_material(*own);
  return Unexpected{Refusal{Refusal::Kind::not_found, no_such_material(name), {}}};
}

Answer<std::string> remove_material(db::Store& store, const std::string& name) {
  if (find_material(name) != nullptr) return Unexpected{published(name)};
  if (const auto schedule = schedule_that_needs(store, name)) {
    const std::string which = "schedule " + std::to_string(*schedule);
    return Unexpected{Refusal{Refusal::Kind::wrong_state,
                              which + " takes its grain from " + name + ": remove " + which +
                                  ", or give its study a grain, before",
                              {}}};
  }
  auto document = material(store, name);
  if (document) db::MaterialStore(store).remove(name);
  return document;
}

}  // namespace repose::server
