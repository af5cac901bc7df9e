#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <catch2/catch.hpp>

#include "server/report/frame_files.hpp"
#include "server/report/image.hpp"

using repose::engine::FrameGrain;
using repose::server::base64;
using repose::server::FrameFiles;
using repose::server::print_vtp;

namespace fs = std::filesystem;

namespace {

std::string decoded(std::string_view text) {
  constexpr std::string_view letters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned group = 0, bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    group = group << 6U | static_cast<unsigned>(letters.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(group >> bits & 255U);
  }
  return bytes;
}

/// The numbers of one array of a .vtp text, after the count of bytes before them.
template <class T>
std::vector<T> read_array(const std::string& vtp, const std::string& name) {
  const std::size_t tag = vtp.find("Name=\"" + name + "\"");
  REQUIRE(tag != std::string::npos);
  const std::size_t from = vtp.find('>', tag) + 1;
  const std::string bytes = decoded(std::string_view(vtp).substr(from, vtp.find('<', from) - from));
  std::uint32_t size = 0;
  REQUIRE(bytes.size() >= sizeof size);
  std::memcpy(&size, bytes.data(), sizeof size);
  REQUIRE(bytes.size() == sizeof size + size);
  std::vector<T> values(size / sizeof(T));
  if (size > 0) std::memcpy(values.data(), bytes.data() + sizeof size, size);
  return values;
}

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

const std::vector<FrameGrain> grains{{{0.1, 0.2, 0.3}, {1.0, -2.0, 3.0}, 0.004, 11},
                                     {{0.4, 0.5, 0.6}, {0.0, 0.0, -9.0}, 0.005, 4294967296}};

}  // namespace

TEST_CASE("a .vtp file reads back to the grains it was written from", "[server]") {
  const std::string vtp = print_vtp({"running", 0.25, {0, 0, -9.81}, {}, grains, {}});
  CHECK(read_array<double>(vtp, "Points") == std::vector{0.1, 0.2, 0.3, 0.4, 0.5, 0.6});
  CHECK(read_array<double>(vtp, "velocity") == std::vector{1.0, -2.0, 3.0, 0.0, 0.0, -9.0});
  CHECK(read_array<double>(vtp, "radius") == std::vector{0.004, 0.005});
  CHECK(read_array<std::int64_t>(vtp, "id") == std::vector<std::int64_t>{11, 4294967296});
  CHECK(read_array<std::int64_t>(vtp, "connectivity") == std::vector<std::int64_t>{0, 1});
  CHECK(read_array<std::int64_t>(vtp, "offsets") == std::vector<std::int64_t>{1, 2});
  CHECK(vtp.find("NumberOfPoints=\"2\" NumberOfVerts=\"2\"") != std::string::npos);
  CHECK(vtp.find(">0.25<") != std::string::npos);
}

TEST_CASE("a frame without grains is still a .vtp file", "[server]") {
  const std::string vtp = print_vtp({"running", 0.0, {}, {}, {}, {}});
  CHECK(read_array<double>(vtp, "Points").empty());
}

TEST_CASE("the index names every frame with its time and stages have a picture", "[server]") {
  const TemporaryFolder folder;
  FrameFiles files(folder.path / "deep" / "frames");
  files.write({"running", 0.0, {0, 0, -9.81}, {}, grains, {}});
  files.write({"hopper filled", 0.5, {0, 0, -9.81}, {}, grains, {}});
  files.write_index();
  const fs::path written = folder.path / "deep" / "frames";
  const std::string index = read_file(written / "frames.pvd");
  CHECK(index.find("timestep=\"0\" part=\"0\" file=\"frame_00000.vtp\"") != std::string::npos);
  CHECK(index.find("timestep=\"0.5\" part=\"0\" file=\"frame_00001.vtp\"") != std::string::npos);
  CHECK(fs::exists(written / "frame_00000.vtp"));
  CHECK(fs::exists(written / "frame_00001.vtp"));
  CHECK(read_file(written / "01_hopper_filled.png").substr(1, 3) == "PNG");
  CHECK(files.frames() == 2);
  CHECK(files.pictures() == 1);
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
