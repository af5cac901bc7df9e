#include "server/cli/study_summary.hpp"

#include "server/cli/text_table.hpp"
#include "server/report/number_text.hpp"
#include "server/report/study_words.hpp"
#include "server/studies/study_findings.hpp"

namespace repose::server {

namespace {

std::string table_text(const StudyResult& result,
                       const StudyTable& table,
                       const StudyExperiment& what) {
  TextTable text({"run", "inputs", "paper", "ours", "difference", "trend"}, "ll");
  for (const StudyGroup& group : table.groups) {
    for (const std::string& run : group.runs) {
      const auto& printed = result.study->run(run).printed;
      const auto paper = printed.find(what.experiment);
      if (paper == printed.end()) continue;
      const Sample& ours = result.sample(run, what.experiment);
      text.row({run,
                difference_text(*result.study, run),
                published_text(paper->second),
                sample_text(ours),
                signed_text(ours.mean() - paper->second.mean, 1),
                trend_text(trend(result, run, what))});
    }
  }
  return table.table + ", " + what.experiment + ", " + what.unit + "\n" + text.str() + "\n";
}

std::string variants_text(const StudyResult& result, const StudyExperiment& what) {
  TextTable text({"variant of the base", "asks about", "value", "change", "of the gap", "left"},
                 "ll");
  for (const StudyVariant& variant : result.study->variants) {
    const auto explained = explain(result, variant.variant, what);
    if (!explained) continue;
    text.row({variant.variant,
              variant.kind,
              sample_text(explained->sample),
              signed_text(explained->change, 1) + " +- " + known_text(explained->error, 1),
              signed_text(100.0 * explained->share, 0) + " %",
              signed_text(explained->left, 1)});
  }
  return "Why, " + what.experiment + ", " + what.unit + "\n" + text.str() + "\n";
}

std::string cost_text(const StudyResult& result) {
  TextTable text({"run", "kettle, paper", "ours", "box, paper", "ours"});
  for (const StudyRun& run : result.study->computing_hours) {
    std::vector<std::string> row{run.run};
    for (const StudyExperiment& what : result.study->experiments) {
      const CostRatio ratio = cost_ratio(result, run.run, what.experiment);
      row.push_back(known_text(ratio.paper, 2));
      row.push_back(known_text(ratio.ours, 2));
    }
    text.row(std::move(row));
  }
  return "Computing for a simulated second over the base's; ours in sphere-steps\n" + text.str() +
         "\n";
}

}  // namespace

std::string print_study_summary(const StudyResult& result) {
  std::string text;
  for (const StudyTable& table : result.study->tables) {
    for (const StudyExperiment& what : result.study->experiments) {
      text += table_text(result, table, what);
    }
  }
  text += cost_text(result);
  for (const StudyExperiment& what : result.study->experiments) text += variants_text(result, what);
  for (const std::string& sentence : findings(result)) text += sentence + "\n";
  return text +
         "\nMean (standard deviation). A trend with ? is within twice its standard error, "
         "in the paper or here.\n* some replicates failed.\n";
}

}  // namespace repose::server
