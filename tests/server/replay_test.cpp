#include "server/report/replay.hpp"

#include <cstring>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/support/vtk_reader.hpp"

using repose::engine::Frame;
using repose::engine::FrameGrain;
using repose::engine::FrameWall;
using repose::engine::Vec3;
using repose::server::Replay;
using repose::tests::base64_decoded;

namespace {

constexpr Vec3 down{0.0, 0.0, -9.81};

/// Every value of that name in a JSON text, as raw bytes.
std::vector<std::string> decoded(const std::string& json, const std::string& name) {
  std::vector<std::string> all;
  const std::string mark = "\"" + name + "\":\"";
  for (auto at = json.find(mark); at != std::string::npos; at = json.find(mark, at + 1)) {
    const std::size_t from = at + mark.size();
    all.push_back(base64_decoded(std::string_view(json).substr(from, json.find('"', from) - from)));
  }
  return all;
}

template <class T>
std::vector<T> as(const std::string& bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

Frame running(double time, const std::vector<FrameGrain>& grains) {
  return {"running", time, down, {}, grains, {}};
}

}  // namespace

TEST_CASE("centres stand in a replay to a 65535th of the box about them", "[server]") {
  const std::vector<FrameGrain> grains{{{0.0, 0.0, 0.0}, {}, 0.004, 0, 0},
                                       {{0.25, 1.0, 0.5}, {}, 0.005, 1, 0},
                                       {{1.0, 0.5, 2.0}, {}, 0.006, 2, 2}};
  Replay replay;
  replay.add(running(0.5, grains));
  const std::string json = replay.json();
  CHECK(as<float>(decoded(json, "radius").at(0)) == std::vector{0.004F, 0.005F, 0.006F});
  CHECK(as<std::uint32_t>(decoded(json, "body").at(0)) == std::vector<std::uint32_t>{0, 0, 2});
  CHECK(json.find(R"("box":[[0,0,0],[1,1,2]])") != std::string::npos);
  CHECK(as<std::uint16_t>(decoded(json, "centres").at(0)) ==
        std::vector<std::uint16_t>{0, 0, 0, 16384, 65535, 16384, 65535, 32768, 65535});
}

TEST_CASE("a grain that left is absent by its bit and those that stay keep theirs", "[server]") {
  const FrameGrain a{{0, 0, 0}, {}, 0.1, 0, 0}, b{{1, 0, 0}, {}, 0.1, 1, 1},
      c{{2, 0, 0}, {}, 0.1, 7, 7};
  Replay replay;
  replay.add(running(0.0, {a, b}));
  replay.add(running(0.1, {b, c}));
  const auto present = decoded(replay.json(), "present");
  REQUIRE(present.size() == 2);
  CHECK(as<std::uint8_t>(present[0]) == std::vector<std::uint8_t>{0b011});
  CHECK(as<std::uint8_t>(present[1]) == std::vector<std::uint8_t>{0b110});
}

TEST_CASE("walls stand once until they move", "[server]") {
  const std::vector<FrameGrain> grains{{{0, 0, 0}, {}, 0.1, 0, 0}};
  const std::vector<FrameWall> low{{.from_s = -1.0, .to_s = 1.0}};
  const std::vector<FrameWall> high{{.from_s = -1.0, .from_z = 0.05, .to_s = 1.0, .to_z = 0.05}};
  Replay replay;
  replay.add({"running", 0.0, down, {}, grains, low});
  replay.add({"running", 0.1, down, {}, grains, low});
  replay.add({"pressed", 0.2, down, {}, grains, high});
  const std::string json = replay.json();
  const auto corners = decoded(json, "corners");
  REQUIRE(corners.size() == 2);
  CHECK(as<float>(corners[0]).size() == 12);
  CHECK(as<float>(corners[1])[2] == 0.05F);
  CHECK(json.find(R"("walls":1}]})") != std::string::npos);
}

TEST_CASE("a long run is thinned out to the room there is, and keeps its stages", "[server]") {
  const std::vector<FrameGrain> grains(10, FrameGrain{{0, 0, 0}, {}, 0.1, 0, 0});
  Replay replay(6 * 10 * 20);  // room for 20 frames
  for (int i = 0; i < 100; ++i) {
    replay.add({i % 25 == 24 ? "stage" : "running", 0.1 * i, down, {}, grains, {}});
  }
  CHECK(replay.frames() <= 20);
  CHECK(replay.frames() > 8);
  const std::string json = replay.json();
  std::size_t stages = 0;
  for (auto at = json.find("\"stage\":\"stage\""); at != std::string::npos; ++stages) {
    at = json.find("\"stage\":\"stage\"", at + 1);
  }
  CHECK(stages == 4);
}

TEST_CASE("the page that plays a run asks nothing of the network", "[server]") {
  const std::vector<FrameGrain> grains{{{0, 0, 0}, {}, 0.1, 0, 0}};
  Replay replay;
  replay.add({"filled", 0.0, down, {}, grains, {}});
  const std::string page = replay.page("drum <draft>");
  CHECK(page.find("drum &lt;draft&gt;") != std::string::npos);
  for (const char* word : {"http:", "https:", "src=", "import ", "fetch(", "@import", "url("}) {
    INFO(word);
    CHECK(page.find(word) == std::string::npos);
  }
}
