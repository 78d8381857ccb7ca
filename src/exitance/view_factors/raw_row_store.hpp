#pragma once

#include <vector>

#include "exitance/view_factors/raw_row.hpp"

namespace exitance {

/// Where finished rows are kept, so that an interrupted run can go on from them.
class RawRowStore {
  public:
    virtual ~RawRowStore() = default;
    /// Returns the rows that an earlier run of the same work kept; called once, first.
    virtual std::vector<RawRow> resumed() { return {}; }
    /// Keeps a row. A failure is the store's to report; the run goes on without it.
    virtual void keep(const RawRow& row) = 0;
    /// Everything kept so far should survive the end of the process.
    virtual void flush() {}
};

}  // namespace exitance
