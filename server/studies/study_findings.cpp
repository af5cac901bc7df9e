#include "server/studies/study_findings.hpp"

#include <algorithm>
#include <cmath>

#include "calibrator/phrase.hpp"
#include "engine/parameter_set.hpp"
#include "server/report/number_text.hpp"
#include "server/report/study_words.hpp"

namespace repose::server {

namespace {

std::string with_unit(double value, int decimals, const StudyExperiment& what) {
  return fixed_text(value, decimals) + " " + what.unit;
}

std::string of(int part, int all) { return std::to_string(part) + " of " + std::to_string(all); }

/// Mean difference between ours and the paper's over all runs, and its spread.
std::string offset_sentence(const StudyResult& result, const StudyExperiment& what) {
  Sample differences;
  for (const StudyRun& run : result.study->runs) {
    const auto printed = run.printed.find(what.experiment);
    const double ours = result.sample(run.run, what.experiment).mean();
    if (printed == run.printed.end() || std::isnan(ours)) continue;
    differences.values.push_back(ours - printed->second.mean);
  }
  const double mean = differences.mean();
  if (std::isnan(mean)) return "No run of " + what.experiment + " is done.";
  return "Over " + std::to_string(differences.values.size()) + " runs our " +
         observable_text(what) + " is " + with_unit(std::abs(mean), 1, what) +
         (mean < 0.0 ? " below" : " above") +
         " the paper's on average (standard deviation of the differences " +
         with_unit(differences.deviation(), 1, what) + ").";
}

std::string trend_sentence(const StudyResult& result,
                           const StudyTable& table,
                           const StudyExperiment& what) {
  const TrendCount count = count_trends(result, table, what);
  const int clear = count.clear_agree + static_cast<int>(count.clearly_opposite.size());
  return table.table + ", " + observable_text(what) +
         ": the change against the base has the paper's sign in " +
         of(count.agree, count.agree + count.opposite) +
         " runs; where both changes exceed twice their standard error, in " +
         of(count.clear_agree, clear) + "." +
         (count.clearly_opposite.empty()
              ? ""
              : " Opposite, and not explained: " +
                    calibrator::joined(count.clearly_opposite, ", ") + ".");
}

std::string best_sentence(const StudyResult& result, const StudyExperiment& what) {
  const Sample& found = result.search->samples.at(what.experiment);
  const Sample& theirs = result.sample(result.study->best, what.experiment);
  const auto percent = [&](double value) {
    return signed_text(100.0 * (value / what.target - 1.0), 2) + " %";
  };
  const double printed = result.study->run(result.study->best).printed.at(what.experiment).mean;
  return "Best set, " + observable_text(what) + " against the target of " +
         with_unit(what.target, 1, what) + ": ours " + with_unit(found.mean(), 1, what) + " (" +
         percent(found.mean()) + "); the paper's " + result.study->best + " gives " +
         with_unit(theirs.mean(), 1, what) + " here (" + percent(theirs.mean()) + ") and gave " +
         with_unit(printed, 1, what) + " there (" + percent(printed) + ").";
}

/// Sphere-steps of all the study's experiments, one replicate each.
double cost(const StudyResult& result, const Samples& samples) {
  double sum = 0.0;
  for (const StudyExperiment& what : result.study->experiments) {
    const auto found = samples.find(what.experiment);
    if (found != samples.end()) sum += found->second.grain_steps;
  }
  return sum;
}

std::string cost_sentence(const StudyResult& result) {
  const double ours = cost(result, result.search->samples);
  const double theirs = cost(result, result.runs.at(result.study->best));
  return "Cost of one replicate of each experiment, in sphere-steps: ours " +
         number_text(1e-6 * ours, 3) + " million, " + result.study->best + " " +
         number_text(1e-6 * theirs, 3) + " million (ratio " + number_text(ours / theirs, 3) + ").";
}

/// Which open question explains how much of the gap: of each kind the variant that closes most.
std::string shares_text(const StudyResult& result, const StudyExperiment& what) {
  struct Share {
    const StudyVariant* variant;
    Explained explained;
  };
  std::vector<Share> most;  // one of a kind
  for (const StudyVariant& variant : result.study->variants) {
    const auto explained = explain(result, variant.variant, what);
    if (!explained || std::isnan(explained->share) || variant.kind == "all") continue;
    const auto same = [&](const Share& share) { return share.variant->kind == variant.kind; };
    const auto known = std::ranges::find_if(most, same);
    if (known == most.end()) {
      most.push_back({&variant, *explained});
    } else if (explained->share > known->explained.share) {
      *known = {&variant, *explained};
    }
  }
  if (most.empty()) return {};
  const auto share = [](const Share& each) { return -each.explained.share; };
  std::ranges::sort(most, {}, share);
  std::string text;
  for (const Share& each : most) {
    text += (text.empty() ? " Of this gap, one change at a time: " : "; ") + each.variant->kind +
            " (" + each.variant->variant + ") " + fixed_text(100.0 * each.explained.share, 0) +
            " %";
    if (std::abs(each.explained.change) < 2.0 * each.explained.error) {
      text += ", within its scatter";
    }
  }
  return text + ".";
}

std::string gap_sentence(const StudyResult& result, const StudyExperiment& what) {
  const double printed = result.study->run(result.study->base).printed.at(what.experiment).mean;
  const double ours = result.sample(result.study->base, what.experiment).mean();
  if (std::isnan(ours)) return "The base run of " + what.experiment + " is not done.";
  std::string text = "The base run: " + observable_text(what) + " " + with_unit(ours, 1, what) +
                     " here, " + with_unit(printed, 1, what) + " in the paper.";
  text += shares_text(result, what);
  const StudyVariant& last = result.study->variants.back();
  const auto all = explain(result, last.variant, what);
  if (!all || std::isnan(all->left)) return text;
  return text + " With " + last.meaning + ", " + with_unit(all->sample.mean(), 1, what) + ": " +
         with_unit(std::abs(all->left), 1, what) + (all->left < 0.0 ? " below" : " above") +
         " the paper's, which is unexplained.";
}

}  // namespace

std::vector<DropRow> drop_rows(const StudyResult& result) {
  const PublishedStudy& study = *result.study;
  const auto key = engine::make_key("restitution.coefficient",
                                    {engine::MaterialId::grain, engine::MaterialId::wall});
  std::vector<DropRow> rows;
  rows.reserve(study.runs.size());
  for (const StudyRun& run : study.runs) {
    DropRow row{run.run, run_parameters(study, run.run).get_or(key, 1.0), 0.0, 0.0, {}};
    row.read = result.sample(run.run, study.drop_experiment).mean();
    row.percent = 100.0 * (row.read / row.given - 1.0);
    const auto paper =
        std::ranges::find(study.drop_accuracy, row.given, &DropAccuracy::restitution);
    if (paper != study.drop_accuracy.end()) row.paper = *paper;
    rows.push_back(row);
  }
  return rows;
}

std::optional<Explained> explain(const StudyResult& result,
                                 const std::string& variant,
                                 const StudyExperiment& experiment) {
  const auto found = std::ranges::find(result.variants, variant, &VariantResult::variant);
  if (found == result.variants.end() || !found->samples.contains(experiment.experiment)) return {};
  const Sample& sample = found->samples.at(experiment.experiment);
  const Sample& base = result.sample(result.study->base, experiment.experiment);
  const double printed =
      result.study->run(result.study->base).printed.at(experiment.experiment).mean;
  const double change = sample.mean() - base.mean();
  return Explained{sample,
                   change,
                   std::hypot(sample.error(), base.error()),
                   change / (printed - base.mean()),
                   sample.mean() - printed};
}

std::vector<std::string> findings(const StudyResult& result) {
  std::vector<std::string> sentences;
  if (result.missing > 0) {
    sentences.push_back(
        "Unfinished: " + of(static_cast<int>(result.missing), static_cast<int>(result.trials)) +
        " simulations are missing, and the search for the best set.");
  }
  double worst = 0.0;
  for (const DropRow& row : drop_rows(result)) {
    if (!std::isnan(row.percent)) worst = std::max(worst, std::abs(row.percent));
  }
  sentences.push_back("Drop test: the restitution read differs from the one given by at most " +
                      fixed_text(worst, 2) + " % in any run.");
  for (const StudyExperiment& what : result.study->experiments) {
    sentences.push_back(offset_sentence(result, what));
    for (const StudyTable& table : result.study->tables) {
      sentences.push_back(trend_sentence(result, table, what));
    }
  }
  for (const StudyExperiment& what : result.study->experiments) {
    sentences.push_back(gap_sentence(result, what));
  }
  if (!result.search || result.search->samples.empty()) return sentences;
  for (const StudyExperiment& what : result.study->experiments) {
    sentences.push_back(best_sentence(result, what));
  }
  sentences.push_back(cost_sentence(result));
  return sentences;
}

}  // namespace repose::server
