/// Charts of a lineage, as SVG text: what each model makes of the same measurements.
#pragma once

#include <string>

#include "server/report/lineage.hpp"

namespace repose::server {

/// For each observable: predicted against measured, by the first model and by the last, on bars of
/// what a right model may be off by.
std::string parity_panels(const Lineage& lineage);

/// Measurements down, models across, coloured by the difference in standard errors.
std::string residual_map(const Lineage& lineage);

/// For each condition along which an observable was measured: the differences of the first model
/// and of the last.
std::string trend_panels(const Lineage& lineage);

/// For each experiment the root mean square difference of every model, with the noise floor.
std::string waterfall_chart(const Lineage& lineage);

/// For the effects that were refitted: what each does to the measurements, what of that the free
/// parameters cannot imitate, and what is missing.
std::string fingerprint_panels(const Generation& generation);

/// Free parameters within their bounds under the first model and under the last.
std::string shift_chart(const Lineage& lineage);

/// Of all of these: which colour is which model.
std::string model_legend(const Lineage& lineage);

/// "m0", "m1", ...: the style of a model's marks.
std::string model_style(std::size_t generation);

}  // namespace repose::server
