/// Webhooks: the use cases. Who is told what is for administrators; secrets are shown once.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "db/store.hpp"
#include "server/service.hpp"

namespace repose::server {

/// `private_hosts`: that are not public, and may be told all the same.
Answer<std::string> add_webhook(db::Store& store,
                                std::string_view content,
                                const std::vector<std::string>& private_hosts);
/// Puts another content in its place, and goes on where it was: so a parked one is put in force
/// again. The former secret, where a new one is asked for, signs for a day more.
Answer<std::string> replace_webhook(db::Store& store,
                                    std::int64_t id,
                                    std::string_view content,
                                    const std::vector<std::string>& private_hosts);
Answer<std::string> remove_webhook(db::Store& store, std::int64_t id);
Answer<std::string> webhook(const db::Store& store, std::int64_t id);
std::string webhooks(const db::Store& store);

}  // namespace repose::server
