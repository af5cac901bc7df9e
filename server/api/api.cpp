#include "server/api/api.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <iostream>
#include <random>
#include <utility>

#include "db/store.hpp"
#include "server/access/secret.hpp"
#include "server/api/conditional.hpp"
#include "server/api/page_link.hpp"
#include "server/api/problem.hpp"
#include "server/jobs/clock.hpp"
#include "server/json/reply_json.hpp"
#include "server/service.hpp"

namespace repose::server {

namespace {

constexpr std::size_t longest_key = 64;  // of those that clients choose

/// Letters that may go into a log or a header as they are.
bool is_plain(std::string_view text) {
  return !text.empty() && text.size() <= longest_key && std::ranges::all_of(text, [](char c) {
    return c > ' ' && c < 0x7f && c != '"' && c != '\\';
  });
}

/// The client's, where it is one that can be repeated; else a new one.
std::string request_id(const Request& request) {
  std::string given = request.field("x-request-id");
  return is_plain(given) ? given : new_request_id();
}

bool reads(const Request& request) { return request.method == "GET" || request.method == "HEAD"; }

void log_failure(const Request& request, const std::string& id, const char* what) {
  std::clog << "http: " + id + " " + request.method + " " + request.path + " failed: " + what +
                   "\n";
}

/// What the store could not do is tried again; all else is our own mistake.
Reply failure(const db::Error& error) {
  constexpr int busy = 5, input_output = 10, full = 13;  // SQLite's primary result codes
  const int primary = error.code() & 0xff;
  if (primary != busy && primary != input_output && primary != full) {
    return problem_reply(500, "The service failed; its log says why.");
  }
  Reply reply = problem_reply(503, "The store cannot take it now; nothing was changed.");
  reply.headers.emplace_back("Retry-After", "10");
  return reply;
}

/// Adds the tag to what was read; nothing more where the client has it already.
void tag(const Request& request, Reply& reply) {
  if (!reads(request) || reply.status != 200 || reply.stream) return;
  const std::string own = entity_tag(reply.body);
  reply.headers.emplace_back("ETag", own);
  if (!names_tag_weakly(request.field("if-none-match"), own)) return;
  reply.status = 304;
  reply.body.clear();
}

/// Adds the address of the page that follows.
void link(const Route& route, const Request& request, Reply& reply) {
  const std::string address = next_page(route, request, reply.next);
  if (!address.empty()) reply.headers.emplace_back("Link", "<" + address + ">; rel=\"next\"");
}

}  // namespace

std::string new_request_id() {
  static thread_local std::mt19937_64 random{std::random_device{}()};
  static constexpr std::string_view digits = "0123456789abcdef";
  std::string id;
  for (int i = 0; i < 16; ++i) id += digits[random() % digits.size()];
  return id;
}

Reply Api::respond(Request request) {
  const auto begin = std::chrono::steady_clock::now();
  const std::string id = request_id(request);
  request.api = this;
  const auto route = find_route(request);
  Reply reply;
  try {
    reply = route ? answer(**route, request) : route.error();
    if (route) link(**route, request, reply);
    tag(request, reply);
  } catch (const db::Error& error) {
    log_failure(request, id, error.what());
    reply = failure(error);
  } catch (const std::exception& error) {
    log_failure(request, id, error.what());
    reply = problem_reply(500, "The service failed; its log says why.");
  }
  if (reply.status == 202) reply.headers.emplace_back("Retry-After", "1");
  reply.headers.emplace_back("X-Request-Id", id);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  metrics_.count(request.method, route ? (*route)->pattern : "", reply.status, taken.count());
  return reply;
}

/// Why the one who asks may not, where that is so. As long as there were no tokens nobody needs one.
std::optional<Reply> Api::refuse(const Route& route, Request& request) {
  const Scope needed = needed_scope(route);
  if (tokens_ == nullptr || needed == Scope::nothing || tokens_->all().empty()) return std::nullopt;
  const auto token = tokens_->find(request.field("authorization"));
  const Scope given = token ? scope_at(*token, microseconds_now()) : Scope::nothing;
  if (given == Scope::nothing) {
    // The same words whether it is unknown, expired or revoked.
    Reply reply = problem_reply(401, "Send a token that is valid: Authorization: Bearer rps_...");
    reply.headers.emplace_back("WWW-Authenticate", "Bearer");
    return reply;
  }
  request.user = token->id;
  if (given >= needed) return std::nullopt;
  return problem_reply(403,
                       "This needs a token with the scope " +
                           std::string(scope_names.at(static_cast<std::size_t>(needed))) + ".");
}

/// A stream ends about a second after its reader's token: one that was revoked, or has expired, is
/// good for no event more.
void Api::watch_reader(const Route& route, const Request& request, Reply& reply) {
  using Clock = std::chrono::steady_clock;
  reply.stream = [this,
                  &route,
                  reader = request,
                  source = std::move(reply.stream),
                  last = Clock::now()]() mutable -> std::optional<std::string> {
    if (const auto now = Clock::now(); now - last >= std::chrono::seconds(1)) {
      if (refuse(route, reader)) return std::nullopt;
      last = now;
    }
    return source();
  };
}

Reply Api::answer(const Route& route, Request& request) {
  if (auto refusal = refuse(route, request)) return std::move(*refusal);
  if (reads(request)) {
    Reply reply = run_route(route, service_, request);
    if (reply.stream) watch_reader(route, request, reply);
    return reply;
  }
  const std::scoped_lock hold(changes_);
  if (!request.field("idempotency-key").empty()) return once(route, request);
  return change(route, request);
}

/// Does it where nobody has done it with that key, else says what was answered then.
Reply Api::once(const Route& route, const Request& request) {
  const std::string key = request.field("idempotency-key");
  if (!is_plain(key)) {
    return problem_reply(400,
                         "An Idempotency-Key has 1 to " + std::to_string(longest_key) +
                             " printable letters without blanks, quotes or backslashes.");
  }
  const std::string query = print_query(request);
  const std::string address = request.path + (query.empty() ? "" : "?" + query);
  const std::string request_digest =
      digest(request.method + " " + address + "\n" + request.content_type + "\n" + request.body);
  Reply reply;
  const std::string owned = request.user + " " + key;  // nobody sees what others were answered
  const auto earlier = service_.once(owned, request_digest, [&]() -> std::optional<std::string> {
    reply = change(route, request);
    if (reply.status >= 300)
      return std::nullopt;  // nothing was done: it may be mended and sent again
    return print_reply(reply);
  });
  if (!earlier) return reply;
  if (earlier->request_digest != request_digest) {
    return problem_reply(422, "That Idempotency-Key was used for another request.");
  }
  reply = read_reply(earlier->reply);
  reply.headers.emplace_back("Idempotency-Replayed", "true");
  return reply;
}

/// Does it, if the client names a state of the thing only where it is still in that state.
Reply Api::change(const Route& route, const Request& request) {
  if (!request.field("if-match").empty()) {
    if (auto refusal = refuse_unread(request)) return std::move(*refusal);
  }
  if (request.method == "PUT" && request.field("if-none-match") == "*" && is_there(request)) {
    return problem_reply(412, "It is there already.");
  }
  return run_route(route, service_, request);
}

/// Whether there is something to be read where a change goes.
bool Api::is_there(const Request& request) {
  Request reading;
  reading.method = "GET";
  reading.path = request.path;
  const auto current = find_route(reading);
  return current && run_route(**current, service_, reading).status == 200;
}

/// Why not to change a thing of which the client names another state than it has now, in whichever
/// form it was read.
std::optional<Reply> Api::refuse_unread(const Request& request) {
  Request reading;
  reading.method = "GET";
  reading.path = request.path;
  const auto current = find_route(reading);
  if (!current) return problem_reply(400, "There is nothing to match at this address.");
  std::vector<std::string_view> forms{(*current)->media};
  forms.insert(forms.end(), (*current)->also.begin(), (*current)->also.end());
  for (const std::string_view form : forms) {
    if (form.empty()) continue;
    reading.fields["accept"] = form;
    const Reply now = run_route(**current, service_, reading);
    if (now.status == 200 && names_tag(request.field("if-match"), entity_tag(now.body))) {
      return std::nullopt;
    }
  }
  return problem_reply(412, "It has changed since it was read, or is not there.");
}

std::string Api::metrics() const {
  return metrics_.print(service_.figures(), sockets_ ? sockets_() : TransportFigures{});
}

}  // namespace repose::server
