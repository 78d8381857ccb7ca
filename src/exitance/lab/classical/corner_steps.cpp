#include "exitance/lab/classical/corner_steps.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {

void CornerSteps::add(RegionId region, const Patch& patch, bool is_watched) {
    const auto cell = [&](double x) { return std::llround(x / rounding_); };
    const auto number = static_cast<std::uint32_t>(elements_.size());
    Element element{.corners = static_cast<std::uint8_t>(patch.corner_count()), .is_watched = is_watched};
    for (std::size_t k = 0; k < element.corners; ++k) {
        const Point p = patch.corner(static_cast<int>(k));
        const auto next = static_cast<std::uint32_t>(vertices_.size());
        const auto [entry, is_new] = known_.try_emplace({region.value, cell(p.x), cell(p.y), cell(p.z)}, next);
        if (is_new) vertices_.emplace_back();
        element.vertices[k] = entry->second;
        look_around(entry->second);
        vertices_[entry->second].elements.push_back(number);
    }
    elements_.push_back(element);
}

void CornerSteps::remove(std::size_t element) {
    Element& removed = elements_[element];
    for (std::size_t k = 0; k < removed.corners; ++k) {
        std::erase(vertices_[removed.vertices[k]].elements, static_cast<std::uint32_t>(element));
        look_around(removed.vertices[k]);
    }
    removed.corners = 0;
}

/// Marks all elements around a vertex, so that the next call tests them again.
void CornerSteps::look_around(std::uint32_t vertex) {
    for (std::uint32_t i : vertices_[vertex].elements) elements_[i].next_look = 0;
}

const std::array<float, bands>& CornerSteps::mean_at(std::uint32_t vertex, const ValueOf& value) {
    Vertex& v = vertices_[vertex];
    if (v.look == looks_) return v.mean;
    Spectrum sum;
    for (std::uint32_t i : v.elements) {
        const Spectrum own = value(i);
        // Rounded as functions on elements store it.
        for (std::size_t b = 0; b < bands; ++b) sum[b] += static_cast<double>(static_cast<float>(own[b]));
    }
    const Spectrum mean = sum / static_cast<double>(v.elements.size());
    for (std::size_t b = 0; b < bands; ++b) v.mean[b] = static_cast<float>(mean[b]);
    v.look = looks_;
    return v.mean;
}

CornerSteps::Range CornerSteps::largest_step(std::size_t element, const ValueOf& value) {
    std::array<const std::array<float, bands>*, 4> corner{};
    const Element& e = elements_[element];
    for (std::size_t k = 0; k < e.corners; ++k) corner[k] = &mean_at(e.vertices[k], value);
    Range largest;
    for (std::size_t b = 0; b < bands; ++b) {
        Range of_band{HUGE_VAL, -HUGE_VAL};
        for (std::size_t k = 0; k < e.corners; ++k) {
            const auto v = static_cast<double>((*corner[k])[b]);
            of_band = {std::min(of_band.low, v), std::max(of_band.high, v)};
        }
        if (b == 0 || of_band.high - of_band.low > largest.high - largest.low) largest = of_band;
    }
    return largest;
}

std::vector<std::size_t> CornerSteps::steeper_than(double limit, double change, const ValueOf& value) {
    ++looks_;
    changes_ += change;
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < elements_.size(); ++i) {
        Element& e = elements_[i];
        if (e.corners == 0 || !e.is_watched || changes_ < e.next_look) continue;
        const auto [low, high] = largest_step(i, value);
        if (high - low > limit) {
            out.push_back(i);
            continue;
        }
        // Derived from single precision: what rounding of the means may add to a difference.
        constexpr double rounding = 1e-6;
        const double room = limit - (high - low) - rounding * std::max(std::abs(low), std::abs(high));
        // One corner may rise by the change while another one falls by it.
        e.next_look = changes_ + 0.5 * std::max(0.0, room);
    }
    return out;
}

}  // namespace exitance
