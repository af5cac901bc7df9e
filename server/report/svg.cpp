#include "server/report/svg.hpp"

#include "server/report/number_text.hpp"

namespace repose::server {

namespace {

std::string px(double value) { return fixed_text(value, 1); }

std::string attribute(std::string_view name, double value) {
  return " " + std::string(name) + "=\"" + px(value) + "\"";
}

std::string attribute(std::string_view name, std::string_view value) {
  return " " + std::string(name) + "=\"" + escaped(value) + "\"";
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

Svg::Svg(double width, double height, std::string_view title) {
  body_ = "<svg class=\"chart\" role=\"img\" viewBox=\"0 0 " + px(width) + " " + px(height) + "\"" +
          attribute("aria-label", title) + ">";
}

void Svg::line(double x1, double y1, double x2, double y2, std::string_view style) {
  body_ += "<line" + attribute("x1", x1) + attribute("y1", y1) + attribute("x2", x2) +
           attribute("y2", y2) + attribute("class", style) + "/>";
}

void Svg::rect(double x, double y, double width, double height, std::string_view style) {
  body_ += "<rect" + attribute("x", x) + attribute("y", y) + attribute("width", width) +
           attribute("height", height) + attribute("class", style) + "/>";
}

void Svg::circle(double x, double y, double radius, std::string_view style, std::string_view hint) {
  body_ += "<circle" + attribute("cx", x) + attribute("cy", y) + attribute("r", radius) +
           attribute("class", style);
  body_ += hint.empty() ? "/>" : "><title>" + escaped(hint) + "</title></circle>";
}

void Svg::dot(double x, double y) {
  body_ += "<path class=\"speck\" d=\"M" + px(x) + " " + px(y) + "h0\"/>";
}

void Svg::diamond(double x, double y, double radius, std::string_view style) {
  body_ += "<path d=\"M" + px(x) + " " + px(y - radius) + "L" + px(x + radius) + " " + px(y) + "L" +
           px(x) + " " + px(y + radius) + "L" + px(x - radius) + " " + px(y) + "Z\"" +
           attribute("class", style) + "/>";
}

void Svg::polyline(const std::vector<std::pair<double, double>>& points, std::string_view style) {
  body_ += "<polyline points=\"";
  for (const auto& [x, y] : points) body_ += px(x) + "," + px(y) + " ";
  body_ += "\"" + attribute("class", style) + "/>";
}

void Svg::text(
    double x, double y, std::string_view words, std::string_view anchor, std::string_view style) {
  body_ += "<text" + attribute("x", x) + attribute("y", y) + attribute("text-anchor", anchor) +
           attribute("class", style) + ">" + escaped(words) + "</text>";
}

}  // namespace repose::server
