/// Route: one row of the table from which requests are answered and the API's description printed.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace repose::server {

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
};

struct Reply {
  int status = 200;
  std::string body;
  std::string content_type = "application/json";
  std::vector<std::pair<std::string, std::string>> headers = {};
};

/// A field of the query.
struct QueryField {
  std::string_view name;
  std::string_view meaning;
  bool whole = true;       ///< a whole number; else any text
  std::int64_t least = 1;  ///< of a whole number
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
};

/// The table.
std::span<const Route> routes();

/// Answers a request from the table: 404 and 405 included.
Reply respond(Service& service, Request request);

}  // namespace repose::server
