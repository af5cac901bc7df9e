/// The stand-in's physics, made up: logarithms of bulk observables from five parameters, thirteen
/// effects and some departures outside any catalogue. Its rankings and error rates count, not its
/// numbers.
///
/// The settings of an experiment are its condition: moisture M (%), height h (m), Froude number Fr,
/// stress sg (kPa), size of an orifice o and of a heap b over the usual, kinetic (1) friction k,
/// gently (1) or tapped (2) filled f.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "engine/random.hpp"

namespace repose::stand_in {

inline constexpr std::array<std::string_view, 13> effects{"shape",
                                                          "jkr",
                                                          "capillary",
                                                          "visco_e",
                                                          "plastic_e",
                                                          "hysteresis",
                                                          "drag",
                                                          "wall",
                                                          "twist",
                                                          "weaken",
                                                          "moist_G",
                                                          "moist_mu",
                                                          "tap"};

/// Outside the catalogue. The trace of breakage is that of hysteresis; "anything" shifts every kind
/// of observable, each with a trend along moisture, in a direction that its strength's digits
/// choose.
inline constexpr std::array<std::string_view, 6> outside{
    "swelling", "breakage", "tilt_bias", "static_charge", "segregation", "anything"};

/// The rig at which a departure of that kind sits; empty: at none, or at all.
inline std::string_view rig_of(std::string_view departure) {
  if (departure == "swelling") return "density";
  if (departure == "tilt_bias") return "static_angle";
  if (departure == "static_charge") return "wall_angle";
  if (departure == "segregation") return "drawdown_angle";
  return {};
}

/// Strengths by name; absent: none.
using Hidden = std::map<std::string, double, std::less<>>;

struct Observable {
  std::string rig;
  std::string kind;
  double measured;   ///< standard error of its measurement, relative
  double simulated;  ///< scatter of a run, relative
};

inline const std::map<std::string, Observable>& observables() {
  static const std::map<std::string, Observable> all{
      {"density", {"kettle", "dens", 0.008, 0.004}},
      {"static_angle", {"tiltbox", "stat", 0.025, 0.030}},
      {"heap_angle", {"heap", "heap", 0.030, 0.030}},
      {"rebound", {"drop", "reb", 0.020, 0.004}},
      {"rate", {"hopper", "rate", 0.015, 0.012}},
      {"drawdown_angle", {"hopper", "draw", 0.030, 0.030}},
      {"drum_angle", {"drum", "drum", 0.020, 0.015}},
      {"stiffness", {"oedo", "stif", 0.030, 0.020}},
      {"residual", {"oedo", "resd", 0.030, 0.030}},
      {"wall_angle", {"plane", "wang", 0.020, 0.006}},
      {"shear_intercept", {"shear", "shci", 0.150, 0.100}},
      {"shear_angle", {"shear", "shca", 0.020, 0.020}},
      {"spin_torque", {"spin", "spin", 0.040, 0.020}},
  };
  return all;
}

/// The logarithm of one observable.
inline double response(const std::array<double, 5>& u,
                       const Hidden& hidden,
                       const std::string& observable,
                       const std::map<std::string, double>& condition) {
  const auto phi = [&](std::string_view name) {
    const auto found = hidden.find(name);
    return found == hidden.end() ? 0.0 : found->second;
  };
  const auto at = [&](const char* name) {
    const auto found = condition.find(name);
    return found == condition.end() ? 0.0 : found->second;
  };
  const auto over_usual = [&](const char* name) {
    const auto found = condition.find(name);
    return found == condition.end() ? 1.0 : found->second;
  };
  const auto th = [](double x) { return std::tanh(x); };
  const double e = 0.35 + 0.55 * u[0], mu0 = 0.15 + 0.60 * u[1], mur = 0.02 + 0.28 * u[2];
  const double s = 0.05 + 0.30 * u[3], lgG = 6.0 + 2.5 * u[4];
  const double a = phi("shape"), hy = phi("hysteresis"), dr = phi("drag"), tp = phi("tap");
  const double tw = phi("twist"), dw = phi("wall"), wk = phi("weaken"), ch = phi("static_charge");
  const double sg = phi("segregation"), br = phi("breakage");
  const double moist = at("M"), m = (moist - 10.0) / 8.0;
  const double mu = mu0 * (1 + 0.6 * phi("moist_mu") * m);
  const double G = std::pow(10.0, lgG - 0.55 * phi("moist_G") * m);
  const double en = e - 0.12 * phi("moist_G") * m;
  const double muk = mu * (1 - 0.45 * wk), muw = mu * (1 + 0.5 * dw);
  const double t = std::max((moist - 11.0) / 7.0, 0.0);
  const double Bo = 2.5 * phi("jkr") + 3.0 * phi("capillary") * std::pow(t, 1.3) / (1 + 0.4 * t);
  const double bump = (a / 0.45) * std::exp(1 - a / 0.45);
  const double pf = 0.640 - 0.060 * th(mu / 0.35) - 0.040 * th(mur / 0.12) + 0.28 * s * s +
                    0.015 * (en - 0.6) - 0.085 * Bo / (Bo + 2.5) +
                    0.040 * bump * (1 - 0.5 * th(mu / 0.5)) - 0.015 * a * a - 0.004 * dw -
                    0.004 * dr - 0.006 * tw * th(mu / .4) + 0.0015 * std::pow(1e7 / G, 2.0 / 3.0) -
                    0.008 * ch;
  const double pfp = pf + 0.055 * tp * (0.66 - pf) / 0.08;
  const double roll = 0.35 + 0.65 * th(mu / 0.4);
  const std::string& kind = observables().at(observable).kind;
  double value = 0.0;
  if (kind == "dens") {
    const double tapped = pf + 0.75 * (0.655 + 0.25 * s * s + 0.03 * bump - pf);
    const double packed = at("f") == 1.0 ? pf - 0.004 : at("f") == 2.0 ? tapped : pfp;
    value = packed * std::exp(-0.06 * phi("swelling") * m);
  } else if (kind == "stat") {
    value = 0.24 + 0.30 * th(mu / 0.45) + 0.42 * th(mur / 0.15) * roll + 0.10 * th(2.2 * a) +
            0.15 * Bo / (1 + 0.30 * Bo) + 0.045 * tw * th(mu / 0.4) - 0.06 * (s - 0.2) +
            0.015 * dw + 0.02 * ch;
    value *= 1 + 0.10 * phi("tilt_bias");
  } else if (kind == "heap") {
    value = 0.21 + 0.28 * th(0.5 * (mu + muk) / 0.45) +
            0.45 * th(mur / 0.13) * (0.35 + 0.65 * th(0.5 * (mu + muk) / .4)) + 0.09 * th(2.0 * a) +
            0.10 / std::pow(over_usual("b"), 0.7) * Bo / (1 + 0.30 * Bo) +
            0.050 * tw * th(mu / 0.4) - 0.14 * (en - 0.5) - 0.02 * dr + 0.06 * sg;
  } else if (kind == "reb") {
    const double h = at("h");
    const double v = std::sqrt(2 * 9.81 * h) * (1 - 0.06 * dr * std::min(h, 2.0) / 0.4);
    value = en - 0.30 * phi("visco_e") * (std::pow(v, 0.2) - 1.0);
    value *= std::pow(std::sqrt(v * v + 0.36) / 1.2, -0.25 * phi("plastic_e"));
    value *= (1 - 0.10 * a) * (1 - 0.20 * hy) * (1 - 0.05 * dr * std::min(h, 2.0) / 0.4);
    value = std::max(value - 0.012 * Bo / (v * v) * 0.5, 0.03);
  } else if (kind == "rate") {
    const double o = over_usual("o");
    value = 0.58 * (pf / 0.6) * (1 - 0.25 * th(muk / 0.4)) * (1 - 0.10 * th(mur / 0.15)) *
            (1 - 0.08 * a / o) * (1 - 0.13 / o * Bo / (1 + Bo)) * (1 - 0.06 * dr / o) *
            (1 + 0.05 * (en - .6)) * (1 - 0.03 * dw) * (1 + 0.10 * (s - .2)) * (1 - 0.07 * ch) *
            (1 - 0.06 * sg);
  } else if (kind == "draw") {
    value = 0.30 + 0.32 * th(mu / 0.45) + 0.40 * th(mur / 0.15) * roll + 0.12 * th(2.2 * a) +
            0.22 * Bo / (1 + 0.25 * Bo) + 0.040 * tw * th(mu / 0.4) + 0.02 * dw - 0.08 * sg;
  } else if (kind == "drum") {
    const double q = std::sqrt(at("Fr"));
    const double mf = mu + (muk - mu) * th(0.3 + 6 * q);
    value = 0.23 + 0.30 * th(mf / 0.45) + 0.42 * th(mur / 0.15) * (0.35 + 0.65 * th(mf / .4)) +
            0.55 * q * (0.6 + 0.8 * th(mf / 0.5)) + 0.09 * th(2.0 * a) * (1 + 0.5 * q) +
            0.13 * Bo / (1 + 0.30 * Bo) * (1 - 0.8 * q) + 0.040 * tw * th(mu / 0.4) -
            0.05 * (en - 0.5) * (1 + 5 * q) + 0.02 * dw - 0.07 * dr * q;
  } else if (kind == "stif") {
    const double st = at("sg") / 100.0;
    value = std::pow(G / 1e7, 2.0 / 3.0) * std::cbrt(st) * std::pow(pfp / 0.6, 3) *
            (1 + 0.10 * th(mu / 0.4)) * (1 - 0.30 * hy * std::pow(st, 0.15)) * (1 + 0.10 * a) *
            (1 + 0.10 * tp) * (1 - 0.20 * br * st / (1 + st));
  } else if (kind == "resd") {
    const double st = at("sg") / 100.0;
    value = 0.30 + 0.30 * hy * std::pow(st, 0.1) + 0.04 * Bo / (1 + Bo) - 0.08 * tp +
            0.10 * th(mu / 0.4) - 0.8 * (pfp - 0.58) + 0.22 * br * st / (1 + st);
  } else if (kind == "shci") {
    value = 0.08 + 0.02 * mu + 0.10 * a + 0.60 * Bo;
  } else if (kind == "shca") {
    value = 0.30 + 0.45 * th(mu / 0.45) + 0.30 * th(mur / 0.2) + 0.10 * th(2 * a);
  } else if (kind == "spin") {
    value = 0.02 + 0.05 * mur + 0.10 * tw + 0.005 * Bo;
  } else {  // the plane
    value =
        muw * (1 - 0.45 * wk * (at("k") == 1.0 ? 1.0 : 0.15)) + 0.015 * Bo + 0.05 * ch * (1 - m);
  }
  double result = std::log(std::max(value, 1e-4));
  if (const double anything = phi("anything"); anything != 0.0) {
    const auto direction = static_cast<std::uint64_t>(std::llround(1e9 * anything));
    const auto place = std::distance(observables().begin(), observables().find(observable));
    engine::Random random(direction, engine::Purpose::design, static_cast<std::uint64_t>(place));
    constexpr double size = 0.06;
    const double shift = size * random.normal(), trend = size * random.normal();
    result += anything * (shift + trend * m);
  }
  return result;
}

struct Reading {
  std::string observable;
  std::map<std::string, double> condition;
};

/// The twenty-six readings of the full study.
inline std::vector<Reading> full_study() {
  std::vector<Reading> all;
  for (const double m : {10.0, 14.0, 18.0}) all.push_back({"density", {{"M", m}}});
  for (const double m : {10.0, 14.0, 18.0}) all.push_back({"static_angle", {{"M", m}}});
  for (const double m : {10.0, 18.0}) all.push_back({"heap_angle", {{"M", m}}});
  for (const double h : {0.05, 0.15, 0.40}) all.push_back({"rebound", {{"M", 10.0}, {"h", h}}});
  all.push_back({"rebound", {{"M", 18.0}, {"h", 0.15}}});
  for (const double m : {10.0, 18.0}) all.push_back({"rate", {{"M", m}}});
  for (const double m : {10.0, 18.0}) all.push_back({"drawdown_angle", {{"M", m}}});
  for (const double fr : {0.002, 0.02, 0.10}) {
    all.push_back({"drum_angle", {{"M", 10.0}, {"Fr", fr}}});
  }
  all.push_back({"drum_angle", {{"M", 18.0}, {"Fr", 0.02}}});
  for (const double sg : {20.0, 100.0}) all.push_back({"stiffness", {{"M", 10.0}, {"sg", sg}}});
  all.push_back({"stiffness", {{"M", 18.0}, {"sg", 100.0}}});
  all.push_back({"residual", {{"M", 10.0}, {"sg", 100.0}}});
  for (const double m : {10.0, 18.0}) all.push_back({"wall_angle", {{"M", m}}});
  return all;
}

/// The readings at one moisture.
inline std::vector<Reading> at_moisture(double moisture) {
  std::vector<Reading> all = full_study();
  std::erase_if(all, [](const Reading& reading) { return reading.condition.at("M") != 10.0; });
  for (Reading& reading : all) reading.condition["M"] = moisture;
  return all;
}

/// What could be measured besides: every rig once more, under other conditions and of other kinds.
inline std::vector<Reading> further_readings() {
  return {{"rebound", {{"M", 10.0}, {"h", 0.01}}},
          {"rebound", {{"M", 10.0}, {"h", 1.5}}},
          {"rebound", {{"M", 14.0}, {"h", 0.6}}},
          {"static_angle", {{"M", 10.0}}},
          {"static_angle", {{"M", 12.0}}},
          {"static_angle", {{"M", 16.0}}},
          {"static_angle", {{"M", 18.0}}},
          {"density", {{"M", 10.0}}},
          {"density", {{"M", 18.0}}},
          {"density", {{"M", 10.0}, {"f", 1.0}}},
          {"density", {{"M", 10.0}, {"f", 2.0}}},
          {"wall_angle", {{"M", 10.0}}},
          {"wall_angle", {{"M", 18.0}}},
          {"wall_angle", {{"M", 10.0}, {"k", 1.0}}},
          {"drum_angle", {{"M", 10.0}, {"Fr", 0.3}}},
          {"drum_angle", {{"M", 10.0}, {"Fr", 0.0005}}},
          {"heap_angle", {{"M", 10.0}, {"b", 4.0}}},
          {"shear_intercept", {{"M", 10.0}}},
          {"shear_intercept", {{"M", 18.0}}},
          {"shear_angle", {{"M", 10.0}}},
          {"stiffness", {{"M", 10.0}, {"sg", 100.0}}},
          {"stiffness", {{"M", 10.0}, {"sg", 400.0}}},
          {"stiffness", {{"M", 18.0}, {"sg", 100.0}}},
          {"residual", {{"M", 10.0}, {"sg", 400.0}}},
          {"spin_torque", {{"M", 10.0}}},
          {"rate", {{"M", 10.0}, {"o", 0.6}}}};
}

/// Of those, the ones that a study does not have.
inline std::vector<Reading> not_in(const std::vector<Reading>& study) {
  std::vector<Reading> open = further_readings();
  std::erase_if(open, [&](const Reading& reading) {
    return std::ranges::any_of(study, [&](const Reading& own) {
      return own.observable == reading.observable && own.condition == reading.condition;
    });
  });
  return open;
}

/// One effect, or effects that no study of this kind can tell apart.
inline std::string_view class_of(std::string_view effect) {
  return effect == "visco_e" || effect == "plastic_e" ? "e(v)" : effect;
}

}  // namespace repose::stand_in
