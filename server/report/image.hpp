/// Image: pixels with transparency, and their PNG.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace repose::server {

struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t>
      rgba;  ///< rows from the top, four bytes a pixel, alpha not premultiplied

  [[nodiscard]] const std::uint8_t* pixel(int x, int y) const {
    return rgba.data() + (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                          static_cast<std::size_t>(x)) *
                             4;
  }
};

/// The file's bytes. Throws std::runtime_error where libpng cannot write it.
std::string print_png(const Image& image);

/// For a data: address inside a page.
std::string base64(const std::string& bytes);

}  // namespace repose::server
