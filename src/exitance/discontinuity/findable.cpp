#include "exitance/discontinuity/findable.hpp"

#include <algorithm>

namespace exitance {

double min_findable(std::vector<double> areas, double unfindable) {
    std::erase(areas, 0.0);
    std::sort(areas.begin(), areas.end());
    double sum = 0, least = 0;
    for (const double area : areas) {
        sum += area;
        if (sum > unfindable) break;
        least = area;
    }
    return least;
}

std::size_t count_different(std::vector<PieceId> pieces) {
    std::sort(pieces.begin(), pieces.end(), [](PieceId a, PieceId b) { return a.value < b.value; });
    return static_cast<std::size_t>(std::unique(pieces.begin(), pieces.end()) - pieces.begin());
}

}  // namespace exitance
