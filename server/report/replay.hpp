/// Replay: the frames of one run in a compact form, and the page that plays it. The page stands
/// alone: it opens as a file and asks no network.
///
/// A frame holds which of the grains seen so far are there, a bit each, and their centres as 16-bit
/// shares of the box about them: 6 bytes a grain, to 1/65535 of the box. Radii and bodies stand
/// once. Walls stand once until they move.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "engine/frame.hpp"
#include "server/report/view.hpp"

namespace repose::server {

class Replay {
 public:
  /// Running frames are thinned out, every second one each time, where all would take more bytes.
  explicit Replay(std::size_t most_bytes = 24'000'000) : most_bytes_(most_bytes) {}

  void add(const engine::Frame& frame);
  [[nodiscard]] std::size_t frames() const { return moments_.size(); }

  /// As JSON: {"box", "radius", "body", "walls": [{"corners", "edges"}], "frames": [{
  /// "stage", "time", "gravity", "box", "present", "centres", "walls"}]}; arrays as base64 of
  /// little-endian float32 (radius, corners of patches 12 numbers each, edges 6), uint32 (body),
  /// bits (present, lowest first) and uint16 (centres: x, y, z of each grain that is present).
  [[nodiscard]] std::string json() const;

  /// The page, as HTML.
  [[nodiscard]] std::string page(std::string_view title) const;

 private:
  struct Moment {
    std::string stage;
    double time = 0.0;     // s
    engine::Vec3 gravity;  // m/s2
    Bounds box;            // about the centres, m
    std::vector<std::uint8_t> present;
    std::vector<std::uint16_t> centres;
    std::size_t walls = 0;
  };
  struct Walls {
    std::vector<float> corners, edges;  // m
    bool operator==(const Walls&) const = default;
  };

  std::size_t slot_of(const engine::FrameGrain& grain);
  void add_grains(const engine::Frame& frame, Moment& moment);
  void add_walls(const engine::Frame& frame, Moment& moment);
  void thin_out();

  std::size_t most_bytes_;
  std::size_t bytes_ = 0;
  std::size_t running_ = 0;                               // frames offered between stages
  std::size_t every_ = 1;                                 // of these, one in so many is kept
  Bounds box_;                                            // what the page shows, m
  std::unordered_map<std::uint64_t, std::size_t> slots_;  // by grain id
  std::vector<float> radius_;                             // m, by slot
  std::vector<std::uint32_t> body_;                       // by slot
  std::vector<Walls> walls_;
  std::vector<Moment> moments_;
};

}  // namespace repose::server
