#include "exitance/lab/classical/corner_steps.hpp"

#include <cmath>

namespace exitance {

void CornerSteps::add(RegionId region, const Patch& patch) {
    const auto cell = [&](double x) { return std::llround(x / rounding_); };
    std::array<std::uint32_t, 4> around{};
    const int corners = patch.corner_count();
    for (int k = 0; k < corners; ++k) {
        const Point p = patch.corner(k);
        const auto next = static_cast<std::uint32_t>(vertices_.size());
        const auto [entry, is_new] = known_.try_emplace({region.value, cell(p.x), cell(p.y), cell(p.z)}, next);
        if (is_new) vertices_.emplace_back();
        around[static_cast<std::size_t>(k)] = entry->second;
    }
    vertices_of_.push_back(around);
    corner_count_.push_back(static_cast<std::uint8_t>(corners));
}

void CornerSteps::average(std::span<const Spectrum> values) {
    for (Vertex& v : vertices_) v.sum = {}, v.count = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        Spectrum delivered;  // rounded as functions on elements store it
        for (std::size_t b = 0; b < bands; ++b) delivered[b] = static_cast<double>(static_cast<float>(values[i][b]));
        for (std::size_t k = 0; k < corner_count_[i]; ++k) {
            Vertex& v = vertices_[vertices_of_[i][k]];
            v.sum += delivered, v.count += 1;
        }
    }
    for (Vertex& v : vertices_) {
        if (v.count == 0) continue;
        const Spectrum mean = v.sum / v.count;
        for (std::size_t b = 0; b < bands; ++b) v.mean[b] = static_cast<float>(mean[b]);
    }
}

double CornerSteps::largest_step(std::size_t element) const {
    double largest = 0;
    for (std::size_t b = 0; b < bands; ++b) {
        double lo = HUGE_VAL, hi = -HUGE_VAL;
        for (std::size_t k = 0; k < corner_count_[element]; ++k) {
            const auto v = static_cast<double>(vertices_[vertices_of_[element][k]].mean[b]);
            lo = std::min(lo, v), hi = std::max(hi, v);
        }
        largest = std::max(largest, hi - lo);
    }
    return largest;
}

}  // namespace exitance
