#include "server/report/page.hpp"

#include "server/report/report_style.hpp"
#include "server/report/svg.hpp"

namespace repose::server {

namespace {

/// The undetermined intervals' pattern, shared by the charts of the page.
constexpr std::string_view swatches =
    "<svg class=\"swatches\" aria-hidden=\"true\"><defs><pattern id=\"hatch\" width=\"6\" "
    "height=\"6\" patternUnits=\"userSpaceOnUse\" patternTransform=\"rotate(45)\"><rect "
    "width=\"2.4\" height=\"6\" style=\"fill:var(--open)\"/></pattern></defs></svg>\n";

}  // namespace

std::string element(std::string_view name, std::string_view words, std::string_view style) {
  const std::string tag(name);
  const std::string of = style.empty() ? "" : " class=\"" + std::string(style) + "\"";
  return "<" + tag + of + ">" + escaped(words) + "</" + tag + ">";
}

std::string cell(std::string_view head, std::string_view words, std::string_view style) {
  return "<td data-head=\"" + escaped(head) + "\" class=\"" + std::string(style) + "\">" +
         "<span>" + escaped(words) + "</span></td>";
}

std::string described(std::string_view term, std::string_view what) {
  return element("dt", term) + element("dd", what) + "\n";
}

std::string page_head(std::string_view title) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<title>" +
         escaped(title) + "</title>\n<style>" + std::string(report_style) +
         "</style>\n</head>\n<body>\n" + std::string(swatches) + "<main>\n";
}

}  // namespace repose::server
