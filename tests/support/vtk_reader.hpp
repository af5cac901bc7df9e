/// A reader of VTK's XML files, written from the published grammar (XML 1.0; "VTK File Formats",
/// VTK User's Guide, appendix) and not from the writer: it refuses what ParaView would refuse.
#pragma once

#include <cctype>
#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace repose::tests {

struct XmlElement {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::vector<XmlElement> children;
  std::string text;

  /// The only child of that name.
  [[nodiscard]] const XmlElement& child(std::string_view wanted) const {
    const XmlElement* found = nullptr;
    for (const XmlElement& candidate : children) {
      if (candidate.name != wanted) continue;
      if (found != nullptr) throw std::runtime_error("two of " + std::string(wanted));
      found = &candidate;
    }
    if (found == nullptr) throw std::runtime_error("no " + std::string(wanted));
    return *found;
  }
  [[nodiscard]] const std::string& at(const std::string& attribute) const {
    return attributes.at(attribute);
  }
};

/// Elements, attributes, text and a declaration: no comments, entities or CDATA.
class XmlReader {
 public:
  explicit XmlReader(std::string_view text) : text_(text) {}

  XmlElement document() {
    if (take("<?xml")) at_ = text_.find("?>") + 2;
    space();
    XmlElement root = element();
    space();
    if (at_ != text_.size()) fail("text after the root");
    return root;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw std::runtime_error("XML: " + why + " at " + std::to_string(at_));
  }
  [[nodiscard]] char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  bool take(std::string_view word) {
    if (!text_.substr(at_).starts_with(word)) return false;
    at_ += word.size();
    return true;
  }
  void need(std::string_view word) {
    if (!take(word)) fail("no " + std::string(word));
  }
  void space() {
    while (std::isspace(static_cast<unsigned char>(peek())) != 0) ++at_;
  }
  std::string name() {
    const std::size_t from = at_;
    while (std::isalnum(static_cast<unsigned char>(peek())) != 0 || peek() == '_') ++at_;
    if (at_ == from) fail("no name");
    return std::string(text_.substr(from, at_ - from));
  }

  XmlElement element() {
    need("<");
    XmlElement result;
    result.name = name();
    for (space(); peek() != '>' && peek() != '/'; space()) {
      const std::string attribute = name();
      need("=\"");
      const std::size_t end = text_.find_first_of("\"<", at_);
      if (end == std::string_view::npos || text_[end] == '<') fail("attribute without an end");
      if (!result.attributes.emplace(attribute, text_.substr(at_, end - at_)).second) {
        fail("an attribute twice");
      }
      at_ = end + 1;
    }
    if (take("/>")) return result;
    need(">");
    while (!text_.substr(at_).starts_with("</")) {
      if (at_ >= text_.size()) fail("an element without an end");
      if (peek() == '<') {
        result.children.push_back(element());
      } else {
        result.text += text_[at_++];
      }
    }
    need("</");
    need(result.name);
    need(">");
    return result;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

/// RFC 4648, section 4; refuses letters outside the alphabet and wrong padding.
inline std::string base64_decoded(std::string_view text) {
  constexpr std::string_view letters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  if (text.size() % 4 != 0) throw std::runtime_error("base64: not in groups of four");
  const std::size_t end = text.find('=');
  if (end != std::string_view::npos && text.size() - end > 2) {
    throw std::runtime_error("base64: too much padding");
  }
  std::string bytes;
  std::uint32_t group = 0, bits = 0;
  for (const char c : text.substr(0, end)) {
    const std::size_t value = letters.find(c);
    if (value == std::string_view::npos) throw std::runtime_error("base64: not a letter of it");
    group = (group << 6U | static_cast<std::uint32_t>(value)) & 0xffffffU;
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(group >> bits & 255U);
  }
  return bytes;
}

/// The numbers of a DataArray in format "binary" behind a UInt32 that counts their bytes.
template <class T>
std::vector<T> data_array(const XmlElement& array) {
  const std::string type = std::is_same_v<T, double> ? "Float64" : "Int64";
  if (array.at("type") != type) throw std::runtime_error("array is no " + type);
  if (array.at("format") != "binary") throw std::runtime_error("array is not binary");
  const std::string bytes = base64_decoded(array.text);
  std::uint32_t size = 0;
  if (bytes.size() < sizeof size) throw std::runtime_error("array without its size");
  std::memcpy(&size, bytes.data(), sizeof size);
  if (bytes.size() != sizeof size + size || size % sizeof(T) != 0) {
    throw std::runtime_error("array of another size than it says");
  }
  std::vector<T> values(size / sizeof(T));
  if (size > 0) std::memcpy(values.data(), bytes.data() + sizeof size, size);
  return values;
}

/// What a PolyData file of one piece holds.
struct PolyData {
  double time = 0.0;
  std::vector<double> points;                           ///< x, y, z of each
  std::vector<std::vector<std::int64_t>> verts, polys;  ///< cells: numbers of points
  std::map<std::string, std::vector<double>> reals;     ///< point data
  std::map<std::string, std::vector<std::int64_t>> whole;
};

inline std::vector<std::vector<std::int64_t>> cells_of(const XmlElement& piece,
                                                       const std::string& kind,
                                                       std::size_t points) {
  std::vector<std::vector<std::int64_t>> cells;
  const std::size_t count = std::stoul(piece.at("NumberOf" + kind));
  if (count == 0) return cells;
  std::map<std::string, std::vector<std::int64_t>> arrays;
  for (const XmlElement& array : piece.child(kind).children) {
    arrays[array.at("Name")] = data_array<std::int64_t>(array);
  }
  const auto& connectivity = arrays.at("connectivity");
  std::int64_t from = 0;
  for (const std::int64_t end : arrays.at("offsets")) {
    if (end <= from || end > static_cast<std::int64_t>(connectivity.size())) {
      throw std::runtime_error("offsets do not rise within the connectivity");
    }
    cells.emplace_back(connectivity.begin() + from, connectivity.begin() + end);
    from = end;
  }
  if (cells.size() != count || from != static_cast<std::int64_t>(connectivity.size())) {
    throw std::runtime_error("another number of " + kind + " than the piece says");
  }
  for (const std::int64_t point : connectivity) {
    if (point < 0 || point >= static_cast<std::int64_t>(points)) {
      throw std::runtime_error("a cell names a point that is not there");
    }
  }
  return cells;
}

inline PolyData read_poly_data(std::string_view text) {
  const XmlElement root = XmlReader(text).document();
  if (root.name != "VTKFile" || root.at("type") != "PolyData" ||
      root.at("byte_order") != "LittleEndian" || root.at("header_type") != "UInt32") {
    throw std::runtime_error("not a little-endian VTK PolyData file with UInt32 headers");
  }
  const XmlElement& body = root.child("PolyData");
  const XmlElement& piece = body.child("Piece");
  const std::size_t count = std::stoul(piece.at("NumberOfPoints"));
  PolyData data;
  data.time = std::stod(body.child("FieldData").child("DataArray").text);
  data.points = data_array<double>(piece.child("Points").child("DataArray"));
  if (data.points.size() != 3 * count) throw std::runtime_error("another number of points");
  for (const XmlElement& part : piece.children) {
    if (part.name != "PointData") continue;
    for (const XmlElement& array : part.children) {
      const std::string& name = array.at("Name");
      const std::size_t wanted = count * std::stoul(array.at("NumberOfComponents"));
      const bool real = array.at("type") == "Float64";
      if (real) data.reals[name] = data_array<double>(array);
      if (!real) data.whole[name] = data_array<std::int64_t>(array);
      if ((real ? data.reals[name].size() : data.whole[name].size()) != wanted) {
        throw std::runtime_error("point data " + name + " of another length");
      }
    }
  }
  data.verts = cells_of(piece, "Verts", count);
  data.polys = cells_of(piece, "Polys", count);
  return data;
}

/// One line of a .pvd collection.
struct DataSet {
  double time = 0.0;
  int part = 0;
  std::string file;
};

inline std::vector<DataSet> read_collection(std::string_view text) {
  const XmlElement root = XmlReader(text).document();
  if (root.name != "VTKFile" || root.at("type") != "Collection") {
    throw std::runtime_error("not a VTK collection");
  }
  std::vector<DataSet> sets;
  for (const XmlElement& set : root.child("Collection").children) {
    sets.push_back({std::stod(set.at("timestep")), std::stoi(set.at("part")), set.at("file")});
  }
  return sets;
}

}  // namespace repose::tests
