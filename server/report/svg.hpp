/// Svg: the text of a drawing, and text made safe to stand in a page.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace repose::server {

/// For text and attribute values of HTML and SVG.
std::string escaped(std::string_view text);

/// One drawing. Colours and type come from the page's style sheet by class.
class Svg {
 public:
  /// `title` is what a screen reader says.
  Svg(double width, double height, std::string_view title);

  void line(double x1, double y1, double x2, double y2, std::string_view style);
  void rect(double x, double y, double width, double height, std::string_view style);
  /// `hint` is what a pointer shows over it; may be empty.
  void circle(
      double x, double y, double radius, std::string_view style, std::string_view hint = {});
  /// One of a cloud of points.
  void dot(double x, double y);
  /// A square on its corner.
  void diamond(double x, double y, double radius, std::string_view style);
  void polyline(const std::vector<std::pair<double, double>>& points, std::string_view style);
  /// Anchored at its "start", "middle" or "end".
  void text(
      double x, double y, std::string_view words, std::string_view anchor, std::string_view style);

  [[nodiscard]] std::string str() const { return body_ + "</svg>\n"; }

 private:
  std::string body_;
};

}  // namespace repose::server
