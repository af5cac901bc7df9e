// STL files, sound and broken.
#include "engine/stl.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include <catch2/catch.hpp>

#include "engine/mesh.hpp"

using namespace repose::engine;

namespace {

constexpr const char* two_facets =
    "solid plate\n"
    "  facet normal 0 0 1\n    outer loop\n"
    "      vertex 0 0 0\n      vertex 0.1 0 0\n      vertex 0.1 2e-1 0\n"
    "    endloop\n  endfacet\n"
    "  FACET NORMAL 0 0 1\n    OUTER LOOP\n"
    "      VERTEX 0 0 0\n      VERTEX 0.1 0.2 0\n      VERTEX 0 +0.2 0\n"
    "    ENDLOOP\n  ENDFACET\n"
    "endsolid plate\n";

std::string replaced(std::string text, std::string_view old, std::string_view fresh) {
  const auto at = text.find(old);
  REQUIRE(at != std::string::npos);
  return text.replace(at, old.size(), fresh);
}

std::string binary(const std::vector<Triangle>& facets, std::uint32_t count) {
  std::string bytes = "solid in name only";
  bytes.resize(80, '\0');
  const auto append = [&bytes](auto value) {
    std::array<char, sizeof value> raw{};
    std::memcpy(raw.data(), &value, sizeof value);
    bytes.append(raw.data(), raw.size());
  };
  append(count);
  for (const Triangle& facet : facets) {
    for (int k = 0; k < 3; ++k) append(0.0F);
    for (const Vec3& corner : facet) {
      for (const double x : {corner.x, corner.y, corner.z}) append(static_cast<float>(x));
    }
    append(std::uint16_t{0});
  }
  return bytes;
}

const std::vector<Triangle> pair{{{{0, 0, 0}, {0.5, 0, 0}, {0.5, 0.25, 0}}},
                                 {{{0, 0, 0}, {0.5, 0.25, 0}, {0, 0.25, 0}}}};

MeshError error_of(std::string_view bytes, const MeshOptions& options = {}) {
  const auto mesh = mesh_from_stl(bytes, options);
  REQUIRE_FALSE(mesh);
  return mesh.error();
}

bool says(const MeshError& error, std::string_view words) {
  CAPTURE(error.message);
  const bool found = error.message.find(words) != std::string::npos;
  CHECK(found);
  return found;
}

}  // namespace

TEST_CASE("an STL file of text gives its corners", "[engine]") {
  const auto facets = read_stl(two_facets);
  REQUIRE(facets);
  REQUIRE(facets->size() == 2);
  CHECK((*facets)[0][2] == Vec3{0.1, 0.2, 0.0});
  CHECK((*facets)[1][2] == Vec3{0.0, 0.2, 0.0});
}

TEST_CASE("a binary STL file gives its corners, whatever its header says", "[engine]") {
  static_assert(std::endian::native == std::endian::little);
  const auto facets = read_stl(binary(pair, 2));
  REQUIRE(facets);
  CHECK(*facets == pair);
}

TEST_CASE("a broken STL file is named as what it is", "[engine]") {
  CHECK(error_of("solid x\nendsolid x\n").fault == MeshFault::not_stl);
  CHECK(error_of("not a mesh").fault == MeshFault::truncated);
  const MeshError word = error_of(replaced(two_facets, "outer loop", "outer lop"));
  CHECK((word.fault == MeshFault::not_stl && word.facet == 1 && says(word, "\"lop\"")));
  const MeshError cut = error_of(std::string(two_facets).substr(0, 215));
  CAPTURE(cut.message);
  CHECK((cut.fault == MeshFault::truncated && cut.facet == 2));
  const MeshError nan = error_of(replaced(two_facets, "2e-1", "nan"));
  CHECK((nan.fault == MeshFault::not_finite && nan.facet == 1 && says(nan, "corner 3")));
  const MeshError large = error_of(replaced(two_facets, "+0.2", "1e999"));
  CHECK((large.fault == MeshFault::not_finite && large.facet == 2));
  const MeshError line = error_of(replaced(two_facets, "0.1 2e-1 0", "0.05 0 0"));
  CHECK((line.fault == MeshFault::no_area && line.facet == 1));
  const MeshError count = error_of(binary(pair, 1));
  CHECK((count.fault == MeshFault::wrong_count && says(count, "room for 2")));
  const MeshError ends = error_of(binary(pair, 2).substr(0, 150));
  CHECK((ends.fault == MeshFault::truncated && ends.facet == 2));
  auto hole = pair;
  hole[1][1].y = std::numeric_limits<double>::quiet_NaN();
  const MeshError missing = error_of(binary(hole, 2));
  CHECK(
      (missing.fault == MeshFault::not_finite && missing.facet == 2 && says(missing, "corner 2")));
}

TEST_CASE("a mesh in the wrong unit or with a hole is refused", "[engine]") {
  const MeshError millimetres = error_of(replaced(two_facets, "0.1 2e-1", "100 200"));
  CHECK((millimetres.fault == MeshFault::wrong_unit && says(millimetres, "0.001")));
  const MeshError metres = error_of(two_facets, {.scale = 0.001, .grain_diameter = 0.0065});
  CHECK((metres.fault == MeshFault::wrong_unit && says(metres, "its scale is 1")));
  const MeshError open = error_of(two_facets, {.closed = true});
  CHECK((open.fault == MeshFault::open && open.facet == 1 && says(open, "4 edges")));
  const auto mesh = mesh_from_stl(two_facets, {});
  REQUIRE(mesh);
  CHECK(mesh->parts().boundary_edges == 4);
  CHECK(mesh->patches() == 1);
}
