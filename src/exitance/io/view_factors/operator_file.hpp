#pragma once

#include <string>
#include <variant>

#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"
#include "exitance/view_factors/factor_operator.hpp"

namespace exitance {

/// Writes an operator as HDF5 (group `factor_operator`): its rows, whose columns are faces and then nodes, and the
/// tree. The file appears whole or not at all. Errors: ErrorCode::limit if a stop is requested,
/// ErrorCode::cannot_write.
Result<void> write_factor_operator(const std::string& path, const FactorOperator& transport, const StopRequest& stop);

/// Reads a file of write_factor_operator().
Result<FactorOperator> read_factor_operator(const std::string& path);

/// Reads a `.h5` file of view factors: a table, or an operator.
Result<std::variant<SparseFactors, FactorOperator>> read_factors(const std::string& path);

}  // namespace exitance
