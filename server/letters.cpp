#include "server/letters.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace repose::server {

char lower_case(char letter) {
  return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& letter : result) letter = lower_case(letter);
  return result;
}

std::string lower_first(std::string text) {
  const auto is_capital = [&](std::size_t i) {
    return i < text.size() && lower_case(text[i]) != text[i];
  };
  if (is_capital(0) && !is_capital(1)) text.front() = lower_case(text.front());
  return text;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t";
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

bool is_utf8(std::string_view text) {
  // RFC 3629, 4: first bytes, how many follow, and between what the second lies.
  struct Form {
    unsigned char first, last;
    std::size_t more;
    unsigned char least, most;
  };
  static constexpr std::array<Form, 9> forms{{{0x00, 0x7f, 0, 0, 0},
                                              {0xc2, 0xdf, 1, 0x80, 0xbf},
                                              {0xe0, 0xe0, 2, 0xa0, 0xbf},
                                              {0xe1, 0xec, 2, 0x80, 0xbf},
                                              {0xed, 0xed, 2, 0x80, 0x9f},
                                              {0xee, 0xef, 2, 0x80, 0xbf},
                                              {0xf0, 0xf0, 3, 0x90, 0xbf},
                                              {0xf1, 0xf3, 3, 0x80, 0xbf},
                                              {0xf4, 0xf4, 3, 0x80, 0x8f}}};
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  while (!text.empty()) {
    const auto form = std::ranges::find_if(
        forms, [&](const Form& f) { return byte(0) >= f.first && byte(0) <= f.last; });
    if (form == forms.end() || text.size() <= form->more) return false;
    for (std::size_t i = 1; i <= form->more; ++i) {
      const bool second = i == 1;
      if (byte(i) < (second ? form->least : 0x80) || byte(i) > (second ? form->most : 0xbf)) {
        return false;
      }
    }
    text.remove_prefix(form->more + 1);
  }
  return true;
}

bool has_control_letter(std::string_view text) { return without_control_letters(text) != text; }

std::string without_control_letters(std::string_view text) {
  std::string result;
  for (const char letter : text) {
    const auto code = static_cast<unsigned char>(letter);
    const bool second = !result.empty() && result.back() == '\xc2' && code >= 0x80 && code < 0xa0;
    if (second) result.pop_back();
    result += second || code < 0x20 || code == 0x7f ? ' ' : letter;
  }
  return result;
}

}  // namespace repose::server
