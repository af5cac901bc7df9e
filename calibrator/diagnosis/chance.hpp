/// Chance: what the errors of the measurements alone leave of a fitted model's residuals.
///
///   r = P w,  w_j ~ t(nu_j),  the prior's ~ N(0, 1)     Q = sum over the data of r_j^2
///
///   P  projector off what the free parameters follow     nu_j  degrees of freedom of an error
///
/// Where every error is known, Q is chi-squared; one that was estimated from a few repetitions is
/// often too small, and Q then far above that.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "calibrator/diagnosis/model_fit.hpp"
#include "engine/random.hpp"

namespace repose::calibrator {

/// Off the columns of the tangent space, the prior's rows below the data's.
Eigen::MatrixXd projector_off(const ModelFit& fit, const ModelSpace& space);

/// Whitened errors, one per degree of freedom given (infinite: known), then normal ones up to
/// `rows`.
Eigen::VectorXd draw_errors(engine::Random& random,
                            const Eigen::VectorXd& freedom,
                            Eigen::Index rows);

/// The chance of a misfit at least as large as the fit's where nothing more is missing.
double misfit_p(const ModelFit& fit,
                const ModelSpace& space,
                const Eigen::VectorXd& freedom,
                std::uint64_t seed);

/// The same where only the number of directions is known that were fitted: any are as likely.
double misfit_p(double misfit,
                Eigen::Index directions,
                const Eigen::VectorXd& freedom,
                std::uint64_t seed);

}  // namespace repose::calibrator
