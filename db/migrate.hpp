/// migrate(): brings a database to this program's schema, one numbered step at a time.
#pragma once

#include "db/sqlite.hpp"

namespace repose::db {

/// Marks a file as ours ("rpos").
inline constexpr std::int64_t application_id = 0x72706f73;

/// The number of the newest schema this program knows.
std::int64_t newest_schema();

/// Refuses a file that is not ours or that a newer program has made.
void check_schema(Connection& connection);

/// Refuses also one that holds nothing.
void check_made(Connection& connection);

/// Refuses also one that this program would have to migrate first.
void check_current(Connection& connection);

/// Whether it holds something that migrate() would change.
bool is_older(Connection& connection);

/// Applies the missing steps in order, each in one transaction.
void migrate(Connection& connection, std::int64_t up_to = newest_schema());

}  // namespace repose::db
