/// Replies made of what the service answers.
#pragma once

#include <string>
#include <string_view>

#include "server/api/route.hpp"
#include "server/service.hpp"

namespace repose::server {

/// The document with that status, or the refusal as a problem.
Reply reply_of(const Answer<std::string>& answer, int status = 200);

/// A page, which knows where the next one begins.
Reply reply_of(const Answer<Page>& answer);

/// 201: made. The document's number is the last segment of its address.
Reply created(const Answer<std::string>& answer, std::string_view collection);

/// 202: taken on. The document's number is the last segment of its address, where it can be asked
/// for, in a few seconds at the soonest.
Reply accepted(const Answer<std::string>& answer, std::string_view collection);

}  // namespace repose::server
