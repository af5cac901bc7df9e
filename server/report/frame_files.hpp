/// FrameFiles: the frames of one run as files: VTK XML PolyData with an index that ParaView opens,
/// and a picture of every stage.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/frame.hpp"

namespace repose::server {

/// The grains as .vtp text: points with radius (m), velocity (m/s) and id, inline binary.
std::string print_vtp(const engine::Frame& frame);

/// Writes frame_00000.vtp ..., 01_filled.png ... and frames.pvd into a folder, which is made.
/// Throws std::runtime_error where a file cannot be written.
class FrameFiles {
 public:
  explicit FrameFiles(std::filesystem::path folder);

  void write(const engine::Frame& frame);
  /// The index of all frames so far.
  void write_index() const;

  [[nodiscard]] std::size_t frames() const { return times_.size(); }
  [[nodiscard]] std::size_t pictures() const { return pictures_; }

 private:
  std::filesystem::path folder_;
  std::vector<double> times_;  // s, of the frames written
  std::size_t pictures_ = 0;
};

/// Writes a whole file; throws std::runtime_error naming it where that fails.
void write_file(const std::filesystem::path& path, const std::string& bytes);

}  // namespace repose::server
