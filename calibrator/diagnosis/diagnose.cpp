#include "calibrator/diagnosis/diagnose.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>

#include "calibrator/design.hpp"
#include "calibrator/diagnosis/chi_squared.hpp"
#include "calibrator/diagnosis/choice.hpp"
#include "calibrator/diagnosis/excuses.hpp"
#include "calibrator/diagnosis/models.hpp"
#include "calibrator/diagnosis/paired_offset.hpp"
#include "calibrator/diagnosis/question.hpp"
#include "calibrator/diagnosis/refits.hpp"
#include "calibrator/diagnosis/rivals.hpp"
#include "calibrator/diagnosis/screen.hpp"
#include "calibrator/diagnosis/trace.hpp"
#include "calibrator/diagnosis/verdict.hpp"

namespace repose::calibrator {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int probe_replicates = 2;
/// Where all probes are compared: the scatter there is in every score, and a best set in a corner
/// of the bounds has few of the calibration's runs around it.
constexpr int base_replicates = 8;
constexpr double probe_strength =
    0.8;  // large steps beat replicates: the trace is read above noise
constexpr int most_runs = 180, most_runs_with_pairs = 350;  // before what to measure next is asked
constexpr std::uint64_t anchor_design = 1'000'001;          // apart from other designs

UnitPoint unit_point(const Vector& x, std::size_t dimensions) {
  return {x.data(), x.data() + dimensions};
}

Vector vector_of(const UnitPoint& point) {
  return Eigen::Map<const Vector>(point.data(), static_cast<Index>(point.size()));
}

class Inquiry {
 public:
  Inquiry(const DiagnosisQuestion& question,
          const Evaluator& evaluator,
          const std::stop_token& stop,
          const DiagnosisObserver& observer)
      : question_(question),
        evaluator_(evaluator),
        stop_(stop),
        observer_(observer),
        runs_(question.calibration, question.suspects, evaluator, question.fit),
        dimensions_(runs_.space().dimensions()) {}

  std::optional<Diagnosis> run();

 private:
  /// False where it was stopped.
  bool ask(const std::string& stage, const Points& points);
  void tell(const std::string& stage) const;
  bool learn_offset();
  bool anchor(Diagnosis& diagnosis);
  bool probe(Diagnosis& diagnosis);
  void screen(Diagnosis& diagnosis);
  void fit_excuses(Diagnosis& diagnosis);
  bool refit(const std::vector<Additions>& candidates, int most, Diagnosis& diagnosis);
  bool refit_best(Diagnosis& diagnosis);
  bool refit_pairs(Diagnosis& diagnosis);
  bool advise(Diagnosis& diagnosis);

  DiagnosisQuestion question_;
  const Evaluator& evaluator_;
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
  std::optional<Refits> refits_;
  std::vector<Model> refitted_;  ///< in the order of the diagnosis' refits
};

void Inquiry::tell(const std::string& stage) const {
  if (observer_) observer_({stage, runs_.spent()});
}

bool Inquiry::ask(const std::string& stage, const Points& points) {
  if (stop_.stop_requested()) return false;
  tell(stage);
  runs_.run(points);
  return !stop_.stop_requested();
}

bool Inquiry::learn_offset() {
  if (!wants_offset(question_.calibration)) return true;
  if (stop_.stop_requested()) return false;
  tell("offset");
  add_offset(runs_, question_);
  return !stop_.stop_requested();
}

/// The calibrated model's most probable set, with enough runs around it for its slopes. A
/// calibration that started from an earlier answer may have a few runs at one point only: then it
/// is looked for around the calibration's best.
bool Inquiry::anchor(Diagnosis& diagnosis) {
  models_.emplace(question_, runs_);
  const bool learnt = models_->knows_all_fitted();
  if (learnt) base_.emplace(models_->fit_calibrated());
  const Vector centre =
      learnt ? base_->fit.at : vector_of(runs_.space().coordinates(question_.fit.best));
  constexpr double near = 0.22, radius = 0.16;
  const auto close = std::ranges::count_if(runs_.all(), [&](const SuiteRun& run) {
    return run.strengths.empty() &&
           (dimensions_ == 0 || (vector_of(run.at) - centre).cwiseAbs().maxCoeff() <= near);
  });
  constexpr int least = 3;  // for their scatter, where there are no slopes
  const int wanted = std::max(6 * static_cast<int>(dimensions_), least) - static_cast<int>(close);
  if (wanted > 0) {
    const Points points = spread(models_->space({}),
                                 {},
                                 wanted,
                                 question_.calibration.seed,
                                 anchor_design,
                                 Neighbourhood{centre, radius});
    if (!ask("anchor", points)) return false;
    models_.emplace(question_, runs_);
    if (learnt) base_.emplace(models_->fit({}, std::vector<Vector>{centre}));
  }
  if (!learnt) base_.emplace(models_->fit_calibrated());
  probed_ = base_->fit.at;
  diagnosis.effects.clear();
  for (const Suspect& suspect : question_.suspects) diagnosis.effects.push_back({suspect});
  return true;
}

bool Inquiry::probe(Diagnosis& diagnosis) {
  std::vector<std::size_t> suspects;
  for (std::size_t k = 0; k < question_.suspects.size(); ++k) {
    if (question_.suspects[k].objection.empty()) suspects.push_back(k);
  }
  Points base(base_replicates, {unit_point(probed_, dimensions_), {}});
  if (!ask("probe", base)) return false;
  const std::uint64_t shared = runs_.all().back().seed;
  for (const double strength : {probe_strength, probe_strength / 2.0, probe_strength / 4.0}) {
    if (suspects.empty()) break;
    // The first replicate shows which experiments an effect touches, the others run only those.
    for (int replicate = 0; replicate < probe_replicates; ++replicate) {
      Points points;
      for (const std::size_t k : suspects) {
        points.push_back({base.front().at, {{k, strength}}});
        if (replicate == 0) points.back().seed = shared;
      }
      if (!ask("probe", points)) return false;
    }
    // What a strong effect makes fail is tried weaker.
    std::erase_if(suspects, [&](std::size_t k) {
      return std::ranges::any_of(runs_.all(), [&](const SuiteRun& run) {
        return observed(runs_, k, models_->fitted(), run);
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

void Inquiry::screen(Diagnosis& diagnosis) {
  std::vector<Departure> departures;
  for (const std::size_t k : screened_) {
    Trace trace = trace_of(runs_, k, models_->fitted(), *base_, probed_);
    departures.push_back(
        {std::move(trace.change), question_.suspects[k].two_sided, std::move(trace.variance)});
  }
  for (ExcuseDirection& direction : excuse_directions(question_, models_->fitted())) {
    const std::vector<Departure> alone{{direction.change, true, {}}};
    constexpr double all = 0.98;  // of it absorbed: then it is no excuse, the parameters are
    const Screen screen(base_->fit, base_->space, alone);
    if (screen.scores().front().absorbed > all) continue;
    departures.push_back(alone.front());
    excuses_.push_back(std::move(direction));
  }
  screen_.emplace(base_->fit, base_->space, departures);
  const Vector freedom = question_.error_freedom(models_->fitted());
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
    finding.probe_noise = std::min(1.0, score.noise / score.information);
    weigh(finding, power_of(score), screened_.size());
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
    excuse.misfit_p = fit.p;
  }
  std::ranges::sort(diagnosis.excuses, {}, &Excuse::deviance);
}

bool Inquiry::refit(const std::vector<Additions>& candidates, int most, Diagnosis& diagnosis) {
  auto models = refits_->fit(candidates, most - runs_.spent());
  if (!models) return false;
  std::ranges::move(*models, std::back_inserter(refitted_));
  std::ranges::stable_sort(refitted_, {}, [](const Model& model) { return model.fit.deviance; });
  diagnosis.refits.clear();
  for (const Model& model : refitted_) {
    diagnosis.refits.push_back(summary_of(question_, *models_, runs_, base_->fit, model));
  }
  return true;
}

bool Inquiry::refit_best(Diagnosis& diagnosis) {
  std::vector<double> expected(question_.suspects.size(), 0.0);
  for (std::size_t i = 0; i < screened_.size(); ++i) {
    expected[screened_[i]] = screen_->scores()[i].strength;
  }
  refits_.emplace(
      question_,
      *models_,
      base_->fit.at,
      expected,
      [this](const std::string& stage, const Points& points) { return ask(stage, points); });
  const auto best = best_singles(*screen_, screened_, diagnosis);
  return best.empty() || refit(best, most_runs, diagnosis);
}

bool Inquiry::refit_pairs(Diagnosis& diagnosis) {
  const auto best = best_pairs(*screen_, screened_, diagnosis);
  return best.empty() || refit(best, most_runs_with_pairs, diagnosis);
}

/// Explanations that are still open, and what would settle them.
bool Inquiry::advise(Diagnosis& diagnosis) {
  if (question_.candidates.empty()) return true;
  std::vector<Rival> rivals;
  const auto add = [&](const Model& model, double weight) {
    rivals.push_back(rival_of(question_, runs_, model, weight, rivals.size()));
    diagnosis.rivals.push_back(model.on);
  };
  const OpenExplanations open = open_explanations(diagnosis);
  for (const auto& [index, weight] : open.refits) add(refitted_[index], weight);
  if (open.calibrated > 0.0) add(*base_, open.calibrated);
  for (const auto& [effect, weight] : open.imitated) {
    add(imitated(*models_, *base_, effect, diagnosis.effects[effect].change), weight);
  }
  if (rivals.size() < 2) {
    diagnosis.rivals.clear();
    return true;
  }
  tell("next");
  diagnosis.next =
      weigh_candidates(question_.calibration, question_.candidates, rivals, evaluator_);
  for (const Rival& rival : rivals) diagnosis.evaluations += static_cast<int>(rival.draws.size());
  if (diagnosis.next.size() > 3) diagnosis.next.resize(3);
  if (diagnosis.next.empty()) {
    diagnosis.remarks.emplace_back(
        "No measurement that the virtual experiments could make would settle what is still open.");
  }
  return !stop_.stop_requested();
}

std::optional<Diagnosis> Inquiry::run() {
  Diagnosis diagnosis;
  if (!learn_offset() || !anchor(diagnosis)) return std::nullopt;
  if (models_->fitted().empty()) {
    refuse(diagnosis);
    diagnosis.evaluations = runs_.spent();
    return diagnosis;
  }
  if (!probe(diagnosis)) return std::nullopt;
  diagnosis.parameters = runs_.space().at(unit_point(base_->fit.at, dimensions_));
  diagnosis.predicted = predictions_of(question_, *base_);
  diagnosis.fitted_z = rms_z(question_, diagnosis.predicted, Role::fit);
  diagnosis.held_out_z = rms_z(question_, diagnosis.predicted, Role::held_out);
  diagnosis.p_held_out = models_->held_out_p(*base_);
  screen(diagnosis);
  fit_excuses(diagnosis);
  if (!adequate(diagnosis)) {
    if (!refit_best(diagnosis)) return std::nullopt;
    if (wants_pairs(diagnosis) && !refit_pairs(diagnosis)) return std::nullopt;
  }
  find_families(*screen_, screened_, diagnosis);
  conclude(question_.calibration,
           refitted_.empty() ? "" : sole_witness(question_, *models_, refitted_.front()),
           diagnosis);
  if (!advise(diagnosis)) return std::nullopt;
  diagnosis.evaluations += runs_.spent();
  return diagnosis;
}

}  // namespace

std::optional<Diagnosis> diagnose(const Calibration& calibration,
                                  const Fit& fit,
                                  const Tolerances& stated,
                                  const Evaluator& evaluator,
                                  std::stop_token stop,
                                  const DiagnosisObserver& observer) {
  return diagnose(question_of(calibration, fit, stated), evaluator, std::move(stop), observer);
}

std::optional<Diagnosis> diagnose(const DiagnosisQuestion& question,
                                  const Evaluator& evaluator,
                                  std::stop_token stop,
                                  const DiagnosisObserver& observer) {
  return Inquiry(question, evaluator, stop, observer).run();
}

}  // namespace repose::calibrator
