#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <catch2/catch.hpp>

#include "server/report/frame_files.hpp"
#include "server/report/image.hpp"
#include "tests/support/vtk_reader.hpp"

using repose::engine::Frame;
using repose::engine::FrameGrain;
using repose::engine::FrameWall;
using repose::engine::Vec3;
using repose::server::base64;
using repose::server::FrameFiles;
using repose::server::print_vtp;
using repose::server::print_walls_vtp;
using repose::tests::DataSet;
using repose::tests::PolyData;
using repose::tests::read_collection;
using repose::tests::read_poly_data;

namespace fs = std::filesystem;

namespace {

std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// A folder of its own, removed at the end.
struct TemporaryFolder {
  fs::path path;
  TemporaryFolder() {
    std::string pattern = (fs::temp_directory_path() / "repose_frames_XXXXXX").string();
    path = mkdtemp(pattern.data());
  }
  ~TemporaryFolder() { fs::remove_all(path); }
};

const std::vector<FrameGrain> grains{{{0.1, 0.2, 0.3}, {1.0, -2.0, 3.0}, 0.004, 11, 11},
                                     {{0.4, 0.5, 0.6}, {0.0, 0.0, -9.0}, 0.005, 13, 11}};
constexpr Vec3 down{0.0, 0.0, -9.81};

Frame frame_with(const std::vector<FrameWall>& walls, const Vec3& period = {}) {
  return {"running", 0.25, down, period, grains, walls};
}

}  // namespace

TEST_CASE("a .vtp file reads back to the grains it was written from", "[server]") {
  const PolyData data = read_poly_data(print_vtp(frame_with({})));
  CHECK(data.time == 0.25);
  CHECK(data.points == std::vector{0.1, 0.2, 0.3, 0.4, 0.5, 0.6});
  CHECK(data.reals.at("velocity") == std::vector{1.0, -2.0, 3.0, 0.0, 0.0, -9.0});
  CHECK(data.reals.at("radius") == std::vector{0.004, 0.005});
  CHECK(data.whole.at("id") == std::vector<std::int64_t>{11, 13});
  CHECK(data.whole.at("body") == std::vector<std::int64_t>{11, 11});
  CHECK(data.verts == std::vector<std::vector<std::int64_t>>{{0}, {1}});
  CHECK(data.polys.empty());
}

TEST_CASE("a frame without grains is still a .vtp file, of grains and of walls", "[server]") {
  const Frame empty{"running", 0.0, {}, {}, {}, {}};
  CHECK(read_poly_data(print_vtp(empty)).points.empty());
  CHECK(read_poly_data(print_walls_vtp(empty)).points.empty());
}

TEST_CASE("walls stand in their .vtp file where they are, as polygons", "[server]") {
  const FrameWall tube{.revolved = true, .from_s = 2.0, .to_s = 2.0, .to_z = 5.0};
  const FrameWall floor{.from_s = -1.0, .to_s = 1.0};
  FrameWall facet;
  facet.triangles = {{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 0, 1}}};
  SECTION("a tube as rectangles round its axis, whole") {
    const PolyData data = read_poly_data(print_walls_vtp(frame_with({tube})));
    REQUIRE(data.polys.size() > 50);
    for (const auto& cell : data.polys) CHECK(cell.size() == 4);
    double lowest = 9.0, highest = -9.0;
    for (std::size_t i = 0; i < data.points.size(); i += 3) {
      CHECK(std::hypot(data.points[i], data.points[i + 1]) == Approx(2.0));
      lowest = std::min(lowest, data.points[i + 2]);
      highest = std::max(highest, data.points[i + 2]);
    }
    CHECK(lowest == Approx(0.0));
    CHECK(highest == Approx(5.0));
  }
  SECTION("what runs along y as long as the period") {
    const PolyData data = read_poly_data(print_walls_vtp(frame_with({floor}, {0.0, 0.7, 0.0})));
    CHECK(data.points == std::vector{-1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.7, 0.0, -1.0, 0.7, 0.0});
  }
  SECTION("a plane without end cut about the bed") {
    const FrameWall endless{.from_s = -repose::engine::endless,
                            .from_z = 0.25,
                            .to_s = repose::engine::endless,
                            .to_z = 0.25};
    const PolyData data = read_poly_data(print_walls_vtp(frame_with({endless}, {0.0, 0.7, 0.0})));
    REQUIRE(data.polys.size() == 1);
    CHECK(data.points[0] < 0.1);
    CHECK(data.points[0] > -0.2);
  }
  SECTION("a facet of a mesh as a triangle") {
    const PolyData data = read_poly_data(print_walls_vtp(frame_with({facet})));
    CHECK(data.polys == std::vector<std::vector<std::int64_t>>{{0, 1, 2}});
    CHECK(data.points == std::vector{0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0});
  }
}

TEST_CASE("the index names every frame with its time and its walls, stages have a picture",
          "[server]") {
  const TemporaryFolder folder;
  FrameFiles files(folder.path / "deep" / "frames", "kettle");
  FrameWall tube{.revolved = true, .from_s = 2.0, .to_s = 2.0, .to_z = 5.0};
  const std::vector<FrameWall> resting{tube};
  tube.from_z = 1.0;
  tube.to_z = 6.0;
  const std::vector<FrameWall> lifted{tube};
  files.write({"running", 0.0, down, {}, grains, resting});
  files.write({"running", 0.5, down, {}, grains, resting});
  files.write({"hopper filled", 1.0, down, {}, grains, lifted});
  files.write_index();
  const fs::path written = folder.path / "deep" / "frames";
  const auto sets = read_collection(read_file(written / "frames.pvd"));
  REQUIRE(sets.size() == 6);
  for (const DataSet& set : sets) {
    INFO(set.file);
    const PolyData data = read_poly_data(read_file(written / set.file));
    CHECK(data.polys.empty() == (set.part == 0));
  }
  CHECK(sets[0].file == "frame_00000.vtp");
  CHECK(sets[2].file == "frame_00001.vtp");
  CHECK(sets[2].time == 0.5);
  CHECK(sets[1].file == "walls_00000.vtp");
  CHECK(sets[3].file == "walls_00000.vtp");  // they have not moved
  CHECK(sets[5].file == "walls_00002.vtp");
  CHECK(read_file(written / "01_hopper_filled.png").substr(1, 3) == "PNG");
  CHECK(files.frames() == 3);
  CHECK(files.pictures() == 1);
  const std::string page = read_file(written / "play.html");
  CHECK(page.find("<h1>kettle</h1>") != std::string::npos);
  CHECK(page.find("{{") == std::string::npos);
}

TEST_CASE("the reader of VTK files refuses what is broken", "[server]") {
  const std::string good = print_vtp(frame_with({}));
  const auto with = [&good](const std::string& from, const std::string& to) {
    std::string bad = good;
    return bad.replace(bad.find(from), from.size(), to);
  };
  CHECK_THROWS(read_poly_data(with("</Verts>", "")));
  CHECK_THROWS(read_poly_data(with("NumberOfVerts=\"2\"", "NumberOfVerts=\"3\"")));
  CHECK_THROWS(read_poly_data(with("NumberOfPoints=\"2\"", "NumberOfPoints=\"1\"")));
  CHECK_THROWS(
      read_poly_data(with("type=\"Float64\" Name=\"radius\"", "type=\"Float32\" Name=\"radius\"")));
}

TEST_CASE("a file that cannot be written is named in the error", "[server]") {
  CHECK_THROWS_WITH(repose::server::write_file("/proc/nowhere/x.html", "x"),
                    Catch::Contains("/proc/nowhere/x.html"));
}

TEST_CASE("base64 pads as RFC 4648 says", "[server]") {
  CHECK(base64("").empty());
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("foobar") == "Zm9vYmFy");
}
