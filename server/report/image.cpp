#include "server/report/image.hpp"

#include <stdexcept>
#include <string_view>

#include <png.h>

namespace repose::server {

std::string print_png(const Image& image) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGBA;
  const auto write = [&](void* memory, png_alloc_size_t* size) {
    return png_image_write_to_memory(&header, memory, size, 0, image.rgba.data(), 0, nullptr) != 0;
  };
  png_alloc_size_t size = 0;
  std::string bytes;
  if (!write(nullptr, &size)) throw std::runtime_error(std::string("PNG: ") + header.message);
  bytes.resize(size);
  if (!write(bytes.data(), &size)) throw std::runtime_error(std::string("PNG: ") + header.message);
  bytes.resize(size);
  return bytes;
}

std::string base64(const std::string& bytes) {
  constexpr std::string_view letters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const unsigned byte = i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U;
      group = group << 8U | byte;
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const bool padding = i + k > bytes.size();
      text += padding ? '=' : letters[group >> (18U - 6U * k) & 63U];
    }
  }
  return text;
}

}  // namespace repose::server
