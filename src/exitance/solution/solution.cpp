#include "exitance/solution/solution.hpp"

#include <algorithm>

namespace exitance {
namespace {

constexpr std::array<std::string_view, 8> stop_reason_names{"",           "interrupt",  "time limit", "memory limit",
                                                            "iterations", "divergence", "unit limit", "termination"};

}  // namespace

std::string_view name_of(StopReason reason) {
    return stop_reason_names[static_cast<std::size_t>(reason)];
}

StopReason reason_of(const StopRequest& stop) {
    switch (stop.cause()) {
        case StopRequest::Cause::interrupt:
            return StopReason::interrupt;
        case StopRequest::Cause::termination:
            return StopReason::termination;
        case StopRequest::Cause::memory_limit:
            return StopReason::memory_limit;
        case StopRequest::Cause::time_limit:
        case StopRequest::Cause::none:
            return StopReason::time_limit;
    }
    return StopReason::time_limit;
}

StopReason stop_reason_of(std::string_view name) {
    const auto found = std::find(stop_reason_names.begin(), stop_reason_names.end(), name);
    return found == stop_reason_names.end() ? StopReason::none
                                            : static_cast<StopReason>(found - stop_reason_names.begin());
}

void ElementFunction::add_value(const Spectrum& value) {
    std::array<float, bands> v;
    for (std::size_t b = 0; b < bands; ++b) v[b] = static_cast<float>(value[b]);
    values.push_back(v);
}

Spectrum ElementFunction::at(ElementTree::Place place) const {
    if (place.element.is_none()) return Spectrum();
    const auto [u, v] = place.uv;
    const bool triangle = place.element >= tree.first_of_fans() || tree.patch(place.element).is_triangle();
    const double weight[4] = {triangle ? 1 - u - v : (1 - u) * (1 - v), triangle ? u : u * (1 - v),
                              triangle ? v : u * v, triangle ? 0 : (1 - u) * v};
    const std::size_t first = first_value[place.element];
    Spectrum sum;
    for (std::size_t i = 0; i < (triangle ? 3u : 4u); ++i)
        for (std::size_t b = 0; b < bands; ++b) sum[b] += weight[i] * static_cast<double>(values[first + i][b]);
    return sum;
}

}  // namespace exitance
