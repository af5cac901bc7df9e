/// Grains that users describe themselves: kept by name beside the published ones, which nobody
/// changes. A study of one may leave its grain out.
#pragma once

#include <string>
#include <string_view>

#include "db/store.hpp"
#include "server/service.hpp"

namespace repose::server {

/// A name under which something is kept, and that stands in an address as it is.
bool is_name(std::string_view text);
/// What is wrong with a name that is none.
Refusal no_name(const std::string& text);

/// Keeps a description; one that is there is replaced only where the caller knows it.
Answer<std::string> put_material(db::Store& store,
                                 const std::string& name,
                                 std::string_view content,
                                 bool may_replace);
/// Published or own.
Answer<std::string> material(db::Store& store, const std::string& name);
/// The document that was removed.
Answer<std::string> remove_material(db::Store& store, const std::string& name);

}  // namespace repose::server
