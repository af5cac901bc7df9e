#include "server/laboratory/drawings.hpp"

#include <algorithm>
#include <array>

namespace repose::server {

namespace {

struct Drawing {
  std::string_view experiment;
  std::string_view drawing;
};

// Settings by their names. o: a grain.
constexpr std::array drawings{
    Drawing{"drop", R"(
        o       released at rest
        |                          ^
        |        o  first apex     |
        |       ^  ^               | height
        v       |  | H_r           |
    ____|_______|__v_______________v__
    //////////////// wall ////////////)"},
    Drawing{"kettle", R"(
           \ o o /     source: hopper, or a stream of `rate` and `speed`
            \o o/
             | |       opening  ^
              o                 | drop
         o  o o  o              v
      o _|o o o o o|_ o   rim: what stands above it is struck off
         | o o o o |      ^
         |o o o o o|      | height
     ____|_o_o_o_o_|______v___  floor
         <diameter >)"},
    Drawing{"tilting_box", R"(
      top layer, 20 mm clear of the ends
        | o o o o o o o o o o o |  rim             o .|
        |o o o o o o o o o o o o|  ^           o . o o|   static_angle:
        | o o o o o o o o o o o |  | depth  | o o o . |   it has slid by `slide`
        |o_o_o_o_o_o_o_o_o_o_o_o|  v        |o . '       onset_angle:
        <------- length -------->           '   turns at `rate`   `onset_speed`
      endless (periodic) across its `width`, base of grains' stuff)"},
    Drawing{"heap", R"(
         ||      ||   lifted at lift_speed
         || o o o||   ^                            o
         ||o o o ||   | fill                     o o o    heap_angle
         || o o o||   |                        o o o o o
    _|___||o_o_o_||___v_|_                |_o_o_o_o_o_o_o_|   rim
          <------> cylinder_diameter       <-- disc_diameter ->
      surplus falls off the disc and is removed)"},
    Drawing{"draw_down", R"(
    |o o o o o o o o o o o|  ^           |o                   o|
    | o o o o o o o o o o |  | depth     | o o             o o |  drain_angle
    |o o o o o o o o o o o|  |           |o o o           o o o|
    |_o_o_o__     _o_o_o_o|  v           |_o_o_o__     _o_o_o_o|
             slot                                 o o
    <------- length ------>                       o o    discharge_rate
      endless (periodic) along its `width`, floor of grains' stuff)"},
    Drawing{"drum", R"(
         .-----.
       /.        \      `ribs` ribs, a grain high
      | o o .      |
      |o o o o .   |    dynamic_angle: slope of the surface that flows,
       \ o o o o ./     mean over `seconds`
         '-----'        turns at `speed`, filled to `fill`
      < diameter  >     endless (periodic) along its `length`)"},
    Drawing{"compression", R"(
      ==================  platen, down and up at `speed`
       o o o o o o o o    ^                stress |      /|
      o o o o o o o o o   | depth                 |    /  |   secant_modulus: up
       o o o o o o o o    |                       |  /   /    residual_strain_ratio:
      o_o_o_o_o_o_o_o_o   v                       |/___/___     what does not come back
      <---- side ----->   base                        strain
      endless (periodic) both ways; up to `overshoot` x `stress`)"},
};

}  // namespace

std::string_view drawing_of(std::string_view experiment) {
  const auto found = std::ranges::find(drawings, experiment, &Drawing::experiment);
  return found == drawings.end() ? std::string_view() : found->drawing;
}

}  // namespace repose::server
