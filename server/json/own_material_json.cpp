#include "server/json/own_material_json.hpp"

#include "server/json/labels.hpp"
#include "server/json/material_library.hpp"
#include "server/json/place.hpp"
#include "server/json/study.hpp"
#include "server/json/text.hpp"

namespace repose::server {

engine::Result<std::string, Problems> parse_own_material(std::string_view text) {
  constexpr std::size_t longest_title = 200;
  ProblemList problems;
  const auto json = parse_text(text, {}, problems);
  if (!json) return engine::Unexpected{problems.all()};
  Members members(Place(&*json, "", problems));
  const Place title_place = members.required("title", "what people call it");
  const Place grain = members.required("grain", "properties, as under materials in a study");
  members.no_others();
  std::string title;
  check_label(title_place);
  if (title_place.exists()) title = title_place.text(longest_title).value_or("");
  if (grain.exists()) {
    // Checked where studies are: under the name that it has there.
    const Json materials{{"grain", grain.json()}};
    Study study;
    read_materials(Place(&materials, "", problems), study);
  }
  if (!problems.empty()) return engine::Unexpected{problems.all()};
  return to_text(Json{{"title", title}, {"grain", grain.json()}});
}

std::string print_own_material(const db::MaterialRecord& material) {
  const Json document = Json::parse(material.document);
  return to_text(Json{{"name", material.name},
                      {"title", document["title"]},
                      {"origin", "own"},
                      {"created_at", print_time(material.created_at)},
                      {"grain", document["grain"]}});
}

std::string print_all_materials(const std::vector<db::MaterialRecord>& own) {
  Json list = Json::parse(print_material_list());
  for (Json& item : list["items"]) item["origin"] = "published";
  for (const auto& material : own) {
    const Json document = Json::parse(material.document);
    Json properties = Json::array();
    for (const auto& [name, value] : document["grain"].items()) {
      properties.push_back("material." + name + ":grain");
    }
    list["items"].push_back({{"name", material.name},
                             {"title", document["title"]},
                             {"properties", std::move(properties)},
                             {"origin", "own"}});
  }
  return to_text(list);
}

bool has_grain(std::string_view study) {
  const Json json = Json::parse(study);
  return json.contains("materials") &&
         (!json["materials"].is_object() || json["materials"].contains("grain"));
}

std::string with_grain(std::string_view study, std::string_view material) {
  if (has_grain(study)) return std::string(study);
  Json json = Json::parse(study);
  json["materials"]["grain"] = Json::parse(material)["grain"];
  return to_text(json);
}

}  // namespace repose::server
