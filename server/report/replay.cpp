#include "server/report/replay.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>

#include "server/report/image.hpp"
#include "server/report/number_text.hpp"
#include "server/report/svg.hpp"
#include "server/report/wall_mesh.hpp"

extern const std::span<const std::pair<std::string_view, std::string_view>> embedded_pages;

namespace repose::server {

using engine::Vec3;

namespace {

constexpr std::size_t bytes_per_grain = 6;

template <class T>
std::string packed(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return '"' + base64(bytes) + '"';
}

std::string list(const Vec3& v) {
  return "[" + number_text(v.x, 9) + "," + number_text(v.y, 9) + "," + number_text(v.z, 9) + "]";
}

std::string list(const Bounds& box) { return "[" + list(box.lower) + "," + list(box.upper) + "]"; }

std::uint16_t share(double value, double lower, double upper) {
  if (upper <= lower) return 0;
  return static_cast<std::uint16_t>(std::lround(65535.0 * (value - lower) / (upper - lower)));
}

void append(std::vector<float>& numbers, const Vec3& v) {
  for (const double x : {v.x, v.y, v.z}) numbers.push_back(static_cast<float>(x));
}

/// Appends corners so that they turn to the right about the normal.
void append(std::vector<float>& numbers, const WallPatch& patch) {
  std::array<Vec3, 4> c = patch.corners;
  if (dot(cross(c[1] - c[0], c[2] - c[0]), patch.normals[0]) < 0.0) std::swap(c[0], c[2]);
  for (const Vec3& corner : c) append(numbers, corner);
}

}  // namespace

std::size_t Replay::slot_of(const engine::FrameGrain& grain) {
  const auto [place, is_new] = slots_.try_emplace(grain.id, radius_.size());
  if (is_new) {
    radius_.push_back(static_cast<float>(grain.radius));
    body_.push_back(static_cast<std::uint32_t>(grain.body));
  }
  return place->second;
}

void Replay::add_grains(const engine::Frame& frame, Moment& moment) {
  std::vector<std::pair<std::size_t, Vec3>> placed;
  placed.reserve(frame.grains.size());
  for (const engine::FrameGrain& grain : frame.grains) {
    placed.emplace_back(slot_of(grain), grain.centre);
    moment.box.include(grain.centre);
  }
  std::ranges::sort(placed, {}, &std::pair<std::size_t, Vec3>::first);
  moment.present.assign((radius_.size() + 7) / 8, 0);
  moment.centres.reserve(3 * placed.size());
  const auto& [lower, upper] = moment.box;
  for (const auto& [slot, centre] : placed) {
    moment.present[slot / 8] |= static_cast<std::uint8_t>(1U << slot % 8);
    moment.centres.push_back(share(centre.x, lower.x, upper.x));
    moment.centres.push_back(share(centre.y, lower.y, upper.y));
    moment.centres.push_back(share(centre.z, lower.z, upper.z));
  }
  bytes_ += bytes_per_grain * placed.size();
}

void Replay::add_walls(const engine::Frame& frame, Moment& moment) {
  const WallSurfaces surfaces = wall_surfaces(frame, whole_apparatus(frame));
  Walls walls;
  for (const WallPatch& patch : surfaces.patches) append(walls.corners, patch);
  for (const WallEdge& edge : surfaces.edges) {
    append(walls.edges, edge.from);
    append(walls.edges, edge.to);
  }
  if (walls_.empty() || walls_.back() != walls) walls_.push_back(std::move(walls));
  moment.walls = walls_.size() - 1;
}

void Replay::thin_out() {
  while (bytes_ > most_bytes_ && every_ < (std::size_t{1} << 30U)) {
    every_ *= 2;
    std::size_t seen = 0;
    bytes_ = 0;
    std::erase_if(moments_, [&](const Moment& m) {
      const bool leaves = m.stage == "running" && seen++ % 2 == 1;
      if (!leaves) bytes_ += 2 * m.centres.size();
      return leaves;
    });
  }
}

void Replay::add(const engine::Frame& frame) {
  if (frame.grains.empty()) return;
  const bool running = frame.stage == "running";
  if (running && running_++ % every_ != 0) return;
  Moment moment{.stage = std::string(frame.stage),
                .time = frame.time,
                .gravity = frame.gravity,
                .box = {},
                .present = {},
                .centres = {}};
  add_grains(frame, moment);
  add_walls(frame, moment);
  moments_.push_back(std::move(moment));
  if (running && !box_.empty()) return thin_out();
  // Grains that rain from high up are not what the page is about: the stages' ends are.
  const Bounds shown = surroundings(frame);
  if (!running) {
    box_.include(shown.lower);
    box_.include(shown.upper);
  }
  thin_out();
}

std::string Replay::json() const {
  std::string text = R"({"box":)" + list(box_) + R"(,"radius":)" + packed(radius_) + R"(,"body":)" +
                     packed(body_) + R"(,"walls":[)";
  for (const Walls& walls : walls_) {
    text += &walls == walls_.data() ? "\n" : ",\n";
    text += R"({"corners":)" + packed(walls.corners) + R"(,"edges":)" + packed(walls.edges) + "}";
  }
  text += R"(],"frames":[)";
  for (const Moment& m : moments_) {
    text += &m == moments_.data() ? "\n" : ",\n";
    text += R"({"stage":")" + escaped(m.stage) + R"(","time":)" + number_text(m.time, 9) +
            R"(,"gravity":)" + list(m.gravity) + R"(,"box":)" + list(m.box) + R"(,"present":)" +
            packed(m.present) + R"(,"centres":)" + packed(m.centres) + R"(,"walls":)" +
            std::to_string(m.walls) + "}";
  }
  return text + "]}";
}

std::string Replay::page(std::string_view title) const {
  const auto page = std::ranges::find(embedded_pages,
                                      std::string_view("play.html"),
                                      &std::pair<std::string_view, std::string_view>::first);
  std::string text(page->second);
  const auto put = [&text](std::string_view mark, const std::string& with) {
    text.replace(text.find(mark), mark.size(), with);
  };
  put("{{title}}", escaped(title));
  put("{{title}}", escaped(title));
  put("{{replay}}", json());
  return text;
}

}  // namespace repose::server
