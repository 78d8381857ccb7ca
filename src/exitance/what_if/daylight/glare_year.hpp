#pragma once

#include <array>
#include <span>
#include <vector>

#include "exitance/measure/glare/daylight_glare_rules.hpp"
#include "exitance/what_if/daylight/daylight_totals.hpp"
#include "exitance/what_if/daylight/glare_view.hpp"
#include "exitance/what_if/daylight/sensor_year.hpp"

namespace exitance {

/// Protection from glare by EN 17037 at one view. Levels: 0 none, 1 minimum, 2 medium, 3 high.
struct GlareStatistics {
    static constexpr double allowed_share = 0.05;  ///< Share of the occupied hours that may exceed a level's limit.

    std::array<double, 3> exceeded{};  ///< Shares of the occupied hours with DGP above 0.35, 0.40 and 0.45.
    double reached = 0;                ///< DGP that 5% of the occupied hours exceed.
    double worst = 0;                  ///< Largest DGP of an occupied hour.
    int level() const;
};
GlareStatistics glare_statistics(std::span<const float> probabilities, std::span<const DaylightHour> hours,
                                 const DaylightCriteria& criteria);

/// Daylight glare of a year at one view.
struct GlareYear {
    std::vector<float> probability;  ///< DGP of every hour; 0 without light.
    GlareStatistics statistics;
};

/// Counts the levels of the views.
GlareSummary summary_of(std::span<const GlareYear> years);

/// Evaluates daylight glare for the hours of a year: the illuminance of the eye as that of a sensor, the sun by exact
/// visibility of its centre, the sky by patches, and the elements of BrightElements.
class GlareYears {
  public:
    /// All arguments must outlive this object. `threshold`: luminance of sources, cd/m^2.
    GlareYears(const DaylightSetting& setting, const DaylightTransport& transport, const ElementLight& light,
               double threshold)
        : setting_(setting),
          transport_(transport),
          threshold_(threshold),
          bright_(setting, transport, light, threshold) {}

    /// `eyes`: views, each at the eye and facing along the line of sight. `block`: their results as sensors. 10 ms per
    /// view, and 1 us per hour.
    std::vector<GlareYear> evaluate(std::span<const SurfacePoint> eyes, const DaylightBlock& block) const;

  private:
    GlareYear evaluate(const SurfacePoint& eye, std::span<const float> illuminance, std::span<const float> sun) const;

    const DaylightSetting& setting_;
    const DaylightTransport& transport_;
    double threshold_;
    BrightElements bright_;
};

}  // namespace exitance
