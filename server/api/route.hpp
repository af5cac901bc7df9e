/// Route: one row of the table from which requests are answered and the API's description printed.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/result.hpp"
#include "server/access/tokens.hpp"

namespace repose::server {

class Api;
class Service;

/// A request as handlers see it: checked for form, decoded, without a trace of the transport.
struct Request {
  std::string method;
  std::string path;
  std::multimap<std::string, std::string> query;
  std::string content_type;
  std::string body;
  std::int64_t id = 0;    ///< of the path, where the route's pattern has {id}
  std::string name = {};  ///< of the path, where the route's pattern has {name}
  std::map<std::string, std::string> fields = {};  ///< of the head, their names in lower case

  std::string user = {};     ///< id of the token; empty where none is needed
  const Api* api = nullptr;  ///< that answers it; null where a handler is called by itself

  /// A field of the head, by its name in lower case; empty where it is not there.
  [[nodiscard]] std::string field(const std::string& lower_case_name) const {
    const auto found = fields.find(lower_case_name);
    return found == fields.end() ? std::string() : found->second;
  }
};

struct Reply {
  int status = 200;
  std::string body;
  std::string content_type = "application/json";
  std::vector<std::pair<std::string, std::string>> headers = {};
  std::string next = {};  ///< of a page of a list: where the next one begins; empty at the end
  /// Of an answer that does not end by itself: the text that has come up since the last call, or
  /// nothing where there will be no more.
  std::function<std::optional<std::string>()> stream = {};
};

/// A field of the query.
struct QueryField {
  std::string_view name;
  std::string_view meaning;
  enum class Kind { whole, text, truth };
  Kind kind = Kind::whole;
  // Of a whole number:
  std::int64_t least = 1;
  std::int64_t most = std::numeric_limits<std::int64_t>::max();
};

using Handler = Reply (*)(Service& service, const Request& request);

struct Route {
  std::string_view method;
  std::string_view pattern;  ///< segments; {id} is a whole number from 1, {name} any but nothing
  std::string_view name;     ///< for programs that are generated from the description
  std::string_view summary;
  std::string_view request;   ///< name of the body's schema; empty: no body
  int success = 200;          ///< status of an answer that is no problem
  std::string_view response;  ///< name of its schema; empty: any object
  std::span<const QueryField> query;
  Handler handler;
  std::string_view media = "application/json";  ///< form of the answer
  std::optional<Scope> scope = {};              ///< else read to read, submit to change
  /// Other forms that body or answer may have.
  std::span<const std::string_view> also = {};
  std::span<const std::string_view> names = {};  ///< that {name} may be; none: any
};

/// A media type without its parameters, in lower case.
std::string media_type(std::string_view content_type);

/// What a token must give for a request of that route.
Scope needed_scope(const Route& route);

/// The table.
std::span<const Route> routes();

/// The route of a request, whose id and name are set from its path; else the problem, 404 or 405.
engine::Result<const Route*, Reply> find_route(Request& request);

/// Checks what the route demands of every request, and calls its handler.
Reply run_route(const Route& route, Service& service, const Request& request);

/// Both: answers a request from the table.
Reply respond(Service& service, Request request);

}  // namespace repose::server
