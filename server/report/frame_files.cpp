#include "server/report/frame_files.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "server/report/image.hpp"
#include "server/report/number_text.hpp"
#include "server/report/picture.hpp"

namespace repose::server {

namespace {

static_assert(std::endian::native == std::endian::little, "the files say byte_order LittleEndian");

/// Raw bytes with their count before them, as base64 (VTK file formats, inline binary data).
template <class T>
std::string packed(const std::vector<T>& values) {
  const auto size = static_cast<std::uint32_t>(values.size() * sizeof(T));
  std::string bytes(sizeof size + size, '\0');
  std::memcpy(bytes.data(), &size, sizeof size);
  if (size > 0) std::memcpy(bytes.data() + sizeof size, values.data(), size);
  return base64(bytes);
}

template <class T>
std::string array(const std::string& name,
                  const std::string& type,
                  int components,
                  const std::vector<T>& values) {
  return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\" format=\"binary\">" + packed(values) + "</DataArray>\n";
}

std::string file_name(std::size_t frame) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "frame_%05zu.vtp", frame);
  return name.data();
}

std::string picture_name(std::size_t number, std::string_view stage) {
  std::array<char, 16> digits{};
  std::snprintf(digits.data(), digits.size(), "%02zu_", number);
  std::string name = digits.data();
  for (const char c : stage) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name + ".png";
}

}  // namespace

void write_file(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) {
    throw std::runtime_error(path.string() +
                             " cannot be written: " + std::generic_category().message(errno));
  }
}

std::string print_vtp(const engine::Frame& frame) {
  const std::size_t count = frame.grains.size();
  std::vector<double> points, velocities, radii;
  std::vector<std::int64_t> ids, cells, ends;
  for (const engine::FrameGrain& grain : frame.grains) {
    points.insert(points.end(), {grain.centre.x, grain.centre.y, grain.centre.z});
    velocities.insert(velocities.end(), {grain.velocity.x, grain.velocity.y, grain.velocity.z});
    radii.push_back(grain.radius);
    ids.push_back(static_cast<std::int64_t>(grain.id));
    cells.push_back(static_cast<std::int64_t>(cells.size()));
    ends.push_back(static_cast<std::int64_t>(cells.size()));
  }
  const std::string n = std::to_string(count);
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
         "byte_order=\"LittleEndian\" header_type=\"UInt32\">\n<PolyData>\n<FieldData>\n"
         "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">" +
         number_text(frame.time, 9) +
         "</DataArray>\n</FieldData>\n"
         "<Piece NumberOfPoints=\"" +
         n + "\" NumberOfVerts=\"" + n +
         "\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n"
         "<PointData Scalars=\"radius\" Vectors=\"velocity\">\n" +
         array("radius", "Float64", 1, radii) + array("velocity", "Float64", 3, velocities) +
         array("id", "Int64", 1, ids) + "</PointData>\n<Points>\n" +
         array("Points", "Float64", 3, points) + "</Points>\n<Verts>\n" +
         array("connectivity", "Int64", 1, cells) + array("offsets", "Int64", 1, ends) +
         "</Verts>\n</Piece>\n</PolyData>\n</VTKFile>\n";
}

FrameFiles::FrameFiles(std::filesystem::path folder) : folder_(std::move(folder)) {
  std::filesystem::create_directories(folder_);
}

void FrameFiles::write(const engine::Frame& frame) {
  write_file(folder_ / file_name(times_.size()), print_vtp(frame));
  times_.push_back(frame.time);
  if (frame.stage == "running" || frame.grains.empty()) return;
  ++pictures_;
  write_file(folder_ / picture_name(pictures_, frame.stage), print_png(picture(frame)));
}

void FrameFiles::write_index() const {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (std::size_t i = 0; i < times_.size(); ++i) {
    text += "<DataSet timestep=\"" + number_text(times_[i], 9) + "\" part=\"0\" file=\"" +
            file_name(i) + "\"/>\n";
  }
  write_file(folder_ / "frames.pvd", text + "</Collection>\n</VTKFile>\n");
}

}  // namespace repose::server
