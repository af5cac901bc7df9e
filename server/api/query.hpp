/// Query: the fields of a request's query (and of its head), each read once and checked.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "server/api/route.hpp"
#include "server/json/problem.hpp"

namespace repose::server {

/// Items of a page: at most, and where the request does not say.
inline constexpr std::int64_t largest_page = 200;
inline constexpr std::int64_t usual_page = 50;

class Query {
 public:
  explicit Query(const Request& request) : request_(request) {}

  /// A whole number in these bounds; nothing where it is not given or has a problem.
  std::optional<std::int64_t> whole(std::string_view name,
                                    std::int64_t least,
                                    std::int64_t most = std::numeric_limits<std::int64_t>::max());
  std::optional<std::string> text(std::string_view name);
  /// true or false; false where it is not given.
  bool truth(std::string_view name);
  /// A whole number in a field of the head, by its name in lower case.
  std::optional<std::int64_t> whole_field(const std::string& name, std::int64_t least);

  [[nodiscard]] const Problems& problems() const { return problems_; }
  [[nodiscard]] Reply refusal() const;

 private:
  std::optional<std::string> once(std::string_view name);
  std::optional<std::int64_t> whole_in(const std::string& text,
                                       std::string_view name,
                                       std::int64_t least,
                                       std::int64_t most);
  void complain(std::string_view name,
                const std::string& message,
                const std::string& found,
                const std::string& allowed);

  const Request& request_;
  Problems problems_;
};

/// Fields of the query that the route does not have.
Problems unknown_fields(const Request& request, const Route& route);

}  // namespace repose::server
