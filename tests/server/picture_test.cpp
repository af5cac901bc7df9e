#include "server/report/picture.hpp"

#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

using repose::engine::Frame;
using repose::engine::FrameGrain;
using repose::engine::FrameWall;
using repose::engine::Vec3;
using repose::server::Image;
using repose::server::picture;

namespace {

constexpr Vec3 down{0.0, 0.0, -9.81};

Image draw(const std::vector<FrameGrain>& grains,
           const Vec3& gravity,
           const std::vector<FrameWall>& walls = {}) {
  const Frame frame{"filled", 0.0, gravity, {}, grains, walls};
  return picture(frame, {.width = 200, .height = 160, .azimuth = 0.0, .elevation = 0.0});
}

int alpha(const Image& image, int x, int y) { return image.pixel(x, y)[3]; }

/// Middle of all that is opaque, pixels.
struct Middle {
  double x = 0.0, y = 0.0, count = 0.0;
};

template <class Condition>
Middle middle_where(const Image& image, Condition condition) {
  Middle middle;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (!condition(image.pixel(x, y))) continue;
      middle.x += x;
      middle.y += y;
      middle.count += 1.0;
    }
  }
  middle.x /= middle.count;
  middle.y /= middle.count;
  return middle;
}

bool opaque(const std::uint8_t* pixel) { return pixel[3] > 127; }

}  // namespace

TEST_CASE("one sphere fills a disc in the middle of the page and nothing else", "[server]") {
  const Image image = draw({{{0.3, -0.2, 0.1}, {}, 0.01, 7}}, down);
  const Middle middle = middle_where(image, opaque);
  CHECK(middle.x == Approx(99.5).margin(0.6));
  CHECK(middle.y == Approx(79.5).margin(0.6));
  const double radius = 0.46 * 160.0;  // the page's height less a margin of 4 % on each side
  CHECK(middle.count == Approx(3.14159 * radius * radius).epsilon(0.01));
  CHECK(alpha(image, 0, 0) == 0);
  CHECK(alpha(image, 199, 159) == 0);
}

TEST_CASE("the edge of a sphere is antialiased", "[server]") {
  const Image image = draw({{{}, {}, 0.01, 7}}, down);
  const Middle partly =
      middle_where(image, [](const std::uint8_t* p) { return p[3] > 0 && p[3] < 255; });
  CHECK(partly.count > 100.0);
}

TEST_CASE("a grain is straw coloured and lit from above", "[server]") {
  const Image image = draw({{{}, {}, 0.01, 7}}, down);
  const std::uint8_t* high = image.pixel(90, 40);
  const std::uint8_t* low = image.pixel(110, 140);
  CHECK(high[0] > high[1]);
  CHECK(high[1] > high[2]);
  CHECK(high[0] > low[0] + 30);
}

TEST_CASE("grains differ in colour by body, members of a clump do not, frame by frame",
          "[server]") {
  const Image one = draw({{{}, {}, 0.01, 1, 1}}, down);
  const Image same = draw({{{0.5, 0.5, 0.5}, {}, 0.01, 2, 1}}, down);
  const Image other = draw({{{}, {}, 0.01, 2, 2}}, down);
  CHECK(one.pixel(100, 80)[0] == Approx(same.pixel(100, 80)[0]).margin(1));
  CHECK(one.pixel(100, 80)[2] != other.pixel(100, 80)[2]);
}

TEST_CASE("the grain nearer to the viewer hides the one behind, whatever their order", "[server]") {
  // The viewer is at -y. Both grains cover the middle of the page.
  const FrameGrain near{{0.0, -0.05, 0.0}, {}, 0.01, 1}, far{{0.0, 0.05, 0.0}, {}, 0.02, 2};
  const Image alone = draw({far}, down);
  const Image one = draw({near, far}, down);
  const Image other = draw({far, near}, down);
  CHECK(one.rgba == other.rgba);
  CHECK(one.pixel(100, 80)[2] != alone.pixel(100, 80)[2]);
}

TEST_CASE("gravity points down the page in a tilted apparatus", "[server]") {
  // A small grain beside a large one, on the side gravity leans to: it must stand lower on the
  // page.
  const FrameGrain large{{0.0, 0.0, 0.0}, {}, 0.01, 1}, small{{0.03, 0.0, 0.0}, {}, 0.002, 2};
  const auto height_of_right_end = [&](const Vec3& gravity) {
    const Image image = draw({large, small}, gravity);
    for (int x = image.width - 1; x >= 0; --x) {
      double sum = 0.0, count = 0.0;
      for (int y = 0; y < image.height; ++y) {
        if (!opaque(image.pixel(x, y))) continue;
        sum += y;
        count += 1.0;
      }
      if (count > 0.0) return sum / count - middle_where(image, opaque).y;
    }
    return 0.0;
  };
  CHECK(std::abs(height_of_right_end(down)) < 2.0);
  CHECK(height_of_right_end({4.9, 0.0, -8.5}) > 10.0);  // pixels below the middle
  CHECK(height_of_right_end({-4.9, 0.0, -8.5}) < -10.0);
}

TEST_CASE("a wall before the bed is glass and a wall behind it is solid", "[server]") {
  const std::vector<FrameGrain> grains{{{0.0, 0.0, 0.01}, {}, 0.01, 1}};
  const std::vector<FrameWall> kettle{
      {.revolved = true, .from_s = 0.012, .to_s = 0.012, .to_z = 0.02}};
  const Image bare = draw(grains, down);
  const Image walled = draw(grains, down, kettle);
  const std::uint8_t* seen = walled.pixel(100, 80);
  CHECK(seen[3] == 255);
  CHECK(seen[0] > seen[2] + 20);  // still the grain's colour, not the wall's
  CHECK(middle_where(walled, opaque).count > middle_where(bare, opaque).count);
}

TEST_CASE("facets of a mesh are drawn like any wall", "[server]") {
  const std::vector<FrameGrain> grains{{{0.0, 0.0, 0.01}, {}, 0.01, 1}};
  FrameWall back;
  back.triangles = {{Vec3{-0.03, 0.02, 0.0}, Vec3{0.03, 0.02, 0.0}, Vec3{0.0, 0.02, 0.04}}};
  const auto count = [](const Image& image) { return middle_where(image, opaque).count; };
  const Image bare = draw(grains, down), walled = draw(grains, down, {back});
  // A sphere that fills a height of 20 mm against a triangle 60 mm wide.
  CHECK(count(bare) == Approx(3.14159 * 73.6 * 73.6).epsilon(0.02));
  CHECK(walled.pixel(100, 80)[3] == 255);
  const auto grey =
      middle_where(walled, [](const std::uint8_t* p) { return p[3] > 127 && p[2] > p[0]; });
  CHECK(grey.count > 1000.0);
}

TEST_CASE("of a drum the whole mantle is drawn, also far above the bed", "[server]") {
  const std::vector<FrameGrain> grains{{{0.0, 0.0, 0.01}, {}, 0.01, 1}};
  FrameWall lid{.from_s = -0.05, .from_z = 0.2, .to_s = 0.05, .to_z = 0.2};
  const Image cut = draw(grains, down, {lid});
  lid.closed = true;
  const Image whole = draw(grains, down, {lid});
  const auto count = [](const Image& image) { return middle_where(image, opaque).count; };
  CHECK(count(cut) > 2.0 * count(whole));  // the grain is drawn smaller beside all of the mantle
}

TEST_CASE("a frame without grains gives an empty page", "[server]") {
  const Image image = draw({}, down);
  CHECK(image.width == 200);
  CHECK(middle_where(image, [](const std::uint8_t* p) { return p[3] > 0; }).count == 0.0);
}

TEST_CASE("equal frames give equal pixels and equal files", "[server]") {
  const std::vector<FrameGrain> grains{{{0.0, 0.0, 0.0}, {}, 0.01, 1},
                                       {{0.02, 0.0, 0.0}, {}, 0.01, 2}};
  CHECK(print_png(draw(grains, down)) == print_png(draw(grains, down)));
  CHECK(print_png(draw(grains, down)).substr(1, 3) == "PNG");
}
