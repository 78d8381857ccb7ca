#include "exitance/transport/ray_rows.hpp"

#include <bit>

#include "exitance/core/parallel.hpp"
#include "exitance/core/random.hpp"
#include "exitance/core/trace.hpp"
#include "exitance/transport/element_rays.hpp"

namespace exitance {

unsigned RayBudget::rays(double area, double mean_area) const {
    const double wanted = average * std::sqrt(area / mean_area);
    const double clamped = std::clamp(wanted, static_cast<double>(least), static_cast<double>(most));
    return std::bit_floor(static_cast<unsigned>(clamped * std::numbers::sqrt2));  // to the nearer power of two
}

RayRows::RayRows(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering,
                 const ElementLocator& locator, RayBudget budget, std::uint64_t seed) {
    const std::size_t n = numbering.leaves.size();
    const double mean_area = stage.area / static_cast<double>(n);
    first_.assign(n + 1, 0);
    for (std::size_t i = 0; i < n; ++i)
        first_[i + 1] = first_[i] + budget.rays(tree.area(numbering.leaves[i]), mean_area);
    hits_.assign(first_[n], missed);

    parallel_ranges(n, 16,
                    [&](std::size_t begin, std::size_t end) {
                        ElementRays rays(stage, tree, locator);
                        for (std::size_t i = begin; i < end; ++i) {
                            const std::size_t count = first_[i + 1] - first_[i];
                            rays.cast(numbering.leaves[i], hash(seed, static_cast<std::uint64_t>(Stream::rows), i),
                                      std::span(hits_).subspan(first_[i], count));
                            note_touched("rays", count);
                        }
                    },
                    {"cast rows", [&](std::size_t i) { return tree.region(numbering.leaves[i]).value; }});
}

Spectrum RayRows::gather_at(std::size_t receiver, std::span<const Spectrum> radiosity) const {
    Spectrum sum;
    for (std::size_t k = first_[receiver]; k < first_[receiver + 1]; ++k)
        if (hits_[k] != missed) sum += radiosity[hits_[k]];
    return sum / static_cast<double>(first_[receiver + 1] - first_[receiver]);
}

void RayRows::gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const {
    parallel_for(size(), 64, [&](std::size_t i) { irradiance[i] = gather_at(i, radiosity); });
}

}  // namespace exitance
