#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "exitance/what_if/daylight/daylight_sample.hpp"
#include "exitance/what_if/daylight/variant_tile.hpp"
#include "exitance/what_if/daylight/year_suns.hpp"

namespace exitance {

/// Light through a group of panes at the sensors of a block: one of the parts of HourlyStates.
struct StateRows {
    DaylightMatrix matrix;
    std::vector<SurfacePoint> places;  ///< The sensors in the scene of the part.
};

/// Consecutive sensors of a block.
struct TileRange {
    std::size_t first = 0, count = 0;
};

/// Corrects the hourly light of a few sensors for the states of panes, by HourlyStates. All arrays have a row per
/// sensor and a column per hour.
class StateTile {
  public:
    /// `parts`: rows of all sensors of the block, for each of the parts of the states; `sun`: direct sunlight at the
    /// sensors of the tile with all groups in their first states. Does nothing if the setting has no states.
    /// `bias`: relative, of all light.
    StateTile(const DaylightSetting& setting, const YearSuns& suns, std::span<const StateRows> parts, TileRange tile,
              std::span<const float> sun, double bias);

    /// Adds the corrections to `lux`, the light in the first states, and evaluates the variants. `replicate`: that of
    /// the light, or the number of replicates for their mean.
    void correct(std::span<float> lux, std::size_t replicate);
    /// Adds the corrections to the direct sunlight.
    void correct_sun(std::span<float> sun) const;
    /// Returns the light by which the corrections may be wrong, from the light in the first states; empty without
    /// states.
    std::vector<float> uncertainty(std::span<const float> lux) const;
    /// Returns the results with other glass: sensor by sensor, one per variant.
    std::span<const VariantResult> variants() const {
        return variants_ ? std::span(variants_->results()) : std::span<const VariantResult>();
    }

  private:
    std::span<const float> rows_of(std::span<const float> rows) const {
        const std::size_t m = parts_.front().matrix.patches;
        return rows.subspan(tile_.first * m, tile_.count * m);
    }
    void find_straight(const YearSuns& suns, std::span<const float> sun);
    void add_weighted(std::size_t part, std::span<const float> light, std::span<float> out) const;
    static void remove_rounding(std::span<float> lux) {
        for (float& v : lux) v = std::max(0.0f, v);
    }

    const DaylightSetting& setting_;
    std::span<const StateRows> parts_;
    TileRange tile_;
    /// Per part: direct sunlight, and the sum of direct sunlight and direct light of the sky.
    std::vector<std::vector<float>> sun_, straight_;
    std::optional<VariantTile> variants_;
};

}  // namespace exitance
