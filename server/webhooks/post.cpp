#include "server/webhooks/post.hpp"

#include <algorithm>
#include <curl/curl.h>
#include <memory>
#include <stdexcept>
#include <sys/socket.h>

#include "server/letters.hpp"
#include "server/webhooks/address.hpp"

namespace repose::server {

namespace {

struct End {
  void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
  void operator()(CURLU* url) const { curl_url_cleanup(url); }
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};

/// One part of an address; empty where it is not there.
std::string part(CURLU* url, CURLUPart which) {
  char* text = nullptr;
  if (curl_url_get(url, which, &text, 0) != CURLUE_OK || text == nullptr) return {};
  std::string result = lower_case(std::string_view(text));
  curl_free(text);
  return result;
}

/// Whether the socket may be opened, once the name is an address.
struct Gate {
  bool any_address = false;
  bool refused = false;
};

curl_socket_t open_socket(void* gate_of_message, curlsocktype /*purpose*/, curl_sockaddr* to) {
  auto& gate = *static_cast<Gate*>(gate_of_message);
  if (!gate.any_address && !is_public(to->addr)) {
    gate.refused = true;
    return CURL_SOCKET_BAD;
  }
  return socket(to->family, to->socktype | SOCK_CLOEXEC, to->protocol);
}

/// What the receiver says beside its status is of no use, and may be endless.
std::size_t discard(char* /*text*/, std::size_t size, std::size_t count, void* taken) {
  constexpr std::size_t longest = 64U << 10U;
  auto& so_far = *static_cast<std::size_t*>(taken);
  so_far += size * count;
  return so_far > longest ? 0 : size * count;
}

/// Called about once a second; other than zero ends it.
int look_up(void* stop, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  return static_cast<const std::stop_token*>(stop)->stop_requested() ? 1 : 0;
}

Posted post(const std::vector<std::string>& private_hosts,
            const Message& message,
            std::stop_token stop) {
  const auto target = parse_url(message.url);
  if (!target) return {0, "the address cannot be read"};
  const std::unique_ptr<CURL, End> handle(curl_easy_init());
  if (!handle) return {0, "libcurl does not start"};
  Gate gate{.any_address = std::ranges::find(private_hosts, target->host) != private_hosts.end()};
  std::unique_ptr<curl_slist, End> head;
  for (const auto& [name, value] : message.fields) {
    std::string line(name);
    line.append(": ").append(value);
    head.reset(curl_slist_append(head.release(), line.c_str()));
  }
  head.reset(curl_slist_append(head.release(), "Expect:"));
  std::size_t taken = 0;
  CURL* curl = handle.get();
  curl_easy_setopt(curl, CURLOPT_URL, message.url.c_str());
  curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(curl, CURLOPT_FOLLOWLOCATION, 0L);
  curl_easy_setopt(curl, CURLOPT_PROXY, "");
  curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(curl, CURLOPT_TIMEOUT, 10L);
  curl_easy_setopt(curl, CURLOPT_NOPROGRESS, 0L);
  curl_easy_setopt(curl, CURLOPT_XFERINFOFUNCTION, look_up);
  curl_easy_setopt(curl, CURLOPT_XFERINFODATA, &stop);
  curl_easy_setopt(curl, CURLOPT_OPENSOCKETFUNCTION, open_socket);
  curl_easy_setopt(curl, CURLOPT_OPENSOCKETDATA, &gate);
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, discard);
  curl_easy_setopt(curl, CURLOPT_WRITEDATA, &taken);
  curl_easy_setopt(curl, CURLOPT_HTTPHEADER, head.get());
  curl_easy_setopt(curl, CURLOPT_POSTFIELDSIZE_LARGE, static_cast<curl_off_t>(message.body.size()));
  curl_easy_setopt(curl, CURLOPT_POSTFIELDS, message.body.c_str());
  const CURLcode code = curl_easy_perform(curl);
  if (gate.refused) return {0, "the address leads to a network that is not public"};
  long status = 0;
  curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &status);
  // An answer that goes on and on has told its status.
  if (code != CURLE_OK && code != CURLE_WRITE_ERROR) return {0, curl_easy_strerror(code)};
  return {static_cast<int>(status), {}};
}

}  // namespace

std::optional<Target> parse_url(const std::string& url) {
  const std::unique_ptr<CURLU, End> parsed(curl_url());
  if (!parsed || curl_url_set(parsed.get(), CURLUPART_URL, url.c_str(), 0) != CURLUE_OK) {
    return std::nullopt;
  }
  Target target{part(parsed.get(), CURLUPART_SCHEME), part(parsed.get(), CURLUPART_HOST)};
  const bool known = target.scheme == "http" || target.scheme == "https";
  const bool open =
      part(parsed.get(), CURLUPART_USER).empty() && part(parsed.get(), CURLUPART_PASSWORD).empty();
  if (!known || !open || target.host.empty()) return std::nullopt;
  return target;
}

Post post_to_public(std::vector<std::string> private_hosts) {
  static const CURLcode ready = curl_global_init(CURL_GLOBAL_DEFAULT);
  if (ready != CURLE_OK) throw std::runtime_error("libcurl does not start");
  return [hosts = std::move(private_hosts)](const Message& message, const std::stop_token& stop) {
    return post(hosts, message, stop);
  };
}

}  // namespace repose::server
