#pragma once

#include <span>
#include <vector>

#include "exitance/what_if/daylight/daylight_sample.hpp"

namespace exitance {

/// The elements of a scene that are brighter than a threshold, in every hour of a year: sources of glare.
///
/// Their luminance is that of the sky's light, with all its reflections, and of direct sunlight at their centre.
/// Sunlight that arrives after a reflection is left out.
class BrightElements {
  public:
    struct Entry {
        std::uint32_t leaf = 0;
        float luminance = 0;  ///< cd/m^2
    };

    /// `threshold`: cd/m^2. O(leaves x hours x patches), and a search for blockers for every leaf and hour in which
    /// the sun could make it bright enough.
    BrightElements(const DaylightSetting& setting, const DaylightTransport& transport, const ElementLight& light,
                   double threshold);

    /// Returns the bright elements in the hour YearSky::bright_hours()[k], in ascending order of leaves.
    std::span<const Entry> in_hour(std::size_t k) const {
        return std::span(entries_).subspan(first_[k], first_[k + 1] - first_[k]);
    }
    /// True if a leaf is bright in some hour.
    bool is_ever_bright(std::size_t leaf) const { return is_bright_[leaf] != 0; }

  private:
    std::vector<Entry> entries_;      ///< Entries, hour by hour.
    std::vector<std::size_t> first_;  ///< Per hour: index of its first entry; the last value is the number of entries.
    std::vector<std::uint8_t> is_bright_;
};

}  // namespace exitance
