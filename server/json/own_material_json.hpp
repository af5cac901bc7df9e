/// Grains that users describe themselves <-> documents, and their place in the list of all.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "db/material_store.hpp"
#include "engine/result.hpp"
#include "server/json/problem.hpp"

namespace repose::server {

/// {"title", "grain": {...as in a study's materials}}, checked; what comes back is kept.
engine::Result<std::string, Problems> parse_own_material(std::string_view text);

/// {"name","title","origin","created_at","grain"}
std::string print_own_material(const db::MaterialRecord& material);

/// The published ones, then these: {"citation","reading","items":[{"name","title","properties",
/// "origin"}]}.
std::string print_all_materials(const std::vector<db::MaterialRecord>& own);

/// Whether a study's materials have a grain, or are what its reader will complain of.
bool has_grain(std::string_view study);

/// The study with that grain, where it has none of its own.
std::string with_grain(std::string_view study, std::string_view material);

}  // namespace repose::server
