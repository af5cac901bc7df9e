/// Which addresses of the network are public: what a user names must not lead this service to a
/// machine that only this service can reach.
#pragma once

#include <string>

struct sockaddr;

namespace repose::server {

/// False for the loopback, private, link-local, shared, multicast and reserved ones, for those that
/// hold one of these within (IPv4 in IPv6), and for all that are no internet addresses.
bool is_public(const sockaddr& address);

}  // namespace repose::server
