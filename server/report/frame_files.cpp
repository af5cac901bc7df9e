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
#include "server/report/wall_mesh.hpp"

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

std::string file_name(const char* what, std::size_t number) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "%s_%05zu.vtp", what, number);
  return name.data();
}

/// A PolyData file of one piece; `counts` are its points, vertices and polygons.
std::string poly_data(double time,
                      const std::array<std::size_t, 3>& counts,
                      const std::string& body) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
         "byte_order=\"LittleEndian\" header_type=\"UInt32\">\n<PolyData>\n<FieldData>\n"
         "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">" +
         number_text(time, 9) + "</DataArray>\n</FieldData>\n<Piece NumberOfPoints=\"" +
         std::to_string(counts[0]) + "\" NumberOfVerts=\"" + std::to_string(counts[1]) +
         "\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
         std::to_string(counts[2]) + "\">\n" + body + "</Piece>\n</PolyData>\n</VTKFile>\n";
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
  std::vector<std::int64_t> ids, bodies, cells, ends;
  for (const engine::FrameGrain& grain : frame.grains) {
    points.insert(points.end(), {grain.centre.x, grain.centre.y, grain.centre.z});
    velocities.insert(velocities.end(), {grain.velocity.x, grain.velocity.y, grain.velocity.z});
    radii.push_back(grain.radius);
    ids.push_back(static_cast<std::int64_t>(grain.id));
    bodies.push_back(static_cast<std::int64_t>(grain.body));
    cells.push_back(static_cast<std::int64_t>(cells.size()));
    ends.push_back(static_cast<std::int64_t>(cells.size()));
  }
  return poly_data(frame.time,
                   {count, count, 0},
                   "<PointData Scalars=\"radius\" Vectors=\"velocity\">\n" +
                       array("radius", "Float64", 1, radii) +
                       array("velocity", "Float64", 3, velocities) + array("id", "Int64", 1, ids) +
                       array("body", "Int64", 1, bodies) + "</PointData>\n<Points>\n" +
                       array("Points", "Float64", 3, points) + "</Points>\n<Verts>\n" +
                       array("connectivity", "Int64", 1, cells) +
                       array("offsets", "Int64", 1, ends) + "</Verts>\n");
}

std::string print_walls_vtp(const engine::Frame& frame) {
  std::vector<double> points;
  std::vector<std::int64_t> cells, ends;
  const WallSurfaces walls = wall_surfaces(frame, whole_apparatus(frame));
  for (const WallPatch& patch : walls.patches) {
    const bool is_triangle = patch.corners[2] == patch.corners[3];
    for (std::size_t k = 0; k < (is_triangle ? 3U : 4U); ++k) {
      const engine::Vec3& corner = patch.corners.at(k);
      cells.push_back(static_cast<std::int64_t>(cells.size()));
      points.insert(points.end(), {corner.x, corner.y, corner.z});
    }
    ends.push_back(static_cast<std::int64_t>(cells.size()));
  }
  return poly_data(frame.time,
                   {cells.size(), 0, ends.size()},
                   "<Points>\n" + array("Points", "Float64", 3, points) + "</Points>\n<Polys>\n" +
                       array("connectivity", "Int64", 1, cells) +
                       array("offsets", "Int64", 1, ends) + "</Polys>\n");
}

FrameFiles::FrameFiles(std::filesystem::path folder, std::string title)
    : folder_(std::move(folder)), title_(std::move(title)) {
  std::filesystem::create_directories(folder_);
}

void FrameFiles::write(const engine::Frame& frame) {
  const std::size_t number = times_.size();
  write_file(folder_ / file_name("frame", number), print_vtp(frame));
  write_walls(frame);
  times_.push_back(frame.time);
  replay_.add(frame);
  if (frame.stage == "running" || frame.grains.empty()) return;
  ++pictures_;
  write_file(folder_ / picture_name(pictures_, frame.stage), print_png(picture(frame)));
}

void FrameFiles::write_walls(const engine::Frame& frame) {
  engine::Frame timeless = frame;
  timeless.time = walls_.empty() ? frame.time : times_[walls_.back()];
  const bool same = !walls_.empty() && print_walls_vtp(timeless) == last_walls_;
  walls_.push_back(same ? walls_.back() : times_.size());
  if (same) return;
  last_walls_ = print_walls_vtp(frame);
  write_file(folder_ / file_name("walls", walls_.back()), last_walls_);
}

void FrameFiles::write_index() const {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (std::size_t i = 0; i < times_.size(); ++i) {
    const std::string start = "<DataSet timestep=\"" + number_text(times_[i], 9) + "\" part=\"";
    text += start + "0\" file=\"" + file_name("frame", i) + "\"/>\n";
    text += start + "1\" file=\"" + file_name("walls", walls_[i]) + "\"/>\n";
  }
  write_file(folder_ / "frames.pvd", text + "</Collection>\n</VTKFile>\n");
  if (replay_.frames() > 0) write_file(folder_ / "play.html", replay_.page(title_));
}

}  // namespace repose::server
