/// Filling: how grains get into an apparatus. Every procedure counts what it was asked for and what
/// it put in; nobody goes on with less in silence.
#pragma once

#include <functional>
#include <limits>

#include "engine/session.hpp"

namespace repose::engine {

/// Rain: a loose jittered lattice of grains above a rectangle, all at once, from `bottom` upwards.
/// Places that the condition refuses stay empty. Returns the grains put in.
struct Rain {
  double low_x = 0.0, high_x = 0.0;  ///< m
  double low_y = 0.0, high_y = 0.0;
  double bottom = 0.0;
  std::uint64_t grains = 0;                                     ///< asked for
  std::function<bool(const Vec3& centre, double r)> fits = {};  ///< empty: everywhere
  double top = std::numeric_limits<double>::infinity();         ///< of the highest grain, m
};

std::uint64_t rain(Session& session, const Rain& order);

/// Fills a vessel to a level: rain of a tenth more than a close random packing of the vessel's
/// volume (m3) up to that level, rest, strike-off at the level, rest. False where the session
/// failed.
bool fill_to(Session& session, Rain order, double volume, double level);

/// Stream: grains put at random free places in a round opening, falling, at a steady rate. Call
/// feed() at short intervals.
class Stream {
 public:
  struct Order {
    double radius = 0.0;  ///< of the opening, m
    double bottom = 0.0;  ///< of the region in which grains appear, m
    double height = 0.0;  ///< of that region, m
    double rate = 0.0;    ///< grains per second
    double speed = 0.0;   ///< downwards, m/s
  };

  Stream(Session& session, const Order& order);

  /// Puts in what is due by now, as far as there is room; what is not stays due.
  void feed();

 private:
  Session& session_;
  Order order_;
  Random random_;
  double start_;
  std::uint64_t ordered_ = 0;
  std::uint64_t put_ = 0;
};

/// Removes every grain whose centre is above a level; returns how many.
std::size_t strike_off(Session& session, double level);

}  // namespace repose::engine
