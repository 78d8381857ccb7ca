#include "exitance/view_factors/raw_row_store.hpp"

#include "exitance/processes/exchange_archived.hpp"

namespace exitance {

std::vector<RawRow> resumed_rows(RawRowStore* store) {
    return as_first_archived(
        store ? store->resumed() : std::vector<RawRow>(),
        [](auto& archive, std::vector<RawRow>& rows) { archive(rows); }, "rows");
}

}  // namespace exitance
