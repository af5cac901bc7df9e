/// FrameFiles: the frames of one run as files: VTK XML PolyData of grains and walls with an index
/// that ParaView opens, a picture of every stage, and a page that plays the run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/frame.hpp"
#include "server/report/replay.hpp"

namespace repose::server {

/// The spheres as .vtp text: points with radius (m), velocity (m/s), id and body (equal for the
/// members of a clump), inline binary.
std::string print_vtp(const engine::Frame& frame);

/// The walls as .vtp text: flat polygons, m; what has no end is cut about the bed.
std::string print_walls_vtp(const engine::Frame& frame);

/// Writes frame_00000.vtp ..., walls_00000.vtp ... (a new one where they have changed),
/// 01_filled.png ..., frames.pvd and play.html into a folder, which is made.
/// Throws std::runtime_error where a file cannot be written.
class FrameFiles {
 public:
  /// `title` stands over the page.
  FrameFiles(std::filesystem::path folder, std::string title);

  void write(const engine::Frame& frame);
  /// The index and the page of all frames so far.
  void write_index() const;

  [[nodiscard]] std::size_t frames() const { return times_.size(); }
  [[nodiscard]] std::size_t pictures() const { return pictures_; }

 private:
  void write_walls(const engine::Frame& frame);

  std::filesystem::path folder_;
  std::string title_;
  std::vector<double> times_;       // s, of the frames written
  std::vector<std::size_t> walls_;  // by frame: the number of its walls' file
  std::string last_walls_;          // their text
  Replay replay_;
  std::size_t pictures_ = 0;
};

/// Writes a whole file; throws std::runtime_error naming it where that fails.
void write_file(const std::filesystem::path& path, const std::string& bytes);

}  // namespace repose::server
