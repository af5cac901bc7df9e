/// STL: the facets of a surface from the bytes of a file, text or binary, told apart by content.
///
/// Format: 3D Systems, StereoLithography Interface Specification, 1988: text ("solid", "facet",
/// "vertex"), or 80 bytes of header, a count (4 bytes) and 50 bytes a facet, least byte first.
/// Normals and attributes are passed over: the corners say all.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "engine/result.hpp"
#include "engine/triangle.hpp"

namespace repose::engine {

enum class MeshFault {
  not_stl,      ///< neither of the two forms
  truncated,    ///< ends in the midst of a facet or without an end
  wrong_count,  ///< another number of facets than its header says
  not_finite,   ///< a coordinate that is no number or infinite
  no_area,      ///< a facet whose corners lie on a line
  open,         ///< edges of one facet only, where a closed surface was asked for
  wrong_unit,   ///< too large or too small to be meant
};

/// Why a mesh cannot be used.
struct MeshError {
  MeshFault fault = MeshFault::not_stl;
  std::size_t facet = 0;  ///< counted from 1; 0 where it is not one facet's
  std::string message;
};

/// The facets in the file's order and in its unit of length.
Result<std::vector<Triangle>, MeshError> read_stl(std::string_view bytes);

}  // namespace repose::engine
