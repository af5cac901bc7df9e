#include "server/webhooks/address.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <array>
#include <cstdint>
#include <cstring>
#include <netinet/in.h>
#include <sys/socket.h>

namespace repose::server {

namespace {

/// The addresses whose first `bits` are those of `first`.
struct Range {
  std::uint32_t first;
  unsigned bits;
};

constexpr std::uint32_t of(std::uint32_t a, std::uint32_t b, std::uint32_t c = 0) {
  return a << 24U | b << 16U | c << 8U;
}

/// What is not globally reachable by IANA's IPv4 Special-Purpose Address Registry (RFC 6890 and
/// later), and multicast with all that is above it.
constexpr std::array<Range, 15> reserved{{
    {of(0, 0), 8},           // this network
    {of(10, 0), 8},          // private
    {of(100, 64), 10},       // shared between a provider's customers
    {of(127, 0), 8},         // loopback
    {of(169, 254), 16},      // link-local, where clouds answer to their machines
    {of(172, 16), 12},       // private
    {of(192, 0, 0), 24},     // protocol assignments
    {of(192, 0, 2), 24},     // documentation
    {of(192, 88, 99), 24},   // relays of IPv6
    {of(192, 168), 16},      // private
    {of(198, 18), 15},       // benchmarks
    {of(198, 51, 100), 24},  // documentation
    {of(203, 0, 113), 24},   // documentation
    {of(224, 0), 4},         // multicast
    {of(240, 0), 4},         // reserved, broadcast
}};

bool is_public(const in_addr& address) {
  const std::uint32_t number = ntohl(address.s_addr);
  return std::ranges::none_of(reserved, [number](const Range& range) {
    return (number ^ range.first) >> (32U - range.bits) == 0;
  });
}

/// Of IPv6 only what is assigned for unicast (2000::/3, RFC 4291) is public, but for what leads to
/// an IPv4 address (2002::/16, RFC 3056; 2001::/23, RFC 2928) and documentation (2001:db8::/32).
bool is_public(const in6_addr& address) {
  const auto* bytes = address.s6_addr;
  const unsigned first = unsigned{bytes[0]} << 8U | bytes[1];
  const unsigned second = unsigned{bytes[2]} << 8U | bytes[3];
  if (first >> 13U != 1) return false;
  if (first == 0x2002) return false;
  return first != 0x2001 || (second >= 0x200 && second != 0xdb8);
}

}  // namespace

bool is_public(const sockaddr& address) {
  if (address.sa_family == AF_INET) {
    sockaddr_in ip{};
    std::memcpy(&ip, &address, sizeof ip);
    return is_public(ip.sin_addr);
  }
  if (address.sa_family == AF_INET6) {
    sockaddr_in6 ip{};
    std::memcpy(&ip, &address, sizeof ip);
    return is_public(ip.sin6_addr);
  }
  return false;
}

}  // namespace repose::server
