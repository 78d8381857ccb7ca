#include "exitance/measure/glare/near_directions.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/check.hpp"

namespace exitance {

std::vector<std::pair<std::uint32_t, std::uint32_t>> near_pairs(std::span<const Normal> directions, double angle) {
    constexpr int across = 32;  // cells with an edge of the angle along each axis: only those around one are searched
    EXI_ASSERT(2 / angle + 4 < across);
    const auto key = [&](const Normal& d, int x, int y, int z) {
        const auto cell = [&](double v) { return static_cast<int>(std::floor((v + 1) / angle)) + 2; };
        return ((cell(d.x) + x) * across + cell(d.y) + y) * across + cell(d.z) + z;
    };
    std::vector<std::pair<int, std::uint32_t>> entries;
    for (std::uint32_t i = 0; i < directions.size(); ++i) entries.emplace_back(key(directions[i], 0, 0, 0), i);
    std::sort(entries.begin(), entries.end());
    const double nearest = std::cos(angle);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> out;
    for (std::uint32_t i = 0; i < directions.size(); ++i)
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y) {
                // Cells along z have consecutive keys.
                const int low = key(directions[i], x, y, -1);
                auto entry = std::lower_bound(entries.begin(), entries.end(), std::pair{low, 0U});
                for (; entry != entries.end() && entry->first <= low + 2; ++entry)
                    if (entry->second < i && dot(directions[i], directions[entry->second]) >= nearest)
                        out.emplace_back(i, entry->second);
            }
    return out;
}

}  // namespace exitance
