#include "exitance/mesh/discontinuity/clough_tocher.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {

CloughTocher::CloughTocher(const Data& data) : corner_(data.value) {
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        edge_[i] = {corner_[i] + data.to_next[i][0] / 3, corner_[j] + data.to_next[j][1] / 3};
        // the centroid S minus the corner V is a third of the sum of both edge vectors
        spoke_[i] = corner_[i] + (data.to_next[i][0] + data.to_next[i][1]) / 9;
    }
    // The slope at an edge's middle towards S, which is a third of the way across, equals that of the cubic at the
    // edge: across / 3 = 3 (d_0 / 4 + d_1 / 2 + d_2 / 4), where d_k are differences of ordinates, one of which is the
    // wing.
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        wing_[i] = 2 * (data.across[i] / 9 + (corner_[i] + corner_[j]) / 8 + 3 * (edge_[i][0] + edge_[i][1]) / 8 -
                        (spoke_[i] + spoke_[j]) / 4);
    }
    for (std::size_t i = 0; i < 3; ++i) hub_[i] = (spoke_[i] + wing_[i] + wing_[(i + 2) % 3]) / 3;
    centre_ = (hub_[0] + hub_[1] + hub_[2]) / 3;
}

double CloughTocher::at(const std::array<double, 3>& L) const {
    const auto k = static_cast<std::size_t>(std::min_element(L.begin(), L.end()) - L.begin());
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    const double u = L[i] - L[k], v = L[j] - L[k], w = 3 * L[k];
    return u * u * (corner_[i] * u + 3 * (edge_[i][0] * v + spoke_[i] * w)) +
           v * v * (corner_[j] * v + 3 * (edge_[i][1] * u + spoke_[j] * w)) +
           w * w * (centre_ * w + 3 * (hub_[i] * u + hub_[j] * v)) + 6 * wing_[i] * u * v * w;
}

double CloughTocher::mean() const {
    double sum = 3 * centre_;  // The mean of a cubic is that of its ten ordinates; the three parts have equal areas.
    for (std::size_t i = 0; i < 3; ++i)
        sum += 2 * (corner_[i] + spoke_[i] + hub_[i]) + edge_[i][0] + edge_[i][1] + wing_[i];
    return sum / 30;
}

EdgeFrame::EdgeFrame(const Point& a, const Point& b, const Point& across) {
    const Vec3 edge = b - a, way = across - 0.5 * (a + b);
    const double square = squared_norm(edge);
    if (!(square > 0)) return;
    along = dot(way, edge) / square;
    height = norm(cross(edge, way)) / std::sqrt(square);
}

double slope_along(const CloughTocher::Data& data, std::size_t i) {
    const std::size_t j = (i + 1) % 3;
    // Slope of the cubic in the middle, derived from its values and slopes at both ends.
    return 1.5 * (data.value[j] - data.value[i]) - 0.25 * (data.to_next[i][0] - data.to_next[j][1]);
}

}  // namespace exitance
