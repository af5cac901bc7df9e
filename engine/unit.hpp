/// Unit: a unit accepted at the boundary. Inside there is only SI; an angle counts as a dimension
/// of its own, so that degrees are refused where a plain number is meant.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace repose::engine {

/// Exponents of metre, kilogram, second, radian.
struct Dimension {
  std::int8_t length = 0;
  std::int8_t mass = 0;
  std::int8_t time = 0;
  std::int8_t angle = 0;

  constexpr bool operator==(const Dimension&) const = default;
};

struct Unit {
  std::string_view symbol = "1";
  Dimension dimension = {};
  double factor = 1.0;  ///< SI value of one such unit

  constexpr bool operator==(const Unit&) const = default;
};

namespace unit {

inline constexpr double pi = 3.14159265358979323846;
inline constexpr Unit one{"1", {}, 1.0};
inline constexpr Unit percent{"%", {}, 1e-2};
inline constexpr Unit metre{"m", {1, 0, 0, 0}, 1.0};
inline constexpr Unit centimetre{"cm", {1, 0, 0, 0}, 1e-2};
inline constexpr Unit millimetre{"mm", {1, 0, 0, 0}, 1e-3};
inline constexpr Unit micrometre{"um", {1, 0, 0, 0}, 1e-6};
inline constexpr Unit inch{"in", {1, 0, 0, 0}, 0.0254};
inline constexpr Unit second{"s", {0, 0, 1, 0}, 1.0};
inline constexpr Unit millisecond{"ms", {0, 0, 1, 0}, 1e-3};
inline constexpr Unit kilogram{"kg", {0, 1, 0, 0}, 1.0};
inline constexpr Unit gram{"g", {0, 1, 0, 0}, 1e-3};
inline constexpr Unit milligram{"mg", {0, 1, 0, 0}, 1e-6};
inline constexpr Unit kilogram_per_second{"kg/s", {0, 1, -1, 0}, 1.0};
inline constexpr Unit kilogram_per_cubic_metre{"kg/m3", {-3, 1, 0, 0}, 1.0};
inline constexpr Unit gram_per_cubic_centimetre{"g/cm3", {-3, 1, 0, 0}, 1e3};
inline constexpr Unit kilogram_per_second_metre{"kg/(s m)", {-1, 1, -1, 0}, 1.0};
inline constexpr Unit pascal{"Pa", {-1, 1, -2, 0}, 1.0};
inline constexpr Unit kilopascal{"kPa", {-1, 1, -2, 0}, 1e3};
inline constexpr Unit megapascal{"MPa", {-1, 1, -2, 0}, 1e6};
inline constexpr Unit gigapascal{"GPa", {-1, 1, -2, 0}, 1e9};
inline constexpr Unit pascal_second{"Pa s", {-1, 1, -1, 0}, 1.0};
inline constexpr Unit joule_per_cubic_metre{"J/m3", {-1, 1, -2, 0}, 1.0};
inline constexpr Unit joule_per_square_metre{"J/m2", {0, 1, -2, 0}, 1.0};
inline constexpr Unit newton_per_metre{"N/m", {0, 1, -2, 0}, 1.0};
inline constexpr Unit metre_per_second{"m/s", {1, 0, -1, 0}, 1.0};
inline constexpr Unit millimetre_per_second{"mm/s", {1, 0, -1, 0}, 1e-3};
inline constexpr Unit metre_per_second_squared{"m/s2", {1, 0, -2, 0}, 1.0};
inline constexpr Unit radian{"rad", {0, 0, 0, 1}, 1.0};
inline constexpr Unit degree{"deg", {0, 0, 0, 1}, pi / 180.0};
inline constexpr Unit radian_per_second{"rad/s", {0, 0, -1, 1}, 1.0};
inline constexpr Unit degree_per_second{"deg/s", {0, 0, -1, 1}, pi / 180.0};
inline constexpr Unit revolution_per_minute{"rpm", {0, 0, -1, 1}, pi / 30.0};

/// Every unit accepted at the boundary.
std::span<const Unit> all();

/// The unit with that symbol, if there is one.
std::optional<Unit> find(std::string_view symbol);

}  // namespace unit

/// In at most that many figures, without zeros at the end: "0.25", "1.3e+06".
std::string short_number(double value, int figures = 6);

/// A value, SI, in a unit: "19.5 mm".
std::string quantity_text(double value, const Unit& unit);

}  // namespace repose::engine
