/// Sends a document to an address that a user has named, and looks where that leads: libcurl's
/// header is included here alone.
#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

namespace repose::server {

struct Target {
  std::string scheme, host;  ///< in lower case
};

/// The parts of an address; nothing where it is none of http or https, or where it holds a name and
/// password.
std::optional<Target> parse_url(const std::string& url);

struct Message {
  std::string url;
  std::vector<std::pair<std::string, std::string>> fields;  ///< of the head
  std::string body;
};

struct Posted {
  int status = 0;            ///< of the answer; 0: there was none
  std::string account = {};  ///< why there was none
};

/// Comes back early where it is asked to stop.
using Post = std::function<Posted(const Message& message, const std::stop_token& stop)>;

/// Posts within 10 s, follows no redirect and uses no proxy. Connects to a public address only, but
/// for the hosts of that list: looked at when the name has been resolved, so that no name service
/// can lead elsewhere.
Post post_to_public(std::vector<std::string> private_hosts);

}  // namespace repose::server
