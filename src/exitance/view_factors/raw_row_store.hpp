#pragma once

#include <vector>

#include "exitance/view_factors/raw_row.hpp"

namespace exitance {

/// Storage for finished rows, from which an interrupted run can be resumed.
class RawRowStore {
  public:
    virtual ~RawRowStore() = default;
    /// Returns the rows kept by an earlier run of the same work. Called once, before all other functions.
    virtual std::vector<RawRow> resumed() { return {}; }
    /// Keeps a row. The store reports failures itself; the run continues without it.
    virtual void keep(const RawRow& row) = 0;
    /// Makes all rows kept so far survive the end of the process.
    virtual void flush() {}
};

/// Returns the rows that the store of the first process has kept, in all processes; none without a store, which the
/// other processes do not have. Collective.
std::vector<RawRow> resumed_rows(RawRowStore* store);

}  // namespace exitance
