#include "server/json/reply_json.hpp"

#include "server/json/text.hpp"

namespace repose::server {

std::string print_reply(const Reply& reply) {
  Json headers = Json::object();
  for (const auto& [name, value] : reply.headers) headers[name] = value;
  return to_text(Json{{"status", reply.status},
                      {"content_type", reply.content_type},
                      {"headers", std::move(headers)},
                      {"body", reply.body}});
}

Reply read_reply(std::string_view text) {
  const Json json = Json::parse(text);
  Reply reply{.status = json["status"].get<int>(),
              .body = json["body"].get<std::string>(),
              .content_type = json["content_type"].get<std::string>()};
  for (const auto& [name, value] : json["headers"].items()) {
    reply.headers.emplace_back(name, value.get<std::string>());
  }
  return reply;
}

}  // namespace repose::server
