#include "calibrator/diagnosis/trend_emulator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace repose::calibrator {
namespace {

using Eigen::Index;
using Matrix = TrendEmulator::Matrix;
using Vector = TrendEmulator::Vector;

constexpr std::array lengths{0.45, 0.9, 1.8};
constexpr std::array nuggets{0.003, 0.02, 0.1, 0.5};

/// A block before the outputs are shared out: the likelihood of each at one length and noise.
struct Option {
  double length = 0.0;
  double nugget = 0.0;
  Eigen::LLT<Matrix> root;
  Matrix basis;
  Eigen::LLT<Matrix> basis_root;
  Matrix trend;
  Matrix rest;  ///< root^-1 (y - trend)
  Vector variance;
  Vector likelihood;
};

Matrix squared_distances(const Matrix& runs) {
  const Vector norms = runs.rowwise().squaredNorm();
  Matrix d2 = -2.0 * runs * runs.transpose();
  d2.colwise() += norms;
  d2.rowwise() += norms.transpose();
  return d2.cwiseMax(0.0);
}

Option weigh(const Matrix& correlation,
             const Matrix& trend_inputs,
             const Matrix& y,
             double nugget) {
  Option option;
  option.nugget = nugget;
  Matrix covariance = correlation;
  covariance.diagonal().array() += nugget;
  option.root.compute(covariance);
  option.basis = option.root.matrixL().solve(trend_inputs);
  const Matrix data = option.root.matrixL().solve(y);
  Matrix normal = option.basis.transpose() * option.basis;
  normal.diagonal().array() += 1e-9;  // runs on one line leave a slope open: it is then zero
  option.basis_root.compute(normal);
  option.trend = option.basis_root.solve(option.basis.transpose() * data);
  option.rest = data - option.basis * option.trend;
  const auto freedom = static_cast<double>(y.rows() - trend_inputs.cols());
  option.variance = (option.rest.colwise().squaredNorm().transpose() / freedom)
                        .cwiseMax(std::numeric_limits<double>::min());
  const Matrix lower = option.root.matrixLLT();
  const Matrix basis_lower = option.basis_root.matrixLLT();
  option.likelihood =
      (-0.5 * freedom * option.variance.array().log() - lower.diagonal().array().log().sum() -
       basis_lower.diagonal().array().log().sum())
          .matrix();
  return option;
}

}  // namespace

TrendEmulator::TrendEmulator(const Matrix& inputs,
                             const Matrix& outputs,
                             Vector scale,
                             const Heard& heard)
    : scale_(std::move(scale)), noise_(Vector::Constant(outputs.cols(), -1.0)) {
  std::vector<Index> every(static_cast<std::size_t>(inputs.cols()));
  std::iota(every.begin(), every.end(), Index{0});
  using Rows = std::vector<Index>;
  std::map<std::pair<Rows, std::vector<Index>>, std::vector<Index>> groups;  // -> outputs
  for (Index j = 0; j < outputs.cols(); ++j) {
    Rows rows;
    for (Index i = 0; i < outputs.rows(); ++i) {
      if (std::isfinite(outputs(i, j))) rows.push_back(i);
    }
    const auto& own = heard.empty() ? every : heard[static_cast<std::size_t>(j)];
    groups[{std::move(rows), own}].push_back(j);
  }
  for (const auto& [key, columns] : groups) {
    const auto& [rows, own] = key;
    // A trend and two runs to judge it by.
    if (rows.size() < own.size() + 3) continue;
    const Vector own_scale = scale_(own);
    const Matrix runs = inputs(rows, own).array().rowwise() / own_scale.transpose().array();
    learn(own, runs, columns, outputs(rows, columns));
  }
}

void TrendEmulator::learn(const std::vector<Index>& heard,
                          const Matrix& runs,
                          const std::vector<Index>& columns,
                          const Matrix& y) {
  Matrix trend_inputs(runs.rows(), runs.cols() + 1);
  trend_inputs << Vector::Ones(runs.rows()), runs;
  const Matrix d2 = squared_distances(runs);

  std::vector<Option> options;
  options.reserve(lengths.size() * nuggets.size());
  for (const double length : lengths) {
    const Matrix correlation = (-0.5 / (length * length) * d2.array()).exp();
    for (const double nugget : nuggets) {
      options.push_back(weigh(correlation, trend_inputs, y, nugget));
      options.back().length = length;
    }
  }
  std::vector<std::vector<Index>> chosen(options.size());
  for (Index c = 0; c < y.cols(); ++c) {
    const auto best = std::ranges::max_element(
        options, {}, [c](const Option& option) { return option.likelihood(c); });
    chosen[static_cast<std::size_t>(best - options.begin())].push_back(c);
  }
  for (std::size_t o = 0; o < options.size(); ++o) {
    if (chosen[o].empty()) continue;
    const Option& option = options[o];
    Block block;
    for (const Index c : chosen[o]) {
      block.outputs.push_back(columns[static_cast<std::size_t>(c)]);
      noise_(block.outputs.back()) = option.nugget * option.variance(c);
    }
    block.inputs = heard;
    block.length = option.length;
    block.runs = runs;
    block.root = option.root;
    block.basis = option.basis;
    block.basis_root = option.basis_root;
    block.trend = option.trend(Eigen::all, chosen[o]);
    block.weights = option.root.matrixU().solve(option.rest(Eigen::all, chosen[o]));
    block.variance = option.variance(chosen[o]);
    blocks_.push_back(std::move(block));
  }
}

Vector TrendEmulator::correlations(const Block& block, const Vector& x) {
  const Vector d2 = (block.runs.rowwise() - x.transpose()).rowwise().squaredNorm();
  return (-0.5 / (block.length * block.length) * d2.array()).exp();
}

Vector TrendEmulator::mean(const Vector& x) const {
  const Vector scaled = x.cwiseQuotient(scale_);
  Vector result = Vector::Constant(outputs(), std::numeric_limits<double>::quiet_NaN());
  for (const Block& block : blocks_) {
    const Vector own = scaled(block.inputs);
    const Vector values = block.trend.row(0).transpose() +
                          block.trend.bottomRows(own.size()).transpose() * own +
                          block.weights.transpose() * correlations(block, own);
    result(block.outputs) = values;
  }
  return result;
}

Matrix TrendEmulator::jacobian(const Vector& x) const {
  const Vector scaled = x.cwiseQuotient(scale_);
  Matrix result = Matrix::Constant(outputs(), x.size(), std::numeric_limits<double>::quiet_NaN());
  for (const Block& block : blocks_) {
    const Vector own = scaled(block.inputs), own_scale = scale_(block.inputs);
    const Vector k = correlations(block, own) / (block.length * block.length);
    const Matrix slopes = (block.runs.rowwise() - own.transpose()).array().colwise() * k.array();
    const Matrix local =
        block.trend.bottomRows(own.size()).transpose() + block.weights.transpose() * slopes;
    result(block.outputs, Eigen::all).setZero();
    result(block.outputs, block.inputs) = local.array().rowwise() / own_scale.transpose().array();
  }
  return result;
}

Vector TrendEmulator::variance(const Vector& x) const {
  const Vector scaled = x.cwiseQuotient(scale_);
  Vector result = Vector::Constant(outputs(), std::numeric_limits<double>::quiet_NaN());
  for (const Block& block : blocks_) {
    const Vector own = scaled(block.inputs);
    Vector h(own.size() + 1);
    h << 1.0, own;
    const Vector v = block.root.matrixL().solve(correlations(block, own));
    const Vector t = h - block.basis.transpose() * v;
    const double share = std::max(1.0 - v.squaredNorm() + t.dot(block.basis_root.solve(t)), 1e-6);
    result(block.outputs) = share * block.variance;
  }
  return result;
}

}  // namespace repose::calibrator
