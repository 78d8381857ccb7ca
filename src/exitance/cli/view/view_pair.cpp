#include "exitance/cli/view/view_pair.hpp"

#include <fmt/format.h>

namespace exitance {
namespace {

constexpr double same_box = 0.01;  ///< Allowed difference, in diagonals; derived from lamps that stick out of ceilings.

std::string words(const Box& box) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g})", box.lo.x, box.lo.y, box.lo.z, box.hi.x,
                       box.hi.y, box.hi.z);
}

}  // namespace

Result<void> check_pair(const Scene& first, const Scene& second, const ViewUnits& units,
                        const std::string& second_file) {
    const Box &a = first.box(), &b = second.box();
    const double allowed = same_box * a.diagonal();
    if (!(norm(a.lo - b.lo) <= allowed && norm(a.hi - b.hi) <= allowed))
        return Error{
            ErrorCode::usage,
            fmt::format("is of another scene: it extends from {}, and the first from {} m", words(b), words(a)),
            second_file, "compare solutions of one room; lamps, furniture and materials may differ"};
    if (units(first).is_lux() != units(second).is_lux())
        return Error{ErrorCode::usage, "has its light in another unit than the first solution", second_file,
                     "choose one by --unit lux or --unit w"};
    return {};
}

}  // namespace exitance
