#include "calibrator/diagnosis/diagnose.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "calibrator/design.hpp"
#include "calibrator/diagnosis/chi_squared.hpp"
#include "calibrator/diagnosis/excuses.hpp"
#include "calibrator/diagnosis/models.hpp"
#include "calibrator/diagnosis/screen.hpp"
#include "calibrator/diagnosis/verdict.hpp"

namespace repose::calibrator {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int probe_replicates = 2;
constexpr double probe_strength =
    0.8;  // large steps beat replicates: the trace is read above noise
constexpr std::uint64_t anchor_design = 1'000'000, refit_design = 2'000'000;  // apart by index

UnitPoint unit_point(const Vector& x, std::size_t dimensions) {
  return {x.data(), x.data() + dimensions};
}

Vector vector_of(const UnitPoint& point) {
  return Eigen::Map<const Vector>(point.data(), static_cast<Index>(point.size()));
}

/// Root mean square of z over the measurements with that role; NaN where there is none.
double rms_z(const DiagnosisQuestion& question, const std::vector<double>& predicted, Role role) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t j = 0; j < predicted.size(); ++j) {
    const Measurement& measurement = question.calibration.measurements[j];
    if (measurement.role != role || !std::isfinite(predicted[j])) continue;
    const auto i = static_cast<Index>(j);
    const double gap = predicted[j] - measurement.value;
    sum += gap * gap / question.covariance(i, i);
    ++count;
  }
  return count == 0 ? std::numeric_limits<double>::quiet_NaN() : std::sqrt(sum / count);
}

class Inquiry {
 public:
  Inquiry(const DiagnosisQuestion& question,
          const Evaluator& evaluator,
          const std::stop_token& stop,
          const DiagnosisObserver& observer)
      : question_(question),
        stop_(stop),
        observer_(observer),
        runs_(question.calibration, question.suspects, evaluator, question.fit),
        dimensions_(runs_.space().dimensions()) {}

  std::optional<Diagnosis> run();

 private:
  using Points = std::vector<SuiteRuns::Point>;

  /// False where it was stopped.
  bool ask(const std::string& stage, const Points& points);
  bool anchor(Diagnosis& diagnosis);
  bool probe(Diagnosis& diagnosis);
  [[nodiscard]] Vector trace_of(std::size_t suspect, double& noise) const;
  void screen(Diagnosis& diagnosis);
  void fit_excuses(Diagnosis& diagnosis);
  bool refit(const std::vector<Additions>& candidates, Diagnosis& diagnosis);
  bool refit_pairs(Diagnosis& diagnosis);
  [[nodiscard]] Points spread(const Additions& on, int count, const Vector* about, double share);
  [[nodiscard]] std::vector<Vector> starts_of(const Additions& on) const;
  [[nodiscard]] Refit summary(const Model& model) const;
  [[nodiscard]] std::vector<double> predictions(const Model& model) const;

  const DiagnosisQuestion& question_;
  std::stop_token stop_;
  const DiagnosisObserver& observer_;
  SuiteRuns runs_;
  std::size_t dimensions_;
  std::optional<Models> models_;
  std::optional<Model> base_;
  Vector probed_;                      ///< where the probes were made
  std::vector<std::size_t> screened_;  ///< suspects in the order of the screen's departures
  std::vector<ExcuseDirection> excuses_;
  std::optional<Screen> screen_;
  std::uint64_t designs_ = 0;
};

bool Inquiry::ask(const std::string& stage, const Points& points) {
  if (stop_.stop_requested()) return false;
  if (observer_) observer_({stage, runs_.spent()});
  runs_.run(points);
  return !stop_.stop_requested();
}

/// Latin hypercube over the whole box, or over a share of it about a point.
Inquiry::Points Inquiry::spread(const Additions& on, int count, const Vector* about, double share) {
  const ModelSpace space = models_->space(on);
  Points points;
  for (const UnitPoint& u : latin_hypercube(static_cast<std::size_t>(count),
                                            dimensions_ + on.size(),
                                            question_.calibration.seed,
                                            refit_design + designs_)) {
    SuiteRuns::Point point;
    for (std::size_t k = 0; k < u.size(); ++k) {
      const auto i = static_cast<Index>(k);
      const bool strength = k >= dimensions_;
      // Strengths beyond 1 are allowed, but not looked for.
      const double upper = strength ? 1.0 : space.upper(i);
      double x = space.lower(i) + u[k] * (upper - space.lower(i));
      if (about != nullptr) {
        const double radius = strength ? share * 5.0 / 3.0 : share;
        x = std::clamp((*about)(i) + radius * (2.0 * u[k] - 1.0), space.lower(i), space.upper(i));
      }
      if (strength) {
        point.strengths[on[k - dimensions_]] = x;
      } else {
        point.at.push_back(x);
      }
    }
    points.push_back(std::move(point));
  }
  ++designs_;
  return points;
}

/// The calibrated model's most probable set, with enough runs around it for its slopes.
bool Inquiry::anchor(Diagnosis& diagnosis) {
  models_.emplace(question_, runs_);
  std::vector<Vector> starts{vector_of(runs_.space().coordinates(question_.fit.best)),
                             Vector::Constant(static_cast<Index>(dimensions_), 0.5)};
  for (const UnitPoint& u :
       latin_hypercube(4, dimensions_, question_.calibration.seed, anchor_design)) {
    starts.push_back(vector_of(u));
  }
  base_.emplace(models_->fit({}, starts));
  constexpr double near = 0.22, radius = 0.16;
  const auto close = std::ranges::count_if(runs_.all(), [&](const SuiteRun& run) {
    return run.strengths.empty() &&
           (dimensions_ == 0 || (vector_of(run.at) - base_->fit.at).cwiseAbs().maxCoeff() <= near);
  });
  const int wanted = 6 * static_cast<int>(dimensions_) - static_cast<int>(close);
  if (wanted > 0) {
    if (!ask("anchor", spread({}, wanted, &base_->fit.at, radius))) return false;
    starts.assign({base_->fit.at});
    base_.emplace(models_->fit({}, starts));
  }
  probed_ = base_->fit.at;
  diagnosis.effects.clear();
  for (const Suspect& suspect : question_.suspects) diagnosis.effects.push_back({suspect});
  return true;
}

bool observed(const std::vector<Index>& fitted, const SuiteRun& run) {
  return std::ranges::all_of(
      fitted, [&](Index j) { return std::isfinite(run.values[static_cast<std::size_t>(j)]); });
}

bool Inquiry::probe(Diagnosis& diagnosis) {
  std::vector<std::size_t> suspects;
  for (std::size_t k = 0; k < question_.suspects.size(); ++k) {
    if (question_.suspects[k].objection.empty()) suspects.push_back(k);
  }
  Points base(probe_replicates, {unit_point(probed_, dimensions_), {}});
  if (!ask("probe", base)) return false;
  for (const double strength : {probe_strength, probe_strength / 2.0, probe_strength / 4.0}) {
    if (suspects.empty()) break;
    Points points;
    for (const std::size_t k : suspects) {
      points.insert(points.end(), probe_replicates, {base.front().at, {{k, strength}}});
    }
    if (!ask("probe", points)) return false;
    // What a strong effect makes fail is tried weaker.
    std::erase_if(suspects, [&](std::size_t k) {
      return std::ranges::any_of(runs_.all(), [&](const SuiteRun& run) {
        return run.strengths.contains(k) && observed(models_->fitted(), run);
      });
    });
  }
  base_.emplace(models_->fit({}, std::vector<Vector>{probed_}));
  for (std::size_t k = 0; k < question_.suspects.size(); ++k) {
    const bool failed = std::ranges::find(suspects, k) != suspects.end();
    if (question_.suspects[k].objection.empty() && !failed) screened_.push_back(k);
    if (failed) {
      diagnosis.effects[k].suspect.objection =
          "every run with it failed, even at a fifth of its "
          "strong value";
    }
  }
  return true;
}

/// Change of the fitted measurements per unit of strength; `noise` is its variance in sum,
/// whitened.
Vector Inquiry::trace_of(std::size_t suspect, double& noise) const {
  const std::vector<Index>& fitted = models_->fitted();
  const Vector before = base_->emulator.mean(probed_)(fitted);
  Vector sum = Vector::Zero(before.size());
  int count = 0;
  double strength = 0.0;
  for (const SuiteRun& run : runs_.all()) {
    const auto found = run.strengths.find(suspect);
    if (found == run.strengths.end() || !observed(fitted, run)) continue;
    strength = found->second;
    sum +=
        Eigen::Map<const Vector>(run.values.data(), static_cast<Index>(run.values.size()))(fitted);
    ++count;
  }
  const Matrix& whitener = base_->fit.whitener;
  const Vector run_noise = base_->emulator.noise()(fitted) / count;
  const Vector variance =
      (run_noise + base_->emulator.variance(probed_)(fitted)) / (strength * strength);
  noise = (whitener * variance.asDiagonal() * whitener.transpose()).trace();
  return (sum / count - before) / strength;
}

double share_at_least(const std::vector<Screen::Draw>& null, double Screen::Draw::*what, double x) {
  const auto count =
      std::ranges::count_if(null, [&](const Screen::Draw& draw) { return draw.*what >= x; });
  return static_cast<double>(count) / static_cast<double>(null.size());
}

void Inquiry::screen(Diagnosis& diagnosis) {
  std::vector<Departure> departures;
  std::vector<double> noise(screened_.size());
  for (std::size_t i = 0; i < screened_.size(); ++i) {
    const std::size_t k = screened_[i];
    departures.push_back({trace_of(k, noise[i]), question_.suspects[k].two_sided});
  }
  for (ExcuseDirection& direction : excuse_directions(question_, models_->fitted())) {
    const std::vector<Departure> alone{{direction.change, true}};
    constexpr double all = 0.98;  // of it absorbed: then it is no excuse, the parameters are
    const Screen screen(base_->fit, base_->space, alone);
    if (screen.scores().front().absorbed > all) continue;
    departures.push_back(alone.front());
    excuses_.push_back(std::move(direction));
  }
  screen_.emplace(base_->fit, base_->space, departures);
  const Vector freedom = question_.freedom(models_->fitted());
  const auto null = screen_->draw_null(screened_.size(), freedom, question_.calibration.seed);

  double largest = 0.0, largest_excuse = 0.0;
  for (std::size_t i = 0; i < departures.size(); ++i) {
    const Score& score = screen_->scores()[i];
    (i < screened_.size() ? largest : largest_excuse) =
        std::max(i < screened_.size() ? largest : largest_excuse, score.value);
  }
  diagnosis.p_named = screened_.empty() ? 1.0 : share_at_least(null, &Screen::Draw::named, largest);
  diagnosis.p_unnamed =
      excuses_.empty() ? 1.0 : share_at_least(null, &Screen::Draw::unnamed, largest_excuse);
  diagnosis.misfit = base_->fit.misfit;
  diagnosis.freedom = base_->fit.freedom;
  diagnosis.p_misfit = freedom.array().isFinite().any()
                           ? share_at_least(null, &Screen::Draw::misfit, diagnosis.misfit)
                           : chi_squared_tail(diagnosis.misfit, diagnosis.freedom);
  for (std::size_t i = 0; i < screened_.size(); ++i) {
    EffectFinding& finding = diagnosis.effects[screened_[i]];
    const Score& score = screen_->scores()[i];
    finding.score = score.value;
    finding.p = share_at_least(null, &Screen::Draw::named, score.value);
    finding.strength = score.strength;
    finding.absorbed = score.absorbed;
    finding.probe_noise = std::min(1.0, noise[i] / score.information);
    weigh(finding, score.information, screened_.size());
    finding.change.assign(question_.calibration.measurements.size(),
                          std::numeric_limits<double>::quiet_NaN());
    finding.trace = finding.change;
    for (std::size_t row = 0; row < models_->fitted().size(); ++row) {
      const auto j = static_cast<std::size_t>(models_->fitted()[row]);
      finding.change[j] = departures[i].change(static_cast<Index>(row));
      finding.trace[j] = screen_->projected(i)(static_cast<Index>(row));
    }
  }
  for (std::size_t i = 0; i < excuses_.size(); ++i) {
    const double value = screen_->scores()[screened_.size() + i].value;
    diagnosis.excuses.push_back({.observable = excuses_[i].observable,
                                 .setting = excuses_[i].setting,
                                 .score = value,
                                 .p = share_at_least(null, &Screen::Draw::unnamed, value)});
  }
}

void Inquiry::fit_excuses(Diagnosis& diagnosis) {
  for (std::size_t i = 0; i < excuses_.size(); ++i) {
    const ExcuseFit fit = fit_excuse(*models_, *base_, excuses_[i]);
    Excuse& excuse = diagnosis.excuses[i];
    excuse.size = fit.size;
    excuse.deviance = fit.deviance;
    excuse.misfit = fit.misfit;
    excuse.misfit_p = chi_squared_tail(fit.misfit, fit.freedom);
  }
  std::ranges::sort(diagnosis.excuses, {}, &Excuse::deviance);
}

/// Near the calibrated set with the strength that the screen expects, where the effect is weak, and
/// half-way to the middle of the box where it is strong: the calibrated set is biased by the lack.
std::vector<Vector> Inquiry::starts_of(const Additions& on) const {
  const auto d = static_cast<Index>(dimensions_), m = static_cast<Index>(on.size());
  const auto extended = [&](const Vector& head, double strength) {
    Vector x(d + m);
    x << head, Vector::Constant(m, strength);
    return x;
  };
  Vector expected = extended(base_->fit.at, 0.1);
  for (Index k = 0; k < m; ++k) {
    const auto place = std::ranges::find(screened_, on[static_cast<std::size_t>(k)]);
    const auto i = static_cast<std::size_t>(place - screened_.begin());
    expected(d + k) = std::min(screen_->scores()[i].strength, 1.0);
  }
  std::vector<Vector> starts{expected,
                             extended(base_->fit.at, 0.1),
                             extended(0.5 * base_->fit.at + Vector::Constant(d, 0.25), 0.6)};
  for (Index k = 0; k < m; ++k) {
    if (!question_.suspects[on[static_cast<std::size_t>(k)]].two_sided) continue;
    Vector other = starts.back();
    other(d + k) *= -1.0;
    starts.push_back(std::move(other));
  }
  return starts;
}

std::vector<double> Inquiry::predictions(const Model& model) const {
  const Vector mean = model.emulator.mean(model.fit.at);
  std::vector<double> result(mean.data(), mean.data() + mean.size());
  for (std::size_t j = 0; j < result.size() && j < question_.fit.offset.size(); ++j) {
    result[j] += question_.fit.offset[j];
  }
  return result;
}

Refit Inquiry::summary(const Model& model) const {
  Refit refit;
  refit.effects = model.on;
  refit.parameters = runs_.space().at(unit_point(model.fit.at, dimensions_));
  for (std::size_t k = 0; k < model.on.size(); ++k) {
    const double strength = model.fit.at(static_cast<Index>(dimensions_ + k));
    refit.strengths.push_back(strength);
    question_.suspects[model.on[k]].apply(refit.parameters, strength);
  }
  refit.predicted = predictions(model);
  refit.deviance = model.fit.deviance;
  refit.gain = base_->fit.deviance - model.fit.deviance;
  refit.misfit = model.fit.misfit;
  refit.freedom = model.fit.freedom;
  refit.p = chi_squared_tail(refit.misfit, refit.freedom);
  refit.at_bound = model.fit.inside.size() < static_cast<std::size_t>(model.fit.at.size());
  refit.fitted_z = rms_z(question_, refit.predicted, Role::fit);
  refit.held_out_z = rms_z(question_, refit.predicted, Role::held_out);
  if (model.on.size() == 1) {
    const Models::Range range = models_->strength_range(model);
    refit.strength_lower = {range.lower};
    refit.strength_upper = {range.upper};
  }
  return refit;
}

/// All candidates side by side: a design over the whole box each, then designs about the running
/// optimum that follow it until it stays. One that is far behind after the first is given up.
bool Inquiry::refit(const std::vector<Additions>& candidates, Diagnosis& diagnosis) {
  struct Candidate {
    Additions on;
    std::optional<Model> model;
    bool open = true;
  };
  std::vector<Candidate> all;
  for (const Additions& on : candidates) all.push_back({on, {}, true});
  constexpr int rounds = 5, least_rounds = 3;
  for (int round = 0; round < rounds; ++round) {
    Points points;
    std::string names;
    for (Candidate& candidate : all) {
      if (!candidate.open) continue;
      const int unknowns = static_cast<int>(dimensions_ + candidate.on.size());
      const int count = std::clamp(3 * unknowns - (round == 0 ? 2 : 4), round == 0 ? 10 : 8, 20);
      const Points design = spread(candidate.on,
                                   count,
                                   candidate.model ? &candidate.model->fit.at : nullptr,
                                   round == 1 ? 0.18 : 0.12);
      points.insert(points.end(), design.begin(), design.end());
      for (const std::size_t k : candidate.on) {
        names += (names.empty() ? "" : ", ") + question_.suspects[k].name;
      }
    }
    if (points.empty()) break;
    if (!ask("refit " + names, points)) return false;
    double best = std::numeric_limits<double>::infinity();
    for (Candidate& candidate : all) {
      if (!candidate.open) continue;
      std::vector<Vector> starts;
      if (candidate.model) starts.push_back(candidate.model->fit.at);
      if (round < 2) std::ranges::copy(starts_of(candidate.on), std::back_inserter(starts));
      const Vector before = starts.front();
      candidate.model.emplace(models_->fit(candidate.on, starts));
      best = std::min(best, candidate.model->fit.deviance);
      const auto d = static_cast<Index>(dimensions_);
      const Vector moved = (candidate.model->fit.at - before).cwiseAbs();
      const double way = std::max(d == 0 ? 0.0 : moved.head(d).maxCoeff() / 0.15,
                                  moved.tail(moved.size() - d).maxCoeff() / 0.25);
      candidate.open = round + 1 < least_rounds || way > 0.8;
    }
    for (Candidate& candidate : all) {
      constexpr double far = 20.0;  // no later design has turned such a gap
      if (candidate.model->fit.deviance > best + far) candidate.open = false;
    }
  }
  for (const Candidate& candidate : all) diagnosis.refits.push_back(summary(*candidate.model));
  std::ranges::sort(diagnosis.refits, {}, &Refit::deviance);
  return true;
}

/// The two pairs of largest one-step gain, and the best with the best single effect.
bool Inquiry::refit_pairs(Diagnosis& diagnosis) {
  struct Pair {
    double gain;
    Additions on;
  };
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < screened_.size(); ++a) {
    for (std::size_t b = a + 1; b < screened_.size(); ++b) {
      pairs.push_back({screen_->pair_gain(a, b), {screened_[a], screened_[b]}});
    }
  }
  std::ranges::stable_sort(pairs, std::greater<>(), &Pair::gain);
  std::vector<Additions> chosen;
  const std::size_t winner = diagnosis.refits.front().effects.front();
  for (const Pair& pair : pairs) {
    const bool with_winner = std::ranges::find(pair.on, winner) != pair.on.end();
    const bool have_winner = std::ranges::any_of(
        chosen, [&](const Additions& on) { return std::ranges::find(on, winner) != on.end(); });
    if (chosen.size() < 2 || (chosen.size() < 3 && with_winner && !have_winner)) {
      chosen.push_back(pair.on);
    }
  }
  return chosen.empty() || refit(chosen, diagnosis);
}

std::optional<Diagnosis> Inquiry::run() {
  Diagnosis diagnosis;
  if (!anchor(diagnosis) || !probe(diagnosis)) return std::nullopt;
  diagnosis.parameters = runs_.space().at(unit_point(base_->fit.at, dimensions_));
  diagnosis.predicted = predictions(*base_);
  diagnosis.fitted_z = rms_z(question_, diagnosis.predicted, Role::fit);
  diagnosis.held_out_z = rms_z(question_, diagnosis.predicted, Role::held_out);
  screen(diagnosis);
  fit_excuses(diagnosis);
  if (!adequate(diagnosis)) {
    std::vector<Additions> best;
    std::vector<std::size_t> order = screened_;
    std::ranges::stable_sort(
        order, std::greater<>(), [&](std::size_t k) { return diagnosis.effects[k].score; });
    for (std::size_t i = 0; i < std::min<std::size_t>(3, order.size()); ++i) {
      best.push_back({order[i]});
    }
    if (!best.empty() && !refit(best, diagnosis)) return std::nullopt;
    if (wants_pairs(diagnosis) && !refit_pairs(diagnosis)) return std::nullopt;
  }
  find_families(*screen_, screened_, diagnosis);
  conclude(question_.calibration, diagnosis);
  diagnosis.evaluations = runs_.spent();
  return diagnosis;
}

}  // namespace

DiagnosisQuestion question_of(const Calibration& calibration,
                              const Fit& fit,
                              const Tolerances& stated) {
  const auto count = static_cast<Index>(calibration.measurements.size());
  DiagnosisQuestion question{calibration,
                             fit,
                             suspects_of(calibration, fit.best),
                             covariance_of(calibration.measurements, stated),
                             Vector(count),
                             Vector(count)};
  for (Index j = 0; j < count; ++j) {
    const Measurement& measurement = calibration.measurements[static_cast<std::size_t>(j)];
    question.sizes(j) = size_of(measurement);
    question.freedom(j) = measurement.replicates > 1 ? measurement.replicates - 1.0
                                                     : std::numeric_limits<double>::infinity();
    if (static_cast<std::size_t>(j) < fit.offset_error.size()) {
      question.covariance(j, j) += std::pow(fit.offset_error[static_cast<std::size_t>(j)], 2);
    }
  }
  return question;
}

std::optional<Diagnosis> diagnose(const DiagnosisQuestion& question,
                                  const Evaluator& evaluator,
                                  std::stop_token stop,
                                  const DiagnosisObserver& observer) {
  return Inquiry(question, evaluator, stop, observer).run();
}

}  // namespace repose::calibrator
