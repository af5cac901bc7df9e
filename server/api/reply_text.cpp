#include "server/api/reply_text.hpp"

namespace repose::server {

namespace {

std::string print_head(const Reply& reply) {
  // The reason is for people; the titles of our problems say more than HTTP's phrases.
  std::string text = "HTTP/1.1 " + std::to_string(reply.status) +
                     (reply.status < 300 ? " OK\r\n" : " Refused\r\n");
  text += "Content-Type: " + reply.content_type + "\r\n";
  text += "X-Content-Type-Options: nosniff\r\nCache-Control: no-store\r\n";
  for (const auto& [name, value] : reply.headers) {
    text.append(name).append(": ").append(value).append("\r\n");
  }
  return text;
}

}  // namespace

std::string print_last_reply(const Reply& reply) {
  return print_head(reply) +
         "Connection: close\r\nContent-Length: " + std::to_string(reply.body.size()) + "\r\n\r\n" +
         reply.body;
}

std::string print_stream_head(const Reply& reply) {
  // The second line keeps nginx from gathering a stream into blocks.
  return print_head(reply) + "X-Accel-Buffering: no\r\nConnection: close\r\n\r\n" + reply.body;
}

}  // namespace repose::server
